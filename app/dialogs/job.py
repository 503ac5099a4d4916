"""One piece of work in a thread of its own, that a dialog waits for and can cancel."""

import threading

from PySide6.QtCore import QObject, Signal

from core.errors import CancelledError, InkbetweenError


class Job(QObject):
    """Runs `work` beside the window; `finished` reaches the window's thread, whatever came of it.

    It carries what `work` returned, None when it was cancelled, or the InkbetweenError that stopped it.
    """

    finished = Signal(object)
    name = "job"
    trouble = "it stopped"

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._cancel = threading.Event()
        self._thread = threading.Thread(target=self._run, name=self.name, daemon=True)

    def start(self) -> None:
        self._thread.start()

    def cancel(self) -> None:
        self._cancel.set()

    def wait(self) -> None:
        self._thread.join()

    def work(self) -> object:
        """Do it, asking `self._cancel` now and then."""
        raise TypeError(f"{type(self).__name__} does not say what its work is")

    def _run(self) -> None:
        result: object
        try:
            result = self.work()
        except CancelledError:
            result = None
        except InkbetweenError as e:
            result = e
        except Exception as e:  # a mistake of ours must not leave a dialog waiting for ever
            result = InkbetweenError(f"{self.trouble}: {e}")
        self.finished.emit(result)
