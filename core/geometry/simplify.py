"""Fewer vertices for a line drawn by hand."""

import numpy as np

from core.geometry.outline import FloatArray, edge_lengths, perimeter, points_at, positions_at_lengths


def simplify(points: FloatArray, tolerance: float) -> FloatArray:
    """Return a subset of an open line's points that stays within `tolerance` px of all the others.

    Parameters
    ----------
    points : (n, 2) float array
    tolerance : float
        In px; 0 keeps everything that is not exactly straight.

    Returns
    -------
    (k, 2) float array
        First and last point included.

    Notes
    -----
    Douglas and Peucker 1973, with a stack instead of recursion.
    """
    keep = np.zeros(len(points), dtype=bool)
    keep[[0, -1]] = True
    stack = [(0, len(points) - 1)]
    while stack:
        first, last = stack.pop()
        if last - first < 2:
            continue
        gaps = _distances(points[first + 1 : last], points[first], points[last])
        farthest = int(gaps.argmax())
        if gaps[farthest] > tolerance:
            middle = first + 1 + farthest
            keep[middle] = True
            stack += [(first, middle), (middle, last)]
    return points[keep]


def simplify_closed(points: FloatArray, tolerance: float) -> FloatArray:
    """Return a subset of a closed outline's points, as `simplify` does; begins with the first point."""
    opposite = int(np.hypot(*(points - points[0]).T).argmax())
    there = simplify(points[: opposite + 1], tolerance)
    back = simplify(np.concatenate([points[opposite:], points[:1]]), tolerance)
    return np.concatenate([there[:-1], back[:-1]])


def smooth(points: FloatArray, *, step: float, radius: int = 2) -> FloatArray:
    """Even out the trembling of a hand-drawn open line.

    Points are set evenly, about `step` px apart, and each becomes the binomially weighted mean of its
    neighbours; near the ends the mean narrows, so that the ends stay.
    """
    whole = perimeter(points, closed=False)
    count = max(int(whole / step) + 1, 2)
    lengths = np.linspace(0, whole, count)
    even = points_at(points, positions_at_lengths(points, lengths, closed=False), closed=False)
    for _ in range(radius):
        if count > 2:
            even[1:-1] = (even[:-2] + 2 * even[1:-1] + even[2:]) / 4
    return even


def without_repeats(points: FloatArray) -> FloatArray:
    """Drop points that equal the one before them."""
    kept: FloatArray = points[np.concatenate([[True], edge_lengths(points, closed=False) > 0])]
    return kept


def _distances(points: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Distances from the segment between two points."""
    d = end - start
    squared = float(d @ d)
    offset = points - start
    if squared == 0:
        return np.hypot(offset[:, 0], offset[:, 1])
    f = np.clip(offset @ d / squared, 0, 1)[:, None]
    gap = offset - f * d
    return np.hypot(gap[:, 0], gap[:, 1])
