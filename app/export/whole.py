"""Files that are whole or not there: written under another name, then renamed."""

import contextlib
import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path

from core.errors import InkbetweenError, StorageError

PART = re.compile(r"\.(.+)\.(\d{1,10})\.part")


class InTheWayError(InkbetweenError):
    """Files that would be lost, and nobody has said that they may be."""

    def __init__(self, paths: list[Path]) -> None:
        self.paths = paths
        several = f"{len(paths)} of the files exist already, the first is {paths[0]}"
        super().__init__(f"{paths[0]} exists already" if len(paths) == 1 else several)


def temporary_of(path: Path, pid: int | None = None) -> Path:
    """Return the name that a file has until it is whole; hidden, and of this process alone."""
    return path.with_name(f".{path.name[:100]}.{pid or os.getpid()}.part")


@contextlib.contextmanager
def whole_file(path: Path, *, lasting: bool = True) -> Iterator[Path]:
    """Give a temporary path to write to, renamed to `path` at the end of the block; nothing stays after an error.

    `lasting` forces the file to the disk before it takes its name, so that not even a power cut leaves half of it.
    Raises StorageError for whatever the system refuses.
    """
    temporary = temporary_of(path)
    try:
        yield temporary
        if lasting:
            with open(temporary, "rb+") as file:
                os.fsync(file.fileno())
        os.replace(temporary, path)
    except MemoryError as e:
        raise StorageError(f"no memory left to write {path}; choose a smaller size") from e
    except OSError as e:
        raise StorageError(f"cannot write {path}: {reason(e)}") from e
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


def write_whole(path: Path, content: bytes, *, lasting: bool = True) -> None:
    """Put `content` into `path` in one step."""
    with whole_file(path, lasting=lasting) as temporary:
        temporary.write_bytes(content)


def make_folder(folder: Path) -> None:
    """Make a folder and those it lies in; raises StorageError with the reason."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as e:
        why = "a file is in the way" if isinstance(e, FileExistsError | NotADirectoryError) else reason(e)
        raise StorageError(f"cannot make the folder {folder}: {why}; choose another one") from e


def reason(error: OSError) -> str:
    """Return what the system said, for the end of a sentence."""
    return (error.strerror or str(error)).lower()


def _sweep(paths: list[Path]) -> None:
    """Take away what exports to these paths have left half done, if their programs have been killed."""
    if os.name != "posix":
        return
    names: dict[Path, set[str]] = {}
    for path in paths:
        names.setdefault(path.parent, set()).add(path.name[:100])
    for folder, wanted in names.items():
        with contextlib.suppress(OSError):
            for entry in list(os.scandir(folder)):
                found = PART.fullmatch(entry.name)
                if found and found[1] in wanted and not _runs(int(found[2])):
                    part = folder / entry.name
                    shutil.rmtree(part) if entry.is_dir(follow_symlinks=False) else part.unlink()


def _runs(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    except (OSError, OverflowError):
        return True
    return True


def check_free(paths: list[Path], *, replace: bool, proceed: bool) -> list[Path]:
    """Return those of `paths` that are to be written; raises InTheWayError before one would be lost unasked."""
    _sweep(paths)
    there = [p for p in paths if os.path.lexists(p)]
    if not there or replace:
        return paths
    if proceed:
        kept = set(there)
        return [p for p in paths if p not in kept]
    raise InTheWayError(there)
