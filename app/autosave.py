"""Unsaved work goes to the disk every few seconds of change, beside the window."""

import threading
import time
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.preview.worker import NewestWins
from app.recovery import Place, new_place
from app.session import Session
from core.errors import InkbetweenError
from core.io.recovery import Recovery

WAIT_S = 1.0
"""From a change to the writing of it; what is lost at most is this and the time of writing.

The worker waits, not a timer of the window: edits of a large drawing may keep the window busy for longer.
"""


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
        session.documentChanged.connect(self._on_changed)
        session.fileChanged.connect(self._on_changed)

    @property
    def place(self) -> Place | None:
        return self._place

    def _on_changed(self, _: object = None) -> None:
        self.keep(WAIT_S)

    def keep(self, wait: float = 0.0) -> None:
        """Write in the worker what is unsaved, after `wait` seconds at most, or take away what is saved."""
        if self._stopped:
            return
        if self._session.is_modified or self._session.in_gesture:
            self._worker.submit(partial(self._write, self._snapshot()), wait)
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
