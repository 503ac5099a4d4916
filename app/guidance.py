"""Whatever helps a person to find things, built in one place: shortcuts, palette, overlay of keys, tour."""

from collections.abc import Callable

from PySide6.QtCore import QObject

import resources
from app.dialogs.keys import KeysOverlay
from app.dialogs.palette import CommandPalette, Entry, entries_of
from app.dialogs.shortcuts import ShortcutsDialog
from app.dialogs.tour import TourCard
from app.files import Files
from app.settings import Settings
from app.shortcuts import Shortcuts
from app.tour import Tour
from app.window import Window


class Guidance(QObject):
    """See the module. `runs` are the actions that it answers."""

    def __init__(self, window: Window, files: Files, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._window, self._files, self._settings = window, files, settings
        self.shortcuts = Shortcuts(window.table, settings, self)
        self.palette = CommandPalette(window, self._entries)
        self.tour = Tour(window.session, settings, self)
        self.card = TourCard(self.tour, window.canvas, window.table.key_of, self._empty_page)
        window.canvas.key_of = window.table.key_of
        self.overlay: KeysOverlay | None = None
        self.dialog: ShortcutsDialog | None = None
        self.shortcuts.changed.connect(self._on_keys)
        self._on_keys()

    @property
    def runs(self) -> dict[str, Callable[[], object]]:
        """What the actions do."""
        return {
            "edit.shortcuts": self._open_shortcuts,
            "help.find": self.palette.open,
            "help.keys": self._show_keys,
            "help.tour": self.tour.restart,
        }

    def _on_keys(self) -> None:
        canvas = self._window.canvas
        canvas.space_plays = "Space" in self._window.table.keys_of("play.toggle")
        canvas.refresh()
        self.card.refresh()

    def _show_keys(self) -> None:
        window = self._window
        overlay = KeysOverlay(window, window.table, self.shortcuts, window.tools.values(), window.canvas.tool)
        overlay.destroyed.connect(self._forget_overlay)
        self.overlay = overlay

    def _forget_overlay(self) -> None:
        self.overlay = None

    def _open_shortcuts(self) -> None:
        self.dialog = ShortcutsDialog(self.shortcuts, self._window.table, self._window)
        self.dialog.open()

    def _entries(self) -> list[Entry]:
        """Everything that the palette finds: the menus, recent files, samples."""
        files = self._files
        found = entries_of(self._window.table)
        for path in self._settings.recent_files():
            found.append(Entry(path.name, "Open Recent", "", lambda p=path: files.open_path(p), words=str(path)))
        for path in resources.samples():
            found.append(Entry(path.stem.capitalize(), "Samples", "", lambda p=path: files.open_sample(p)))
        return found

    def _empty_page(self) -> bool:
        """Give the tour an empty page, if the person lets the open document go."""
        document = self._window.session.document
        if any(layer.keyframes for layer in document.layers):
            self._files.new()
        return not any(layer.keyframes for layer in self._window.session.document.layers)
