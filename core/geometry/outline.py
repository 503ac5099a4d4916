"""Measures of one outline: lengths, areas, places on it, vertices set evenly along it.

An outline is an (n, 2) float array of vertices in stage px, y down. A closed outline does not repeat its
first vertex. A *position* on an outline is one number: the index of an edge plus the fraction along it, so
that 3.0 is vertex 3 and 3.5 the middle of the edge from vertex 3 to vertex 4. On a closed outline positions
run from 0 up to n, on an open one from 0 up to n - 1, both ends included.
"""

from typing import Any

import numpy as np
import numpy.typing as npt

from core.errors import GeometryError

FloatArray = npt.NDArray[np.float64]

LARGEST_COORDINATE = 1e9
"""Beyond this, squares of lengths lose the digits that closing a polygon needs."""

SMALLEST_SIZE = 1e-12
"""Relative to the largest coordinate: below this all vertices are one point to double precision."""


def as_points(points: npt.ArrayLike, *, name: str = "outline", closed: bool = True) -> FloatArray:
    """Return `points` as a checked (n, 2) float array; the one door through which outside numbers enter.

    Parameters
    ----------
    points : array_like
        Vertices in stage px.
    name : str
        What to call them in a message ("before", "after").
    closed : bool
        A closed outline needs 3 vertices, an open one 2.

    Returns
    -------
    (n, 2) float array
        Finite; not all vertices equal. The very array when it is a float array already.

    Raises
    ------
    GeometryError
        Wrong shape, too few vertices, NaN or infinity (the vertex is named), absurdly far, all equal.
    """
    try:
        p = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError) as e:
        raise GeometryError(f"{name} is not a list of (x, y) points: {e}") from None
    if p.ndim != 2 or p.shape[1] != 2:
        raise GeometryError(f"{name} has the shape {p.shape}; expected (n, 2): a list of (x, y) points")
    least = 3 if closed else 2
    if len(p) < least:
        kind = "a closed outline" if closed else "an open outline"
        raise GeometryError(f"{name} has {len(p)} vertices; {kind} needs at least {least}")
    finite = np.isfinite(p).all(axis=1)
    if not finite.all():
        raise GeometryError(f"vertex {int(finite.argmin())} of {name} is not a finite number")
    largest = float(np.abs(p).max())
    if largest > LARGEST_COORDINATE:
        far = int(np.abs(p).max(axis=1).argmax())
        raise GeometryError(
            f"vertex {far} of {name} lies {largest:.3g} px away; the limit is {LARGEST_COORDINATE:.0e} px"
        )
    if float(np.ptp(p, axis=0).max()) <= SMALLEST_SIZE * largest:
        raise GeometryError(f"all {len(p)} vertices of {name} are the same point")
    return p


def edge_vectors(points: FloatArray, *, closed: bool = True) -> FloatArray:
    """Vectors from each vertex to the next: (..., n, 2) -> (..., n, 2), or (..., n - 1, 2) when open."""
    if closed:
        return np.concatenate([points[..., 1:, :], points[..., :1, :]], axis=-2) - points
    return points[..., 1:, :] - points[..., :-1, :]


def edge_lengths(points: FloatArray, *, closed: bool = True) -> FloatArray:
    """Lengths of the edges, in px: (..., n, 2) -> (..., n), or (..., n - 1) when open."""
    d = edge_vectors(points, closed=closed)
    return np.hypot(d[..., 0], d[..., 1])


def arc_lengths(points: FloatArray, *, closed: bool = True) -> FloatArray:
    """Length along the outline from vertex 0 to the start of every edge, and last the whole length, in px."""
    lengths = edge_lengths(points, closed=closed)
    return np.concatenate([[0.0], np.cumsum(lengths)])


def perimeter(points: FloatArray, *, closed: bool = True) -> float:
    """Whole length of the outline in px."""
    return float(edge_lengths(points, closed=closed).sum())


def size(points: FloatArray) -> float:
    """Longer side of the bounding box in px; the unit of every relative tolerance."""
    return float(np.ptp(points, axis=-2).max())


