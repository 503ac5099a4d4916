"""How much the inside of an in-between is stretched, place by place."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from core.errors import GeometryError
from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.geometry.triangulation import triangulate
from core.methods.assembly import Assembly, assemble, in_a_row
from core.methods.bodies import bodies, signed_area
from core.methods.cage import Cage, cage
from core.methods.elements import Elements, Factor
from core.methods.headings import ComplexArray
from core.methods.loops import as_pairs, next_in_loops
from core.methods.plan import AlignedPair

LEVELS = ((0.003, 200), (0.01, 120), (0.025, 70), (0.05, 40))
"""How closely the mesh follows the outlines, see `cage`; a coarser one is tried where that cannot be meshed."""

FINEST = 0.06
"""Size wanted of a triangle, for a drawing of area 1."""

LEAST = 1e-6
"""What no stretch is below: a triangle without area has none that could be told."""


@dataclass(frozen=True, eq=False)
class _Part:
    """One interior: a mesh of the thinner keyframe, its boundary on the outlines, the rest spread between.

    Attributes
    ----------
    first, second : (r,) int array
        Vertices of the drawing between which every vertex of the boundary lies.
    share : (r,) float array
        How far along from the first to the second.
    size : float
        Root of the meshed keyframe's area, px; the mesh is made for 1.
    elements : Elements
    across : sparse (m, r) float matrix
        What the boundary pulls at the inner vertices.
    factor : Factor or None
        Of the inner vertices.
    ends : (2, k) float array
        Largest and least stretch of every triangle from the meshed keyframe to the other.
    """

    first: IndexArray
    second: IndexArray
    share: FloatArray
    size: float
    elements: Elements
    across: Any
    factor: Factor | None
    ends: FloatArray

    def vertices(self, frame: ComplexArray) -> ComplexArray:
        """All vertices of the mesh in a frame (n,): inside, the smoothest mixture of the boundary's."""
        rim = (1 - self.share) * frame[self.first] + self.share * frame[self.second]
        if self.factor is None:
            return np.asarray(rim, np.complex128)
        inner: ComplexArray = -self.factor.solve(self.across @ rim)
        return np.concatenate([rim, inner])

    def stretches(self, vertices: ComplexArray) -> FloatArray:
        """Largest and least stretch (2, k) of every triangle from the meshed keyframe."""
        maps = self.elements.maps(vertices)
        p, q = np.abs(maps.p) / self.size, np.abs(maps.q) / self.size
        return np.asarray(np.maximum(np.stack([p + q, np.abs(p - q)]), LEAST), np.float64)


@dataclass(frozen=True, eq=False)
class InnerStretch:
    """The inside of a drawing between two keyframes, meshed once; made by `inner_stretch`."""

    parts: tuple[_Part, ...]

    def at(self, outlines: Sequence[FloatArray]) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return how much the inside of an in-between is stretched.

        Parameters
        ----------
        outlines : sequence of (k_i, 2) float array
            Its outlines, vertex for vertex those of the keyframes.

        Returns
        -------
        places : (m, 2) float array
            Middles of the triangles, px.
        doublings : (m,) float array
            How often the triangle's stretch doubles (below 0: halves) what lies between the keyframes' own; 0 if
            it is between them. Of the two directions of a triangle the one that is worse off counts.
        areas : (m,) float array
            Of the triangles, px^2.
        """
        frame = np.concatenate(outlines) @ np.array([1, 1j])
        found = [self._of(part, frame) for part in self.parts]
        places, doublings, areas = (np.concatenate(x) for x in zip(*found, strict=True))
        return as_pairs(places), doublings, areas

    def _of(self, part: _Part, frame: ComplexArray) -> tuple[ComplexArray, FloatArray, FloatArray]:
        vertices = part.vertices(frame)
        stretches = part.stretches(vertices)
        low, high = np.minimum(part.ends, 1.0), np.maximum(part.ends, 1.0)
        beyond = np.log2(stretches / np.clip(stretches, low * (1 - 1e-9), high * (1 + 1e-9)))
        worse = np.where(np.abs(beyond[0]) >= np.abs(beyond[1]), beyond[0], beyond[1])
        a, b, c = vertices[part.elements.triangles].T
        return (a + b + c) / 3, worse, np.abs(((b - a).conj() * (c - a)).imag) / 2


def inner_stretch(pairs: Sequence[AlignedPair]) -> InnerStretch | None:
    """Mesh the inside of a drawing; None where it has none that both keyframes have in common.

    Notes
    -----
    The mesh is that of the thinner keyframe. Its inner vertices follow the boundary as a membrane does
    (cotangent weights), which takes any similar or affine image of the keyframe exactly to itself.
    """
    if not pairs:
        return None
    assembly = assemble([(p.left, p.right, p.closed) for p in pairs])
    parts = [part for own in bodies(assembly) if (part := _part(assembly, own)) is not None]
    return InnerStretch(tuple(parts)) if parts else None


def _part(assembly: Assembly, own: list[int]) -> _Part | None:
    """Mesh one interior, of the outlines `own` (the outer one first); None where it cannot be meshed."""
    index = np.concatenate([np.arange(r.start, r.stop) for r in (assembly.rows[k] for k in own)])
    loops = in_a_row([assembly.rows[k].stop - assembly.rows[k].start for k in own])
    frames = assembly.a, assembly.b
    ends = [frame[index] for frame in frames]
    sizes = [np.sqrt(abs(signed_area(p[loops[0]]))) for p in ends]
    around = [sum(float(np.abs(np.diff(p[loop], append=p[loop][:1])).sum()) for loop in loops) for p in ends]
    if around[1] / sizes[1] > around[0] / sizes[0]:
        frames, ends, sizes = frames[::-1], ends[::-1], sizes[::-1]
    meshed, other = ((p - p.mean()) / size for p, size in zip(ends, sizes, strict=True))
    for tolerance, most in LEVELS:
        found = cage(meshed, other, loops, tolerance, most)
        try:
            part = None if found is None else _meshed(found, index, float(sizes[0]))
        except (GeometryError, RuntimeError):  # cannot be meshed, or a matrix that is singular to rounding
            part = None
        if part is not None:
            return replace(part, ends=part.stretches(part.vertices(frames[1])))
    return None


def _meshed(made: Cage, index: IndexArray, size: float) -> _Part:
    """Fill the cage with triangles."""
    after = next_in_loops(made.loops)
    own = np.abs(made.before[after] - made.before)
    mesh = triangulate(made.before, after, np.clip(own, FINEST / 2, FINEST))
    elements, rim = Elements.of(mesh), mesh.rim
    inner = Factor(elements.stiffness[rim:, rim:]) if len(mesh.points) > rim else None
    parts = np.diff(made.places, append=rim)
    owner = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(rim) - made.places[owner]) / parts[owner]
    first, second = made.vertices[owner], made.vertices[next_in_loops(made.edges)][owner]
    across = elements.stiffness[rim:, :rim]
    return _Part(index[first], index[second], share, size, elements, across, inner, np.ones((2, 1)))
