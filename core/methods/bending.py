"""A rigid interior with pins: joined again under the condition that they are where they must be."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse

from core.geometry.outline import FloatArray
from core.methods.body import Body
from core.methods.headings import ComplexArray
from core.methods.loops import next_in_loops

ROUNDS = 3
"""Rounds of turning the triangles along with what the pins do, and joining them again."""


@dataclass(frozen=True, eq=False)
class BentBody:
    """A body, and what its vertices do when its pins are pulled; made by `bend`.

    Attributes
    ----------
    body : Body
    weights : (k, n) float array
        The vertices of the outlines of which each pin is the mean.
    inner : (k, m) float array
        The same of the vertices of the mesh: how they move the pins.
    response : (m, k) float array
        Smooth field of a pull at each pin.
    back : (k + 1, k + 1) float array
        From what the pins lack to the pulls and a shift.
    edge_turns : sparse (n, triangles) float matrix
        From the turns of the triangles to those of the edges of the outlines.
    """

    body: Body
    weights: FloatArray
    inner: FloatArray
    response: FloatArray
    back: FloatArray
    edge_turns: Any

    def forms(self, t: FloatArray, wanted: ComplexArray) -> ComplexArray:
        """Vertices (T, n) at the times `t` (T,), with the pins where they are `wanted` (T, k)."""
        body = self.body
        u = 1 - t if body.backwards else t
        goal = body.interior.wanted(u).turned(np.full((1, 1), np.angle(body.spin)))
        turned = np.zeros(goal.p.shape)
        for _ in range(ROUNDS):
            mesh, _ = self._pulled(u, turned, wanted)
            maps = body.interior.maps(mesh)
            turned = np.angle(maps.p * goal.p.conj() + maps.q * goal.q.conj())
        mesh, turns = self._pulled(u, turned, wanted)
        return body.detail.vertices(u, mesh[body.boundary.places], turns)

    def _pulled(self, u: FloatArray, turned: FloatArray, wanted: ComplexArray) -> tuple[ComplexArray, FloatArray]:
        """Vertices (m, T) of the mesh, pulled so that the pins are right with the detail on it; turns of edges."""
        body, turns = self.body, self.edge_turns @ turned
        mesh = body.interior.vertices(u, turned) * body.spin
        outline = body.detail.vertices(u, mesh[body.boundary.places], turns)
        missing = wanted - outline @ self.weights.T
        pulls = self.back @ np.concatenate([missing.T, np.zeros((1, len(u)))])
        return mesh + self.response @ pulls[:-1] + pulls[-1], turns


def bend(body: Body, weights: FloatArray) -> BentBody:
    """Prepare a body for pins that are means of the vertices of its outlines, with these `weights` (k, n).

    Notes
    -----
    The field of a pull is that of a thin plate, the inverse of the membrane's stiffness applied twice: the
    membrane alone gives way at a point as sharply as the mesh allows, which shows as a kink.
    """
    inner = np.zeros((len(weights), body.interior.count))
    inner[:, body.boundary.places] = body.detail.pull_of(weights)
    response = body.interior.plate(inner)
    matrix = np.ones((len(weights) + 1, len(weights) + 1))
    matrix[:-1, :-1] = inner @ response
    matrix[-1, -1] = 0.0
    back = np.asarray(np.linalg.pinv(matrix, rcond=1e-12), np.float64)
    return BentBody(body, weights, inner, response, back, _edge_turns(body))


def _edge_turns(body: Body) -> Any:
    """Mean turn of the triangles at each boundary vertex, and between these linear along the outline."""
    boundary, elements = body.boundary, body.interior.half_way
    triangles, count = elements.triangles, len(elements.triangles)
    corners = np.repeat(elements.areas, 3)
    rows, columns = triangles.ravel(), np.repeat(np.arange(count), 3)
    mean = sparse.csr_matrix((corners, (rows, columns)), shape=(elements.count, count))
    mean = sparse.diags_array(1 / np.bincount(rows, corners, elements.count)) @ mean
    after = next_in_loops(boundary.loops)
    places = boundary.places
    parts = np.diff(places, append=len(boundary.before))
    number = body.detail.along.astype(np.intp)
    along = (body.detail.along - number) * parts[number]
    step = np.minimum(along.astype(np.intp), parts[number] - 1)
    first = places[number] + step
    share = along - step
    every = np.arange(len(number))
    between = sparse.csr_matrix(
        (
            np.concatenate([1 - share, share]),
            (np.concatenate([every, every]), np.concatenate([first, after[first]])),
        ),
        shape=(len(every), elements.count),
    )
    return (between @ mean).tocsr()
