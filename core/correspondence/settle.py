"""Turn a solved track into the pairs of positions that are kept: few, at vertices, anchors exact."""

from enum import IntEnum

import numpy as np
import numpy.typing as npt

from core.correspondence.cyclic import IntArray
from core.correspondence.pairing import Correspondence
from core.correspondence.problem import Problem
from core.correspondence.ring import Ring
from core.correspondence.track import Track
from core.geometry.outline import FloatArray

TOLERANCE = 1e-4
"""By how much (share of the perimeter) the pairs may leave the track: a tenth of a pixel on a large drawing."""

CLOSEST = 1e-7
"""Shares nearer than this are one point; strictly rising pairs must not depend on rounding."""


class Kind(IntEnum):
    """What a pair of positions is told by."""

    FIRST = 1
    """A vertex of the first ring, and what lies opposite."""
    SECOND = 2
    BOTH = 3
    """Two vertices that meet."""
    KNOT = 4
    """Fixed by the artist, or an end."""


def settled(problem: Problem, track: Track, tolerance: float = TOLERANCE) -> Correspondence:
    """Return the correspondence along a track, told by pairs of which one is a vertex.

    Only vertices are paired, with whatever lies opposite: so aligning the outlines adds no other points, and a
    straight edge moves evenly.
    """
    u, v, kind = events(problem, track)
    keep = _enough(u, v, kind >= Kind.BOTH, tolerance)
    u, v, kind = u[keep], v[keep], kind[keep]
    p = _positions(problem.first, u, (kind == Kind.FIRST) | (kind == Kind.BOTH))
    q = _positions(problem.second, v, (kind == Kind.SECOND) | (kind == Kind.BOTH))
    if problem.swapped:
        p, q = q, p
    fixed = _fixed(problem)
    free = (kind != Kind.KNOT) & _agrees(p, q, fixed, problem)
    p, q = (np.append(x[free], column) for x, column in zip((p, q), fixed.T, strict=True))
    return Correspondence(p, q, problem.counts, problem.first.closed, problem.flipped)


def _fixed(problem: Problem) -> FloatArray:
    """Positions (before, after) that must be told exactly: the anchors, and the ends of open outlines."""
    if problem.first.closed:
        return problem.anchors
    n, m = problem.counts
    ends = np.array([[0.0, m - 1.0], [n - 1.0, 0.0]] if problem.flipped else [[0.0, 0.0], [n - 1.0, m - 1.0]])
    return np.concatenate([problem.anchors, ends])


def _agrees(p: FloatArray, q: FloatArray, fixed: FloatArray, problem: Problem) -> npt.NDArray[np.bool_]:
    """Whether pairs are in order with all that is fixed, told by position: edges without length have one share."""
    if not len(fixed):
        return np.ones(len(p), dtype=bool)
    origin = fixed[0]
    sides = []
    for x, at, zero, n, down in zip(
        (p, q), fixed.T, origin, problem.counts, (False, problem.flipped), strict=True
    ):
        away, fixed_away = (zero - x, zero - at) if down else (x - zero, at - zero)
        if problem.first.closed:
            away, fixed_away = np.mod(away, n), np.mod(fixed_away, n)
        sides.append(np.sign(away[:, None] - fixed_away))
    return np.asarray(((sides[0] == sides[1]) & (sides[0] != 0)).all(axis=1))


def events(problem: Problem, track: Track) -> tuple[FloatArray, FloatArray, IntArray]:
    """Return the shares (k,), (k,) of the pairs along one round of a track, and the `Kind` of each."""
    closed = problem.first.closed
    u = _within(problem.first.vertex_shares, track.u[0], closed)
    v = _within(problem.second.vertex_shares, track.v[0], closed)
    knot_u, knot_v = (x[:-1] if closed else x for x in (problem.knots.u, problem.knots.v))
    all_u = np.concatenate([u, np.interp(v, track.v, track.u), knot_u])
    all_v = np.concatenate([np.interp(u, track.u, track.v), v, knot_v])
    kind = np.repeat([Kind.FIRST, Kind.SECOND, Kind.KNOT], [len(u), len(v), len(knot_u)]).astype(np.intp)
    order = np.lexsort((-kind, all_u + all_v))
    all_u, all_v, kind = all_u[order], all_v[order], kind[order]
    clear, kind = _clear(all_u, all_v, kind, closed)
    return all_u[clear], all_v[clear], kind[clear]


def _within(shares: FloatArray, start: float, closed: bool) -> FloatArray:
    return start + np.mod(shares - start, 1.0) if closed else shares


def _clear(u: FloatArray, v: FloatArray, kind: IntArray, closed: bool) -> tuple[IntArray, IntArray]:
    """Indices of the pairs far enough from the one before and from every knot, and their kinds; knots always stay.

    A vertex dropped because one of the other outline is there makes that one a meeting of both.
    """
    knots = kind == Kind.KNOT
    gaps = [np.diff(x, prepend=x[-1] - 1 if closed else -1.0) for x in (u, v)]
    free = ~knots & (gaps[0] > CLOSEST) & (gaps[1] > CLOSEST)
    meeting = (gaps[0] <= CLOSEST) & (gaps[1] <= CLOSEST) & (kind + np.roll(kind, 1) == Kind.BOTH)
    for x in (u, v):
        for k in np.flatnonzero(knots):
            beside = np.abs(x - x[k])
            free &= (np.minimum(beside, 1 - beside) if closed else beside) > CLOSEST
    met = np.where(np.roll(meeting, -1) & ~knots, Kind.BOTH, kind)
    clear = np.flatnonzero(knots | free)
    return clear if len(clear) else np.zeros(1, dtype=np.intp), met


def _enough(u: FloatArray, v: FloatArray, wanted: npt.NDArray[np.bool_], tolerance: float) -> IntArray:
    """Choose the wanted pairs and the fewest others between which even lengths stay within `tolerance`.

    Source: Douglas and Peucker 1973.
    """
    chosen = wanted.copy()
    chosen[[0, -1]] = True
    while True:
        at = np.flatnonzero(chosen)
        miss = np.abs(np.interp(u, u[at], v[at]) - v)
        miss[at] = 0.0  # knots on an edge without length share their share, and would be missed for ever
        if miss.max() <= tolerance:
            return at
        piece = np.searchsorted(at, np.arange(len(u)), side="right")
        order = np.lexsort((-miss, piece))
        first = order[np.append(True, np.diff(piece[order]) > 0)]
        chosen[first[miss[first] > tolerance]] = True


def _positions(r: Ring, shares: FloatArray, at_vertex: FloatArray) -> FloatArray:
    p = r.positions(shares)
    return np.where(at_vertex, np.rint(p), p)
