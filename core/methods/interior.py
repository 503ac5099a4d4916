"""How the interior travels: every triangle turns by its angle and stretches, and all are joined again.

Alexa, Cohen-Or and Levin, "As-rigid-as-possible shape interpolation", SIGGRAPH 2000, with angles that come from
the boundary and are evened out where triangles are too stretched to tell theirs.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.methods.carry import Carried
from core.methods.elements import Elements, Factor, Maps
from core.methods.headings import TURN, ComplexArray

DOUBT = 8.0
"""How fast trust in a triangle's own angle falls with the square of the logarithm of its stretch ratio."""

ANCHOR = 0.1
"""Weight of the boundary's angle where the triangle's own is not trusted."""

SMOOTH = 0.03
"""Distance over which angles are evened out, for a drawing of area 1."""

STEEPEST = 50.0
"""Largest coupling of neighbouring triangles: length of their side over the distance of their middles."""

LEAST = 1e-12
"""What no length, stretch or strain is below, for a drawing of area 1."""

ASTRAY = 1.2
"""Radians by which an angle may differ from the triangle's own; at a right angle the triangle would collapse."""


BEND = 2.0
"""Widths of the drawing over which its turning accounts for the strain of a bend."""

STRANGE = 0.5
"""Mean strain above which the drawing becomes another one rather than bends."""

BULGE = 3.0
"""Exponent of the mean of the stretches, before and after, in a bend; 1 where there is none."""


@dataclass(frozen=True, eq=False)
class Interior:
    """Vertices of a mesh at any time; made by `travel`.

    Attributes
    ----------
    turn : (m,) float array
        Angle by which each triangle turns, radians.
    stretch : (2, m) float array
        Largest and least stretch of each triangle, for equal areas of both keyframes.
    exponent : (m,) float array
        Of the mean of 1 and the stretch that is wanted in between.
    half_way : Elements
        The triangles in the form in which they are joined.
    parts : tuple of Maps
        The four parts of the map that each triangle wants.
    pulls : sparse (n, 4 m) complex matrix
        What each triangle pulls at its corners for these.
    factor : Factor
        Of the vertices but the first, which stays in the origin.
    """

    turn: FloatArray
    stretch: FloatArray
    exponent: FloatArray
    half_way: Elements
    parts: tuple[Maps, ...]
    pulls: Any
    factor: Factor

    @property
    def count(self) -> int:
        """Vertices of the mesh."""
        return self.half_way.count

    def vertices(self, u: FloatArray, turned: FloatArray | float = 0.0) -> ComplexArray:
        """Vertices (n, T) at the times `u` (T,): up to a shift, those of the mesh at 0 and of its image at 1.

        Triangles are turned by `turned` (m, T) besides.
        """
        pull = self.pulls @ np.concatenate(self._shares(u, turned))
        out = np.zeros(pull.shape, np.complex128)
        out[1:] = self.factor.solve(pull[1:])
        return out

    def wanted(self, u: FloatArray) -> Maps:
        """Maps (m, T) that the triangles, half way, want at the times `u`."""
        shares = self._shares(u, 0.0)
        p, q = (
            sum(share * getattr(part, name)[:, None] for share, part in zip(shares, self.parts, strict=True))
            for name in ("p", "q")
        )
        return Maps(p, q)

    def maps(self, vertices: ComplexArray) -> Maps:
        """Maps (m, T) from the triangles half way to `vertices` (n, T)."""
        corners = vertices[self.half_way.triangles]
        slopes = self.half_way.slopes[:, :, None]
        return Maps((slopes * corners).sum(axis=1), (slopes.conj() * corners).sum(axis=1))

    def plate(self, loads: FloatArray) -> FloatArray:
        """Deflections (n, k) of a free thin plate, half way, under loads (k, n) spread against their sum."""
        corners = np.repeat(self.half_way.areas / 3, 3)
        mass = np.bincount(self.half_way.triangles.ravel(), corners, self.count)
        mass = mass / mass.sum()
        loads = loads.T - mass[:, None] * loads.sum(axis=1)
        for _ in range(2):
            bent = np.zeros_like(loads)
            bent[1:] = self.factor.solve_real(loads[1:])
            bent -= mass @ bent
            loads = mass[:, None] * bent
        return bent

    def _shares(self, u: FloatArray, turned: FloatArray | float) -> list[ComplexArray]:
        """Weights (m, T) of the parts of the map that each triangle wants."""
        high, low = (self._gain(s, np.clip(u, 0.0, 1.0)) for s in self.stretch)
        spin = np.exp(1j * (self.turn[:, None] * u + turned))
        alike, apart = spin * ((high + low) / 2), spin * ((high - low) / 2)
        return [alike * (1 - u), alike * u, apart * (1 - u), apart * u]

    def _gain(self, stretch: FloatArray, u: FloatArray) -> FloatArray:
        """Stretch wanted over the linear one, (m, T)."""
        power = self.exponent
        wanted = 1 + np.outer(stretch**power - 1, u)
        return np.asarray(wanted ** (1 / power)[:, None] / (1 + np.outer(stretch - 1, u)), np.float64)


