"""Menus that are filled when they are wanted."""

from collections.abc import Callable
from pathlib import Path

from PySide6.QtWidgets import QMenu

import resources
from app.settings import Settings

OpenPath = Callable[[Path], object]


def fill_samples(menu: QMenu, open_sample: OpenPath) -> None:
    """List the bundled samples."""
    for path in resources.samples():
        action = menu.addAction(path.stem.capitalize())
        action.triggered.connect(lambda _=False, p=path: open_sample(p))


def fill_recent(menu: QMenu, settings: Settings, open_path: OpenPath) -> None:
    """List the files opened last; one that is not there now is greyed and stays, for its disk may come back."""
    menu.clear()
    menu.setToolTipsVisible(True)
    recent = settings.recent_files()
    for path in recent:
        there = path.is_file()
        action = menu.addAction(path.name if there else f"{path.name} (not found)")
        action.setToolTip(str(path))
        action.setEnabled(there)
        action.triggered.connect(lambda _=False, p=path: open_path(p))
    menu.setEnabled(bool(recent))
    if recent:
        menu.addSeparator()
        menu.addAction("Forget These").triggered.connect(settings.clear_recent)
