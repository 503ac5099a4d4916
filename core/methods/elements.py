"""Maps of triangles as complex numbers, and the sparse systems made of them.

A linear map of the plane is x -> p x + q conj(x): p turns and scales, q is what is not alike in all directions.
Its determinant is |p|^2 - |q|^2, its stretches are |p| + |q| and |p| - |q|, and the nearest rotation is p / |p|.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.geometry.triangulation import Mesh
from core.methods.headings import ComplexArray


@dataclass(frozen=True, eq=False)
class Maps:
    """One linear map a triangle.

    Attributes
    ----------
    p, q : (m,) complex array
    """

    p: ComplexArray
    q: ComplexArray

    @property
    def determinant(self) -> FloatArray:
        """How much area grows, (m,); negative where a triangle turns over."""
        return _square(self.p) - _square(self.q)

    @property
    def rotation(self) -> FloatArray:
        """Angle of the nearest rotation in (-pi, pi], radians, (m,)."""
        return np.angle(self.p)

    def after(self, other: "Maps") -> "Maps":
        """Return the maps that first do `other`, then this."""
        return Maps(
            self.p * other.p + self.q * other.q.conj(),
            self.p * other.q + self.q * other.p.conj(),
        )

    def inverse(self) -> "Maps":
        """Return the maps backwards."""
        d = self.determinant
        return Maps(self.p.conj() / d, -self.q / d)

    def turned(self, angle: FloatArray) -> "Maps":
        """Return the maps followed by a turn of `angle` (m,) radians."""
        unit = np.exp(1j * angle)
        return Maps(unit * self.p, unit * self.q)


@dataclass(frozen=True, eq=False)
class Elements:
    """The triangles of a mesh, with what is needed to differentiate on them.

    Attributes
    ----------
    triangles : (m, 3) int array
    count : int
        Vertices.
    areas : (m,) float array
    slopes : (m, 3) complex array
        Derivatives by x of the three hat functions; those by conj(x) are their conjugates.
    """

    triangles: IndexArray
    count: int
    areas: FloatArray
    slopes: ComplexArray

    @classmethod
    def of(cls, mesh: Mesh) -> "Elements":
        """Return the elements of a mesh as it lies."""
        return cls._made(mesh.triangles, len(mesh.points), mesh.areas, _opposite(mesh.points[mesh.triangles]))

    def mapped(self, maps: Maps) -> "Elements":
        """Return the elements after each triangle has gone through its own map."""
        edges = _edges_of(self.slopes, self.areas)
        gone = maps.p[:, None] * edges + maps.q[:, None] * edges.conj()
        return self._made(self.triangles, self.count, self.areas * maps.determinant, gone)

    @classmethod
    def _made(cls, triangles: IndexArray, count: int, areas: FloatArray, edges: ComplexArray) -> "Elements":
        return cls(triangles, count, areas, -0.25j * edges.conj() / areas[:, None])

    @cached_property
    def edges(self) -> ComplexArray:
        """Side opposite to each corner, (m, 3)."""
        return _edges_of(self.slopes, self.areas)

    def maps(self, image: ComplexArray) -> Maps:
        """Return the map of every triangle that carries the mesh to the vertices `image` (n,)."""
        corners = image[self.triangles]
        return Maps((self.slopes * corners).sum(axis=1), (self.slopes.conj() * corners).sum(axis=1))

    def pull(self, wanted: Maps) -> ComplexArray:
        """Right-hand side (n,) of the vertices whose maps come nearest to `wanted`, by area."""
        part = self.slopes.conj() * wanted.p[:, None] + self.slopes * wanted.q[:, None]
        return self.gathered(part * self.areas[:, None])

    def gathered(self, corners: ComplexArray) -> ComplexArray:
        """Sum values at corners (m, 3) by vertex, (n,)."""
        at = self.triangles.ravel()
        real, imag = (np.bincount(at, part.ravel(), self.count) for part in (corners.real, corners.imag))
        return np.asarray(real + 1j * imag, np.complex128)

    @cached_property
    def stiffness(self) -> Any:
        """Sparse (n, n) matrix of that least-squares problem; its kernel are the shifts."""
        s = self.slopes
        values = 2 * self.areas[:, None, None] * (s.conj()[:, :, None] * s[:, None, :]).real
        rows = np.repeat(self.triangles, 3, axis=1)
        columns = np.tile(self.triangles, (1, 3))
        shape = (self.count, self.count)
        return sparse.csc_matrix((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape)


class Factor:
    """A symmetric positive definite sparse matrix, factored once."""

    def __init__(self, matrix: Any) -> None:
        self._lu = splu(matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})

    def solve(self, right: ComplexArray) -> ComplexArray:
        """Solve for complex columns, (n,) or (n, k)."""
        shape = right.shape
        flat = np.ascontiguousarray(right).view(np.float64).reshape(shape[0], -1)
        found = np.ascontiguousarray(self._lu.solve(flat))
        return np.asarray(found.view(np.complex128).reshape(shape), np.complex128)

    def solve_real(self, right: FloatArray) -> FloatArray:
        """Solve for real columns."""
        return np.asarray(self._lu.solve(right), np.float64)


def _opposite(corners: ComplexArray) -> ComplexArray:
    return np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)


def _edges_of(slopes: ComplexArray, areas: FloatArray) -> ComplexArray:
    return np.asarray((4j * slopes * areas[:, None]).conj())


def _square(x: ComplexArray) -> FloatArray:
    return np.asarray(x.real**2 + x.imag**2)