def signed_area(points: FloatArray) -> Any:
    """Area inside a closed outline in px^2, positive where x turns towards y; (..., n, 2) -> (...)."""
    p = points - points[..., :1, :]  # the shoelace sum cancels badly far from the origin
    q = np.concatenate([p[..., 1:, :], p[..., :1, :]], axis=-2)
    return 0.5 * (p[..., 0] * q[..., 1] - p[..., 1] * q[..., 0]).sum(axis=-1)


def points_at(points: FloatArray, positions: npt.ArrayLike, *, closed: bool = True) -> FloatArray:
    """Return the points of the outline at `positions` (k,) -> (k, 2); a whole position gives the exact vertex.

    Positions of a closed outline wrap round; those of an open one are clipped to its ends.
    """
    n = len(points)
    s = np.asarray(positions, dtype=np.float64)
    if s.size and not (s.min() >= 0 and s.max() < n):
        s = np.mod(s, n) if closed else np.clip(s, 0, n - 1)
    i = s.astype(np.intp)
    f = s - i
    if closed:
        i[i == n] = 0  # mod of a tiny negative number rounds up to n itself
    ahead = np.concatenate([points[1:], points[:1] if closed else points[-1:]])
    start, end = points.take(i, axis=0), ahead.take(i, axis=0)
    f = f[..., None]
    return start * (1 - f) + end * f


def positions_at_lengths(points: FloatArray, lengths: npt.ArrayLike, *, closed: bool = True) -> FloatArray:
    """Return the positions that lie the given lengths (px from vertex 0) along the outline; (k,) -> (k,)."""
    s = arc_lengths(points, closed=closed)
    at = np.asarray(lengths, dtype=np.float64)
    at = np.mod(at, s[-1]) if closed else np.clip(at, 0, s[-1])
    i = np.clip(np.searchsorted(s, at, side="right") - 1, 0, len(s) - 2)
    step = s[i + 1] - s[i]
    part: FloatArray = np.divide(at - s[i], step, out=np.zeros_like(at), where=step > 0)
    return i + part


def lengths_at(points: FloatArray, positions: npt.ArrayLike, *, closed: bool = True) -> FloatArray:
    """Length along the outline from vertex 0 to each position, in px; inverse of `positions_at_lengths`."""
    s = arc_lengths(points, closed=closed)
    return np.asarray(np.interp(np.asarray(positions, dtype=np.float64), np.arange(len(s)), s), np.float64)


def resample(points: FloatArray, count: int, *, closed: bool = True, start: float = 0.0) -> FloatArray:
    """Return `count` points evenly spaced along the outline, the first at the share `start` of its length."""
    whole = perimeter(points, closed=closed)
    steps = np.arange(count) / (count if closed else count - 1)
    return points_at(points, positions_at_lengths(points, (start + steps) * whole, closed=closed), closed=closed)


def locate(points: FloatArray, targets: npt.ArrayLike, *, closed: bool = True) -> tuple[FloatArray, FloatArray]:
    """Return the positions on the outline nearest to `targets` (k, 2), and their distances in px."""
    q = np.atleast_2d(np.asarray(targets, dtype=np.float64))
    d = edge_vectors(points, closed=closed)
    start = points if closed else points[:-1]
    squared = np.maximum((d * d).sum(axis=1), np.finfo(np.float64).tiny)
    offset = q[:, None, :] - start
    f = np.clip((offset * d).sum(axis=2) / squared, 0.0, 1.0)
    gap = np.hypot(*np.moveaxis(offset - f[..., None] * d, 2, 0))
    i = gap.argmin(axis=1)
    rows = np.arange(len(q))
    position = i + f[rows, i]
    return (np.mod(position, len(points)) if closed else position), gap[rows, i]


def contains(points: FloatArray, targets: npt.ArrayLike) -> npt.NDArray[np.bool_]:
    """Return whether a closed outline has `targets` (k, 2) inside, by the even-odd rule; (k,)."""
    x, y = np.atleast_2d(np.asarray(targets, dtype=np.float64)).T[..., None]
    x0, y0 = points.T
    x1, y1 = np.roll(points, -1, axis=0).T
    spans = (y0 > y) != (y1 > y)
    rise = np.where(y1 == y0, 1.0, y1 - y0)
    left_of = x < x0 + (y - y0) * (x1 - x0) / rise
    return np.asarray(np.count_nonzero(spans & left_of, axis=1) % 2 == 1)
