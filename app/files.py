"""New, open, save and close, with their questions."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Protocol

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QFileDialog, QMessageBox, QWidget

from app.awake import awake
from app.dialogs.ask import ask
from app.filelock import FileLock
from app.panels.messagebar import Choice
from app.preview.worker import NewestWins
from app.session import Session
from app.settings import Settings
from core.errors import InkbetweenError
from core.io.project import LARGEST_FILE, SUFFIX, load, load_seen, save
from core.io.storage import Fingerprint, backup_of, fingerprint_on_disk, is_changed
from core.model.document import Document
from core.model.references import with_absolute_references, with_relative_references

FILTER = f"Inkbetween projects (*{SUFFIX});;All files (*)"
COPY, ANYWAY = "Open a Copy", "Open Anyway"
SAVE_ANYWAY, SAVE_AS, RELOAD = "Save Anyway", "Save As…", "Reload"


class Tell(Protocol):
    """Shows a sentence, with buttons for what can be done about it."""

    def __call__(self, text: str, kind: str, choices: tuple[Choice, ...] = (), /) -> None: ...


@dataclass(frozen=True, slots=True)
class _Change:
    """The file was changed: what we had seen of it, and what it is now."""

    path: Path
    seen: Fingerprint
    now: Fingerprint | None


def _look(path: Path, seen: Fingerprint, noticed: Fingerprint | None) -> _Change | None:
    """Return a change of the file that was not told yet."""
    if not is_changed(path, seen, LARGEST_FILE):
        return None
    now = fingerprint_on_disk(path, LARGEST_FILE)
    return _Change(path, seen, now) if noticed is None or now != noticed else None


class Files(QObject):
    """Every way in which the open document meets the disk."""

    opened = Signal(Path)

    def __init__(
        self,
        parent: QWidget,
        session: Session,
        settings: Settings,
        completed: Callable[[Document], Document],
        tell: Tell,
    ) -> None:
        """`completed` adds to a document what is saved with it; `tell(text, kind)` shows a sentence."""
        super().__init__(parent)
        self._parent, self._session, self._settings = parent, session, settings
        self._completed, self._tell = completed, tell
        self._lock: FileLock | None = None
        self._seen: Fingerprint | None = None
        self._noticed: Fingerprint | None = None
        self._writing: Path | None = None
        self._was_slow = False
        self._then: Callable[[], object] | None = None
        self._watch = NewestWins(self, name="watch")
        self._watch.finished.connect(self._on_looked)

    # new and open

    def new(self) -> None:
        if self.may_leave():
            self._session.new()
            self._own(None, None)

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
            document, seen = awake(partial(load_seen, path), deaf=True)
        except InkbetweenError as e:
            self._tell(str(e), "error")
            return False
        lock, answer = self._locked(path)
        if answer == COPY:
            copy = with_absolute_references(document, path.parent)
            self._session.new(copy, f"{path.stem} copy")
            self._own(None, None)
        elif answer == ANYWAY:
            self._session.opened(document, path)
            self._own(lock, seen)
            self._remember(path)
            self.opened.emit(path)
        return answer in (COPY, ANYWAY)

    def _locked(self, path: Path) -> tuple[FileLock | None, str]:
        """Take the lock of a file; where another window has it, ask what to do."""
        lock = self._lock_of(path)
        owner = None if lock is self._lock else lock.take()
        if owner is None:
            return lock, ANYWAY
        detail = f"It belongs to {owner}. If both windows save, the one that saves last wins."
        return lock, ask(self._parent, f"“{path.name}” is open in another window.", detail, (COPY, ANYWAY))

    def open_sample(self, path: Path) -> bool:
        """Open a bundled file as a new document, so that saving never overwrites it."""
        if not self.may_leave():
            return False
        try:
            self._session.new(load(path), path.stem)
        except InkbetweenError as e:
            self._tell(str(e), "error")
            return False
        self._own(None, None)
        frames = self._session.layer.frames()
        if len(frames) > 1:
            self._session.go_to((frames[0] + frames[1]) // 2)  # where an in-between is to be seen
        return True

    def own_recovered(self) -> None:
        """Take the lock of what was recovered; its file counts as seen as it is now."""
        path = self._session.path
        lock = self._lock_of(path) if path else None
        if lock is not None:
            lock.take()
        self._own(lock, fingerprint_on_disk(path, LARGEST_FILE) if path else None)

    def _own(self, lock: FileLock | None, seen: Fingerprint | None) -> None:
        if self._lock is not None and self._lock is not lock:
            self._lock.release()
        self._lock, self._seen, self._noticed = lock, seen, None

    # save

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

    def _save_to(self, path: Path) -> bool:
        if self._is_writing():
            return False
        lock = self._lock_of(path)
        with self._busy(path):
            answer = self._permission(path, lock)
        if answer == SAVE_ANYWAY:
            return self._write(path, lock)
        if lock is not self._lock:
            lock.release()
        if answer == RELOAD:
            self.reload()
        return answer == SAVE_AS and self.save_as()

    def _write(self, path: Path, lock: FileLock) -> bool:
        self._session.settle()
        document = self._session.document
        content = with_relative_references(self._completed(document), path.parent)
        try:
            with self._busy(path):
                seen = awake(partial(save, content, path, backup=True), slow=self._tell_slow)
        except InkbetweenError as e:
            self._then = None
            again = (("Retry", partial(self._save_to, path)), (SAVE_AS, self.save_as))
            self._tell(f"{e}. Your drawing is still here.", "error", again)
            return False
        self._own(lock, seen)
        self._session.saved(path, document)
        self._remember(path)
        if self._was_slow:
            self._tell(f"Saved {path.name}.", "info")
        self._go_on()
        return True

    @contextmanager
    def _busy(self, path: Path) -> Iterator[None]:
        self._writing, self._was_slow = path, False
        try:
            yield
        finally:
            self._writing = None

    @property
    def writing(self) -> bool:
        """Whether a file is being written."""
        return self._writing is not None

    def then(self, run: Callable[[], object]) -> None:
        """Run something when the file that is being written is safe; never if that fails."""
        self._then = run

    def _go_on(self) -> None:
        run, self._then = self._then, None
        if run is not None:
            QTimer.singleShot(0, run)

    def _is_writing(self) -> bool:
        """Whether a file is being written; there are never two at once."""
        if self._writing is not None:
            self._tell(f"{self._writing.name} is being saved; wait for it.", "info")
        return self._writing is not None

    def _tell_slow(self) -> None:
        self._was_slow = True
        name = self._writing.name if self._writing else ""
        self._tell(f"Saving {name}… The disk is slow; you can go on drawing.", "info")

    def _lock_of(self, path: Path) -> FileLock:
        if self._lock is not None and self._lock.path == path.resolve():
            return self._lock
        return FileLock(path)

    def _permission(self, path: Path, lock: FileLock) -> str:
        """Return SAVE_ANYWAY, or what was chosen instead where that would undo what someone else did."""
        kept = f"that is kept as {backup_of(path).name}"
        owner = None if lock is self._lock else lock.take()
        if owner is not None:
            detail = f"It belongs to {owner}. Saving replaces the version there; {kept}."
            return ask(self._parent, f"“{path.name}” is open in another window.", detail, (SAVE_AS, SAVE_ANYWAY))
        seen = self._seen if path == self._session.path else None
        if seen is None or not awake(partial(is_changed, path, seen, LARGEST_FILE), slow=self._tell_slow):
            return SAVE_ANYWAY
        detail = f"Saving replaces what is there now; {kept}."
        answers = (SAVE_AS, SAVE_ANYWAY, RELOAD)
        return ask(self._parent, f"“{path.name}” was changed by another program.", detail, answers)

    def _may_overwrite(self, path: Path) -> bool:
        answer = QMessageBox.question(self._parent, "Save As", f"“{path.name}” exists already. Replace it?")
        return answer == QMessageBox.StandardButton.Yes

    # another version of the open file

    def reload(self) -> None:
        """Take what is in the file now, as a step that undo takes back."""
        self._take("Revert to Saved", self._session.path)

    def restore_backup(self) -> None:
        """Take the version before the last save, as a step that undo takes back."""
        path = self._session.path
        self._take("Restore Backup", backup_of(path) if path else None)

    def _take(self, label: str, path: Path | None) -> None:
        if path is None:
            self._tell("This document has no file yet.", "info")
            return
        try:
            read, seen = awake(partial(load_seen, path), deaf=True)
        except InkbetweenError as e:
            self._tell(str(e), "error")
            return
        document = with_absolute_references(read, path.parent)
        self._session.apply(label, lambda _: document)
        if path == self._session.path:
            self._own(self._lock, seen)
            self._session.saved(path, document)

    def look(self) -> None:
        """See, beside the window, whether someone else has changed the open file."""
        path, seen = self._session.path, self._seen
        if path is not None and seen is not None and self._writing is None:
            self._watch.submit(partial(_look, path, seen, self._noticed))

    def _on_looked(self, result: object) -> None:
        path = self._session.path
        if not isinstance(result, _Change) or result.path != path or result.seen is not self._seen:
            return
        self._noticed = result.now
        mine = ((RELOAD, self.reload), (SAVE_AS, self.save_as))
        self._tell(f"“{result.path.name}” was changed by another program.", "info", mine)

    # close

    def may_leave(self) -> bool:
        """Whether the open document may go: it is saved, or the person gave it up."""
        if self._is_writing():
            return False
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

    def stop(self) -> None:
        """Let go of the open file."""
        self._watch.stop()
        self._own(None, None)

    def _remember(self, path: Path) -> None:
        self._settings.add_recent(path)
        self._settings.keep("folder", str(path.resolve().parent))

    def _folder(self) -> Path:
        if self._session.path is not None:
            return self._session.path.parent
        kept = Path(self._settings.text("folder"))
        return kept if str(kept) != "." and kept.is_dir() else Path.home()
