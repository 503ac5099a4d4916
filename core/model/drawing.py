"""A drawing: the outlines of one keyframe and how they are painted."""

import re
from collections import Counter
from dataclasses import dataclass, field, replace

import numpy as np

from core.errors import DocumentError
from core.geometry.outline import FloatArray, as_points

Color = str
"""Straight-alpha sRGB as #rrggbb or #rrggbbaa, lower case."""

COLOR_PATTERN = re.compile(r"#[0-9a-f]{6}([0-9a-f]{2})?")

WIDEST_STROKE = 10_000.0

LARGEST_ID = 2**31 - 1


def check_id(number: int, *, name: str) -> None:
    """Raise DocumentError unless `number` can name something in a file: 1 to 2**31 - 1."""
    if not 1 <= number <= LARGEST_ID:
        raise DocumentError(f"{name} has the id {number}; ids run from 1 to {LARGEST_ID}")


def as_color(color: str, *, name: str = "color") -> Color:
    """Return `color` in lower case, or raise DocumentError if it is not #rrggbb or #rrggbbaa."""
    lower = color.lower()
    if not COLOR_PATTERN.fullmatch(lower):
        raise DocumentError(f"{name} is {color!r}; expected #rrggbb or #rrggbbaa")
    return lower


@dataclass(frozen=True, slots=True)
class Style:
    """How a drawing is painted.

    Attributes
    ----------
    fill, stroke : Color or None
        None paints nothing.
        An open outline is never filled; without a stroke its line takes the colour of the fill.
    width : float
        Width of the stroke in stage px, 0 to 10,000.
    opacity : float
        Of the whole drawing, 0 to 1: fill and stroke do not show through each other.
    """

    fill: Color | None = "#7b61e8"
    stroke: Color | None = None
    width: float = 4.0
    opacity: float = 1.0

    def __post_init__(self) -> None:
        for name in ("fill", "stroke"):
            color = getattr(self, name)
            if color is not None:
                object.__setattr__(self, name, as_color(color, name=name))
        if not 0 <= self.width <= WIDEST_STROKE:
            raise DocumentError(f"the stroke width is {self.width}; it must be 0 to {WIDEST_STROKE:g} px")
        if not 0 <= self.opacity <= 1:
            raise DocumentError(f"the opacity of a drawing is {self.opacity}; it must be 0 to 1")


@dataclass(frozen=True, slots=True, eq=False)
class Outline:
    """One closed polygon or open polyline; equal when every number is equal.

    Attributes
    ----------
    id : int
        Unique in its drawing; spans name the outline by it.
    points : (n, 2) float array
        Vertices in stage px, y down; read-only.
    closed : bool
    """

    id: int
    points: FloatArray
    closed: bool = True

    def __post_init__(self) -> None:
        check_id(self.id, name="an outline")
        points = as_points(self.points, name=f"outline {self.id}", closed=self.closed)
        if points.flags.writeable or points.base is not None:
            points = points.copy()
            points.setflags(write=False)
        object.__setattr__(self, "points", points)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Outline):
            return NotImplemented
        return (
            self.id == other.id
            and self.closed == other.closed
            and (self.points is other.points or np.array_equal(self.points, other.points))
        )

    def __hash__(self) -> int:
        return hash((self.id, self.closed, self.points.tobytes()))


@dataclass(frozen=True, slots=True)
class Drawing:
    """The outlines of one keyframe; several closed ones fill even-odd, so holes work.

    Attributes
    ----------
    outlines : tuple of Outline
        With different ids. May be empty: a keyframe that shows nothing.
    style : Style
    """

    outlines: tuple[Outline, ...] = ()
    style: Style = field(default_factory=Style)

    def __post_init__(self) -> None:
        ids = [o.id for o in self.outlines]
        if len(set(ids)) < len(ids):
            twice = Counter(ids).most_common(1)[0][0]
            raise DocumentError(f"two outlines of one drawing have the id {twice}")

    def outline(self, outline_id: int) -> Outline:
        """Return the outline with that id, or raise DocumentError."""
        for outline in self.outlines:
            if outline.id == outline_id:
                return outline
        raise DocumentError(f"the drawing has no outline {outline_id}")

    def has(self, outline_id: int) -> bool:
        """Whether an outline with that id is here."""
        return any(o.id == outline_id for o in self.outlines)

    def free_id(self) -> int:
        """Return the smallest id above all that are taken."""
        return max((o.id for o in self.outlines), default=0) + 1

    def with_outline(self, outline: Outline) -> "Drawing":
        """Return a drawing with `outline` in place of the one with its id, or added last."""
        if not self.has(outline.id):
            return replace(self, outlines=(*self.outlines, outline))
        return replace(self, outlines=tuple(outline if o.id == outline.id else o for o in self.outlines))

    def without_outline(self, outline_id: int) -> "Drawing":
        """Return a drawing that lacks that outline."""
        self.outline(outline_id)
        return replace(self, outlines=tuple(o for o in self.outlines if o.id != outline_id))
