"""Unsaved work goes to the disk every few seconds of change, beside the window."""

import threading
import time
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal

from app.preview.worker import NewestWins
from app.recovery import Place, new_place
from app.session import Session
from core.errors import InkbetweenError
from core.io.recovery import Recovery

WAIT_MS = 2000
"""From a change to the writing of it; what is lost at most is this and the time of writing."""


class Autosave(QObject):
    """Keeps what is open and unsaved in one place, and nothing when all is saved.

    The document is immutable, so the worker writes the very one that is shown, in the middle of a gesture too.
    """

    troubled = Signal(str)
    written = Signal()

    def __init__(self, session: Session, folder: Path | None, parent: QObject | None = None) -> None:
        """`folder` is the state folder; without one nothing is kept."""
        super().__init__(parent)
        self._session, self._folder = session, folder
        self._place: Place | None = None
        self._making = threading.Lock()
        self._told = False
        self._stopped = folder is None
        self._worker = NewestWins(self, name="autosave")
        self._worker.finished.connect(self._on_finished)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(WAIT_MS)
        self._timer.timeout.connect(self.keep)
        session.documentChanged.connect(self._on_document_changed)
        session.fileChanged.connect(self._on_file_changed)

    @property
    def place(self) -> Place | None:
        return self._place

    def _on_document_changed(self) -> None:
        if not self._stopped and not self._timer.isActive():
            self._timer.start()

    def _on_file_changed(self) -> None:
        if not self._session.is_modified and not self._session.in_gesture:
            self.keep()

    def keep(self) -> None:
        """Write what is unsaved now, or take away what is saved, in the worker."""
        self._timer.stop()
        if self._stopped:
            return
        if self._session.is_modified or self._session.in_gesture:
            self._worker.submit(partial(self._write, self._snapshot()))
        elif self._place is not None:
            self._worker.submit(self._place.clear)

    def keep_now(self) -> Path | None:
        """Write what is unsaved before this returns, in whatever thread; return where, None if that failed."""
        if self._stopped:
            return None
        try:
            self._write(self._snapshot())
        except InkbetweenError:
            return None
        return self._place.file if self._place else None

    def adopt(self, place: Place) -> None:
        """Go on in the place that the open document came from, and leave the own one."""
        old, self._place = self._place, place
        if old is not None:
            old.release()
        self.keep()

    def stop(self, *, leave: bool = False) -> None:
        """End; with `leave` what is unsaved stays for the next start."""
        if self._stopped:
            return
        if leave and (self._session.is_modified or self._session.in_gesture):
            self.keep_now()
        self._stopped = True
        self._timer.stop()
        self._worker.stop()
        if self._place is not None:
            if leave:
                self._place.abandon()
            else:
                self._place.release()

    def _snapshot(self) -> Recovery:
        session = self._session
        return Recovery(session.document, session.path, session.name, time.time(), session.frame)

    def _write(self, recovery: Recovery) -> None:
        with self._making:
            if self._place is None and self._folder is not None:
                self._place = new_place(self._folder)
        if self._place is not None:
            self._place.write(recovery)

    def _on_finished(self, result: object) -> None:
        if not isinstance(result, Exception):
            self._told = False
            self.written.emit()
        elif not self._told:  # said once, not every few seconds
            self._told = True
            self.troubled.emit(f"Your changes cannot be kept safe: {result}. Save them elsewhere.")
