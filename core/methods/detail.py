"""Fine detail of outlines, riding on the cage that carries the interior."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.methods.headings import TURN, ComplexArray, Headings, joined
from core.methods.loops import previous_in_loops

SHORTEST = 1e-3
"""Length of edge, over the mean one, below which an edge counts as so long."""


@dataclass(frozen=True, eq=False)
class Detail:
    """All vertices from those of the cage; made by `attach`.

    The edges are kept in the order `fold`, in which the matrix of every outline is a narrow band.

    Attributes
    ----------
    half_headings : (2, n) float array
        Half the heading of every edge at its vertex before and after, radians.
    lengths : (2, n) float array
        Length of every edge before and after, times its weight.
    behind : (n,) int array
        Place of the edge before each edge.
    held : (k,) int array
        Places of the vertices of the cage.
    hold : (k,) float array
        Weight with which they are held.
    fold : (n,) int array
        The vertex at each place.
    bands : tuple of (slice, (3, m) float array)
        Places of every outline and the Cholesky factor of its matrix.
    along : (n,) float array
        Where the middle of every edge is along the cage: number of the cage's edge plus share of its length.
    """

    half_headings: FloatArray
    lengths: FloatArray
    behind: IndexArray
    held: IndexArray
    hold: FloatArray
    fold: IndexArray
    bands: tuple[tuple[slice, FloatArray], ...]
    along: FloatArray

    def vertices(self, u: FloatArray, cage: ComplexArray, turned: FloatArray | None = None) -> ComplexArray:
        """Vertices (T, n) at the times `u` (T,), whose cage is at `cage` (k, T).

        The edges are turned by `turned` (n, T) radians besides.
        """
        shares = np.stack([1 - u, u], axis=1)
        half = shares @ self.half_headings
        if turned is not None:
            half += turned[self.fold].T / 2
        tangent = np.tan(half)  # of the half: cheaper than a sine and a cosine
        lengths = shares @ self.lengths
        part = 2 * lengths / (1 + tangent * tangent)
        edges = np.stack([part - lengths, part * tangent])
        right = edges[..., self.behind] - edges
        held = self.hold * cage.T
        right[0][:, self.held] += held.real
        right[1][:, self.held] += held.imag
        rows = right.reshape(2 * len(u), -1)
        for places, band in self.bands:
            # rows of outlines are columns to the library, which asks for them one after the other
            found, _ = lapack.dpbtrs(band, rows[:, places].T, lower=1)
            rows[:, places] = found.T
        out = np.zeros(right.shape[1:], np.complex128)
        out.real[:, self.fold], out.imag[:, self.fold] = right
        return out

    def pull_of(self, weights: FloatArray) -> FloatArray:
        """How much each vertex of the cage moves the means with `weights` (k, n) of the vertices, (k, c)."""
        rows = weights[:, self.fold]
        for places, band in self.bands:
            found, _ = lapack.dpbtrs(band, rows[:, places].T, lower=1)
            rows[:, places] = found.T
        return np.asarray(rows[:, self.held] * self.hold, np.float64)


def attach(
    outlines: Sequence[Headings], rows: Sequence[slice], held: IndexArray, turns: FloatArray, loose: float
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
    intrinsic method. The matrix of each outline is tridiagonal up to its corners, and the same at all times;
    folded in half, first vertex, last, second, last but one, neighbours are at most two places apart.
    """
    edges = joined(outlines)
    turn = _nearest_turns(edges.turn, edges.before + edges.after, rows, held, turns)
    mean = (edges.before + edges.after) / 2
    stiff = 1 / np.maximum(mean, SHORTEST * float(mean.mean()))
    hold = _shares(mean, rows, held) / loose**2
    diagonal = np.zeros(len(mean))
    diagonal[held] = hold
    fold = np.concatenate([r.start + _folded(r.stop - r.start) for r in rows])
    place = np.zeros_like(fold)
    place[fold] = np.arange(len(fold))
    behind = previous_in_loops(rows)
    return Detail(
        np.stack([edges.start, edges.start + turn])[:, fold] / 2,
        (stiff * np.stack([edges.before, edges.after]))[:, fold],
        place[behind[fold]],
        place[held],
        hold,
        fold,
        tuple((r, _band(stiff[r], diagonal[r])) for r in rows),
        _along(mean, rows, held),
    )


