"""Correspondences that the artist turns round, shifts or compares."""

import numpy as np

from core.correspondence.pairing import Correspondence
from core.errors import CorrespondenceError
from core.geometry.outline import FloatArray, lengths_at, perimeter, points_at, positions_at_lengths

SAMPLES = 128


def reversed_direction(c: Correspondence) -> Correspondence:
    """Return the correspondence that runs the other way round from the same start, with even arc length.

    Of open outlines the ends are exchanged.
    """
    n, m = c.counts
    if not c.closed:
        ends = (0.0, m - 1.0) if c.flipped else (m - 1.0, 0.0)
        return Correspondence(np.array([0.0, n - 1.0]), np.array(ends), c.counts, False, not c.flipped)
    return Correspondence(c.before[:1], c.after[:1], c.counts, flipped=not c.flipped)


def shifted_start(c: Correspondence, a: FloatArray, b: FloatArray, steps: int) -> Correspondence:
    """Return the correspondence slid along the outline after, so that the start goes to its next vertex.

    Parameters
    ----------
    c : Correspondence
        Of closed outlines.
    a, b : (n, 2), (m, 2) float array
        The outlines, in px.
    steps : int
        Number of vertices, against the direction of drawing when negative.

    Raises
    ------
    CorrespondenceError
        If the outlines are open: their ends stay together.
    """
    if not c.closed:
        raise CorrespondenceError("open outlines begin at their ends; only closed ones have a start to shift")
    start = float(c.images(a, b, np.zeros(1))[0])
    forward = steps if not c.flipped else -steps
    whole = perimeter(b)
    goal = (np.floor(start) if forward > 0 else np.ceil(start)) + forward
    by = _length(b, goal) - _length(b, start)
    after = positions_at_lengths(b, lengths_at(b, c.after) + np.mod(by, whole))
    return Correspondence(c.before, after, c.counts, flipped=c.flipped)


def mean_shift(c: Correspondence, other: Correspondence, a: FloatArray, b: FloatArray) -> float:
    """Return how far two correspondences of the same outlines lie apart on `b`, as a mean share of its length."""
    if c.flipped != other.flipped:
        return 0.5
    whole = perimeter(a, closed=c.closed)
    at = positions_at_lengths(a, np.linspace(0, whole, SAMPLES, endpoint=not c.closed), closed=c.closed)
    one, two = (lengths_at(b, x.images(a, b, at), closed=c.closed) for x in (c, other))
    length = perimeter(b, closed=c.closed)
    gap = np.abs(one - two) / length
    return float((np.minimum(gap, 1 - gap) if c.closed else gap).mean())


def directions(points: FloatArray, positions: FloatArray, *, closed: bool) -> FloatArray:
    """Return the unit vectors (k, 2) in which the outline runs on at positions (k,)."""
    n = len(points)
    edge = np.floor(positions).astype(np.intp)
    edge = edge % n if closed else np.minimum(edge, n - 2)
    ends = edge.astype(np.float64)
    d = points_at(points, ends + 1, closed=closed) - points_at(points, ends, closed=closed)
    length = np.hypot(d[:, 0], d[:, 1])[:, None]
    return np.divide(d, length, out=np.zeros_like(d), where=length > 0)


def _length(b: FloatArray, position: float) -> float:
    """Length along a closed outline at a position that may lie rounds away."""
    rounds = np.floor(position / len(b))
    return float(lengths_at(b, np.array([position - rounds * len(b)]))[0] + rounds * perimeter(b))
