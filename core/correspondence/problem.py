"""Pose the question of two outlines in a form that no way of drawing them changes."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.correspondence.pairing import Anchor, ordered_anchors
from core.correspondence.ring import Ring, ring, shape_key, turned_together
from core.correspondence.track import FREE, Knots, knots_of
from core.geometry.outline import FloatArray, perimeter, signed_area

FLAT = 1e-6
"""Below this area, in squares of the perimeter, an outline has no inside that could tell its direction."""

INSIDE = 1e-6
"""Share of the length by which an anchor stays off the ends of an open outline."""


@dataclass(frozen=True, eq=False)
class Problem:
    """Two rings to match, in canonical order and pose.

    Attributes
    ----------
    first, second : Ring
    knots : Knots
        Shares on `first` and `second` that the artist has fixed.
    swapped : bool
        `first` is the outline after.
    flipped : bool
        One ring runs with its outline, the other against it.
    anchors : (k, 2) float array
        The artist's positions (before, after), exactly; without those at the ends of open outlines.
    """

    first: Ring
    second: Ring
    knots: Knots
    swapped: bool
    flipped: bool
    anchors: FloatArray

    @property
    def counts(self) -> tuple[int, int]:
        """Numbers of vertices before and after."""
        counts = (self.first.count, self.second.count)
        return counts[::-1] if self.swapped else counts


def problems(a: FloatArray, b: FloatArray, anchors: Sequence[Anchor], *, closed: bool) -> list[Problem]:
    """Return the problem of two outlines; two, one for each direction, where nothing tells the direction.

    Three anchors tell it, two on an open outline; else the areas of closed outlines do.
    """
    before, after, flipped = ordered_anchors(anchors, (len(a), len(b)), closed=closed)
    pairs = np.column_stack([before, after])
    if flipped is None and closed:
        flipped = _flipped_by_area(a, b)
    return [_problem(a, b, pairs, f, closed) for f in ((False, True) if flipped is None else (flipped,))]


def _flipped_by_area(a: FloatArray, b: FloatArray) -> bool | None:
    areas = [float(signed_area(p)) / perimeter(p) ** 2 for p in (a, b)]
    if min(abs(x) for x in areas) < FLAT:
        return None
    return areas[0] * areas[1] < 0


def _problem(a: FloatArray, b: FloatArray, pairs: FloatArray, flipped: bool, closed: bool) -> Problem:
    backwards = _drawn_backwards(a, closed)
    sides = [(a, backwards), (b, backwards != flipped)]
    rings = [ring(p, closed=closed, backwards=back) for p, back in sides]
    swapped = shape_key(rings[0]) > shape_key(rings[1])
    if swapped:
        sides, rings = sides[::-1], rings[::-1]
    # the start of a symmetric shape is chosen by the other's, so that they change together or not at all
    for k in range(2):
        points, back = sides[k]
        rings[k] = ring(points, closed=closed, backwards=back, towards=complex(rings[1 - k].z[0]))
    first, second = turned_together(rings[0], rings[1])
    if not closed:
        pairs = pairs[(pairs[:, 0] > 0) & (pairs[:, 0] < len(a) - 1)]
    columns = pairs[:, ::-1] if swapped else pairs
    knots = _knots(first.shares_of(columns[:, 0]), second.shares_of(columns[:, 1]), closed)
    return Problem(first, second, knots, swapped, flipped, pairs)


def _knots(u: FloatArray, v: FloatArray, closed: bool) -> Knots:
    if closed:
        return knots_of(u, v, closed=True) if len(u) else FREE
    return knots_of(np.append(_inside(u), [0.0, 1.0]), np.append(_inside(v), [0.0, 1.0]), closed=False)


def _inside(shares: FloatArray) -> FloatArray:
    """Hold shares off the ends: an anchor on an edge without length at an end is still not the end."""
    return np.clip(shares, INSIDE, 1 - INSIDE)


def _drawn_backwards(points: FloatArray, closed: bool) -> bool:
    """Closed outlines run with positive area, open ones from the end that is farther from the centroid."""
    if closed:
        return bool(signed_area(points) < 0)
    r = ring(points, closed=False)
    return bool(round(abs(r.z[0]), 7) < round(abs(r.z[-1]), 7))
