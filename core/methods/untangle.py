"""Opening of folded triangles: Newton steps on an energy that no triangle can lower by staying turned over.

Garanzha, Kaporin, Kudryavtseva, Protais, Ray and Sokolov, "Foldover-free maps in 50 lines of code", ACM TOG 2021;
the second derivatives are of closed form here, since in two dimensions the energy of a map x -> p x + q conj(x)
depends on |p| and |q| alone.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.methods.carry import Carried
from core.methods.elements import Elements, Factor, Maps
from core.methods.headings import ComplexArray

FLAT = 1e-3
"""Growth of area below which a triangle counts as folded at the start."""

RINGS = (2, 4)
"""How far round folded triangles vertices may move: first near by, then farther."""

SHARPEST = 1e-10
"""Rounding off of the energy once nothing is folded."""


def untangle(carried: Carried, steps: int) -> ComplexArray | None:
    """Return the vertices moved so that no triangle is folded, the boundary fixed; None if `steps` do not do."""
    image = carried.image
    bad = carried.elements.maps(image).determinant < FLAT
    if not bad.any():
        return image
    for rings in RINGS:
        patch = _Patch.of(carried, bad, rings)
        if patch is None:
            return None
        image = patch.opened(image, steps)
        bad = carried.elements.maps(image).determinant <= 0
        if not bad.any():
            return image
    return None


@dataclass(frozen=True, eq=False)
class _Patch:
    """The triangles that move, and the pattern of the matrix for their free vertices.

    Attributes
    ----------
    elements : Elements
    free : (k,) int array
        Vertices that move.
    cells : (c,) int array
        Which of the 36 m entries of the triangles' matrices concern free vertices only.
    slots : (c,) int array
        Where in the sparse matrix each of these is added.
    pattern : tuple
        Indices and starts of the columns of the sparse matrix.
    slopes : (m, 4, 6) float array
        Real derivatives of (p, q) by the corners.
    """

    elements: Elements
    free: IndexArray
    cells: IndexArray
    slots: IndexArray
    pattern: tuple[IndexArray, IndexArray]
    slopes: FloatArray

    @classmethod
    def of(cls, carried: Carried, bad: np.ndarray, rings: int) -> "_Patch | None":
        triangles, mesh = carried.mesh.triangles, carried.mesh
        near = np.zeros(len(mesh.points), dtype=bool)
        near[triangles[bad]] = True
        for _ in range(rings):
            near[triangles[near[triangles].any(axis=1)]] = True
        near[: mesh.rim] = False
        free = np.flatnonzero(near)
        if not len(free):
            return None
        moved = near[triangles].any(axis=1)
        whole = carried.elements
        part = Elements(triangles[moved], whole.count, whole.areas[moved], whole.slopes[moved])
        number = np.full(len(mesh.points), -1)
        number[free] = np.arange(len(free))
        corners = number[part.triangles]
        at = np.where(corners[:, :, None] >= 0, 2 * corners[:, :, None] + np.arange(2), -1).reshape(-1, 6)
        rows, columns = np.broadcast_arrays(at[:, :, None], at[:, None, :])
        cells = np.flatnonzero((rows >= 0) & (columns >= 0))
        key = columns.ravel()[cells] * (2 * len(free)) + rows.ravel()[cells]
        unique, slots = np.unique(key, return_inverse=True)
        starts = np.searchsorted(unique // (2 * len(free)), np.arange(2 * len(free) + 1))
        return cls(part, free, cells, slots, (unique % (2 * len(free)), starts), _real_slopes(part.slopes))

    def opened(self, image: ComplexArray, steps: int) -> ComplexArray:
        """Return the vertices after at most `steps` Newton steps, fewer when nothing is folded."""
        maps = self.elements.maps(image)
        softness = _softness(float(maps.determinant.min()), 0.9, 1.0)
        for _ in range(steps):
            energy = _energy(maps, softness)
            force = self.elements.pull(Maps(energy.by_p * maps.p, energy.by_q * maps.q))[self.free]
            step = np.zeros(len(image), np.complex128)
            step[self.free] = self._direction(maps, energy, force)
            fall = float((force.conj() * step[self.free]).real.sum())
            before = float(self.elements.areas @ energy.value)
            image, now = self._searched(image, step, softness, (before, fall))
            maps = self.elements.maps(image)
            least = float(maps.determinant.min())
            if least > 0:
                break
            softness = _softness(least, 1 - max(1 - now / before, 0.1), softness)
        return image

    def _direction(self, maps: Maps, energy: "_Energy", force: ComplexArray) -> ComplexArray:
        """Newton's step of the free vertices; down the gradient where the matrix is singular to rounding."""
        weighted = self.elements.areas[:, None, None] * energy.hessian(maps)
        hessian = self.slopes.transpose(0, 2, 1) @ (weighted @ self.slopes)
        size = 2 * len(self.free)
        values = np.bincount(self.slots, hessian.ravel()[self.cells], len(self.pattern[0]))
        matrix = sparse.csc_matrix((values, *self.pattern), shape=(size, size))
        try:
            found = Factor(matrix).solve_real(-force.view(np.float64)).view(np.complex128)
        except RuntimeError:
            return -force
        return found if np.isfinite(found).all() else -force

    def _searched(
        self, image: ComplexArray, step: ComplexArray, softness: float, start: tuple[float, float]
    ) -> tuple[ComplexArray, float]:
        """Go along `step`, less far until the energy falls enough (Armijo), from `start`: its value and slope."""
        before, fall = start
        length = 1.0
        for _ in range(30):
            there = image + length * step
            now = float(self.elements.areas @ _energy(self.elements.maps(there), softness).value)
            if now <= before + 1e-4 * length * fall:
                return there, now
            length /= 2
        return image, before


