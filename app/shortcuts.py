"""Which key runs which action: presets that feel like other programs, and what a person has changed on top."""

import json
from collections.abc import Mapping

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QKeySequence

from app.action_table import ActionTable
from app.actions import ACTIONS
from app.settings import Settings

Keys = dict[str, tuple[str, ...]]
"""The keys of actions by id, the first one shown."""

OWN = "Inkbetween"
PRESETS: dict[str, Keys] = {
    OWN: {},
    "OpenToonz-like": {
        "file.open": ("Ctrl+L",),
        "edit.redo": ("Ctrl+Y", "Ctrl+Shift+Z"),
        "tool.select": ("S",),
        "tool.pen": ("G",),
        "insert.letters": ("Y",),
        "view.lines": ("Shift+L",),
        "view.onion": ("/",),
        "view.fit": ("Alt+9",),
        "view.actual": ("N",),
        "view.zoom_in": ("+", "="),
        "view.zoom_out": ("-",),
        "play.toggle": ("P",),
        "play.loop": ("L",),
        "play.previous": ("Shift+,", ",", "Left"),
        "play.next": ("Shift+.", ".", "Right"),
        "play.first": ("Alt+,", "Home"),
        "play.last": ("Alt+.", "End"),
    },
    "Animate-like": {
        "file.import": ("Ctrl+R",),
        "file.export": ("Ctrl+Alt+Shift+S",),
        "file.stage": ("Ctrl+J",),
        "edit.redo": ("Ctrl+Y",),
        "tool.pencil": ("Shift+Y",),
        "view.onion": ("Alt+Shift+O",),
        "view.fit": ("Ctrl+2",),
        "view.actual": ("Ctrl+1",),
        "view.zoom_in": ("Ctrl+=", "Ctrl++"),
        "play.toggle": ("Return",),
        "play.loop": ("Alt+Shift+L",),
        "play.first": ("Shift+,", "Home"),
        "play.last": ("Shift+.", "End"),
    },
}
"""What each preset has other than the table of actions. An action that is named nowhere keeps the table's keys."""


def preset_keys(preset: str) -> Keys:
    """Return the keys of every action in a preset."""
    return {spec.id: PRESETS[preset].get(spec.id, spec.keys) for spec in ACTIONS if spec.id}


def normal(key: str) -> str:
    """Return a key as Qt writes it; "" for what is none."""
    return QKeySequence(key).toString(QKeySequence.SequenceFormat.PortableText)


def conflicts(keys: Mapping[str, tuple[str, ...]]) -> dict[str, tuple[str, ...]]:
    """Return every key that more than one action has, with those actions."""
    owners: dict[str, list[str]] = {}
    for name, own in keys.items():
        for key in dict.fromkeys(map(normal, own)):
            owners.setdefault(key, []).append(name)
    return {key: tuple(names) for key, names in owners.items() if len(names) > 1}


class Shortcuts(QObject):
    """The keys in use, kept between runs; `changed` after each change."""

    changed = Signal()

    def __init__(self, table: ActionTable, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._table, self._settings = table, settings
        preset = settings.text("shortcuts/preset", OWN)
        self._preset = preset if preset in PRESETS else OWN
        self._own = _read(settings.text("shortcuts/own", "{}"))
        self._show()

    @property
    def preset(self) -> str:
        """The name of the preset in use."""
        return self._preset

    @property
    def keys(self) -> Keys:
        """The keys of every action: the preset's, and the person's own on top."""
        return preset_keys(self._preset) | self._own

    @property
    def own(self) -> Keys:
        """What the person has changed."""
        return dict(self._own)

    def set_preset(self, preset: str) -> None:
        """Use another preset; the person's own keys are forgotten, as they may belong to other actions there."""
        if preset in PRESETS and (preset != self._preset or self._own):
            self._preset, self._own = preset, {}
            self._keep()

    def owners(self, key: str, name: str) -> tuple[str, ...]:
        """Return the other actions that have a key."""
        wanted = normal(key)
        return tuple(x for x, own in self.keys.items() if x != name and wanted in map(normal, own))

    def assign(self, name: str, key: str) -> None:
        """Make `key` the only one of an action, or, with "", leave it without; others lose that key."""
        wanted = normal(key)
        for other in self.owners(wanted, name) if wanted else ():
            self._set(other, tuple(k for k in self.keys[other] if normal(k) != wanted))
        self._set(name, (wanted,) if wanted else ())
        self._keep()

    def reset(self, name: str) -> tuple[str, ...]:
        """Give an action the preset's keys again; return the names of actions that have one of them by now.

        Then nothing is changed.
        """
        wanted = preset_keys(self._preset)[name]
        taken = tuple(dict.fromkeys(x for key in wanted for x in self.owners(key, name)))
        if not taken and name in self._own:
            del self._own[name]
            self._keep()
        return taken

    def reset_all(self) -> None:
        """Forget what the person has changed."""
        if self._own:
            self._own = {}
            self._keep()

    def _set(self, name: str, keys: tuple[str, ...]) -> None:
        if keys == preset_keys(self._preset)[name]:
            self._own.pop(name, None)
        else:
            self._own[name] = keys

    def _keep(self) -> None:
        self._settings.keep("shortcuts/preset", self._preset)
        self._settings.keep("shortcuts/own", json.dumps(self._own))
        self._show()
        self.changed.emit()

    def _show(self) -> None:
        self._table.set_keys(self.keys)


def _read(text: str) -> Keys:
    """Return what was kept; what is damaged, or of actions that are gone, is left out."""
    try:
        kept = json.loads(text)
    except ValueError:
        return {}
    known = {spec.id for spec in ACTIONS if spec.id}
    found: Keys = {}
    for name, keys in kept.items() if isinstance(kept, dict) else ():
        if name in known and isinstance(keys, list) and all(isinstance(k, str) and normal(k) for k in keys):
            found[name] = tuple(keys)
    return found
