"""A rigid interior with pins: joined again under the condition that they are where they must be."""

from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.body import Body
from core.methods.headings import ComplexArray

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
    """

    body: Body
    weights: FloatArray
    inner: FloatArray
    response: FloatArray
    back: FloatArray

    def forms(self, t: FloatArray, wanted: ComplexArray) -> ComplexArray:
        """Vertices (T, n) at the times `t` (T,), with the pins where they are `wanted` (T, k)."""
        body = self.body
        u = 1 - t if body.backwards else t
        goal = body.interior.wanted(u).turned(np.full((1, 1), np.angle(body.spin)))
        turned = np.zeros(goal.p.shape)
        for _ in range(ROUNDS):
            mesh = self._pulled(u, body.interior.vertices(u, turned) * body.spin, wanted)
            maps = body.interior.maps(mesh)
            turned = np.angle(maps.p * goal.p.conj() + maps.q * goal.q.conj())
        mesh = self._pulled(u, body.interior.vertices(u, turned) * body.spin, wanted)
        return body.detail.vertices(u, mesh[body.places])

    def _pulled(self, u: FloatArray, mesh: ComplexArray, wanted: ComplexArray) -> ComplexArray:
        """Pull the vertices (m, T) of the mesh so that the pins are right once the detail is attached."""
        outline = self.body.detail.vertices(u, mesh[self.body.places])
        missing = wanted - outline @ self.weights.T
        right = np.concatenate([missing.T, np.zeros((1, len(u)))])
        pulls = self.back @ right
        return np.asarray(mesh + self.response @ pulls[:-1] + pulls[-1], np.complex128)


def bend(body: Body, weights: FloatArray) -> BentBody:
    """Prepare a body for pins that are means of the vertices of its outlines, with these `weights` (k, n).

    Notes
    -----
    The field of a pull is that of a thin plate, the inverse of the membrane's stiffness applied twice: the
    membrane alone gives way at a point as sharply as the mesh allows, which shows as a kink.
    """
    inner = np.zeros((len(weights), body.interior.count))
    inner[:, body.places] = body.detail.pull_of(weights)
    response = body.interior.plate(inner)
    matrix = np.ones((len(weights) + 1, len(weights) + 1))
    matrix[:-1, :-1] = inner @ response
    matrix[-1, -1] = 0.0
    back = np.asarray(np.linalg.pinv(matrix, rcond=1e-12), np.float64)
    return BentBody(body, weights, inner, response, back)
