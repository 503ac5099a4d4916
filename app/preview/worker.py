"""One thread for slow work, with one pending place: a newer request takes the place of one that waits."""

import threading
import time
from collections.abc import Callable

from PySide6.QtCore import QObject, Signal

Request = Callable[[], object]
"""A function that has captured all it needs; it must not touch the window."""


class NewestWins(QObject):
    """Runs requests one at a time beside the window.

    `finished` carries the request's result to the thread that this object lives in. An exception is a result
    too: the receiver decides what to say of it.
    """

    finished = Signal(object)

    def __init__(self, parent: QObject | None = None, name: str = "preview") -> None:
        super().__init__(parent)
        self._name = name
        self._wake = threading.Condition()
        self._pending: Request | None = None
        self._due = 0.0
        self._running = False
        self._stopped = False
        self._thread: threading.Thread | None = None

    @property
    def idle(self) -> bool:
        """Whether nothing runs and nothing waits."""
        with self._wake:
            return self._pending is None and not self._running

    def submit(self, request: Request, delay: float = 0.0) -> None:
        """Run `request` as soon as the thread is free, unless a newer one comes first.

        With `delay` it waits so many seconds for newer ones, which do not make it wait again.
        """
        with self._wake:
            if self._stopped:
                return
            due = time.monotonic() + delay
            self._due = due if self._pending is None else min(due, self._due)
            self._pending = request
            if self._thread is None:
                self._thread = threading.Thread(target=self._loop, name=self._name, daemon=True)
                self._thread.start()
            self._wake.notify_all()

    def stop(self) -> None:
        """Forget what waits and end the thread after what runs."""
        with self._wake:
            self._stopped = True
            self._pending = None
            self._wake.notify_all()
        if self._thread is not None:
            self._thread.join()

    def _wait(self) -> float | None:
        """How long there is nothing to do, in seconds; None: until something is submitted."""
        return None if self._pending is None else max(0.0, self._due - time.monotonic())

    def _loop(self) -> None:
        while True:
            with self._wake:
                self._running = False
                while not self._stopped and (wait := self._wait()) != 0:
                    self._wake.wait(wait)
                if self._stopped:
                    return
                request, self._pending, self._running = self._pending, None, True
            try:
                result = request() if request else None
            except Exception as e:  # whatever it is, it must reach the window and not kill the thread
                result = e
            self.finished.emit(result)
