"""Work that may take long, such as writing to a slow disk, while the window stays awake."""

import threading
from collections.abc import Callable
from typing import TypeVar

from PySide6.QtCore import QEventLoop, QObject, Qt, Signal

PATIENCE_S = 0.15
"""Most files are there sooner; then no event comes in between, and nothing flickers."""

T = TypeVar("T")


class _Bell(QObject):
    rung = Signal()


def awake(work: Callable[[], T], *, slow: Callable[[], object] | None = None, deaf: bool = False) -> T:
    """Return what `work` returns, or raise what it raises; the window paints and answers meanwhile.

    `slow` is called when it takes longer than a moment. While `deaf`, mouse and keys wait for the end.
    `work` runs in a thread of its own and must not touch the window.
    """
    results: list[T] = []
    errors: list[BaseException] = []
    bell, loop = _Bell(), QEventLoop()
    bell.rung.connect(loop.quit, Qt.ConnectionType.QueuedConnection)

    def run() -> None:
        try:
            results.append(work())
        except BaseException as e:  # it is raised again where it is waited for
            errors.append(e)
        bell.rung.emit()

    thread = threading.Thread(target=run, name="file")
    thread.start()
    thread.join(PATIENCE_S)
    if thread.is_alive():
        if slow is not None:
            slow()
        flags = QEventLoop.ProcessEventsFlag
        loop.exec(flags.ExcludeUserInputEvents if deaf else flags.AllEvents)
    thread.join()
    if errors:
        raise errors[0]
    return results[0]
