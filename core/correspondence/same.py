"""One shape drawn twice: every vertex is put exactly where it lies on the other drawing."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.correspondence.ring import ComplexArray, Ring
from core.correspondence.track import Knots, Track
from core.geometry.outline import FloatArray

PERHAPS = 0.02
"""Root mean square of what the similarity may leave (in radii) for the test to be worth making."""

SAME = 0.002
"""What may be left of it in the end: drawings that share a shape, not all their vertices."""

ROUNDS = 3

MOST_PAIRS = 1_000_000
"""Pairs of point and edge that are measured; the windows round the points shrink to it."""

SAME_VERTEX = 1e-7
"""Distance (in radii) of two vertices that are one."""

ON_LINE = 1e-8
"""Distance (in radii) from the line between its neighbours at which a vertex is none."""

ONE_POINT = 1e-10
"""Pairs nearer than this (shares) are a vertex and the vertex right on it."""


@dataclass(frozen=True)
class Similarity:
    """The map z -> factor z + shift of the complex plane: rotation, scale and shift."""

    factor: complex
    shift: complex

    def __call__(self, z: ComplexArray) -> ComplexArray:
        """Return the images of points."""
        return self.factor * z + self.shift

    @property
    def inverse(self) -> "Similarity":
        """The map back."""
        return Similarity(1 / self.factor, -self.shift / self.factor)


def same_shape(before: Ring, after: Ring, track: Track, knots: Knots) -> Track | None:
    """Return the track that leaves a shape unmoved that was drawn twice, or None if these are two shapes."""
    exact = _vertex_by_vertex(before, after, track, knots)
    if exact is not None:
        return exact
    at = np.linspace(track.u[0], track.u[0] + 1, 128, endpoint=False) if before.closed else np.linspace(0, 1, 128)
    p, q = before.at(at), after.at(track.images(at, closed=before.closed))
    fit = _fitted(p, q)
    if fit is None or _root_mean_square(fit(p) - q) > PERHAPS:
        return None
    for _ in range(ROUNDS):
        projected = _projected(before, after, track, fit, knots)
        if projected is None:
            return None
        track = projected
        p, q = before.at(track.u), after.at(track.v)
        if (fit := _fitted(p, q)) is None:
            return None
    return track if _root_mean_square(fit(p) - q) <= SAME else None


def _vertex_by_vertex(before: Ring, after: Ring, track: Track, knots: Knots) -> Track | None:
    """The track through the vertices of one polygon drawn twice, whatever lies between them on straight edges.

    Sliding to the nearest points takes for ever on what is nearly a circle; this does not slide.
    """
    u, v = _bent_vertices(before), _bent_vertices(after)
    if len(u) != len(v) or len(u) < 2:
        return None
    p, q = before.at(u), after.at(v)
    for shift in _shifts(u, v, track) if before.closed else (0,):
        fit = _fitted(p, np.roll(q, -shift))
        if fit is not None and np.abs(fit(p) - np.roll(q, -shift)).max() <= SAME_VERTEX:
            return _closed_up(*_unrolled(u, np.roll(v, -shift), track, before.closed), knots)
    return None


def _bent_vertices(r: Ring) -> FloatArray:
    """Shares of the vertices at which the outline turns, and of the ends of an open one."""
    d = np.diff(r.z)
    keep = np.abs(d) > ON_LINE
    at, d = r.shares[:-1][keep], d[keep]
    before = np.roll(d, 1)
    product = d * np.conj(before)
    # distance of the vertex from the line between its neighbours: short edges have no direction to speak of
    off = np.abs(product.imag) > ON_LINE * np.abs(d + before)
    turned = off | (product.real < 0)
    return at[turned] if r.closed else np.append(at[turned | (at == 0)], 1.0)


def _shifts(u: FloatArray, v: FloatArray, track: Track) -> tuple[int, ...]:
    """The vertex after that lies nearest to the image of the first one before, and those beside it."""
    gap = v - track.images(u[:1], closed=True)
    nearest = int(np.abs(gap - np.rint(gap)).argmin())
    return nearest, nearest - 1, nearest + 1


def _unrolled(u: FloatArray, v: FloatArray, track: Track, closed: bool) -> tuple[FloatArray, FloatArray]:
    if not closed:
        return u, v
    v = v[0] + np.mod(v - v[0], 1.0)
    v = v + np.rint(track.images(u[:1], closed=True)[0] - v[0])
    rounds = np.floor(u - track.u[0])
    order = np.argsort(u - rounds)
    return (u - rounds)[order], (v - rounds)[order]


def whole_turn(before: Ring, after: Ring, track: Track) -> float:
    """Angle of the best rotation along a track, in radians."""
    fit = _fitted(before.at(track.u), after.at(track.v))
    return float(np.angle(fit.factor)) if fit else 0.0


def _root_mean_square(z: ComplexArray) -> float:
    return float(np.sqrt((np.abs(z) ** 2).mean()))


def _fitted(p: ComplexArray, q: ComplexArray) -> Similarity | None:
    """Least squares; None where all points before are one."""
    cp, cq = p.mean(), q.mean()
    spread = (np.abs(p - cp) ** 2).sum()
    factor = (np.conj(p - cp) * (q - cq)).sum() / spread if spread > 0 else 0.0
    return Similarity(complex(factor), complex(cq - factor * cp)) if abs(factor) > 0 else None


def _projected(before: Ring, after: Ring, track: Track, fit: Similarity, knots: Knots) -> Track | None:
    """Pair every vertex of both rings with its nearest point on the other, carried over by `fit`."""
    closed = before.closed
    u = _from(before.vertex_shares, track.u[0], closed)
    v = _from(after.vertex_shares, track.v[0], closed)
    v_of_u = _nearest(after, fit(before.at(u)), np.interp(u, track.u, track.v))
    u_of_v = _nearest(before, fit.inverse(after.at(v)), np.interp(v, track.v, track.u))
    pairs_u, pairs_v = np.append(u, u_of_v), np.append(v_of_u, v)
    order = np.lexsort((pairs_u, pairs_u + pairs_v))
    order = order[np.append(True, np.diff((pairs_u + pairs_v)[order]) > ONE_POINT)]
    keep = order[_rising(pairs_u[order]) & _rising(pairs_v[order])]
    return _closed_up(pairs_u[keep], pairs_v[keep], knots) if len(keep) else None


def _from(shares: FloatArray, start: float, closed: bool) -> FloatArray:
    return start + np.mod(shares - start, 1.0) if closed else shares


def _rising(x: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether a number is larger than all before and smaller than all after it."""
    before = np.append(-np.inf, np.maximum.accumulate(x)[:-1])
    after = np.append(np.minimum.accumulate(x[::-1])[::-1][1:], np.inf)
    return (x > before) & (x < after)


