"""Fine detail of outlines, riding on the cage that carries the interior."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from core.geometry.crossings import ComplexArray, IntArray, next_in_loops
from core.geometry.outline import FloatArray
from core.methods.headings import TURN, Headings, joined

SHORTEST = 1e-3
"""Length of edge, over the mean one, below which an edge counts as so long."""


@dataclass(frozen=True, eq=False)
class Detail:
    """All vertices from those of the cage; made by `attach`.

    Attributes
    ----------
    start, turn : (n,) float array
        Heading of every edge before, and its turn, radians.
    lengths : (2, n) float array
        Of every edge before and after.
    stiff : (n,) float array
        Weight of every edge.
    held : (k,) int array
        The vertices of the cage.
    hold : (k,) float array
        Weight with which they are held.
    rings : tuple of _Ring
    """

    start: FloatArray
    turn: FloatArray
    lengths: FloatArray
    stiff: FloatArray
    held: IntArray
    hold: FloatArray
    rings: "tuple[_Ring, ...]"

    def vertices(self, u: FloatArray, cage: ComplexArray) -> ComplexArray:
        """Vertices (n, T) at the times `u` (T,), whose cage is at `cage` (k, T)."""
        edges = np.exp(1j * (self.start[:, None] + self.turn[:, None] * u))
        edges *= self.lengths[0][:, None] * (1 - u) + self.lengths[1][:, None] * u
        edges *= self.stiff[:, None]
        right: ComplexArray = -edges
        for ring in self.rings:
            right[ring.rows.start + 1 : ring.rows.stop] += edges[ring.rows.start : ring.rows.stop - 1]
            right[ring.rows.start] += edges[ring.rows.stop - 1]
        right[self.held] += self.hold[:, None] * cage
        for ring in self.rings:
            right[ring.rows] = ring.solve(right[ring.rows])
        return right


def attach(
    outlines: Sequence[Headings], rows: Sequence[slice], held: IntArray, turns: FloatArray, loose: float
) -> Detail:
    """Plan the detail of closed outlines.

    Parameters
    ----------
    outlines, rows : sequences of Headings and slice
        The outlines and where their vertices are.
    held : (k,) int array
        The vertices of the cage, in the order of each outline.
    turns : (k,) float array
        Turn of the cage's edge from each of them to the next, radians, whole turns told apart.
    loose : float
        Distance along the outline within which it may leave the cage: 0 follows the cage, large ones the
        headings alone (then the paths are intrinsic).

    Notes
    -----
    Least squares over all vertices x: sum over edges |step of x - edge wanted|^2 / length, and over the vertices
    of the cage share of the outline |x - where the cage has it|^2 / loose^2; edges wanted are those of the
    intrinsic method.
    The matrix of each outline is tridiagonal up to its corners, and the same at all times.
    """
    edges = joined(outlines)
    turn = _nearest_turns(edges.turn, edges.before + edges.after, rows, held, turns)
    mean = (edges.before + edges.after) / 2
    length = np.maximum(mean, SHORTEST * float(mean.mean()))
    hold = _shares(mean, rows, held) / loose**2
    diagonal = np.zeros(len(mean))
    diagonal[held] = hold
    rings = tuple(_Ring.of(r, 1 / length[r], diagonal[r]) for r in rows)
    lengths = np.stack([edges.before, edges.after])
    return Detail(edges.start, turn, lengths, 1 / length, held, hold, rings)


@dataclass(frozen=True, eq=False)
class _Ring:
    """Factor of the matrix of one outline, folded in half so that neighbours are at most two rows apart.

    Attributes
    ----------
    rows : slice
    fold : (n,) int array
        0, n - 1, 1, n - 2 and so on.
    band : (3, n) float array
        Cholesky factor.
    """

    rows: slice
    fold: IntArray
    band: FloatArray

    @classmethod
    def of(cls, rows: slice, stiff: FloatArray, hold: FloatArray) -> "_Ring":
        n = len(stiff)
        fold = np.zeros(n, np.intp)
        fold[0::2] = np.arange((n + 1) // 2)
        fold[1::2] = n - 1 - np.arange(n // 2)
        at = np.zeros(n, np.intp)
        at[fold] = np.arange(n)
        band = np.zeros((3, n))
        band[0] = (hold + stiff + np.roll(stiff, 1))[fold]
        first, second = at, np.roll(at, -1)
        low, apart = np.minimum(first, second), np.abs(first - second)
        np.add.at(band, (apart, low), -stiff)
        factor, info = lapack.dpbtrf(band, lower=1)
        if info:
            raise ArithmeticError("the detail of an outline is not held by its cage")
        return cls(rows, fold, factor)

    def solve(self, right: ComplexArray) -> ComplexArray:
        """Solve for the columns (n, T)."""
        flat = np.asfortranarray(right[self.fold].view(np.float64))
        found, _ = lapack.dpbtrs(self.band, flat, lower=1, overwrite_b=1)
        out = np.zeros_like(right)
        out[self.fold] = np.ascontiguousarray(found).view(np.complex128)
        return out


def _shares(mean: FloatArray, rows: Sequence[slice], held: IntArray) -> FloatArray:
    """How much of its outline each held vertex stands for: half of it on both sides up to the next ones."""
    segment = _segments(len(mean), rows, held)
    whole = np.bincount(segment, mean, len(held))
    after = _next_held(rows, held)
    behind = np.zeros_like(after)
    behind[after] = np.arange(len(after))
    return np.asarray((whole + whole[behind]) / 2)


def _nearest_turns(
    turn: FloatArray, weight: FloatArray, rows: Sequence[slice], held: IntArray, turns: FloatArray
) -> FloatArray:
    """Add the whole turns to every stretch of outline that bring its mean turn nearest to that of the cage."""
    segment = _segments(len(turn), rows, held)
    total = np.maximum(np.bincount(segment, weight, len(held)), 1e-300)
    mean = np.bincount(segment, weight * turn, len(held)) / total
    return np.asarray(turn + (TURN * np.rint((turns - mean) / TURN))[segment])


def _segments(n: int, rows: Sequence[slice], held: IntArray) -> IntArray:
    """Number in `held` of the last held vertex at or before each vertex of its outline, (n,)."""
    number = np.full(n, -1)
    number[held] = np.arange(len(held))
    for row in rows:
        own = number[row]
        last = np.maximum.accumulate(np.where(own >= 0, np.arange(len(own)), -1))
        wrap = int(np.flatnonzero(own >= 0)[-1])
        number[row] = own[np.where(last >= 0, last, wrap)]
    return number


def _next_held(rows: Sequence[slice], held: IntArray) -> IntArray:
    """Number of the next held vertex of the same outline, (k,)."""
    outline = np.searchsorted([r.stop for r in rows], held, side="right")
    counts = np.bincount(outline, minlength=len(rows))
    stops = np.cumsum(counts).tolist()
    return next_in_loops([slice(s - c, s) for s, c in zip(stops, counts.tolist(), strict=True)])
