"""A triangle mesh of the inside of outlines with holes: constrained Delaunay, as fine as the outline near by."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt
import pythoncdt

from core.errors import GeometryError
from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray

ComplexArray = npt.NDArray[np.complex128]

PASSES = 7
"""Rounds of putting points into large triangles; each about halves the largest."""

LARGE = 0.9
"""A triangle is divided when its area is above this many squares of the size wanted there."""

COARSER = 1.25
"""Size wanted at a new point, over the mean of its triangle: the mesh grows coarser towards the middle."""

SMOOTHINGS = 2


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles that fill a domain.

    Attributes
    ----------
    points : (n,) complex array
        Vertices x + iy, those of the boundary first.
    triangles : (m, 3) int array
        Corners, each triangle turning from x towards y.
    rim : int
        How many vertices lie on the boundary.
    """

    points: ComplexArray
    triangles: IndexArray
    rim: int

    @cached_property
    def areas(self) -> FloatArray:
        """Area of each triangle, (m,)."""
        return triangle_areas(self.points, self.triangles)

    @cached_property
    def neighbours(self) -> tuple[IndexArray, IndexArray]:
        """Inner edges: the (k, 2) triangles on both sides, and the (k, 2) vertices they join, smaller first."""
        ends = np.sort(_sides(self.triangles).reshape(-1, 2), axis=1)
        key = ends[:, 0] * len(self.points) + ends[:, 1]
        order = np.argsort(key, kind="stable")
        twin = np.flatnonzero(key[order[1:]] == key[order[:-1]])
        return np.stack([order[twin] // 3, order[twin + 1] // 3], axis=1), ends[order[twin]]


def triangle_areas(points: ComplexArray, triangles: IndexArray) -> FloatArray:
    """Signed areas (m,) of `triangles` (m, 3), positive where x turns towards y."""
    a, b, c = points[triangles].T
    return np.asarray(((b - a).conj() * (c - a)).imag / 2)


def triangulate(boundary: ComplexArray, after: IndexArray, sizes: FloatArray) -> Mesh:
    """Return a mesh of the inside (even-odd) of closed outlines; every inner edge has an end inside.

    Parameters
    ----------
    boundary : (n,) complex array
        Vertices of all outlines.
    after : (n,) int array
        The vertex after each vertex; its edge is an edge of the mesh.
    sizes : (n,) float array
        Length of edge wanted near each vertex, above 0.

    Returns
    -------
    Mesh
        The boundary first and in the order given.

    Raises
    ------
    GeometryError
        If the outlines cross, touch or have doubled vertices.

    Notes
    -----
    Points go into the middle of triangles that are too large, and the mesh is made Delaunay again. At last every
    inner edge between two boundary vertices is split: a triangle with all its corners on the boundary could never
    be unfolded.
    """
    edges = np.stack([np.arange(len(boundary)), after], axis=1)
    try:
        mesh = _filled(boundary, edges, sizes)
    except RuntimeError as e:  # the library names the edges that cross, or the doubled vertex
        raise GeometryError(f"the outlines cannot be triangulated: {e}") from None
    _check(mesh, edges)
    return split_chords(smoothed(mesh))


def smoothed(mesh: Mesh) -> Mesh:
    """Move every inner vertex to the mean of its neighbours, if that turns no triangle over."""
    points = mesh.points.copy()
    ends = _sides(mesh.triangles).reshape(-1, 2).T
    count = np.maximum(np.bincount(ends[0], minlength=len(points)), 1)[mesh.rim :]
    for _ in range(SMOOTHINGS):
        near = points[ends[1]]
        total = np.bincount(ends[0], near.real, len(points)) + 1j * np.bincount(ends[0], near.imag, len(points))
        points[mesh.rim :] = total[mesh.rim :] / count
    least = 1e-3 * float(mesh.areas.min())
    return replace(mesh, points=points) if (triangle_areas(points, mesh.triangles) > least).all() else mesh


def split_chords(mesh: Mesh) -> Mesh:
    """Halve every inner edge that joins two boundary vertices; a triangle becomes two, three or four."""
    _, ends = mesh.neighbours
    chords = ends[(ends < mesh.rim).all(axis=1)]
    if not len(chords):
        return mesh
    n = len(mesh.points)
    key = chords[:, 0] * n + chords[:, 1]  # sorted, as the neighbours are
    sides = np.sort(_sides(mesh.triangles), axis=2)
    wanted = sides[..., 0] * n + sides[..., 1]
    at = np.minimum(np.searchsorted(key, wanted), len(key) - 1)
    middle = np.where(key[at] == wanted, n + at, -1)
    points = np.concatenate([mesh.points, mesh.points[chords].mean(axis=1)])
    return Mesh(points, _divided(mesh.triangles, middle), mesh.rim)


def _divided(triangles: IndexArray, middle: IndexArray) -> IndexArray:
    """Triangles with the vertices `middle` (m, 3) in the sides from each corner to the next; -1 for none."""
    count = (middle >= 0).sum(axis=1)
    # turn each triangle so that its only split side, or the first of its two, comes first
    first = np.where(count == 2, (np.argmin(middle, axis=1) + 1) % 3, np.argmax(middle, axis=1))
    turn = (first[:, None] + np.arange(3)) % 3
    corner, half = np.take_along_axis(triangles, turn, 1), np.take_along_axis(middle, turn, 1)
    both = np.concatenate([corner, half], axis=1)
    patterns = {
        0: [(0, 1, 2)],
        1: [(0, 3, 2), (3, 1, 2)],
        2: [(3, 1, 4), (0, 3, 4), (0, 4, 2)],
        3: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
    }
    return np.concatenate([both[count == k][:, part] for k, parts in patterns.items() for part in parts])


def _filled(boundary: ComplexArray, edges: IndexArray, sizes: FloatArray) -> Mesh:
    cdt = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    cdt.insert_vertices(_pairs(boundary))
    numbers: Any = edges.astype(np.uint32)
    cdt.insert_edges(numbers)
    points = boundary
    for _ in range(PASSES):
        triangles = _inside(cdt)
        wanted = sizes[triangles].mean(axis=1)
        large = triangle_areas(points, triangles) > LARGE * wanted**2
        if not large.any():
            break
        added = points[triangles[large]].mean(axis=1)
        cdt.insert_vertices(_pairs(added))
        points = np.concatenate([points, added])
        sizes = np.concatenate([sizes, COARSER * wanted[large]])
    return Mesh(points, _inside(cdt), len(boundary))


def _inside(cdt: pythoncdt.Triangulation) -> IndexArray:
    """Triangles with an odd number of outlines round them; the first three vertices are the library's own."""
    depth = np.asarray(cdt.calculate_triangle_depths())
    corners: IndexArray = cdt.triangles_array()["vertices"][depth % 2 == 1].astype(np.intp)
    return corners - 3


def _check(mesh: Mesh, edges: IndexArray) -> None:
    """Refuse a mesh that lacks a boundary edge (a vertex lies on it) or has a triangle without area."""
    n = len(mesh.points)
    if not len(mesh.triangles) or mesh.triangles.max() >= n or mesh.triangles.min() < 0:
        raise GeometryError("the outlines enclose nothing")
    have = _sides(mesh.triangles).reshape(-1, 2)
    keys = np.sort(have, axis=1) @ [n, 1]
    if np.setdiff1d(np.sort(edges, axis=1) @ [n, 1], keys).size:
        raise GeometryError("the outlines touch")
    if mesh.areas.min() <= 1e-12 * mesh.areas.max():
        raise GeometryError("the outlines all but touch")


def _sides(triangles: IndexArray) -> IndexArray:
    """Corners at both ends of the three sides, (m, 3, 2)."""
    return np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)


def _pairs(p: ComplexArray) -> Any:
    """(n, 2) array as the library's buffer, a type of which arrays are not known to be before Python 3.12."""
    return np.stack([p.real, p.imag], axis=1)
