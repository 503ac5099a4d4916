"""Edits of an easing's curve: adding, moving and deleting its knots and their handles.

Functions from easing to easing. Whatever a hand asks for, the curve stays one: knots keep their order, and handles
are shortened until they lie within their piece.
"""

from itertools import pairwise
from typing import Literal

import numpy as np

from core.errors import DocumentError
from core.geometry.outline import FloatArray
from core.model.easing import HIGHEST, LOWEST, MOST_KNOTS, Easing, Knot, chained, split

Side = Literal["in", "out"]

CLOSEST = 1e-3
"""Ratio that stays between neighbouring knots."""

STRAIGHT = 0.05
"""Radians that two handles may be off one line and still turn together; a curve is drawn by hand."""


def with_handles(easing: Easing) -> Easing:
    """Return the easing itself, or, where it is linear, the same line with handles that can be taken hold of."""
    return Easing(1 / 3, 1 / 3, 2 / 3, 2 / 3) if easing.is_linear else easing


def add_knot(easing: Easing, ratio: float) -> Easing:
    """Put a knot on the curve; the curve stays as it is.

    All but a curve that nearly stands upright: handles of its parts may have to be shortened to lie within them.

    Raises
    ------
    DocumentError
        If another knot or an end of the curve is too near.
    """
    pieces = with_handles(easing).pieces()
    if len(pieces) > MOST_KNOTS:
        raise DocumentError(f"the curve has {len(pieces) - 1} knots; the limit is {MOST_KNOTS}")
    taken = np.append(pieces[:, 0, 0], 1.0)
    if not np.abs(taken - ratio).min() >= CLOSEST:
        raise DocumentError(f"there is a knot at ratio {ratio:.3g} already")
    i = int(np.searchsorted(taken, ratio)) - 1
    halves = (fitted(p) for p in split(pieces[i], ratio))
    return chained([*pieces[:i], *halves, *pieces[i + 1 :]])


def delete_knot(easing: Easing, index: int) -> Easing:
    """Take a knot away; one that `add_knot` has just put there leaves the curve as it was."""
    _check(easing, index)
    pieces = with_handles(easing).pieces()
    left, right = pieces[index], pieces[index + 1]
    way, back = right[1] - left[2], left[3] - left[2]
    share = back[0] / way[0] if way[0] > 0 else (left[3, 0] - left[0, 0]) / (right[3, 0] - left[0, 0])
    share = min(max(float(share), CLOSEST), 1 - CLOSEST)
    joined = np.stack(
        [
            left[0],
            left[0] + (left[1] - left[0]) / share,
            right[3] + (right[2] - right[3]) / (1 - share),
            right[3],
        ]
    )
    return chained([*pieces[:index], fitted(joined), *pieces[index + 2 :]])


def move_knot(easing: Easing, index: int, ratio: float, t: float) -> Easing:
    """Put a knot elsewhere, its handles with it, between its neighbours."""
    _check(easing, index)
    xs = [0.0, *(k.x for k in easing.knots), 1.0]
    gap = min(CLOSEST, (xs[index + 2] - xs[index]) / 3)
    x = min(max(ratio, xs[index] + gap), xs[index + 2] - gap)
    k = easing.knots[index]
    dx, dy = x - k.x, _within(t) - k.y
    moved = Knot(x, k.y + dy, k.in_x + dx, k.in_y + dy, k.out_x + dx, k.out_y + dy)
    return _with_knot(easing, index, moved)


