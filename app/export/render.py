"""Painting one picture of an export, wherever that happens: here, in a thread, in a process of its own."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QSize
from PySide6.QtGui import QImage

from app.export.png import channels_of, encode_png, straight_image
from app.export.whole import write_whole
from app.painting import render_pictures
from core.geometry.outline import FloatArray
from core.model.document import Stage
from core.model.drawing import Color, Style

if TYPE_CHECKING:
    from core.model.inbetweens import Picture

EIGHT, SIXTEEN = "rgba", "rgba64le"
"""What FFmpeg calls the order and depth of the channels."""


@dataclass(frozen=True, slots=True)
class Look:
    """What all pictures of an export have in common.

    Attributes
    ----------
    stage : Stage
    size : (int, int)
    background : Color or None
    deep : bool
        16 bits a channel in what comes out.
    """

    stage: Stage
    size: tuple[int, int]
    background: Color | None
    deep: bool = False

    @property
    def opaque(self) -> bool:
        """Whether nothing shines through the background."""
        return self.background is not None and (len(self.background) == 7 or self.background.endswith("ff"))


@dataclass(frozen=True, slots=True)
class Shown:
    """What one layer shows, as a `Picture`; a process that unpacks this need not know how it was solved."""

    outlines: tuple[tuple[FloatArray, bool], ...]
    style: Style
    opacity: float = 1.0


@dataclass(frozen=True, slots=True)
class Job:
    """One picture: written to `path` as PNG, or handed back as straight pixels if that is None."""

    pictures: "tuple[Shown | Picture, ...]"
    path: Path | None = None

    def light(self) -> "Job":
        """Return the same job to be sent to another process."""
        shown = (Shown(p.outlines, p.style, p.opacity) for p in self.pictures)
        return Job(tuple(shown), self.path)


def paint(job: Job, look: Look) -> QImage:
    """Paint with 16 bits a channel if there is alpha: 8 premultiplied bits forget the colours of thin edges."""
    deep = not look.opaque or look.deep
    kind = QImage.Format.Format_RGBA64_Premultiplied if deep else QImage.Format.Format_RGB32
    return render_pictures(job.pictures, look.stage, QSize(*look.size), look.background, format=kind)


def finish(image: QImage, job: Job, look: Look) -> bytes:
    """Write the PNG file and return nothing, or return the pixels, row by row."""
    if job.path is None:
        straight = straight_image(image, alpha=True, deep=look.deep)
        return channels_of(straight, deep=look.deep).tobytes()
    write_whole(job.path, encode_png(image, deep=look.deep), lasting=False)
    return b""
