"""One mesh for both keyframes: made in the one, carried to the other by how its boundary turns and stretches."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.geometry.triangulation import Mesh, triangulate
from core.methods.cage import Cage
from core.methods.elements import Elements, Factor, Maps
from core.methods.headings import ComplexArray, headings, joined
from core.methods.loops import next_in_loops, previous_in_loops

FINEST = 0.04
"""Smallest size wanted of a triangle, for a drawing of area 1."""

STEEPEST = 3.0
"""Largest logarithm of a boundary edge's stretch that is led into the interior."""

ROUNDS = 3
"""Rounds of turning triangles rigidly and joining them again."""


@dataclass(frozen=True, eq=False)
class Carried:
    """A mesh and where it goes.

    Attributes
    ----------
    mesh : Mesh
    elements : Elements
        Of the mesh.
    image : (n,) complex array
        Its vertices in the other keyframe; those of the boundary exactly on it.
    turn : (m,) float array
        By how much the boundary around each triangle turns, radians, whole turns told apart.
    rim_turn : (r,) float array
        The same of every boundary edge itself.
    width : float
        How wide the drawing is, if it is a strip: twice its area over its perimeter.
    """

    mesh: Mesh
    elements: Elements
    image: ComplexArray
    turn: FloatArray
    rim_turn: FloatArray
    width: float

    def maps(self) -> Maps:
        """Return the map of every triangle."""
        return self.elements.maps(self.image)


def carry(cage: Cage, mean_turns: Sequence[float]) -> Carried:
    """Mesh the inside of the cage before and carry it to the cage after.

    Parameters
    ----------
    cage : Cage
        Area 1 in both keyframes.
    mean_turns : sequence of float
        Turn of each outline as a whole, radians, to tell whole turns apart.

    Raises
    ------
    GeometryError
        If the cage encloses nothing that can be triangulated.

    Notes
    -----
    The headings of the boundary say how far it turns, whole turns included; both that and the logarithm of its
    stretch are extended harmonically. The vertices then follow these similarities as nearly as may be (a
    Poisson equation), and a few rounds as rigidly as possible (Sorkine and Alexa 2007).
    """
    behind = previous_in_loops(cage.loops)
    edge, own, length = _boundary(cage, mean_turns)
    rim_field = _at_vertices(edge, length, behind)
    sizes = np.maximum((own + own[behind]) / 2, FINEST)
    mesh = triangulate(cage.before, next_in_loops(cage.loops), sizes)
    elements = Elements.of(mesh)
    width = 2 * float(mesh.areas.sum()) / float(own.sum())
    rim, matrix = mesh.rim, elements.stiffness
    inner = Factor(matrix[rim:, rim:]) if len(mesh.points) > rim else None
    across = matrix[rim:, :rim]
    field = np.concatenate([rim_field, np.zeros(len(mesh.points) - rim)])
    image = np.concatenate([cage.after, np.zeros(len(mesh.points) - rim, np.complex128)])
    if inner is None:
        return Carried(mesh, elements, image, rim_field.real[mesh.triangles].mean(axis=1), edge.real, width)
    field[rim:] = -inner.solve(across @ field[:rim])
    inside = field[mesh.triangles].mean(axis=1)
    fixed = across @ cage.after
    wanted = Maps(np.exp(inside.imag + 1j * inside.real), np.zeros(len(inside), np.complex128))
    for _ in range(ROUNDS + 1):
        image[rim:] = inner.solve(elements.pull(wanted)[rim:] - fixed)
        p = elements.maps(image).p
        size = np.abs(p)
        wanted = Maps(np.where(size > 0, p / np.maximum(size, 1e-300), 1.0), wanted.q)
    return Carried(mesh, elements, image, inside.real, edge.real, width)


def _boundary(cage: Cage, mean_turns: Sequence[float]) -> tuple[ComplexArray, FloatArray, FloatArray]:
    """Turn + i logarithm of the stretch of every boundary edge; its length before, and that of both together."""
    found = joined(
        [
            headings(cage.before[loop], cage.after[loop], closed=True).following(mean)
            for loop, mean in zip(cage.loops, mean_turns, strict=True)
        ]
    )
    stretch = np.clip(np.log(found.after / found.before), -STEEPEST, STEEPEST)
    return found.turn + 1j * stretch, found.before, found.before + found.after


def _at_vertices(edge: ComplexArray, weight: FloatArray, behind: IndexArray) -> ComplexArray:
    """Mean of the two edges at every vertex."""
    total = weight * edge + weight[behind] * edge[behind]
    return np.asarray(total / (weight + weight[behind]), np.complex128)
