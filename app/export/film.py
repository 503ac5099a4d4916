"""The film as the export sees it: which pictures there are, one after another, and what is in each."""

from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np

from app.export.chart import chart_pictures
from app.export.settings import ExportSettings
from core.errors import InkbetweenError
from core.model.document import LONGEST, Document, Layer
from core.model.drawing import Color
from core.model.inbetweens import Picture
from core.model.motion import PlanCache, pictures_at

Pictures = tuple[Picture, ...]


@dataclass(frozen=True, slots=True)
class Shot:
    """One picture of the export.

    Attributes
    ----------
    frame : int
        Its number for file names.
    time : float
        The frame of the document, a fraction where the export has another frame rate.
    count : int
        How many pictures of the film it stands for.
    drawing : int
        From 1: counts what is written.
    """

    frame: int
    time: float
    count: int = 1
    drawing: int = 1


class Film:
    """A document seen through the settings of an export."""

    def __init__(self, document: Document, settings: ExportSettings) -> None:
        check_frames(document, settings)
        self.settings = settings
        self.document = only_layers(document, settings.layers)
        self.plans = PlanCache()
        self.rate = settings.rate or document.rate

    @property
    def background(self) -> Color | None:
        """The colour behind the drawings, None for transparent."""
        chosen = self.settings.background
        return self.document.stage.background if chosen == "stage" else chosen

    @property
    def opaque(self) -> bool:
        """Whether the background hides what lies behind."""
        color = self.background
        return color is not None and (len(color) == 7 or color.endswith("ff"))

    def shots(self) -> list[Shot]:
        """Return every picture of the film, or every drawing once where the settings say so."""
        step = self.document.rate / self.rate
        count = count_pictures(self.settings, self.document.rate)
        first = self.settings.first
        every = [Shot(first + i, _time(first + i * step), 1, i + 1) for i in range(count)]
        return self._drawings(every) if self.settings.exposures else every

    def _drawings(self, shots: list[Shot]) -> list[Shot]:
        """Return the shots at which something new is seen, each as long as it is held."""
        kept: list[Shot] = []
        shown: Pictures | None = None
        for shot in shots:
            pictures = self.drawn(shot.time)
            if shown is not None and same_pictures(shown, pictures):
                kept[-1] = replace(kept[-1], count=kept[-1].count + 1)
            else:
                kept.append(replace(shot, drawing=len(kept) + 1))
            shown = pictures
        return kept

    def drawn(self, time: float) -> Pictures:
        """Return what the layers show."""
        return pictures_at(self.document, time, self.plans)

    def pictures(self, shot: Shot) -> Pictures:
        """Return what is to be painted: the layers, and the timing chart where it is wanted."""
        found = self.drawn(shot.time)
        if self.settings.chart:
            found += chart_pictures(self.document, shot.time)
        return found


def _time(exact: Fraction) -> float:
    """Return a whole number where it is one: a keyframe is found by its frame."""
    return int(exact) if exact.denominator == 1 else float(exact)


def count_pictures(settings: ExportSettings, rate: Fraction) -> int:
    """Return how many pictures the export shows, so that the film lasts as long at another rate."""
    frames = settings.last - settings.first + 1
    return max(1, round(frames * (settings.rate or rate) / rate))


def check_frames(document: Document, settings: ExportSettings) -> None:
    """Raise InkbetweenError if the film has no such frames, or there would be too many pictures."""
    if settings.last > document.length:
        raise InkbetweenError(
            f"frames {settings.first} to {settings.last} are not all in the film, which ends at {document.length}"
        )
    count = count_pictures(settings, document.rate)
    if count > LONGEST:
        raise InkbetweenError(f"the film would have {count} pictures; the limit is {LONGEST}")


def only_layers(document: Document, ids: tuple[int, ...] | None) -> Document:
    """Return the document with no other layer visible; a layer that is asked for is shown even if it is hidden."""
    if ids is None:
        return document
    layers = tuple(replace(layer, visible=layer.id in ids) for layer in document.layers)
    return replace(document, layers=layers)


def shown_layers(document: Document, settings: ExportSettings) -> tuple[Layer, ...]:
    """Return the layers that an export is about."""
    wanted = settings.layers
    return tuple(x for x in document.layers if (x.visible if wanted is None else x.id in wanted))


def same_pictures(a: Pictures, b: Pictures) -> bool:
    """Whether two frames show the very same."""
    return len(a) == len(b) and all(map(_same_picture, a, b))


def _same_picture(a: Picture, b: Picture) -> bool:
    if a is b:
        return True
    if a.style != b.style or len(a.outlines) != len(b.outlines) or a.opacity != b.opacity:
        return False
    outlines = zip(a.outlines, b.outlines, strict=True)
    return all(c == d and (p is q or np.array_equal(p, q)) for (p, c), (q, d) in outlines)
