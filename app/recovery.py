"""Where unsaved work lies until it is saved, and whose it is.

Each window has a place with a name of its own. A lock in the state folder says that the window lives; what lies in
a place whose lock can be taken was left by a program that has died. The file lies beside the project, for
whoever opens the project, or in the state folder where there is none. A note in the state folder says
where.
"""

import contextlib
import secrets
import threading
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QLockFile, QStandardPaths

from core.errors import InkbetweenError, StorageError
from core.io.recovery import ENDING, Recovery, encode_recovery, read_recovery
from core.io.storage import PART_SUFFIX, hidden_beside, reason, write_atomically

NOTE = "place"


def state_folder() -> Path:
    """Return where the program keeps what no person looks for: recovery files, the log."""
    base = QStandardPaths.writableLocation(QStandardPaths.StandardLocation.GenericStateLocation)
    return Path(base) / "inkbetween"


class Place:
    """One window's unsaved work on the disk; safe to use from any thread."""

    def __init__(self, folder: Path, name: str, lock: QLockFile) -> None:
        self.name = name
        self._folder, self._lock = folder, lock
        self._guard = threading.RLock()
        self._open = True
        self._file = _noted(folder, name)

    @property
    def file(self) -> Path:
        """The recovery file."""
        return self._file

    def write(self, recovery: Recovery) -> None:
        """Keep the document here; raises StorageError and keeps the one before if no place takes it."""
        content = encode_recovery(recovery)
        with self._guard:
            if not self._open:
                return
            own = _own(self._folder, self.name)
            beside = None if recovery.path is None else hidden_beside(recovery.path, f"{self.name}.{ENDING}")
            if beside is None or not self._written(beside, content):
                write_atomically(own, content, private=True)
                self._move_to(own)

    def _written(self, beside: Path, content: bytes) -> bool:
        """Whether the project's folder takes the file."""
        try:
            if beside != self._file:
                write_atomically(_note(self._folder, self.name), str(beside).encode("utf-8", "surrogateescape"))
            write_atomically(beside, content, private=True)
        except StorageError:
            return False
        self._move_to(beside)
        return True

    def _move_to(self, file: Path) -> None:
        if file != self._file:
            _remove(self._file)
            self._file = file

    def clear(self) -> None:
        """Take the work away: it is saved, or was given up."""
        with self._guard:
            if self._open:
                for file in (self._file, _own(self._folder, self.name), _note(self._folder, self.name)):
                    _remove(file)

    def release(self) -> None:
        """Leave for good, and leave nothing."""
        with self._guard:
            self.clear()
            self.abandon()

    def abandon(self) -> None:
        """Leave, and leave the work for the next start."""
        with self._guard:
            self._open = False
            self._lock.unlock()


@dataclass(frozen=True, slots=True)
class Found:
    """Work that a dead program left, and its place, which is ours for now.

    `saved_later`: the project's file has been written after this.
    """

    place: Place
    recovery: Recovery
    saved_later: bool


def new_place(folder: Path) -> Place:
    """Return a place that nobody has; raises StorageError where the state folder cannot be written."""
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    except OSError as e:
        raise StorageError(f"cannot write {folder}: {reason(e)}") from e
    place = _take(folder, secrets.token_hex(6))
    if place is None:
        raise StorageError(f"cannot write {folder}")
    return place


def find(folder: Path, project: Path | None = None) -> tuple[list[Found], list[str]]:
    """Return what dead programs left, the newest first, and a sentence for each that cannot be read.

    With `project` only what belongs to that file; what lies beside it is found whichever computer left it.
    """
    found: list[Found] = []
    problems: list[str] = []
    with contextlib.suppress(OSError):
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    for name, file in sorted(_names(folder, project).items()):
        if file is not None:
            with contextlib.suppress(StorageError):
                write_atomically(_note(folder, name), str(file).encode("utf-8", "surrogateescape"))
        place = _take(folder, name)
        if place is None:
            continue  # its window lives
        try:
            recovery = read_recovery(place.file)
        except InkbetweenError as e:
            if place.file.exists():
                problems.append(f"unsaved work in {place.file} cannot be read: {e}")
                place.abandon()
            else:
                place.release()
            continue
        if project is None or recovery.path == project:
            found.append(Found(place, recovery, _saved_after(recovery)))
        else:
            place.abandon()
    found.sort(key=lambda x: -x.recovery.time)
    return found, problems


def _names(folder: Path, project: Path | None) -> dict[str, Path | None]:
    """Return the names of all places that may hold something, with the file where a note is yet to be made."""
    names: dict[str, Path | None] = {}
    for file in _listed(folder):
        if file.suffix in (f".{NOTE}", f".{ENDING}"):
            names[file.stem] = None
        elif file.suffix == PART_SUFFIX and not _lives(folder, file.name.split(".")[1]):
            _remove(file)
    if project is not None:
        start = hidden_beside(project, "").name
        for file in _listed(project.parent):
            if file.name.startswith(start) and file.suffix == f".{ENDING}":
                names.setdefault(file.name.split(".")[-2], file)
    return names


def _lives(folder: Path, name: str) -> bool:
    place = _take(folder, name)
    if place is not None:
        place.abandon()
    return place is None


def _listed(folder: Path) -> Iterable[Path]:
    try:
        return list(folder.iterdir())
    except OSError:
        return []


def _take(folder: Path, name: str) -> Place | None:
    lock = QLockFile(str(folder / f"{name}.lock"))
    lock.setStaleLockTime(0)  # only a dead owner makes it stale, not its age
    return Place(folder, name, lock) if lock.tryLock(0) else None


def _own(folder: Path, name: str) -> Path:
    return folder / f"{name}.{ENDING}"


def _note(folder: Path, name: str) -> Path:
    return folder / f"{name}.{NOTE}"


def _noted(folder: Path, name: str) -> Path:
    """Return where the work of a place lies."""
    own = _own(folder, name)
    try:
        text = _note(folder, name).read_bytes().decode("utf-8", "surrogateescape")
    except OSError:
        return own
    beside = Path(text)
    # a file moved from the one to the other is in both for a moment; the newer one counts
    return max((p for p in (own, beside) if p.is_file()), key=lambda p: p.stat().st_mtime_ns, default=beside)


def _saved_after(recovery: Recovery) -> bool:
    try:
        return recovery.path is not None and recovery.path.stat().st_mtime > recovery.time
    except OSError:
        return False


def _remove(file: Path) -> None:
    with contextlib.suppress(OSError):
        file.unlink(missing_ok=True)
