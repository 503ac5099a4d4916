"""Layers as shapes that change: what Lottie and animated SVG are made of.

A shape can be interpolated only between drawings with the same outlines and vertices. So a layer becomes a chain
of stretches, each with one set of vertices, and each is seen only in its own time.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from app.export.film import Film, same_pictures
from core.geometry.outline import FloatArray
from core.model.document import Keyframe, Layer
from core.model.drawing import Style
from core.model.easing import Easing
from core.model.inbetweens import Picture
from core.model.motion import picture_at

NEARLY = 1e-6
"""Frames beside a keyframe: there the vertices are those of the in-betweens, and the form is the keyframe's."""
TOLERANCE = 0.05
"""Stage px that a vertex may lie off between two shapes that are kept."""
COLOR_TOLERANCE = 1.0 / 255


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """A shape at a time.

    Attributes
    ----------
    time : float
        Frames from the beginning of the export.
    picture : Picture
    """

    time: float
    picture: Picture


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A time in which a layer keeps its vertices.

    Attributes
    ----------
    start, end : float
        Frames from the beginning of the export, `end` not included.
    moments : tuple of Moment
        Times rising; before the first and behind the last the shape stays.
    held : bool
        Whether each shape stays until the next one; otherwise the one flows into the other.
    easing : Easing or None
        Of the way between the only two moments, where it is no straight line in time.
    """

    start: float
    end: float
    moments: tuple[Moment, ...]
    held: bool = False
    easing: Easing | None = None


@dataclass(frozen=True, slots=True, eq=False)
class ShapeLayer:
    """A layer as stretches, in the order of time."""

    name: str
    stretches: tuple[Stretch, ...]


def shape_layers(film: Film) -> list[ShapeLayer]:
    """Return every visible layer, from the back to the front."""
    return [ShapeLayer(x.name, tuple(_stretches(film, x))) for x in film.document.layers if x.visible]


def _stretches(film: Film, layer: Layer) -> Iterator[Stretch]:
    first, last = film.settings.first, film.settings.last
    cuts = sorted({first, last + 1, *(f for f in layer.frames() if first < f <= last)})
    for start, end in pairwise(cuts):
        before, after = layer.around(start)
        if before is None:
            continue
        if after is None or after.frame <= start:
            found = _held(film, layer, start, end)
        elif _flows(film, layer, before):
            found = [_flowing(film, layer, before, after, start, end)]
        else:
            found = _held(film, layer, start, end)
        for stretch in found:
            yield _from_zero(stretch, first)


def _from_zero(stretch: Stretch, first: int) -> Stretch:
    moments = tuple(replace(m, time=m.time - first) for m in stretch.moments)
    return replace(stretch, start=stretch.start - first, end=stretch.end - first, moments=moments)


def _shown(film: Film, layer: Layer, time: float) -> Picture | None:
    return picture_at(film.document, layer, time, film.plans)


def _flows(film: Film, layer: Layer, before: Keyframe) -> bool:
    """Whether every frame of a span is a drawing of its own."""
    span = before.span
    return not (span.hold or span.exposures or span.step != 1)


def _flowing(film: Film, layer: Layer, before: Keyframe, after: Keyframe, start: int, end: int) -> Stretch:
    """Return a span on ones, whole or cut off at the ends of the export."""
    whole = start == before.frame and end == after.frame
    if whole and _is_straight(layer, before):
        ends = (_inside(film, layer, start, 1), _inside(film, layer, end, -1))
        easing = before.span.easing
        if ends[0] and ends[1] and _is_one_curve(easing):
            moments = (Moment(start, ends[0]), Moment(end, ends[1]))
            return Stretch(start, end, moments, easing=None if easing.is_linear else easing)
    times = [start + NEARLY, *range(start + 1, end), end - NEARLY if end == after.frame else end]
    pictures = [(round(t), _shown(film, layer, t)) for t in times]
    return Stretch(start, end, _thinned([Moment(t, p) for t, p in pictures if p is not None]))


def _is_one_curve(easing: Easing) -> bool:
    """Whether every player can follow: one curve that does not overshoot."""
    return not easing.knots and 0 <= min(easing.y1, easing.y2) <= max(easing.y1, easing.y2) <= 1


def _inside(film: Film, layer: Layer, frame: int, side: int) -> Picture | None:
    return _shown(film, layer, frame + side * NEARLY)


def _is_straight(layer: Layer, before: Keyframe) -> bool:
    """Whether vertices go straight from keyframe to keyframe, and colours do not change."""
    span = before.span
    after = next(k for k in layer.keyframes if k.frame > before.frame)
    bent = span.pins or span.repair or span.turns or span.method != "linear"
    smooth = before.smooth or after.smooth
    follows = layer.parent is not None
    return not (bent or smooth or follows) and before.drawing.style == after.drawing.style


def _held(film: Film, layer: Layer, start: int, end: int) -> list[Stretch]:
    """Return the drawings of a time in which they are held, one stretch while the vertices are the same."""
    found: list[Stretch] = []
    for frame in range(start, end):
        picture = _shown(film, layer, frame)
        if picture is None:
            continue
        last = found[-1] if found else None
        if last is not None and last.end == frame and _same_vertices(last.moments[-1].picture, picture):
            moments = last.moments
            if not same_pictures((moments[-1].picture,), (picture,)):
                moments = (*moments, Moment(frame, picture))
            found[-1] = replace(last, end=frame + 1, moments=moments)
        else:
            found.append(Stretch(frame, frame + 1, (Moment(frame, picture),), held=True))
    return found


def _same_vertices(a: Picture, b: Picture) -> bool:
    return _vertices(a) == _vertices(b) and _paints(a.style) == _paints(b.style)


def _vertices(picture: Picture) -> list[tuple[int, bool]]:
    return [(len(points), closed) for points, closed in picture.outlines]


def _paints(style: Style) -> tuple[bool, bool]:
    return style.fill is not None, style.stroke is not None


def _thinned(moments: list[Moment]) -> tuple[Moment, ...]:
    """Drop the moments that lie where the straight way between their neighbours leads anyway."""
    values = np.array([_numbers(m.picture) for m in moments])
    times = np.array([m.time for m in moments])
    kept = {0, len(moments) - 1}
    open_ends = [(0, len(moments) - 1)]
    while open_ends:
        low, high = open_ends.pop()
        if high - low < 2:
            continue
        share = (times[low + 1 : high] - times[low]) / (times[high] - times[low])
        straight = values[low] + share[:, None] * (values[high] - values[low])
        off = np.abs(values[low + 1 : high] - straight).max(axis=1)
        worst = int(off.argmax())
        if off[worst] > TOLERANCE:
            middle = low + 1 + worst
            kept.add(middle)
            open_ends += [(low, middle), (middle, high)]
    return tuple(moments[i] for i in sorted(kept))


def _numbers(picture: Picture) -> FloatArray:
    """Return everything that changes, in px or so many that a step that can be seen counts as one."""
    style = picture.style
    colors = [c for paint in (style.fill, style.stroke) if paint for c in bytes.fromhex(paint[1:].ljust(8, "f"))]
    scale = TOLERANCE / (255 * COLOR_TOLERANCE)
    rest = [style.width, *(c * scale for c in colors), 255 * picture.opacity * scale]
    return np.concatenate([*(points.ravel() for points, _ in picture.outlines), np.array(rest)])
