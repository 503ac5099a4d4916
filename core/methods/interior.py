"""How the interior travels: every triangle turns by its angle and stretches, and all are joined again.

Alexa, Cohen-Or and Levin, "As-rigid-as-possible shape interpolation", SIGGRAPH 2000, with angles that come from
the boundary and are evened out where triangles are too stretched to tell theirs.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from core.geometry.crossings import ComplexArray
from core.geometry.outline import FloatArray
from core.methods.carry import Carried
from core.methods.elements import Elements, Factor, Maps
from core.methods.headings import TURN

DOUBT = 8.0
"""How fast trust in a triangle's own angle falls with the square of the logarithm of its stretch ratio."""

ANCHOR = 0.1
"""Weight of the boundary's angle where the triangle's own is not trusted."""

SMOOTH = 0.03
"""Distance over which angles are evened out, for a drawing of area 1."""

STEEPEST = 50.0
"""Largest coupling of neighbouring triangles: length of their side over the distance of their middles."""

ASTRAY = 1.2
"""Radians by which an angle may differ from the triangle's own; at a right angle the triangle would collapse."""


@dataclass(frozen=True, eq=False)
class Interior:
    """Vertices of a mesh at any time; made by `travel`.

    Attributes
    ----------
    turn : (m,) float array
        Angle by which each triangle turns, radians.
    still, going : sparse (n, m) complex matrices
        Pull of every triangle on the vertices, weighted by 1 - u and by u.
    factor : Factor
        Of the vertices but the first, which stays in the origin.
    """

    turn: FloatArray
    still: Any
    going: Any
    factor: Factor

    def vertices(self, u: FloatArray) -> ComplexArray:
        """Vertices (n, T) at the times `u` (T,): up to a shift, those of the mesh at 0 and of its image at 1."""
        spin = np.exp(1j * self.turn[:, None] * u)
        pull = self.still @ (spin * (1 - u)) + self.going @ (spin * u)
        out = np.zeros(pull.shape, np.complex128)
        out[1:] = self.factor.solve(pull[1:])
        return out


def travel(carried: Carried, before: float, after: float) -> Interior:
    """Plan how the interior travels, from the mesh `before` times as large to its image `after` times as large.

    Notes
    -----
    With turn a and remaining map S of a triangle (J = R(a) S), it wants to be R(u a) ((1 - u) I + u S). This is the
    same from either end, and so is the metric of the triangles half way, (I + S) / 2, in which all of them are
    joined: exchanging the keyframes changes nothing.
    """
    maps = carried.maps()
    turn = even_turns(carried, maps)
    grown = Maps(maps.p * (after / before), maps.q * (after / before)).turned(-turn)
    middle = Maps((1 + grown.p) / 2, grown.q / 2)
    scaled = Maps(np.full(len(turn), before, np.complex128), np.zeros(len(turn), np.complex128))
    half_way = carried.elements.mapped(middle.after(scaled))
    back = middle.inverse()
    still, going = (_pulls(half_way, wanted) for wanted in (back, grown.after(back)))
    return Interior(turn, still, going, Factor(half_way.stiffness[1:, 1:]))


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
        middles = points[carried.mesh.triangles].mean(axis=1)
        apart = np.abs(middles[pairs[:, 0]] - middles[pairs[:, 1]])
        side = np.abs(points[ends[:, 0]] - points[ends[:, 1]])
        weights += np.minimum(side / np.maximum(apart, 1e-300), STEEPEST) / 2
    count = len(carried.mesh.triangles)
    i, j = pairs.T
    own = np.bincount(i, weights, count) + np.bincount(j, weights, count)
    every = np.arange(count)
    values = np.concatenate([own, -weights, -weights])
    rows, columns = np.concatenate([every, i, j]), np.concatenate([every, j, i])
    return sparse.csc_matrix((values, (rows, columns)), shape=(count, count))


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
