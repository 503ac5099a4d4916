"""The pins of the span: where each begins and ends, the way between, and what of it lies under the pointer."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF

from app.canvas.camera import Camera
from app.canvas.content import Content
from app.canvas.papers import BEFORE, Paper
from app.session import PinRef
from core.geometry.outline import FloatArray
from core.model.document import Keyframe

PIN_REACH = 10.0
WAY_REACH = 7.0
HANDLE_REACH = 9.0
WAY_STEPS = 96
MOST_FRAMES = 500
"""Spans with more frames get a dot at every second, third ... one."""

PULLED = (0.15, 0.85)
"""Part of an arc that follows the hand as it is; nearer to its ends the handles would shoot away."""

Point = tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class PinMark:
    """One pin in stage px.

    Attributes
    ----------
    ref : PinRef
    way : (WAY_STEPS + 1, 2) float array
        From its place in the keyframe before to that in the keyframe after.
    dots : (n, 2) float array
        Where it is at the frames of the film.
    handles : pair of (x, y) or None
    """

    ref: PinRef
    way: FloatArray
    dots: FloatArray
    handles: tuple[Point, Point] | None

    @property
    def start(self) -> FloatArray:
        return self.way[0]

    @property
    def end(self) -> FloatArray:
        return self.way[-1]

    @property
    def bent(self) -> tuple[Point, Point]:
        """The handles; of a straight way those that change nothing."""
        if self.handles is not None:
            return self.handles
        third = (self.end - self.start) / 3
        return as_point(self.start + third), as_point(self.end - third)


@dataclass(frozen=True, slots=True, eq=False)
class PinHit:
    """A part of a pin under the pointer.

    `part` is "pin", "way", or the number of a handle; `place` is in stage px.
    """

    paper: Paper
    mark: PinMark
    part: str | int
    place: FloatArray


def frame_times(before: Keyframe, after: Keyframe) -> FloatArray:
    """Return the eased t of the frames of a span, both ends included."""
    length = after.frame - before.frame
    frames = np.arange(0, length + 1, -(-length // MOST_FRAMES))
    return before.span.easing.t_at(frames / length)


def pin_marks(content: Content) -> tuple[PinMark, ...]:
    """Return the pins of the span under the playhead."""
    before, after, plan = content.before, content.after, content.plan
    if before is None or after is None or plan is None or not before.span.pins:
        return ()
    times = frame_times(before, after)
    even = np.linspace(min(0.0, float(times.min())), max(1.0, float(times.max())), WAY_STEPS - 1)
    places = plan.paths.pinned(np.concatenate([[0.0], even, [1.0], times]))
    ways, dots = np.split(places, [WAY_STEPS + 1])
    pins = zip(before.span.pins, ways.swapaxes(0, 1), dots.swapaxes(0, 1), strict=False)
    return tuple(PinMark(PinRef(before.frame, i), way, dot, pin.handles) for i, (pin, way, dot) in enumerate(pins))


def pin_papers(content: Content) -> list[Paper]:
    """Return the papers that show pins."""
    return [p for p in content.papers if BEFORE in p.shows]


def pin_under(
    content: Content, marks: tuple[PinMark, ...], camera: Camera, at: QPointF, chosen: PinRef | None
) -> PinHit | None:
    """Return the chosen pin's handle under the pointer, else the nearest pin, else the nearest way."""
    here = np.array([at.x(), at.y()])
    best: PinHit | None = None
    least = 1.0
    for paper in pin_papers(content):
        for mark in marks:
            for part, place, reach in _parts(mark, camera, paper, here, chosen):
                gap = float(np.hypot(*(camera.to_view(place, paper.offset) - here))) / reach
                # a handle may lie on a pin, and every pin lies on its way
                rank = gap - (2.0 if isinstance(part, int) else 1.0 if part == "pin" else 0.0)
                if gap <= 1.0 and rank < least:
                    best, least = PinHit(paper, mark, part, place), rank
    return best


def _parts(
    mark: PinMark, camera: Camera, paper: Paper, here: FloatArray, chosen: PinRef | None
) -> Iterator[tuple[str | int, FloatArray, float]]:
    """Yield what can be picked up of a pin: its part, its place and how near the pointer must be."""
    if mark.ref == chosen and mark.handles is not None:
        for i, handle in enumerate(mark.handles):
            yield i, np.array(handle), HANDLE_REACH
    yield "pin", mark.start, PIN_REACH
    i = int(np.hypot(*(camera.to_view(mark.way, paper.offset) - here).T).argmin())
    yield "way", mark.way[i], WAY_REACH


def arc_through(mark: PinMark, place: Point) -> tuple[Point, Point]:
    """Return the handles of the arc whose middle is at `place`, bent evenly on both sides."""
    start, end = mark.start, mark.end
    third, push = (end - start) / 3, (np.array(place) - (start + end) / 2) * 4 / 3
    return as_point(start + third + push), as_point(end - third + push)


def arc_pulled(mark: PinMark, held: FloatArray, place: Point) -> tuple[Point, Point]:
    """Return the handles of the arc bent further, so that its point at `held` comes to `place`."""
    first, second = (np.array(handle) for handle in mark.bent)
    s = np.linspace(*PULLED, 141)[:, None]
    curve = (1 - s) ** 3 * mark.start + 3 * (1 - s) * s * ((1 - s) * first + s * second) + s**3 * mark.end
    at = float(s[int(np.hypot(*(curve - held).T).argmin()), 0])
    push = (np.array(place) - held) / (3 * at * (1 - at))
    return as_point(first + push), as_point(second + push)


def as_point(place: FloatArray) -> Point:
    return float(place[0]), float(place[1])
