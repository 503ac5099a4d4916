"""Where outlines cross or touch themselves and each other, decided exactly.

Two edges *cross* when they have a point in common, other than the vertex that joins neighbours. Touching counts,
and so does an edge that doubles back onto its neighbour; a vertex repeated at once does not. For closed outlines
that is the rule of the OGC "simple features" (ISO 19125-1) for a valid ring.
"""

from fractions import Fraction
from typing import Any

import numpy as np
import numpy.typing as npt

from core.geometry.boxes import IndexArray, box_pairs, box_pairs_between
from core.geometry.outline import FloatArray, edge_vectors

CHUNK = 60_000
"""Edges looked at in one go: more would leave the cache, fewer would pay for the calls."""

DOUBT = 3.3306690738754716e-16
"""Relative error of the orientation of three points in doubles (Shewchuk 1997, bound A)."""


def is_simple(points: FloatArray, *, closed: bool = True) -> bool:
    """Whether an outline (n, 2) neither crosses nor touches itself and, when closed, surrounds an area."""
    return bool(simple_frames(points[None], closed=closed)[0])


def simple_frames(frames: FloatArray, *, closed: bool = True) -> npt.NDArray[np.bool_]:
    """Whether each of the outlines (T, n, 2) is simple, as (T,); see `is_simple`. NaN is never simple."""
    fine = np.asarray(np.isfinite(frames).all(axis=(1, 2)))
    fine &= (edge_vectors(frames, closed=closed) != 0).any(axis=2).sum(axis=1) >= (3 if closed else 1)
    fine[frame_crossings(frames, closed=closed)[:, 0]] = False
    return fine


def crossings(points: FloatArray, *, closed: bool = True) -> IndexArray:
    """Return the pairs of edges (k, 2) of an outline (n, 2) that cross or touch, i < j, in order.

    Edge i runs from vertex i to the next one. `crossing_places` tells where they do.

    Notes
    -----
    Sort and sweep; exact: orientations that doubles leave in doubt are found in rational numbers. About 1 ms for
    1,000 edges.

    Examples
    --------
    >>> crossings(np.array([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]))
    array([[0, 2]])
    """
    return frame_crossings(points[None], closed=closed)[:, 1:]


def frame_crossings(frames: FloatArray, *, closed: bool = True) -> IndexArray:
    """Return the crossings of many outlines (T, n, 2) of one topology as rows (frame, i, j), (k, 3), in order."""
    step = max(1, CHUNK // max(frames.shape[1], 1))
    found = [_crossings(frames[k : k + step], closed) + np.array([k, 0, 0]) for k in range(0, len(frames), step)]
    return np.concatenate(found) if found else np.zeros((0, 3), np.intp)


def frame_crossings_between(
    frames: FloatArray, others: FloatArray, *, closed: bool = True, others_closed: bool = True
) -> IndexArray:
    """Return the crossings of outlines (T, n, 2) with others (T, m, 2) as rows (frame, edge, other edge), (k, 3).

    Outlines of which one lies inside the other do not cross.
    """
    a, b = (_ends(p, c) for p, c in ((frames, closed), (others, others_closed)))
    boxes = [f(s, e) for s, e in (a, b) for f in (np.minimum, np.maximum)]
    t, i, j = box_pairs_between(*boxes)
    hit = _meet(a[0][t, i], a[1][t, i], b[0][t, j], b[1][t, j])
    return _in_order(np.stack([t, i, j], axis=1)[hit])


def crossing_places(points: FloatArray, pairs: IndexArray, others: FloatArray | None = None) -> FloatArray:
    """Return a point common to each of the `pairs` (k, 2) of edges, as (k, 2) px.

    Parameters
    ----------
    points : (n, 2) float array
    pairs : (k, 2) int array
        From `crossings`, or from `frame_crossings_between` without the frame.
    others : (m, 2) float array, optional
        The outline to which the second edge belongs; `points` when omitted.
    """
    others = points if others is None else others
    i, j = pairs.T
    a, c = points[i], others[j]
    b, d = points[(i + 1) % len(points)], others[(j + 1) % len(others)]
    r, s = b - a, d - c
    across = _cross(r, s)
    parallel = np.abs(across) <= 1e-12 * np.hypot(*r.T) * np.hypot(*s.T)
    u = _cross(c - a, s) / np.where(parallel, 1.0, across)
    u = np.where(parallel, _middle_of_overlap(a, r, c, d), np.clip(u, 0.0, 1.0))
    return np.asarray(a + u[:, None] * r, np.float64)


def orientations(p: FloatArray, q: FloatArray, r: FloatArray) -> npt.NDArray[np.int8]:
    """Side of the line from p to q on which r lies: 1 where x turns towards y, -1, or 0 on it; exact.

    All (k, 2) -> (k,). Source: Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
    predicates", 1997; what his first bound leaves in doubt is rare here and found in rational numbers.
    """
    left = (q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1])
    right = (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0])
    area = left - right
    sign = np.sign(area).astype(np.int8)
    doubtful = np.abs(area) <= DOUBT * (np.abs(left) + np.abs(right)) + 1e-290
    for k in np.flatnonzero(doubtful):
        sign[k] = _exact_orientation(*p[k].tolist(), *q[k].tolist(), *r[k].tolist())
    return sign