def move_handle(
    easing: Easing, index: int | None, side: Side, ratio: float, t: float, *, alone: bool = False
) -> Easing:
    """Put a handle elsewhere.

    Parameters
    ----------
    easing : Easing
    index : int or None
        The knot that it belongs to; None: "out" is the handle of the first end, "in" that of the last one.
    side : "in" or "out"
    ratio, t : float
        Where to; clipped to what the handle may reach.
    alone : bool
        Leave the handle on the other side of the knot; else it turns along if the two are in line.
    """
    easing = with_handles(easing)
    if index is None:
        x, y = min(max(ratio, 0.0), 1.0), _within(t)
        changed = (x, y, easing.x2, easing.y2) if side == "out" else (easing.x1, easing.y1, x, y)
        return _fitted_easing(changed, easing.knots)
    _check(easing, index)
    k = easing.knots[index]
    other = _turned(k, side, ratio, _within(t)) if not alone and is_smooth(k) else None
    if side == "in":
        k = k._replace(in_x=min(ratio, k.x), in_y=_within(t))
        k = k if other is None else k._replace(out_x=other[0], out_y=other[1])
    else:
        k = k._replace(out_x=max(ratio, k.x), out_y=_within(t))
        k = k if other is None else k._replace(in_x=other[0], in_y=other[1])
    return _with_knot(easing, index, k)


def is_smooth(knot: Knot) -> bool:
    """Whether the two handles of a knot are in one line."""
    arms = np.array([[knot.x - knot.in_x, knot.y - knot.in_y], [knot.out_x - knot.x, knot.out_y - knot.y]])
    if not (np.hypot(*arms.T) > 0).all():
        return False
    angles = np.arctan2(arms[:, 1], arms[:, 0])
    return bool(abs(angles[0] - angles[1]) < STRAIGHT)


def fitted(piece: FloatArray) -> FloatArray:
    """Return a piece whose handles are shortened until they lie within it, and within the range of t."""
    (x0, _), (x3, _) = piece[0], piece[3]
    result = piece.copy()
    for row, end in ((1, 0), (2, 3)):
        arm = piece[row] - piece[end]
        forward = max(arm[0], 0.0) if row == 1 else min(arm[0], 0.0)
        room = (x3 - x0) / abs(forward) if abs(forward) > x3 - x0 else 1.0
        x = piece[end, 0] + forward * room
        result[row] = min(max(x, x0), x3), _within(piece[end, 1] + arm[1] * room)
    return result


def _turned(k: Knot, side: Side, x: float, y: float) -> tuple[float, float] | None:
    """Return where the other handle of a knot goes when one goes to (x, y): opposite, over the same ratios."""
    dx, dy = (k.x - x, k.y - y) if side == "in" else (x - k.x, y - k.y)
    if dx <= 0:
        return None
    if side == "in":
        reach = k.out_x - k.x
        return k.out_x, _within(k.y + dy / dx * reach)
    reach = k.x - k.in_x
    return k.in_x, _within(k.y - dy / dx * reach)


def _with_knot(easing: Easing, index: int, knot: Knot) -> Easing:
    knots = (*easing.knots[:index], knot, *easing.knots[index + 1 :])
    return _fitted_easing((easing.x1, easing.y1, easing.x2, easing.y2), knots)


def _fitted_easing(ends: tuple[float, float, float, float], knots: tuple[Knot, ...]) -> Easing:
    """Return the easing of these handles and knots, the handles shortened as far as needed."""
    x1, y1, x2, y2 = ends
    if not knots:
        return Easing(x1, y1, x2, y2)
    starts = [(0.0, 0.0, x1, y1), *((k.x, k.y, k.out_x, k.out_y) for k in knots)]
    stops = [*((k.in_x, k.in_y, k.x, k.y) for k in knots), (x2, y2, 1.0, 1.0)]
    pieces = [fitted(np.array(a + b).reshape(4, 2)) for a, b in zip(starts, stops, strict=True)]
    made = tuple(_with_arms(k, a[2], b[1]) for k, (a, b) in zip(knots, pairwise(pieces), strict=True))
    first, last = pieces[0][1], pieces[-1][2]
    return Easing(float(first[0]), float(first[1]), float(last[0]), float(last[1]), made)


def _with_arms(knot: Knot, coming: FloatArray, leaving: FloatArray) -> Knot:
    """Return a knot with other handles."""
    return Knot(knot.x, knot.y, float(coming[0]), float(coming[1]), float(leaving[0]), float(leaving[1]))


def _within(t: float) -> float:
    return min(max(t, LOWEST), HIGHEST)


def _check(easing: Easing, index: int) -> None:
    if not 0 <= index < len(easing.knots):
        raise DocumentError(f"the curve has {len(easing.knots)} knots; there is no number {index}")
