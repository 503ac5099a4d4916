"""A folder of SVG files as the keyframes of one layer."""

import re
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path

from core.errors import FileFormatError, StorageError
from core.io.film import ImportedFilm, ImportedLayer
from core.io.imported import Imported, as_drawing, remark
from core.io.svg import read_svg
from core.model.document import LONGEST, Keyframe

SPACING = 8
"""Frames from one drawing to the next where the names do not tell."""
MOST_FILES = 1000
NAMED = 3
"""Files whose rest is told one by one."""

LAST_NUMBER = re.compile(r"(\d{1,9})\D*$", re.ASCII)


def read_svg_folder(
    folder: Path | str,
    *,
    spacing: int = SPACING,
    progress: Callable[[float], object] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> ImportedFilm:
    """Return the drawings of a folder as keyframes, in the order of their names.

    Where every name ends in a number and the numbers leave gaps (`walk.0001.svg`, `walk.0009.svg`), they are the
    frames; otherwise the drawings are put `spacing` frames apart.

    Parameters
    ----------
    folder : path
    spacing : int
        Frames from one drawing to the next, 1 or more.
    progress, cancelled
        As of `read_svg`.

    Raises
    ------
    FileFormatError
        There is no SVG in it, or one of them cannot be read; the file is named.
    StorageError
        The folder cannot be read.
    CancelledError
        `cancelled` said so.
    """
    files = _files(Path(folder))
    pictures = []
    for i, file in enumerate(files):
        part = None if progress is None else _part(progress, i, len(files))
        pictures.append(read_svg(file, tolerance=None, progress=part, cancelled=cancelled))
    frames = frames_of([f.stem for f in files], spacing)
    keyframes = tuple(Keyframe(f, as_drawing(p)) for f, p in zip(frames, pictures, strict=True))
    size = (max(p.size[0] for p in pictures), max(p.size[1] for p in pictures))
    layer = ImportedLayer(Path(folder).resolve().name, keyframes)
    return ImportedFilm((layer,), size, frames[-1], left_out=_left_out(files, pictures))


def _part(progress: Callable[[float], object], index: int, count: int) -> Callable[[float], object]:
    return lambda share: progress((index + share) / count)


def _files(folder: Path) -> list[Path]:
    try:
        found = [p for p in folder.iterdir() if p.suffix.lower() == ".svg" and not p.name.startswith(".")]
    except OSError as e:
        raise StorageError(f"cannot read the folder {folder}: {(e.strerror or str(e)).lower()}") from None
    if not found:
        raise FileFormatError(f"there is no SVG file in the folder {folder.name}")
    if len(found) > MOST_FILES:
        raise FileFormatError(
            f"there are {len(found)} SVG files in the folder {folder.name}, at most {MOST_FILES}"
        )
    return sorted(found, key=lambda p: (_natural(p.stem), p.name))


def _natural(name: str) -> list[tuple[int, int, str]]:
    """Return a key that sorts 2 before 10."""
    parts = re.split(r"(\d{1,18})", name.lower(), flags=re.ASCII)
    return [(0, int(x), "") if x.isdigit() and x.isascii() else (1, 0, x) for x in parts if x]


def frames_of(names: list[str], spacing: int = SPACING) -> list[int]:
    """Return the frame of every file by its name; rising, the first one is 1 or more.

    Raises FileFormatError if the film would be too long.
    """
    found = [LAST_NUMBER.search(name) for name in names]
    numbers = [int(m[1]) for m in found if m]
    steps = [b - a for a, b in pairwise(numbers)]
    told = len(numbers) == len(names) and all(s > 0 for s in steps) and max(steps, default=1) > 1
    if not told or numbers[-1] >= LONGEST:
        numbers = [1 + spacing * i for i in range(len(names))]
    elif numbers[0] < 1:
        numbers = [n + 1 - numbers[0] for n in numbers]
    if numbers[-1] > LONGEST:
        raise FileFormatError(f"the film would have {numbers[-1]} frames, the limit is {LONGEST}")
    return numbers


def _left_out(files: list[Path], pictures: list[Imported]) -> tuple[str, ...]:
    rests = [
        (f.name, remark(p, as_one=True).removeprefix("not taken over: "))
        for f, p in zip(files, pictures, strict=True)
    ]
    told = [f"{rest} of {name}" for name, rest in rests if rest]
    more = len(told) - NAMED
    return tuple(told[:NAMED]) + ((f"something of {more} more files",) if more > 0 else ())