def _exact_orientation(*numbers: float) -> int:
    if not np.isfinite(numbers).all():
        return 0
    px, py, qx, qy, rx, ry = map(Fraction, numbers)
    area = (qx - px) * (ry - py) - (qy - py) * (rx - px)
    return (area > 0) - (area < 0)


def _crossings(frames: FloatArray, closed: bool) -> IndexArray:
    start, end = _ends(frames, closed)
    solid = (start != end).any(axis=2)
    t, i, j = box_pairs(np.minimum(start, end), np.maximum(start, end))
    # neighbours are told by their number among the edges that have a length
    number = np.cumsum(solid, axis=1)
    gap = number[t, j] - number[t, i]
    apart = solid[t, i] & solid[t, j] & (gap > 1)
    if closed and len(t):
        apart &= gap < number[t, -1] - 1
    t, i, j = t[apart], i[apart], j[apart]
    hit = _meet(start[t, i], end[t, i], start[t, j], end[t, j])
    return _in_order(np.concatenate([np.stack([t, i, j], axis=1)[hit], _doubled_back(start, end, solid, closed)]))


def _doubled_back(start: FloatArray, end: FloatArray, solid: npt.NDArray[np.bool_], closed: bool) -> IndexArray:
    """Neighbouring edges of which the second runs back along the first, as rows (frame, i, j)."""
    t, i = np.nonzero(solid)
    follows = np.arange(1, len(t) + 1)
    last = np.flatnonzero(np.diff(t, append=-1))
    follows[last] = np.searchsorted(t, t[last])
    if not closed:
        keep = np.ones(len(t), np.bool_)
        keep[last] = False
        t, i, follows, all_t, all_i = t[keep], i[keep], follows[keep], t, i
    else:
        all_t, all_i = t, i
    j = all_i[follows]
    a, b, c = start[t, i], end[t, i], end[all_t[follows], j]
    back = np.flatnonzero(((b - a) * (c - b)).sum(axis=1) < 0)
    back = back[orientations(a[back], b[back], c[back]) == 0]
    pairs = np.stack([np.minimum(i, j), np.maximum(i, j)], axis=1)[back]
    return np.concatenate([t[back, None], pairs], axis=1)


def _ends(frames: FloatArray, closed: bool) -> tuple[FloatArray, FloatArray]:
    if closed:
        return frames, np.concatenate([frames[:, 1:], frames[:, :1]], axis=1)
    return frames[:, :-1], frames[:, 1:]


def _meet(a: FloatArray, b: FloatArray, c: FloatArray, d: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether the closed edges ab and cd, whose boxes overlap, have a common point."""
    meet = orientations(a, b, c) * orientations(a, b, d) <= 0
    k = np.flatnonzero(meet)
    meet[k] = orientations(c[k], d[k], a[k]) * orientations(c[k], d[k], b[k]) <= 0
    return meet


def _middle_of_overlap(a: FloatArray, r: FloatArray, c: FloatArray, d: FloatArray) -> FloatArray:
    """Share along the edge a + u r of the middle of what a parallel edge cd covers of it."""
    squared = np.maximum((r * r).sum(axis=1), np.finfo(np.float64).tiny)
    ends = np.clip([((x - a) * r).sum(axis=1) / squared for x in (c, d)], 0.0, 1.0)
    return np.asarray(ends.mean(axis=0), np.float64)


def _cross(u: FloatArray, v: FloatArray) -> Any:
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def _in_order(rows: IndexArray) -> IndexArray:
    return rows[np.lexsort(rows.T[::-1])]
