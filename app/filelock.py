"""Who has a project open: a hidden file beside it that names the process and its computer."""

from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QLockFile

from core.io.storage import hidden_beside

ENDING = "lock"


@dataclass(frozen=True, slots=True)
class Owner:
    """The process that has a file open."""

    pid: int
    computer: str

    def __str__(self) -> str:
        return f"process {self.pid} on {self.computer}"


class FileLock:
    """The lock of one project file; a lock whose process has died is no lock.

    Where the folder cannot be written, or knows no locks, nothing is locked and nobody is kept out.
    """

    def __init__(self, path: Path) -> None:
        self.path = path.resolve()
        self._lock = QLockFile(str(hidden_beside(self.path, ENDING)))
        self._lock.setStaleLockTime(0)  # a project stays open for days

    def take(self) -> Owner | None:
        """Take the lock, or return who has it."""
        if (
            self._lock.isLocked()
            or self._lock.tryLock(0)
            or self._lock.error() != QLockFile.LockError.LockFailedError
        ):
            return None
        pid, computer, _ = self._lock.getLockInfo()
        return Owner(pid, computer) if pid else None

    @property
    def held(self) -> bool:
        return self._lock.isLocked()

    def release(self) -> None:
        """Let others have the file."""
        self._lock.unlock()
