"""Numbered frames: rendered one by one, encoded and written side by side, every file whole or not there."""

import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from PySide6.QtCore import QSize
from PySide6.QtGui import QImage

from app.export.png import encode_png
from app.painting import Background, render_frame
from core.errors import InkbetweenError, StorageError
from core.model.document import LARGEST_STAGE, LONGEST, Document
from core.model.drawing import as_color
from core.model.motion import PlanCache

MOST_ENCODERS = 4
PIXELS_IN_FLIGHT = 48_000_000
"""Pictures rendered and not yet written hold up to 12 bytes a pixel: half a gigabyte at most."""


@dataclass(frozen=True, slots=True)
class ExportSettings:
    """What to export and where to.

    Attributes
    ----------
    folder : Path
        Made if it is not there.
    name : str
        What the file names begin with.
    first, last : int
        Frames, both included.
    size : (int, int)
        Width and height in px; the stage is fitted in.
    background : "stage", Color or None
        "stage" takes the colour of the stage, None is transparent.
    padding : int
        Least number of digits.
    separator : str
        Between name and number.
    """

    folder: Path
    name: str
    first: int
    last: int
    size: tuple[int, int]
    background: Background = "stage"
    padding: int = 4
    separator: str = "."

    def __post_init__(self) -> None:
        if not self.name.strip() or any(c in "/\\" or ord(c) < 32 for c in self.name + self.separator):
            raise InkbetweenError(
                f"{self.name + self.separator!r} cannot begin a file name; use letters and digits"
            )
        if not 1 <= self.first <= self.last <= LONGEST:
            raise InkbetweenError(f"frames {self.first} to {self.last} are no range; write the smaller one first")
        if not all(1 <= side <= LARGEST_STAGE for side in self.size):
            width, height = self.size
            raise InkbetweenError(f"a picture of {width} x {height} px; each side must be 1 to {LARGEST_STAGE} px")
        if not 1 <= self.padding <= 9:
            raise InkbetweenError(f"frame numbers of {self.padding} digits; choose 1 to 9")
        if self.background not in (None, "stage"):
            object.__setattr__(self, "background", as_color(self.background, name="background"))

    @classmethod
    def whole_film(cls, document: Document, folder: Path, name: str) -> "ExportSettings":
        """Return the settings to begin with: every frame, as large as the stage, on its background."""
        return cls(folder, name, 1, document.length, (document.stage.width, document.stage.height))


@dataclass(frozen=True, slots=True)
class Exported:
    """What came of an export: the files in order of frame, and whether it was cancelled before the end."""

    files: tuple[Path, ...]
    cancelled: bool


def frame_path(settings: ExportSettings, frame: int) -> Path:
    """Return where a frame goes: `folder/name.0001.png`."""
    return settings.folder / f"{settings.name}{settings.separator}{frame:0{settings.padding}}.png"


def export_frames(
    document: Document,
    settings: ExportSettings,
    *,
    progress: Callable[[int, int], None] = lambda done, total: None,
    cancelled: Callable[[], bool] = lambda: False,
) -> Exported:
    """Write the frames; files of the same names are replaced.

    Runs in the calling thread, which needs no event loop, and calls `progress(done, total)` and `cancelled()`
    there. Only a few frames are in memory at a time.

    Raises
    ------
    StorageError
        If the folder cannot be written or the disk is full. Frames written before are complete and stay.
    InkbetweenError
        If the film has no such frames.
    """
    if settings.last > document.length:
        raise InkbetweenError(
            f"frames {settings.first} to {settings.last} are not all in the film, which ends at {document.length}"
        )
    _make_folder(settings.folder)
    frames = range(settings.first, settings.last + 1)
    files: list[Path] = []
    waiting: deque[Future[Path]] = deque()
    most_waiting = _most_waiting(settings.size)
    plans, stopped = PlanCache(), False

    def collect() -> None:
        files.append(waiting.popleft().result())
        progress(len(files), len(frames))

    with ThreadPoolExecutor(_encoders(), thread_name_prefix="png") as encoders:
        try:
            for frame in frames:
                stopped = cancelled()
                if stopped:
                    break
                while waiting and (len(waiting) >= most_waiting or waiting[0].done()):
                    collect()
                image = _render(document, settings, frame, plans)
                waiting.append(encoders.submit(_write_png, image, frame_path(settings, frame)))
                del image  # or one more than needed stays in memory
            while waiting:
                collect()
        except BaseException:
            encoders.shutdown(cancel_futures=True)
            raise
    return Exported(tuple(files), stopped)


def _encoders() -> int:
    return min(MOST_ENCODERS, os.cpu_count() or 1)


def _most_waiting(size: tuple[int, int]) -> int:
    return max(1, min(_encoders() + 1, PIXELS_IN_FLIGHT // (size[0] * size[1])))


def _render(document: Document, settings: ExportSettings, frame: int, plans: PlanCache) -> QImage:
    """Render with 16 bits a channel if there is alpha: 8 premultiplied bits forget the colours of thin edges."""
    background = document.stage.background if settings.background == "stage" else settings.background
    opaque = background is not None and (len(background) == 7 or background.endswith("ff"))
    kind = QImage.Format.Format_RGB32 if opaque else QImage.Format.Format_RGBA64_Premultiplied
    return render_frame(document, frame, QSize(*settings.size), plans, background=background, format=kind)


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as e:
        reason = "a file is in the way" if isinstance(e, FileExistsError | NotADirectoryError) else _reason(e)
        raise StorageError(f"cannot make the folder {folder}: {reason}; choose another one") from e


def _write_png(image: QImage, path: Path) -> Path:
    """Put the picture into a new file that takes its name in one step, so that nobody ever reads half a frame."""
    try:
        content = encode_png(image)
    except MemoryError as e:
        raise StorageError(f"no memory left to write {path}; choose a smaller size") from e
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        with open(temporary, "wb") as file:
            file.write(content)
        os.replace(temporary, path)
    except OSError as e:
        temporary.unlink(missing_ok=True)
        raise StorageError(f"cannot write {path}: {_reason(e)}") from e
    return path


def _reason(error: OSError) -> str:
    return (error.strerror or str(error)).lower()
