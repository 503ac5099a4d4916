"""The QActions made of the table of actions, with the keys and texts they have now."""

from collections.abc import Callable, Mapping

from PySide6.QtCore import QObject, Qt
from PySide6.QtGui import QAction, QActionGroup, QKeySequence

from app.actions import ACTIONS, ActionSpec
from app.theme import Theme, icon


class ActionTable(QObject):
    """The QActions of the table, by id."""

    def __init__(self, theme: Theme, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.actions: dict[str, QAction] = {}
        self._specs = {spec.id: spec for spec in ACTIONS if spec.id}
        self._keys: dict[str, tuple[str, ...]] = {spec.id: spec.keys for spec in self._specs.values()}
        self._groups: dict[str, QActionGroup] = {}
        for spec in self._specs.values():
            self.actions[spec.id] = self._made(spec)
            self._show_keys(spec.id)
        self.set_theme(theme)

    def _made(self, spec: ActionSpec) -> QAction:
        action = QAction(spec.text, self)
        action.setObjectName(spec.id)
        action.setShortcutContext(Qt.ShortcutContext.WindowShortcut)
        action.setCheckable(spec.checkable)
        action.setAutoRepeat(not spec.id.startswith("flip."))
        action.setStatusTip("")
        if spec.group:
            group = self._groups.setdefault(spec.group, QActionGroup(self))
            group.addAction(action)
        return action

    def _show_keys(self, name: str) -> None:
        """Give an action its keys, and its tooltip the first of them."""
        action, spec = self.actions[name], self._specs[name]
        action.setShortcuts([QKeySequence(k) for k in self._keys[name]])
        tip = spec.tip or action.text().rstrip("…")
        action.setToolTip(f"{tip} ({self.key_of(name)})" if self._keys[name] else tip)

    def set_keys(self, keys: Mapping[str, tuple[str, ...]]) -> None:
        """Give actions other keys."""
        for name in keys.keys() & self.actions.keys():
            if self._keys[name] != keys[name]:
                self._keys[name] = keys[name]
                self._show_keys(name)

    def keys_of(self, name: str) -> tuple[str, ...]:
        """Return the keys of an action as they are now."""
        return self._keys[name]

    def key_of(self, name: str) -> str:
        """Return the first key of an action; "" if it has none."""
        return self._keys[name][0] if self._keys[name] else ""

    def set_text(self, name: str, text: str) -> None:
        """Call an action otherwise, as Play is called Pause while the film runs."""
        if self.actions[name].text() != text:
            self.actions[name].setText(text)
            self._show_keys(name)

    def spec(self, name: str) -> ActionSpec:
        """Return an action's row of the table."""
        return self._specs[name]

    def set_theme(self, theme: Theme) -> None:
        for spec in self._specs.values():
            if spec.icon:
                self.actions[spec.id].setIcon(icon(spec.icon, theme))
                self.actions[spec.id].setIconVisibleInMenu(False)

    def connect_all(self, runs: dict[str, Callable[[], object]]) -> None:
        """Give every action what it runs; a missing or surplus one is a mistake in the program."""
        if runs.keys() != self.actions.keys() - {"file.recent"}:
            raise KeyError(f"actions and functions differ: {sorted(runs.keys() ^ self.actions.keys())}")
        for name, run in runs.items():
            self.actions[name].triggered.connect(lambda _=False, run=run: run())

    def __getitem__(self, name: str) -> QAction:
        return self.actions[name]
