"""A correspondence as it is solved: shares of two rings that rise together, and nodes spread along it."""

from dataclasses import dataclass

import numpy as np

from core.correspondence.cost import NO_KNOTS, Grid, grid
from core.correspondence.cyclic import IntArray
from core.correspondence.ring import Ring
from core.geometry.outline import FloatArray


@dataclass(frozen=True, eq=False)
class Track:
    """Paired shares `u`, `v` (k,) of two rings, both rising; closed ones end one round after they began."""

    u: FloatArray
    v: FloatArray

    def images(self, shares: FloatArray, *, closed: bool) -> FloatArray:
        """Shares on the other ring, unrolled: they rise with `shares`."""
        if not closed:
            return np.asarray(np.interp(shares, self.u, self.v))
        rounds = np.floor(shares - self.u[0])
        return np.asarray(np.interp(shares - rounds, self.u, self.v) + rounds)

    @property
    def inverse(self) -> "Track":
        """The same pairs the other way round."""
        return Track(self.v, self.u)


@dataclass(frozen=True, eq=False)
class Knots:
    """Pairs of shares that every track must keep, unrolled from the first to (closed) the first again.

    Attributes
    ----------
    u, v : (k,) float array
        Empty where nothing is fixed: a closed outline without anchors.
    """

    u: FloatArray
    v: FloatArray

    def __bool__(self) -> bool:
        return len(self.u) > 0

    def straight(self) -> Track:
        """Even lengths from knot to knot."""
        return Track(self.u, self.v)


FREE = Knots(np.zeros(0), np.zeros(0))


def knots_of(u: FloatArray, v: FloatArray, *, closed: bool) -> Knots:
    """Return the knots at paired shares, given in any order of `u`."""
    if not closed:
        order = np.argsort(u)
        return Knots(u[order], v[order])
    if not len(u):
        return FREE
    order = np.argsort(u)
    u, v = u[order], v[order]
    v = v[0] + np.mod(v - v[0], 1.0)
    return Knots(np.append(u, u[0] + 1), np.append(v, v[0] + 1))


def spread(before: Ring, after: Ring, tracks: list[Track], knots: Knots, rows: int) -> Grid:
    """Return a grid of about `rows` nodes along each track, even in the mean of both shares; knots are nodes."""
    if not knots:
        share = np.arange(rows + 1) / rows
        at = np.array([(t.u[0] + t.v[0]) / 2 + share for t in tracks])
        fixed = NO_KNOTS
    else:
        one, fixed = _between_knots((knots.u + knots.v) / 2, rows)
        at = np.tile(one, (len(tracks), 1))
    u = np.array([np.interp(m, (t.u + t.v) / 2, t.u) for m, t in zip(at, tracks, strict=True)])
    v = np.array([np.interp(m, (t.u + t.v) / 2, t.v) for m, t in zip(at, tracks, strict=True)])
    if knots:
        u[:, fixed], v[:, fixed] = knots.u, knots.v
    return grid(before, after, u, v, fixed)


def _between_knots(means: FloatArray, rows: int) -> tuple[FloatArray, IntArray]:
    """Places of the nodes along the track, and which of them are the knots."""
    counts = np.maximum(1, np.rint(rows * np.diff(means))).astype(np.intp)
    fixed = np.append(0, np.cumsum(counts))
    return np.interp(np.arange(fixed[-1] + 1), fixed, means), fixed


def track_through(g: Grid, candidate: int, rows: IntArray, offsets: IntArray) -> Track:
    """Return the track through the cells (row, row + offset) of a grid."""
    u, v = g.u[candidate], g.v[candidate]
    j = rows + offsets
    if not g.closed:
        return Track(u[rows], v[j])
    rounds, j = np.divmod(j, len(v) - 1)
    return Track(u[rows], v[j] + rounds)


def apart(one: Track, other: Track, *, closed: bool) -> float:
    """Mean distance of two tracks, in shares of the perimeter."""
    at = np.arange(64) / 64
    d = one.images(at, closed=closed) - other.images(at, closed=closed)
    return float(np.abs(d - np.rint(d) if closed else d).mean())
