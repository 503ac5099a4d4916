"""Nothing is lost: unsaved work is kept, found again after a crash, and offered."""

import signal
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

from PySide6.QtCore import QCoreApplication, QObject, Qt, QTimer

from app.autosave import Autosave
from app.awake import awake
from app.dialogs.failure import FailureDialog
from app.dialogs.recovery import RecoveryDialog
from app.emergency import Emergency
from app.files import Files
from app.recovery import Found, find
from app.session import Session
from app.window import Window

FOLDER = "recovery"


class Safekeeping(QObject):
    """Joins autosave and recovery to one window. Without a state folder it does nothing."""

    def __init__(self, window: Window, session: Session, files: Files, state: Path | None) -> None:
        super().__init__(window)
        self._window, self._session, self._files = window, session, files
        self._folder = None if state is None else state / FOLDER
        self.autosave = Autosave(session, self._folder, self)
        self.autosave.troubled.connect(lambda text: window.tell(text, "error"))
        self.dialog: RecoveryDialog | None = None
        self.failure: FailureDialog | None = None
        files.opened.connect(lambda path: QTimer.singleShot(0, partial(self.offer, path)))

    def offer(self, project: Path | None = None, *, asked: bool = False) -> None:
        """Show what dead programs left, of one project or of all; `asked` also says that there is nothing."""
        if self._folder is None or self.dialog is not None:
            return
        found, problems = awake(partial(find, self._folder, project and project.absolute()), deaf=True)
        if problems:
            self._window.tell(problems[0], "error")
        elif asked and not found:
            self._window.tell("There is no unsaved work to recover.", "info")
        if found:
            self._ask(found)

    def _ask(self, found: list[Found]) -> None:
        self.dialog = RecoveryDialog(found, self._window)
        try:
            self.dialog.exec()
            chosen, discarded = self.dialog.opened, self.dialog.discarded
        finally:
            self.dialog.deleteLater()
            self.dialog = None
        for each in found:
            if each in discarded:
                each.place.release()
            elif each is not chosen or not self._files.may_leave():
                each.place.abandon()
            else:
                self._open(each)

    def _open(self, found: Found) -> None:
        """Make what was found the open document, modified, under its old name."""
        recovery = found.recovery
        self._session.recovered(recovery.document, recovery.path, recovery.title)
        self._session.go_to(recovery.frame)
        self._files.own_recovered()
        self.autosave.adopt(found.place)
        self._window.tell(f"Recovered “{self._session.name}”. Save it to keep it.", "info")

    def show_failure(self, report: str, kept: str) -> None:
        """Show the one dialog about mistakes of the program, or add to the one that is open."""
        if self.failure is not None:
            self.failure.add(report)
            return
        self.failure = FailureDialog(report, kept, self._window)
        self.failure.finished.connect(self._forget_failure)
        self.failure.open()

    def _forget_failure(self) -> None:
        if self.failure is not None:
            self.failure.deleteLater()
        self.failure = None

    @contextmanager
    def watching(self, app: QCoreApplication, state: Path) -> Iterator[None]:
        """Until it ends: offer what was left, catch what nobody catches, and leave in order when told to end."""
        emergency = Emergency(self.autosave.keep_now, state, self)
        emergency.failed.connect(self.show_failure, Qt.ConnectionType.QueuedConnection)
        emergency.install()
        QTimer.singleShot(0, self.offer)
        beat = QTimer()  # Python sees signals only when it runs now and then
        beat.timeout.connect(lambda: None)
        beat.start(200)

        def leave(number: int, _: object) -> None:
            self.stop(leave=True)
            app.exit(128 + number)

        signal.signal(signal.SIGINT, lambda *_: self._window.close())
        for name in ("SIGTERM", "SIGHUP"):
            if hasattr(signal, name):
                signal.signal(getattr(signal, name), leave)
        try:
            yield
        finally:
            beat.stop()
            emergency.uninstall()

    def stop(self, *, leave: bool = False) -> None:
        """End; with `leave` unsaved work stays for the next start."""
        self.autosave.stop(leave=leave)
