"""One outline brought into a form that does not depend on how it was drawn.

A *share* is a length along the ring over its whole length, counted from the ring's own start: for a closed
outline the point farthest from the centroid, in a given direction. Two drawings of one shape, whatever their
first vertex, direction, place or scale, thus give the same ring, and everything solved on rings agrees.
"""

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray

ComplexArray = npt.NDArray[np.complex128]

DIGITS = 10
"""Decimals (of the root-mean-square radius) that are kept: what turning and moving adds is rounded off."""


@dataclass(frozen=True, eq=False)
class Ring:
    """An outline as complex numbers round its centroid, in units of its root-mean-square radius.

    Attributes
    ----------
    z : (n + 1,) or (n,) complex array
        Vertices from the ring's start on; the first is repeated at the end of a closed one.
    shares : float array
        Share of the length at every entry of `z`, 0 to 1.
    first : int
        Index of the outline's vertex where the ring starts.
    count : int
    closed, backwards : bool
        Whether the ring runs against the outline.
    """

    z: ComplexArray
    shares: FloatArray
    first: int
    count: int
    closed: bool
    backwards: bool

    def at(self, shares: FloatArray) -> ComplexArray:
        """Points at any shares; a closed ring goes round, an open one stops at its ends."""
        s = np.mod(shares, 1.0) if self.closed else np.clip(shares, 0.0, 1.0)
        return np.asarray(np.interp(s, self.shares, self.z), np.complex128)

    def positions(self, shares: FloatArray) -> FloatArray:
        """Positions on the outline (edge index and fraction) at `shares`."""
        s = np.mod(shares, 1.0) if self.closed else np.clip(shares, 0.0, 1.0)
        i = np.clip(np.searchsorted(self.shares, s, side="right") - 1, 0, len(self.shares) - 2)
        gap = self.shares[i + 1] - self.shares[i]
        k = i + np.divide(s - self.shares[i], gap, out=np.zeros_like(s), where=gap > 0)
        k = self.first - k if self.backwards else self.first + k
        return np.asarray(np.mod(k, self.count) if self.closed else k, np.float64)

    def shares_of(self, positions: FloatArray) -> FloatArray:
        """Shares of positions on the outline, in [0, 1); an open ring's end is 1."""
        k = self.first - positions if self.backwards else positions - self.first
        if self.closed:
            k = np.mod(k, self.count)
        s = np.interp(k, np.arange(len(self.shares)), self.shares)
        return np.mod(s, 1.0) if self.closed else s

    @property
    def vertex_shares(self) -> FloatArray:
        """Share of every vertex, rising; each vertex once."""
        return self.shares[:-1] if self.closed else self.shares


def ring(points: FloatArray, *, closed: bool, backwards: bool = False, towards: complex | None = None) -> Ring:
    """Return the ring of an outline, running as it was drawn or `backwards`.

    Where several vertices are equally far from the centroid, it starts at the one in the direction `towards`.
    """
    z = points[:, 0] + 1j * points[:, 1]
    n = len(z)
    z = z - z[0]
    z = (z - _centroid(z, closed)) / max(float(np.abs(z).max()), np.finfo(float).tiny)
    z = z - _centroid(z, closed)
    z = z / _radius(z, closed)
    if backwards:
        z = z[::-1]
    start = _farthest(z, towards) if closed else 0
    z = np.append(np.roll(z, -start), z[start]) if closed else z
    lengths = np.append(0.0, np.cumsum(np.abs(np.diff(z))))
    first = n - 1 - start if backwards else start
    return Ring(z, lengths / lengths[-1], first, n, closed, backwards)


def turned_together(before: Ring, after: Ring) -> tuple[Ring, Ring]:
    """Turn both rings by the angle that lays the start of the first on the x axis, and round the noise off."""
    start = before.z[0]
    turn = np.conj(start) / abs(start) if abs(start) > 0 else 1.0 + 0.0j
    first, second = (
        replace(r, z=np.asarray(np.round(r.z * turn, DIGITS), np.complex128)) for r in (before, after)
    )
    return first, second


def shape_key(r: Ring) -> tuple[float, ...]:
    """Numbers that tell two shapes apart whatever their place, turn, scale, direction and start.

    They order a pair of outlines, so that exchanging the keyframes poses the very same problem.
    """
    even = r.at(np.arange(64) / 64 if r.closed else np.linspace(0, 1, 65))
    length = float(np.abs(np.diff(r.z)).sum())
    radii = np.abs(even)
    doubled = np.abs(even[: len(even) // 2] - even[len(even) // 2 : 2 * (len(even) // 2)])
    # two moments that turn with the shape: the angle between them changes its sign in a mirror
    hand = (np.conj(_heavy_side(even, r.closed, 3)) * _heavy_side(even, r.closed, 5)).imag
    radial = (float((radii**4).mean()), float(radii.max()), float((doubled**2).mean()), float(radii.min()))
    numbers = (length, *radial, float(hand))
    return tuple(round(x, 7) for x in numbers)


def _heavy_side(z: ComplexArray, closed: bool, power: int) -> complex:
    """An odd moment of the boundary: a vector towards the side that lies farther out."""
    p, q = _edge_ends(z, closed)
    middle, lengths = (p + q) / 2, np.abs(q - p)
    return complex((middle * np.abs(middle) ** (power - 1) * lengths).sum() / lengths.sum())


def _edge_ends(z: ComplexArray, closed: bool) -> tuple[ComplexArray, ComplexArray]:
    return (z, np.roll(z, -1)) if closed else (z[:-1], z[1:])


def _centroid(z: ComplexArray, closed: bool) -> complex:
    """Mean of the boundary, not of the vertices: more vertices on an edge do not move it."""
    p, q = _edge_ends(z, closed)
    lengths = np.abs(q - p)
    return complex(((p + q) / 2 * lengths).sum() / lengths.sum())


def _radius(z: ComplexArray, closed: bool) -> float:
    p, q = _edge_ends(z, closed)
    lengths = np.abs(q - p)
    squares = (np.abs(p) ** 2 + (p * np.conj(q)).real + np.abs(q) ** 2) / 3
    return float(np.sqrt((squares * lengths).sum() / lengths.sum()))


def _farthest(z: ComplexArray, towards: complex | None) -> int:
    """Index of the vertex farthest from the centroid; equally far ones are told apart by what follows them.

    Of those that a rotation carries into each other, the one `towards` is taken, or to the heavy side.
    """
    radii = np.abs(z)
    ties = np.flatnonzero(radii >= radii.max() * (1 - 1e-9))
    if len(ties) == 1:
        return int(ties[0])
    ahead = _radii_ahead(z, ties)
    ties = ties[ahead == ahead.max()]
    side = np.conj(_heavy_side(z, True, 3) if towards is None else towards) * z[ties]
    along = np.round(side.real + 0.5 * side.imag, 7)
    return int(ties[int(along.argmax())])


def _radii_ahead(z: ComplexArray, vertices: npt.NDArray[np.intp]) -> FloatArray:
    """A mean of the radii at several shares behind each vertex, to seven digits."""
    around = np.append(z, z[0])
    shares = np.append(0.0, np.cumsum(np.abs(np.diff(around))))
    shares /= shares[-1]
    at = np.mod(shares[vertices, None] + np.array([0.03, 0.07, 0.13, 0.19]), 1.0)
    weighted = np.abs(np.interp(at, shares, around)) @ np.array([1.0, 0.8, 0.5, 0.3])
    return np.asarray(np.round(weighted, 7), np.float64)
