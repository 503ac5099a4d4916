"""When the program itself fails: keep the drawing, say so once and honestly, and go on.

What Python raises and nobody catches arrives here, from the window, from threads and from objects that end; and
what Qt says before it gives up.
"""

import contextlib
import faulthandler
import platform
import sys
import threading
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from types import TracebackType
from typing import Any

import PySide6
from PySide6.QtCore import QMessageLogContext, QObject, QtMsgType, Signal, qInstallMessageHandler

from app import __version__

LOG = "inkbetween.log"
LARGEST_LOG = 1_000_000
FATAL = frozenset({QtMsgType.QtFatalMsg})
Keep = Callable[[], Path | None]


class Emergency(QObject):
    """`failed(report, kept)` reaches the window's thread once for each different failure."""

    failed = Signal(str, str)

    def __init__(self, keep: Keep, state: Path, parent: QObject | None = None) -> None:
        """`keep` writes the open document at once, in whatever thread, and returns where."""
        super().__init__(parent)
        self._keep, self._log = keep, state / LOG
        self._told: set[str] = set()
        self._at_work = threading.local()
        self._crash_log: Any = None

    # hooks

    def install(self) -> None:
        """Be called from now on."""
        self._hooks = sys.excepthook, threading.excepthook, sys.unraisablehook
        sys.excepthook = self._on_exception
        threading.excepthook = lambda a: self._on_exception(a.exc_type, a.exc_value, a.exc_traceback)
        sys.unraisablehook = lambda a: self._on_exception(a.exc_type, a.exc_value, a.exc_traceback)
        self._qt_hook = qInstallMessageHandler(self._on_qt_message)
        if faulthandler.is_enabled():
            return
        with contextlib.suppress(OSError):
            self._log.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
            self._crash_log = self._log.with_suffix(".crash.log").open("a", encoding="utf-8")
            faulthandler.enable(self._crash_log)

    def uninstall(self) -> None:
        """Leave everything as it was."""
        sys.excepthook, threading.excepthook, sys.unraisablehook = self._hooks
        qInstallMessageHandler(self._qt_hook)
        if self._crash_log is not None:
            faulthandler.disable()
            self._crash_log.close()
            self._crash_log = None

    def _on_exception(
        self, kind: type[BaseException], error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if issubclass(kind, KeyboardInterrupt | SystemExit):
            sys.__excepthook__(kind, error or kind(), trace)
            return
        text = "".join(traceback.format_exception(kind, error, trace))
        # where it was raised, not what it says: a number in the text would make every frame a new failure
        last = traceback.extract_tb(trace)[-1:] or [None]
        where = f"{kind.__name__} {last[0].filename}:{last[0].lineno}" if last[0] else kind.__name__
        self.report(text, where)

    def _on_qt_message(self, kind: QtMsgType, _: QMessageLogContext, text: str) -> None:
        self._write(f"Qt: {text}\n")
        if sys.stderr is not None:
            sys.stderr.write(f"{text}\n")
        if kind in FATAL:  # Qt ends the program as soon as this returns
            self._keep_safely()

    # what is done

    def report(self, text: str, where: str) -> None:
        """Keep the drawing, log the failure, and tell it if it is a new one."""
        if getattr(self._at_work, "now", False):
            return  # a failure while telling of a failure
        self._at_work.now = True
        try:
            self._write(text)
            if sys.stderr is not None:
                sys.stderr.write(text)
            if where in self._told:
                return
            self._told.add(where)
            kept = self._keep_safely()
            self.failed.emit(report_of(text), str(kept or ""))
        finally:
            self._at_work.now = False

    def _keep_safely(self) -> Path | None:
        try:
            return self._keep()
        except Exception as e:  # nothing may stop the report
            self._write(f"the emergency copy failed: {e!r}\n")
            return None

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError):
            if self._log.exists() and self._log.stat().st_size > LARGEST_LOG:
                self._log.replace(self._log.with_suffix(".old.log"))
            with self._log.open("a", encoding="utf-8", errors="backslashreplace") as file:
                file.write(f"{time.strftime('%Y-%m-%d %H:%M:%S')} {text}")


def report_of(text: str) -> str:
    """Return what a person can copy and send: versions and the traceback, nothing of the drawing."""
    return (
        f"Inkbetween {__version__}\nPython {platform.python_version()}, PySide6 {PySide6.__version__}\n"
        f"{platform.platform()}\n\n{text}"
    )