@dataclass(frozen=True, eq=False)
class _Energy:
    """(|J|^2 + det^2 + 1) / chi(det) of every map, and its derivatives.

    With s = |p|^2 + |q|^2 and d = |p|^2 - |q|^2 it is s u(d) + v(d), so all follow from the derivatives of u
    and v by d, of which `rise` and `bend` are the sums s u' + v' and s u'' + v''.
    """

    value: FloatArray
    u: FloatArray
    slope: FloatArray
    rise: FloatArray
    bend: FloatArray

    @property
    def by_p(self) -> FloatArray:
        """Gradient by p, over p."""
        return 2 * (self.u + self.rise)

    @property
    def by_q(self) -> FloatArray:
        """Gradient by q, over q."""
        return 2 * (self.u - self.rise)

    def hessian(self, maps: Maps) -> FloatArray:
        """Second derivatives by (p, q) as four real numbers, (m, 4, 4), with no negative eigenvalue."""
        p, q = np.abs(maps.p), np.abs(maps.q)
        pp = self.by_p + 4 * p**2 * (2 * self.slope + self.bend)
        qq = self.by_q + 4 * q**2 * (self.bend - 2 * self.slope)
        pq = -4 * p * q * self.bend
        half, apart = (pp + qq) / 2, (pp - qq) / 2
        reach = np.hypot(apart, pq)
        largest = np.maximum(np.maximum(half + reach, self.by_p), np.maximum(self.by_q, 1e-300))
        floor = 1e-9 * largest
        high, low = np.maximum(half + reach, floor), np.maximum(half - reach, floor)
        across_p, across_q = np.maximum(self.by_p, floor), np.maximum(self.by_q, floor)
        share = (high - low) / np.maximum(2 * reach, 1e-300)
        middle = (high + low) / 2
        radial = (middle + share * apart, share * pq, middle - share * apart)
        return _framed(_unit(maps.p, p), _unit(maps.q, q), radial, across_p, across_q)


def _energy(maps: Maps, softness: float) -> _Energy:
    pp, qq = np.abs(maps.p) ** 2, np.abs(maps.q) ** 2
    s, d = pp + qq, pp - qq
    root = np.hypot(d, softness)
    u = 2 / np.maximum(_chi(d, softness), 1e-150)
    du, ddu = -u / root, 4 / root**3
    v = (d * d + 1) * u / 2
    dv = d * u + (d * d + 1) * du / 2
    ddv = u + 2 * d * du + (d * d + 1) * ddu / 2
    return _Energy(s * u + v, u, du, s * du + dv, s * ddu + ddv)


def _framed(
    a: ComplexArray,
    b: ComplexArray,
    radial: tuple[FloatArray, FloatArray, FloatArray],
    across_p: FloatArray,
    across_q: FloatArray,
) -> FloatArray:
    """Matrix of the values along and across the directions of p and q."""
    out = np.zeros((len(a), 4, 4))
    u, v = (np.stack([z.real, z.imag], axis=1) for z in (a, b))
    outer_u, outer_v = u[:, :, None] * u[:, None, :], v[:, :, None] * v[:, None, :]
    out[:, :2, :2] = across_p[:, None, None] * (np.eye(2) - outer_u) + radial[0][:, None, None] * outer_u
    out[:, 2:, 2:] = across_q[:, None, None] * (np.eye(2) - outer_v) + radial[2][:, None, None] * outer_v
    cross = radial[1][:, None, None] * (u[:, :, None] * v[:, None, :])
    out[:, :2, 2:] = cross
    out[:, 2:, :2] = np.swapaxes(cross, 1, 2)
    return out


def _unit(z: ComplexArray, size: FloatArray) -> ComplexArray:
    return np.where(size > 0, z / np.maximum(size, 1e-300), 1.0)


def _chi(d: FloatArray, softness: float) -> FloatArray:
    """Return d where it is positive, smoothly approaching 0 where it is negative."""
    root = np.hypot(d, softness)
    # the plain sum cancels where d is negative
    return np.where(d > 0, (d + root) / 2, softness**2 / (2 * np.maximum(root - d, 1e-300)))


def _softness(least: float, keep: float, softness: float) -> float:
    """Rounding off for the next step, from the least determinant: the more is folded, the rounder."""
    goal = keep * float(_chi(np.array(least), softness))
    return max(2 * float(np.sqrt(goal * (goal - least))), SHARPEST) if least < goal else SHARPEST


def _real_slopes(slopes: ComplexArray) -> FloatArray:
    """Derivatives of (Re p, Im p, Re q, Im q) by (x, y) of the three corners, (m, 4, 6)."""
    re, im = slopes.real, slopes.imag
    rows = [(re, -im), (im, re), (re, im), (-im, re)]
    return np.stack([np.stack(row, axis=2).reshape(-1, 6) for row in rows], axis=1)
