"""Where the frames of a drawing lie: what hardly moves between the keyframes stays still."""

from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.headings import TURN, ComplexArray

STILL = 0.02
"""Travel, as a share of the size of the drawing, below which a vertex counts as standing still."""

NEAR, FAR = 1.0, 4.0
"""Distances of the centre of rotation from the still part, in sizes: up to NEAR the path is an arc round
the centre, beyond FAR it is straight."""


@dataclass(frozen=True, eq=False)
class Placement:
    """The path of one reference point, a weighted mean of the vertices, from keyframe to keyframe.

    Attributes
    ----------
    weights : (n,) complex array
        Sum 1; large where vertices travel little.
    before, after : complex
        The reference point in the keyframes, px.
    arm : complex
        From the reference point before to the centre that the drawing turns round, px; 0 for a straight path.
    turn, scale : float
        Of the similarity that carries the drawing before best onto the one after.
    """

    weights: ComplexArray
    before: complex
    after: complex
    arm: complex
    turn: float
    scale: float

    def path(self, t: FloatArray) -> ComplexArray:
        """Where the reference point is at the times `t` (T,): the chord, bent round the centre of rotation."""
        straight = np.asarray(self.before + t * (self.after - self.before), np.complex128)
        if self.arm == 0:
            return straight
        at, end = (np.exp(1j * s * self.turn) * (1 + (self.scale - 1) * s) for s in (t, 1.0))
        bent: ComplexArray = straight + self.arm * ((1 - t) - at + t * end)
        return bent


def place(a: ComplexArray, b: ComplexArray, lengths: FloatArray, turn: float) -> Placement:
    """Plan the placement of all vertices of a drawing.

    Parameters
    ----------
    a, b : (n,) complex array
        Vertices of all outlines, px.
    lengths : (n,) float array
        How much of the outlines each vertex stands for; sum 1.
    turn : float
        Turn of the drawing as a whole, radians, whole turns included.

    Notes
    -----
    A mean over all vertices would let a planted foot slide when the knee bends. Weights that fall with the fourth
    power of the travel hold it, and are equal when everything travels equally far.
    """
    extent = np.hypot(_extent(a, lengths), _extent(b, lengths))
    travel = np.abs(b - a) / (extent or 1.0)
    weights = lengths * ((travel.min() ** 2 + STILL**2) / (travel**2 + STILL**2)) ** 2
    weights /= weights.sum()
    before, after = complex(a @ weights), complex(b @ weights)
    similarity, agreement = _similarity(a, b, lengths)
    arm = _arm(after - before, similarity)
    scale = abs(similarity)
    arm *= agreement * _nearness(abs(arm) * np.sqrt(scale), extent)
    own = float(np.angle(similarity))
    own += TURN * np.rint((turn - own) / TURN)
    return Placement(weights.astype(np.complex128), before, after, arm, own, scale)


def _extent(p: ComplexArray, weights: FloatArray) -> float:
    """Size of a drawing as its mean distance from its middle: unlike a bounding box the same at every turn."""
    q = p - p @ weights
    return float(np.sqrt((q.real**2 + q.imag**2) @ weights))


def _similarity(a: ComplexArray, b: ComplexArray, weights: FloatArray) -> tuple[complex, float]:
    """Rotation and scale, as one complex number, that carry `a` onto `b`; and how well, 0 to 1.

    The scale is that of the extents and not the least-squares one, so that exchanging the keyframes inverts it.
    """
    p, q = a - a @ weights, b - b @ weights
    pp, qq = float(weights @ np.abs(p) ** 2), float(weights @ np.abs(q) ** 2)
    pq = complex((np.conj(p) * q) @ weights)
    if abs(pq) ** 2 <= 1e-12 * pp * qq:
        return 1.0, 0.0
    return pq / abs(pq) * np.sqrt(qq / pp), (abs(pq) ** 2 / (pp * qq)) ** 4


def _arm(shift: complex, similarity: complex) -> complex:
    """Vector to the fixed point of the similarity from a point that it moves by `shift`; 0 where there is none."""
    off = 1 - similarity
    return shift * off.conjugate() / (abs(off) ** 2 + 1e-12)


def _nearness(distance: float, extent: float) -> float:
    """1 for a centre of rotation inside the drawing or close by, falling smoothly to 0 for a far one."""
    x = np.clip((distance / (extent or 1.0) - NEAR) / (FAR - NEAR), 0.0, 1.0)
    return float(1 - x * x * (3 - 2 * x))
