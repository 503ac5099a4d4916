"""Files on a disk that may be full, slow, gone or shared: read with a bound, written whole or not at all."""

import contextlib
import hashlib
import os
import secrets
import shutil
import stat
import time as clock
from dataclasses import dataclass
from pathlib import Path

from core.errors import FileFormatError, StorageError

BACKUP_SUFFIX = "~"
PART_SUFFIX = ".part"
LONGEST_PREFIX = 50
"""Characters of a file's name in the names of what lies beside it; names of 255 bytes are long enough already."""

NEW_MODE = 0o666
"""Permissions of a new file before the umask, as for any new file."""

PRIVATE_MODE = 0o600
FORGOTTEN_S = 600.0
"""A part of a file that is older than this was left by a program that was killed."""


@dataclass(frozen=True, slots=True)
class Fingerprint:
    """What a file was when we last saw it.

    Attributes
    ----------
    time : int
        When it was changed, ns.
    size : int
        Bytes.
    digest : bytes
        Of its content; a file that was only touched has not changed.
    """

    time: int
    size: int
    digest: bytes


def fingerprint(path: Path, content: bytes, time: int | None = None) -> Fingerprint:
    """Return the fingerprint of a file that holds `content`; `time` is that of `changed_at` before it was read."""
    return Fingerprint(changed_at(path) if time is None else time, len(content), _digest(content))


def changed_at(path: Path) -> int:
    """Return when a file was changed, ns; 0 where that cannot be told: it will be compared by its content."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def fingerprint_on_disk(path: Path, most: int) -> Fingerprint | None:
    """Return the fingerprint of a file as it is now; None where it cannot be read."""
    time = changed_at(path)
    try:
        return fingerprint(path, read_bounded(path, most), time)
    except (StorageError, FileFormatError):
        return None


def is_changed(path: Path, seen: Fingerprint, most: int) -> bool:
    """Whether somebody else has changed the file since; one that is gone has nothing that could be lost."""
    try:
        status = path.stat()
    except OSError:
        return False
    if (status.st_mtime_ns, status.st_size) == (seen.time, seen.size):
        return False
    now = fingerprint_on_disk(path, most)
    return now is None or now.digest != seen.digest


def _digest(content: bytes) -> bytes:
    return hashlib.blake2b(content, digest_size=16).digest()


def read_whole(path: Path, most: int) -> bytes:
    """Return the bytes of a file of another program, of a device too as long as it ends before `most`.

    Raises
    ------
    StorageError
        If it cannot be read.
    FileFormatError
        If it is larger than `most` bytes.
    """
    try:
        with path.open("rb") as file:
            content = file.read(most + 1)
    except OSError as e:
        raise StorageError(f"cannot read {path}: {reason(e)}") from None
    if len(content) > most:
        raise FileFormatError(f"{path.name} is larger than {most >> 20} MB; simplify it first")
    return content


def read_bounded(path: Path, most: int) -> bytes:
    """Return the bytes of a file.

    Raises
    ------
    StorageError
        If it cannot be read, or is a device, which might never end.
    FileFormatError
        If it is larger than `most` bytes.
    """
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise StorageError(f"cannot read {path}: it is no file")
        if status.st_size > most:
            raise FileFormatError(f"{path.name} is larger than {most // 2**20} MB: no project of ours")
        with path.open("rb") as file:
            return file.read(most + 1)
    except (OSError, ValueError) as e:  # ValueError: a name with a zero in it
        if isinstance(e, StorageError | FileFormatError):
            raise
        raise StorageError(f"cannot read {path}: {reason(e)}") from e


def backup_of(path: Path) -> Path:
    """Return where the version before the last one is kept: `film.inkb~` beside `film.inkb`."""
    return path.with_name(path.name + BACKUP_SUFFIX)


def hidden_beside(path: Path, ending: str) -> Path:
    """Return a hidden file beside `path` for something of its own."""
    return path.with_name(f".{path.name[:LONGEST_PREFIX]}.{ending}")


def write_atomically(path: Path, content: bytes, *, backup: bool = False, private: bool = False) -> None:
    """Put `content` into `path` in one step; raises StorageError and leaves the old file if it cannot.

    With `backup` the old file takes the place of `backup_of(path)` just before. A new file that is `private` can
    be read by its owner only.
    """
    new_mode = PRIVATE_MODE if private else NEW_MODE
    temporary: Path | None = None
    try:
        target = path.resolve()  # a link stays a link, its target is replaced
        mode = target.stat().st_mode & 0o777 if target.exists() else None
        temporary = target.with_name(f"{_prefix(target)}{secrets.token_hex(6)}{PART_SUFFIX}")
        with open(temporary, "xb", opener=lambda name, how: os.open(name, how, mode or new_mode)) as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        if mode is not None:
            os.chmod(temporary, mode)  # what the umask took away when the file was made
        if backup:
            _keep_old(target, temporary.with_suffix(".old" + PART_SUFFIX))
        os.replace(temporary, target)
    except (OSError, RuntimeError) as e:  # RuntimeError: a loop of links, before Python 3.13
        raise StorageError(f"cannot write {path}: {reason(e)}") from e
    finally:
        if temporary is not None:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
    _sync_folder(target.parent)
    if backup:
        _sweep(target)


def _prefix(target: Path) -> str:
    return f".{target.name[:LONGEST_PREFIX]}."


def _keep_old(target: Path, between: Path) -> None:
    """Give the old file its second name; where that fails the save goes on, and an older backup stays."""
    with contextlib.suppress(OSError):
        if not target.exists():
            return
        try:
            _second_name(target, between)
            os.replace(between, backup_of(target))
        finally:
            between.unlink(missing_ok=True)


def _second_name(target: Path, between: Path) -> None:
    """A hard link costs nothing and fits on a full disk; some disks know none."""
    try:
        os.link(target, between)
    except OSError:
        shutil.copy2(target, between)


def _sweep(target: Path) -> None:
    """Take away parts of this file that a killed program left here."""
    with contextlib.suppress(OSError):
        for name in os.listdir(target.parent):
            if name.startswith(_prefix(target)) and name.endswith(PART_SUFFIX):
                part = target.parent / name
                if clock.time() - part.lstat().st_mtime > FORGOTTEN_S:
                    part.unlink(missing_ok=True)


def _sync_folder(folder: Path) -> None:
    """Make the renaming itself survive a power cut, where the system can; the file is whole either way."""
    if os.name != "posix":
        return
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def reason(error: Exception) -> str:
    """Return what the system says of an error, to stand inside a sentence."""
    return (getattr(error, "strerror", None) or str(error)).lower()
