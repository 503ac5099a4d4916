"""Where edges cross: closed outlines against themselves and each other, many frames in one sweep."""

from collections.abc import Iterator, Sequence

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray

ComplexArray = npt.NDArray[np.complex128]
IntArray = npt.NDArray[np.intp]

SKEW = complex(np.exp(0.7j))
"""Outlines are turned by this before the sweep, so that sides along an axis do not all lie over one place."""

PAIRS = 1 << 20
"""Pairs of edges looked at in one go: bounds the memory of a sweep."""


def crossing_edges(p: ComplexArray, loops: Sequence[slice]) -> IntArray:
    """Return the pairs of edges that cross properly, as (k, 2) edge numbers; edge i begins at vertex i.

    Parameters
    ----------
    p : (n,) complex array
        Vertices of all outlines, x + iy in any unit.
    loops : sequence of slice
        The closed outlines; together they are all of `p`.

    Notes
    -----
    Edges are sorted by their left ends and compared with those that begin before they end (sweep and prune);
    of the pairs whose boxes overlap, those cross whose ends lie strictly on different sides. Touching is no
    crossing, so doubled vertices and neighbours are never reported.
    """
    _, first, second = _crossings(p[None], loops)
    return np.stack([first, second], axis=1)


def crossing_counts(frames: ComplexArray, loops: Sequence[slice]) -> IntArray:
    """Return how many pairs of edges cross properly in each of the frames (T, n) -> (T,); see `crossing_edges`."""
    frame, _, _ = _crossings(frames, loops)
    return np.bincount(frame, minlength=len(frames))


def next_in_loops(loops: Sequence[slice]) -> IntArray:
    """Return the number of the vertex after each vertex, (n,)."""
    after = np.arange(1, sum(loop.stop - loop.start for loop in loops) + 1)
    for loop in loops:
        after[loop.stop - 1] = loop.start
    return after


def _crossings(frames: ComplexArray, loops: Sequence[slice]) -> tuple[IntArray, IntArray, IntArray]:
    """Frame, first and second edge of every crossing."""
    after = next_in_loops(loops)
    start = frames * SKEW
    start = start - start.mean(axis=1, keepdims=True)
    width = 4 * float(np.abs(start).max(initial=0.0)) or 1.0
    start = (start + width * np.arange(len(frames))[:, None]).ravel()  # frames side by side: one sweep for all
    n = frames.shape[1]
    end = start.reshape(frames.shape)[:, after].ravel()
    found = []
    for i, j in _overlapping(start, end):
        own, other = i % n, j % n
        apart = (after[own] != other) & (after[other] != own)
        i, j = i[apart], j[apart]
        cross = _cross(start[i], end[i], start[j], end[j])
        found.append((i[cross], j[cross]))
    i, j = (np.concatenate([pair[side] for pair in found]) for side in (0, 1))
    return i // n, i % n, j % n


def _overlapping(start: ComplexArray, end: ComplexArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Pairs of edges whose boxes overlap, some at a time."""
    left, right = np.minimum(start.real, end.real), np.maximum(start.real, end.real)
    low, high = np.minimum(start.imag, end.imag), np.maximum(start.imag, end.imag)
    order = np.argsort(left)
    last = np.searchsorted(left[order], right[order], side="right")
    reach = np.maximum(last - np.arange(len(order)) - 1, 0)
    done = np.concatenate([[0], np.cumsum(reach)])
    row = 0
    while True:
        stop = max(int(np.searchsorted(done, done[row] + PAIRS, side="right")) - 1, row + 1)
        stop = min(stop, len(order))
        first = np.repeat(np.arange(row, stop), reach[row:stop])
        second = first + 1 + np.arange(len(first)) - (done[first] - done[row])
        i, j = order[first], order[second]
        meet = (low[i] <= high[j]) & (low[j] <= high[i])
        yield i[meet], j[meet]
        row = stop
        if row >= len(order):
            return


def _cross(a: ComplexArray, b: ComplexArray, c: ComplexArray, d: ComplexArray) -> npt.NDArray[np.bool_]:
    """Whether the segments a b and c d have their ends strictly on different sides of each other."""
    sides = [_side(b - a, c - a), _side(b - a, d - a), _side(d - c, a - c), _side(d - c, b - c)]
    return np.asarray((sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0))


def _side(along: ComplexArray, to: ComplexArray) -> FloatArray:
    return np.sign(along.real * to.imag - along.imag * to.real)
