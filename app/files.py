"""New, open, save and close, with their questions."""

from collections.abc import Callable
from pathlib import Path

from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.session import Session
from app.settings import Settings
from core.errors import InkbetweenError
from core.io.project import SUFFIX, load
from core.model.document import Document

FILTER = f"Inkbetween projects (*{SUFFIX});;All files (*)"


class Files:
    """Every way in which the open document meets the disk."""

    def __init__(
        self,
        parent: QWidget,
        session: Session,
        settings: Settings,
        completed: Callable[[Document], Document],
        tell: Callable[[str, str], None],
    ) -> None:
        """`completed` adds to a document what is saved with it; `tell(text, kind)` shows a sentence."""
        self._parent, self._session, self._settings = parent, session, settings
        self._completed, self._tell = completed, tell

    def new(self) -> None:
        if self.may_leave():
            self._session.new()

    def open(self) -> None:
        if not self.may_leave():
            return
        name, _ = QFileDialog.getOpenFileName(self._parent, "Open", str(self._folder()), FILTER)
        if name:
            self.open_path(Path(name), ask=False)

    def open_path(self, path: Path, *, ask: bool = True) -> bool:
        """Open a file; where that fails the open document stays."""
        if ask and not self.may_leave():
            return False
        try:
            self._session.open(path)
        except InkbetweenError as e:
            self._tell(str(e), "error")
            return False
        self._remember(path)
        return True

    def open_sample(self, path: Path) -> bool:
        """Open a bundled file as a new document, so that saving never overwrites it."""
        if not self.may_leave():
            return False
        try:
            self._session.new(load(path), path.stem)
        except InkbetweenError as e:
            self._tell(str(e), "error")
            return False
        frames = self._session.layer.frames()
        if len(frames) > 1:
            self._session.go_to((frames[0] + frames[1]) // 2)  # where an in-between is to be seen
        return True

    def save(self) -> bool:
        if self._session.path is None:
            return self.save_as()
        return self._save_to(self._session.path)

    def save_as(self) -> bool:
        start = self._session.path or self._folder() / f"{self._session.name}{SUFFIX}"
        name, _ = QFileDialog.getSaveFileName(self._parent, "Save As", str(start), FILTER)
        if not name:
            return False
        path = Path(name)
        chosen = path if path.suffix else path.with_suffix(SUFFIX)
        if chosen != path and chosen.exists() and not self._may_overwrite(chosen):
            return False  # the dialog asked about the name without its suffix only
        return self._save_to(chosen)

    def may_leave(self) -> bool:
        """Whether the open document may go: it is saved, or the person gave it up."""
        if not self._session.is_modified:
            return True
        box = QMessageBox(self._parent)
        box.setIcon(QMessageBox.Icon.Question)
        box.setText(f"Save the changes to “{self._session.name}”?")
        box.setInformativeText("What you changed since the last save is lost otherwise.")
        button = QMessageBox.StandardButton
        box.setStandardButtons(button.Save | button.Discard | button.Cancel)
        box.setDefaultButton(button.Save)
        answer = box.exec()
        if answer == button.Save:
            return self.save()
        return answer == button.Discard

    def _save_to(self, path: Path) -> bool:
        try:
            self._session.save(path, self._completed(self._session.document))
        except InkbetweenError as e:
            self._tell(f"{e}. Your drawing is still here: choose Save As and another place.", "error")
            return False
        self._remember(path)
        return True

    def _may_overwrite(self, path: Path) -> bool:
        answer = QMessageBox.question(self._parent, "Save As", f"“{path.name}” exists already. Replace it?")
        return answer == QMessageBox.StandardButton.Yes

    def _remember(self, path: Path) -> None:
        self._settings.add_recent(path)
        self._settings.keep("folder", str(path.resolve().parent))

    def _folder(self) -> Path:
        if self._session.path is not None:
            return self._session.path.parent
        kept = Path(self._settings.text("folder"))
        return kept if str(kept) != "." and kept.is_dir() else Path.home()
