"""Pins of a span as the artist sets them, and as the methods want them."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from core.errors import DocumentError
from core.geometry.outline import FloatArray
from core.methods.pins import Inside, OnOutline, Pin
from core.model.drawing import Drawing

LARGEST_PLACE = 1e9
"""Px; as for the vertices of outlines."""

Point = tuple[float, float]


@dataclass(frozen=True, slots=True)
class SpanPin:
    """A point of the keyframe before whose way through the span the artist has drawn.

    Attributes
    ----------
    outline : int or None
        Id of the outline before that it sits on; None: inside the drawing.
    position : float
        Where on that outline; 0 for one inside.
    place : (x, y) or None
        Where inside the keyframe before, px; None for one on an outline.
    handles : pair of (x, y) or None
        Of the cubic Bezier arc to its place in the keyframe after, px. None: straight, and held still where both
        keyframes have it at the same place.
    """

    outline: int | None = None
    position: float = 0.0
    place: Point | None = None
    handles: tuple[Point, Point] | None = None

    def __post_init__(self) -> None:
        if (self.outline is None) == (self.place is None):
            raise DocumentError("a pin is either on an outline or at a place inside the drawing")
        if self.outline is None and self.position != 0:
            raise DocumentError("a pin inside the drawing has no position on an outline")
        if not math.isfinite(self.position):
            raise DocumentError("the position of a pin is not a finite number")
        object.__setattr__(self, "position", float(self.position))
        if self.place is not None:
            object.__setattr__(self, "place", _checked(self.place))
        if self.handles is not None:
            first, second = self.handles
            object.__setattr__(self, "handles", (_checked(first), _checked(second)))

    def check_on(self, drawing: Drawing) -> None:
        """Raise DocumentError unless `drawing`, the keyframe before, has the outline and the position."""
        if self.outline is None:
            return
        outline = drawing.outline(self.outline)
        top = len(outline.points) if outline.closed else len(outline.points) - 1
        if not 0 <= self.position <= top:
            raise DocumentError(f"a pin at {self.position:g} on outline {self.outline}, which ends at {top}")

    def same_place(self, other: "SpanPin") -> bool:
        """Whether two pins hold the same point, on whatever way."""
        return replace(self, handles=None) == replace(other, handles=None)


def _checked(point: Point) -> Point:
    """Return a point as plain numbers; raises DocumentError where it is far off."""
    x, y = float(point[0]), float(point[1])
    if not (abs(x) <= LARGEST_PLACE and abs(y) <= LARGEST_PLACE):
        raise DocumentError(f"a pin or a handle of its arc lies beyond {LARGEST_PLACE:g} px")
    return x, y


@dataclass(frozen=True, slots=True, eq=False)
class PlannedOutline:
    """One outline of a plan, for the pins on it.

    Attributes
    ----------
    before : int or None
        Id of the outline before; None where it grows out of a point.
    rows : (k,) float array
        Positions of its vertices on that outline, rising.
    count : int
        Number of vertices of that outline.
    closed : bool
    """

    before: int | None
    rows: FloatArray
    count: int
    closed: bool


def planned_pins(pins: Iterable[SpanPin], outlines: Iterable[PlannedOutline]) -> tuple[Pin, ...]:
    """Return the pins as a plan of these outlines takes them; those whose outline is gone are left out."""
    by_id = {o.before: (k, o) for k, o in enumerate(outlines) if o.before is not None}
    if not by_id:
        return ()
    found = []
    for pin in pins:
        if pin.place is not None:
            found.append(Pin(Inside(*pin.place), pin.handles))
        elif pin.outline in by_id:
            number, outline = by_id[pin.outline]
            found.append(Pin(OnOutline(number, _row(pin.position, outline)), pin.handles))
    return tuple(found)


def _row(position: float, outline: PlannedOutline) -> float:
    """Return where among the rows of a plan a position on the outline before lies."""
    rows = outline.rows
    if not outline.closed:
        return float(np.interp(position, rows, np.arange(len(rows))))
    lifted = position % outline.count
    if lifted < rows[0]:
        lifted += outline.count
    return float(np.interp(lifted, np.append(rows, rows[0] + outline.count), np.arange(len(rows) + 1)))
