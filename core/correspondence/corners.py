"""Corners that lie opposite each other but for a little: they are made to meet."""

from dataclasses import dataclass

import numpy as np

from core.correspondence.cyclic import IntArray
from core.correspondence.ring import Ring
from core.correspondence.track import Knots, Track, knots_of
from core.geometry.outline import FloatArray

NARROW, WIDE = 0.005, 0.02
"""Shares of the perimeter on both sides: a corner turns within the narrow one already, a round tip does not."""

SHARP = 0.5
"""Least turn of a corner in radians."""

NEAR = 0.02
"""Farthest that a corner is moved along the outline, as a share of the perimeter."""

ALIKE = 0.9
"""Largest difference of the turns of two corners that meet, in radians."""

STEEPEST = 6.0
"""Between neighbouring corners one outline may be at most so many times longer than the track had it."""


@dataclass(frozen=True, eq=False)
class Corners:
    """Shares of a ring's corners, rising, and how far each turns (radians, positive to the left)."""

    shares: FloatArray
    turns: FloatArray


def corners(r: Ring) -> Corners:
    """Return the vertices at which the outline turns at once, the sharpest of any that crowd together."""
    at = r.vertex_shares
    narrow, wide = _turns(r, at, NARROW), _turns(r, at, WIDE)
    sharp = (np.abs(narrow) >= SHARP) & (np.abs(narrow) >= 0.6 * np.abs(wide))
    found = np.flatnonzero(sharp)
    strength = np.abs(narrow[found]) + 0.1 * np.abs(_own_turns(r))[found]
    keep = np.array([_leads(at[found], strength, k, r.closed) for k in range(len(found))], dtype=bool)
    found = found[keep] if len(found) else found
    return Corners(at[found], narrow[found])


def _turns(r: Ring, shares: FloatArray, reach: float) -> FloatArray:
    here, back, on = r.at(shares), r.at(shares - reach), r.at(shares + reach)
    turned = (on - here) * np.conj(here - back)
    return np.asarray(np.angle(np.where(turned == 0, 1.0, turned)))


def _own_turns(r: Ring) -> FloatArray:
    """Turning angle at every vertex itself."""
    d = np.diff(r.z)
    turned = d * np.conj(np.roll(d, 1)) if r.closed else np.append(1.0, np.append(d[1:] * np.conj(d[:-1]), 1.0))
    return np.asarray(np.angle(np.where(turned == 0, 1.0, turned)))


def _leads(at: FloatArray, strength: FloatArray, k: int, closed: bool) -> bool:
    gap = np.abs(at - at[k])
    gap = np.minimum(gap, 1 - gap) if closed else gap
    rivals = strength[gap <= NARROW]
    return bool(
        strength[k] >= rivals.max() and k == np.flatnonzero((gap <= NARROW) & (strength == strength[k]))[0]
    )


def with_corners(before: Ring, after: Ring, track: Track, knots: Knots) -> Knots:
    """Return the knots and with them every pair of corners that the track brings near each other."""
    p, q = corners(before), corners(after)
    if not len(p.shares) or not len(q.shares):
        return knots
    i, j = _mutual(p, q, track, before.closed)
    u = _after_start(p.shares[i], track.u[0], before.closed)
    v = _after_start(q.shares[j], track.v[0], before.closed)
    knot_u, knot_v = (x[:-1] if before.closed else x for x in (knots.u, knots.v))
    images = track.images(u, closed=before.closed)
    v = v + np.rint(images - v) if before.closed else v
    chosen = _in_order(np.append(knot_u, u), np.append(knot_v, v), len(knot_u), track, before.closed)
    return knots_of(np.append(knot_u, u)[chosen], np.append(knot_v, v)[chosen], closed=before.closed)


def _after_start(shares: FloatArray, start: float, closed: bool) -> FloatArray:
    return start + np.mod(shares - start, 1.0) if closed else shares


def _mutual(p: Corners, q: Corners, track: Track, closed: bool) -> tuple[IntArray, IntArray]:
    """Pairs of corners of which each is the other's best."""
    there = track.images(p.shares, closed=closed)
    gap = there[:, None] - q.shares
    gap = gap - np.rint(gap) if closed else gap
    turn = np.abs(p.turns[:, None] - q.turns)
    miss = np.where((np.abs(gap) <= NEAR) & (turn <= ALIKE), np.abs(gap) / NEAR + turn / ALIKE, np.inf)
    best = miss.argmin(axis=1)
    mutual = (miss.argmin(axis=0)[best] == np.arange(len(best))) & np.isfinite(miss.min(axis=1))
    i = np.flatnonzero(mutual)
    return i, best[i]


def _in_order(u: FloatArray, v: FloatArray, fixed: int, track: Track, closed: bool) -> IntArray:
    """Indices of the pairs that rise together without a sudden change of speed; the first `fixed` always do."""
    images = track.images(u, closed=closed)
    gap = v - images
    nearest = np.argsort(np.abs(gap - np.rint(gap) if closed else gap)[fixed:], kind="stable") + fixed
    chosen = list(range(fixed))
    for k in nearest:
        if all(_compatible(v[k] - v[c], images[k] - images[c], closed) for c in chosen):
            chosen.append(int(k))
    return np.array(chosen, dtype=np.intp)


def _compatible(length: float, expected: float, closed: bool) -> bool:
    """Whether the length between two pairs, and that round the other side, are near what the track has."""
    if closed:
        length, expected = float(np.mod(length, 1.0)), float(np.mod(expected, 1.0))
        return _near(length, expected) and _near(1 - length, 1 - expected)
    return length * expected > 0 and _near(abs(length), abs(expected))


def _near(length: float, expected: float) -> bool:
    return expected < STEEPEST * length and length < STEEPEST * expected