def _closed_up(u: FloatArray, v: FloatArray, knots: Knots) -> Track:
    """The track through rising pairs and the knots; pairs that contradict a knot are dropped."""
    if not knots:
        inside = (u < u[0] + 1 - 1e-12) & (v < v[0] + 1 - 1e-12)
        u, v = u[inside], v[inside]
        return Track(np.append(u, u[0] + 1), np.append(v, v[0] + 1))
    agree = ((u[:, None] - knots.u) * (v[:, None] - knots.v) > 0).all(axis=1)
    u, v = np.append(u[agree], knots.u), np.append(v[agree], knots.v)
    order = np.argsort(u)
    return Track(u[order], v[order])


def _nearest(r: Ring, points: ComplexArray, shares: FloatArray) -> FloatArray:
    """Shares of the points of a ring nearest to `points`, looked for round `shares` and unrolled as they are."""
    edges = len(r.shares) - 1
    reach = min(8 + edges // 50, edges, max(8, MOST_PAIRS // len(points)))
    s = np.mod(shares, 1.0) if r.closed else shares
    here = np.searchsorted(r.shares, s, side="right") - 1
    k = here[:, None] + np.arange(-reach, reach + 1)
    k = k % edges if r.closed else np.clip(k, 0, edges - 1)
    start, d = r.z[:-1][k], np.diff(r.z)[k]
    square = np.abs(d) ** 2
    f = ((points[:, None] - start) * np.conj(d)).real
    f = np.clip(np.divide(f, square, out=np.zeros_like(f), where=square > 0), 0.0, 1.0)
    gap = np.abs(start + f * d - points[:, None])
    rows, best = np.arange(len(points)), gap.argmin(axis=1)
    k, f = k[rows, best], f[rows, best]
    found = r.shares[k] + f * (r.shares[k + 1] - r.shares[k])
    slid = found - s
    return np.asarray(shares + (slid - np.rint(slid) if r.closed else slid))