def travel(carried: Carried, before: float, after: float) -> Interior:
    """Plan how the interior travels, from the mesh `before` times as large to its image `after` times as large.

    Notes
    -----
    With turn a and remaining map S of a triangle (J = R(a) S), it wants to be R(u a) ((1 - u) I + u S). This is
    the same from either end, and so is the metric of the triangles half way, (I + S) / 2, in which all of them are
    joined: exchanging the keyframes changes nothing.

    In a bend the inside of a knee is not pressed together in proportion to the angle but mostly at the last. There
    the stretches s wanted are power means of 1 and s, which are above the linear ones (exponent 2 is the
    interpolation of metrics of Chen, Weber, Keren and Ben-Chen, "Planar shape interpolation with bounded
    distortion", SIGGRAPH 2013).
    """
    maps = carried.maps()
    turn = even_turns(carried, maps)
    grown = Maps(maps.p * (after / before), maps.q * (after / before)).turned(-turn)
    middle = Maps((1 + grown.p) / 2, grown.q / 2)
    scaled = Maps(np.full(len(turn), before, np.complex128), np.zeros(len(turn), np.complex128))
    half_way = carried.elements.mapped(middle.after(scaled))
    back = middle.inverse()
    axes = Maps(np.zeros(len(turn), np.complex128), _axes(maps)).after(back)
    parts = (back, grown.after(back), axes, grown.after(axes))
    pulls = sparse.hstack([_pulls(half_way, part) for part in parts], format="csr")
    stretch = np.stack([np.abs(maps.p) + np.abs(maps.q), np.abs(maps.p) - np.abs(maps.q)])
    stretch = np.maximum(stretch, LEAST)
    exponent = 1 + (BULGE - 1) * bends(carried, turn, stretch)
    factor = Factor(half_way.stiffness[1:, 1:])
    return Interior(turn, stretch, exponent, half_way, parts, pulls, factor)


def bends(carried: Carried, turn: FloatArray, stretch: FloatArray) -> FloatArray:
    """How much of the strain of each triangle is that of a bend, (m,), 0 to 1.

    A strip that bends is strained by its change of direction over the distance from its middle; what is
    strained more than its neighbourhood turns is stretched, as the letters of a wider font are. Nothing bends
    where the drawing as a whole becomes another one.
    """
    pairs, _ = carried.mesh.neighbours
    count = len(turn)
    apart = sum(_distances(p, carried.mesh.triangles, pairs) for p in (carried.mesh.points, carried.image)) / 2
    steep = (np.diff(turn[pairs], axis=1)[:, 0] / np.maximum(apart, LEAST)) ** 2
    both = pairs.ravel()
    near = np.bincount(both, np.repeat(steep, 2), count) / np.maximum(np.bincount(both, minlength=count), 1)
    bent = 2 * near * (BEND * carried.width) ** 2
    strain = (np.log(stretch) ** 2).sum(axis=0)
    mass = carried.elements.areas * (1 + stretch[0] * stretch[1])
    change = float(mass @ strain / mass.sum()) / STRANGE**2
    return np.asarray(bent**2 / (bent**2 + strain**2 + LEAST) / (1 + change))


def even_turns(carried: Carried, maps: Maps) -> FloatArray:
    """Angle of each triangle, (m,): its own where it is plain, else that of its neighbours and the boundary.

    The angle of the nearest rotation is noise where a triangle is stretched much more one way than the other.
    """
    around = carried.turn
    own = around + _wrapped(maps.rotation - around)
    large, small = np.abs(maps.p) + np.abs(maps.q), np.abs(maps.p) - np.abs(maps.q)
    ratio = np.log(np.maximum(small, 1e-300) / np.maximum(large, 1e-300))
    trust = np.maximum(np.exp(-DOUBT * ratio**2), 1e-6)
    mass = carried.elements.areas * (1 + np.abs(maps.determinant)) / 2
    anchor = ANCHOR * mass * (1 - trust)
    matrix = sparse.diags_array(mass * trust + anchor) + SMOOTH**2 * _coupling(carried)
    evened = Factor(matrix.tocsc()).solve_real(mass * trust * own + anchor * around)
    return np.asarray(own + np.clip(evened - own, -ASTRAY, ASTRAY), np.float64)


def _coupling(carried: Carried) -> Any:
    """Laplacian of the triangles: neighbours by the length of their side over the distance of their middles."""
    pairs, ends = carried.mesh.neighbours
    weights = np.zeros(len(pairs))
    for points in (carried.mesh.points, carried.image):
        apart = _distances(points, carried.mesh.triangles, pairs)
        side = np.abs(points[ends[:, 0]] - points[ends[:, 1]])
        weights += np.minimum(side / np.maximum(apart, LEAST), STEEPEST) / 2
    count = len(carried.mesh.triangles)
    i, j = pairs.T
    own = np.bincount(i, weights, count) + np.bincount(j, weights, count)
    every = np.arange(count)
    values = np.concatenate([own, -weights, -weights])
    rows, columns = np.concatenate([every, i, j]), np.concatenate([every, j, i])
    return sparse.csc_matrix((values, (rows, columns)), shape=(count, count))


def _distances(points: ComplexArray, triangles: IndexArray, pairs: IndexArray) -> FloatArray:
    """From the middle of the one to that of the other of each pair (k, 2) of triangles."""
    middles = points[triangles].mean(axis=1)
    return np.asarray(np.abs(middles[pairs[:, 0]] - middles[pairs[:, 1]]))


def _axes(maps: Maps) -> ComplexArray:
    """Twice the angle of the direction of largest stretch, as a number of size 1, (m,)."""
    axis = maps.q * maps.p.conj()
    size = np.abs(axis)
    return np.where(size > 0, axis / np.maximum(size, 1e-300), 1.0)


def _pulls(half_way: Elements, wanted: Maps) -> Any:
    """Matrix (n, m) of what every triangle pulls at its corners when it wants that map and does not turn."""
    s = half_way.slopes
    part = half_way.areas[:, None] * (s.conj() * wanted.p[:, None] + s * wanted.q[:, None])
    count = len(s)
    columns = np.repeat(np.arange(count), 3)
    shape = (half_way.count, count)
    return sparse.csr_matrix((part.ravel(), (half_way.triangles.ravel(), columns)), shape=shape)


def _wrapped(angle: FloatArray) -> FloatArray:
    return angle - TURN * np.ceil((angle - np.pi) / TURN)
