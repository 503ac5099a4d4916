"""A force that grows without bound as a vertex nears an edge, and is nothing where the keyframes are."""

from dataclasses import dataclass

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.repair.chains import ComplexArray
from core.repair.contacts import Pairs, distances

REACH = 2e-3
"""Sizes of the drawing: pairs further apart feel nothing."""

WEIGHT = 0.01
"""Of the barrier against the distance from the wished path."""


@dataclass(frozen=True, eq=False)
class Terms:
    """The active pairs at one place: first and second derivatives by the distance, and how it depends on vertices.

    Attributes
    ----------
    vertices : (k, 3) int array
    shares : (k, 3) float array
        What a move of each of the three along `normal` adds to the distance.
    normal : (k,) complex array
    slope, curvature : (k,) float array
    """

    vertices: IndexArray
    shares: FloatArray
    normal: ComplexArray
    slope: FloatArray
    curvature: FloatArray


@dataclass(frozen=True, eq=False)
class Barrier:
    """The barrier of Li et al. ("Incremental potential contact", 2020), with a reach for every pair of its own.

    The reach of a pair is at most half of its distance in either keyframe: it is silent at both, so that they come
    back exactly and sharp corners are not pushed open. One factor h (in place of h^2) keeps short reaches strong.

    Attributes
    ----------
    before, after : (n,) complex array
    """

    before: ComplexArray
    after: ComplexArray

    def value(self, z: ComplexArray, pairs: Pairs) -> float:
        """Sum over the pairs of -h (y - 1)^2 ln y, where y is the distance over the reach h."""
        _, d, h, *_ = self._active(z, pairs)
        y = d / h
        return float(-(h * (y - 1) ** 2 * np.log(y)).sum())

    def touches(self, z: ComplexArray, pairs: Pairs) -> bool:
        """Whether any pair is within its reach."""
        return len(self._active(z, pairs)[1]) > 0

    def terms(self, z: ComplexArray, pairs: Pairs) -> Terms:
        """Derivatives of `value`; the curvature of the distance itself, which only unsettles Newton, left out."""
        pairs, d, h, share, arm = self._active(z, pairs)
        y = d / h
        slope = -(2 * (y - 1) * np.log(y) + (y - 1) ** 2 / y)
        curvature = -(2 * np.log(y) + 4 * (y - 1) / y - ((y - 1) / y) ** 2) / h
        vertices = np.stack([pairs.vertex, pairs.start, pairs.end], axis=1)
        shares = np.stack([np.ones(len(d)), share - 1, -share], axis=1)
        return Terms(vertices, shares, arm / d, slope, np.maximum(curvature, 0.0))

    def _active(
        self, z: ComplexArray, pairs: Pairs
    ) -> tuple[Pairs, FloatArray, FloatArray, FloatArray, ComplexArray]:
        d, share, arm = distances(*pairs.of(z))
        near = np.flatnonzero(d < REACH)
        pairs, d = pairs[near], d[near]
        reach = np.minimum(distances(*pairs.of(self.before))[0], distances(*pairs.of(self.after))[0])
        reach = np.minimum(REACH, 0.5 * reach)
        active = np.flatnonzero((d < reach) & (d > 0))
        keep = near[active]
        return pairs[active], d[active], reach[active], share[keep], arm[keep]
