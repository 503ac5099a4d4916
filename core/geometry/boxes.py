"""Pairs of boxes that overlap, for many frames at once: what comes before every exact test of near things.

Sort and sweep along the axis that leaves fewer candidates (Cohen, Lin, Manocha and Ponamgi, "I-COLLIDE", 1995),
but with searches and repetition in place of a moving list. Boxes are closed: touching ones overlap.
"""

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray

IndexArray = npt.NDArray[np.intp]

SLACK = 1e-9
"""Rounding of keys that hold frame and coordinate in one number, relative to the size of a frame."""


def box_pairs(low: FloatArray, high: FloatArray) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Return all pairs i < j of boxes of the same frame that overlap, as (frame, i, j), each (k,).

    Parameters
    ----------
    low, high : (T, m, 2) float array
        Corners of m boxes in every one of T frames. A box with NaN overlaps nothing.
    """
    count = low.shape[1]
    lows, highs = _keys(low, high)
    plans = []
    for axis in (0, 1):
        order = np.argsort(lows[axis], kind="stable")
        last = np.searchsorted(lows[axis][order], highs[axis][order], side="right")
        plans.append((order, np.maximum(last - np.arange(1, len(order) + 1), 0)))
    order, after = min(plans, key=lambda plan: int(plan[1].sum()))
    first, second = _runs(np.arange(1, len(order) + 1), after)
    i, j = order[first], order[second]
    met = _meet(low, high, i, low, high, j)
    i, j = i[met], j[met]
    i, j = np.minimum(i, j), np.maximum(i, j)
    return i // count, i % count, j % count


def box_pairs_between(
    low: FloatArray, high: FloatArray, other_low: FloatArray, other_high: FloatArray
) -> tuple[IndexArray, IndexArray, IndexArray]:
    """Return all pairs of a box i and another box j of the same frame that overlap, as (frame, i, j).

    Parameters
    ----------
    low, high : (T, m, 2) float array
    other_low, other_high : (T, k, 2) float array
    """
    count, others = low.shape[1], other_low.shape[1]
    both_low, both_high = np.concatenate([low, other_low], axis=1), np.concatenate([high, other_high], axis=1)
    lows, highs = _keys(both_low, both_high)
    mine = (np.arange(lows.shape[1]) % (count + others)) < count
    best: list[tuple[IndexArray, IndexArray, IndexArray]] = []
    least = -1
    for axis in (0, 1):
        a, b = (np.flatnonzero(mine), np.flatnonzero(~mine))
        tried = [_starting_inside(lows[axis], highs[axis], *pair) for pair in ((a, b, "left"), (b, a, "right"))]
        total = sum(int(counts.sum()) for _, _, counts in tried)
        if least < 0 or total < least:
            best, least = tried, total
    (order_b, first_b, count_b), (order_a, first_a, count_a) = best
    own, inside_b = _runs(first_b, count_b)
    other, inside_a = _runs(first_a, count_a)
    i = np.concatenate([np.flatnonzero(mine)[own], order_a[inside_a]])
    j = np.concatenate([order_b[inside_b], np.flatnonzero(~mine)[other]])
    met = _meet(both_low, both_high, i, both_low, both_high, j)
    i, j = i[met], j[met]
    return i // (count + others), i % (count + others), j % (count + others) - count


def _keys(low: FloatArray, high: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Corners as (2, T m) numbers that grow with the frame too, so that one sort serves all frames."""
    origin = np.nanmin(low, axis=1, keepdims=True, initial=np.inf)
    whole = np.nanmax(high, axis=1, keepdims=True, initial=-np.inf) - origin
    whole = np.where(whole > 0, whole, 1.0)
    frame = 2.0 * np.arange(len(low))[:, None, None]
    lows, highs = (low - origin) / whole + frame, (high - origin) / whole + frame + SLACK
    # every NaN is put where nothing is, so that it cannot upset the order
    lows, highs = np.where(np.isnan(lows), np.inf, lows), np.where(np.isnan(highs), -np.inf, highs)
    return lows.reshape(-1, 2).T, highs.reshape(-1, 2).T


def _starting_inside(
    low: FloatArray, high: FloatArray, rows: IndexArray, others: IndexArray, side: str
) -> tuple[IndexArray, IndexArray, IndexArray]:
    """For every row, the others whose low end lies within it: (order of others, first place in it, how many)."""
    order = others[np.argsort(low[others], kind="stable")]
    at = low[order]
    first = np.searchsorted(at, low[rows], side="left" if side == "left" else "right")
    last = np.searchsorted(at, high[rows], side="right")
    return order, first, np.maximum(last - first, 0)


def _runs(first: IndexArray, count: IndexArray) -> tuple[IndexArray, IndexArray]:
    """Row k repeated count[k] times, and beside it first[k], first[k] + 1, ..."""
    row = np.repeat(np.arange(len(count)), count)
    start = first - (np.cumsum(count) - count)
    return row, np.arange(len(row)) + start[row]


def _meet(
    low: FloatArray, high: FloatArray, i: IndexArray, other_low: FloatArray, other_high: FloatArray, j: IndexArray
) -> npt.NDArray[np.bool_]:
    low, high = low.reshape(-1, 2), high.reshape(-1, 2)
    other_low, other_high = other_low.reshape(-1, 2), other_high.reshape(-1, 2)
    met = np.ones(len(i), np.bool_)
    for axis in (0, 1):
        met &= low[:, axis][i] <= other_high[:, axis][j]
        met &= other_low[:, axis][j] <= high[:, axis][i]
    return met