def _folded(n: int) -> IndexArray:
    """0, n - 1, 1, n - 2 and so on."""
    fold = np.zeros(n, np.intp)
    fold[0::2] = np.arange((n + 1) // 2)
    fold[1::2] = n - 1 - np.arange(n // 2)
    return fold


def _band(stiff: FloatArray, hold: FloatArray) -> FloatArray:
    """Cholesky factor (3, n) of the folded matrix of an outline."""
    n = len(stiff)
    fold = _folded(n)
    place = np.zeros(n, np.intp)
    place[fold] = np.arange(n)
    other = np.roll(place, -1)
    band = np.zeros((3, n))
    band[0] = (hold + stiff + np.roll(stiff, 1))[fold]
    np.add.at(band, (np.abs(place - other), np.minimum(place, other)), -stiff)
    factor, info = lapack.dpbtrf(band, lower=1)
    if info:
        raise ArithmeticError("the detail of an outline is not held by its cage")
    return np.asarray(factor, np.float64)


def _shares(mean: FloatArray, rows: Sequence[slice], held: IndexArray) -> FloatArray:
    """How much of its outline each held vertex stands for: half of it on both sides up to the next ones."""
    segment = _segments(len(mean), rows, held)
    whole = np.bincount(segment, mean, len(held))
    return np.asarray((whole + whole[_held_before(rows, held)]) / 2)


def _along(mean: FloatArray, rows: Sequence[slice], held: IndexArray) -> FloatArray:
    """Middle of each edge along the cage: number of the cage's edge plus share of its length, (n,)."""
    segment = _segments(len(mean), rows, held)
    whole = np.maximum(np.bincount(segment, mean, len(held)), np.finfo(np.float64).tiny)
    total = np.zeros(len(mean))
    for row in rows:
        total[row] = np.cumsum(mean[row]) - mean[row] / 2
    start = total[held] - mean[held] / 2
    around = np.zeros(len(mean))
    for row in rows:
        around[row] = mean[row].sum()
    share = np.mod(total - start[segment], np.maximum(around, np.finfo(np.float64).tiny)) / whole[segment]
    return np.asarray(segment + np.clip(share, 0.0, 1 - 1e-9), np.float64)


def _nearest_turns(
    turn: FloatArray, weight: FloatArray, rows: Sequence[slice], held: IndexArray, turns: FloatArray
) -> FloatArray:
    """Add the whole turns to every stretch of outline that bring its mean turn nearest to that of the cage."""
    segment = _segments(len(turn), rows, held)
    total = np.maximum(np.bincount(segment, weight, len(held)), 1e-300)
    mean = np.bincount(segment, weight * turn, len(held)) / total
    return np.asarray(turn + (TURN * np.rint((turns - mean) / TURN))[segment])


def _segments(n: int, rows: Sequence[slice], held: IndexArray) -> IndexArray:
    """Number in `held` of the last held vertex at or before each vertex of its outline, (n,)."""
    number = np.full(n, -1)
    number[held] = np.arange(len(held))
    for row in rows:
        own = number[row]
        last = np.maximum.accumulate(np.where(own >= 0, np.arange(len(own)), -1))
        wrap = int(np.flatnonzero(own >= 0)[-1])
        number[row] = own[np.where(last >= 0, last, wrap)]
    return number


def _held_before(rows: Sequence[slice], held: IndexArray) -> IndexArray:
    """Number of the held vertex before each one of the same outline, (k,)."""
    outline = np.searchsorted([r.stop for r in rows], held, side="right")
    counts = np.bincount(outline, minlength=len(rows))
    stops = np.cumsum(counts).tolist()
    return previous_in_loops([slice(s - c, s) for s, c in zip(stops, counts.tolist(), strict=True)])
