"""Where the frames of a drawing lie: what hardly moves stays still, or the centroid goes straight."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.geometry.outline import FloatArray, contains
from core.methods.headings import TURN, ComplexArray

PLACEMENTS: tuple[str, ...] = ("still", "centroid")
"""What can decide where frames lie: see `place` and `centre`. Pins come before both."""

STILL = 0.02
"""Travel, as a share of the size of the drawing, below which a vertex counts as standing still."""

NEAR, FAR = 1.0, 4.0
"""Distances of the centre of rotation from the still part, in sizes: up to NEAR the path is an arc round
the centre, beyond FAR it is straight."""


THIN = 1e-6
"""Area, over the square of the extent, below which a drawing has no centroid of its own."""

BARE, FULL = 0.05, 0.25
"""Shares of the lesser keyframe's area: below BARE a frame's centroid is that of its outlines, from FULL on that
of its area. A frame that a method has squeezed to a line has no other."""


class Placement(Protocol):
    """Where frames lie."""

    def shift(self, frames: ComplexArray, t: FloatArray) -> ComplexArray:
        """By how much the `frames` (T, n) must be moved at the times `t` (T,), as (T,) in px."""


@dataclass(frozen=True, eq=False)
class Still:
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

    def shift(self, frames: ComplexArray, t: FloatArray) -> ComplexArray:
        """See `Placement`."""
        return np.asarray(self.path(t) - frames @ self.weights, np.complex128)

    def path(self, t: FloatArray) -> ComplexArray:
        """Where the reference point is at the times `t` (T,): the chord, bent round the centre of rotation."""
        straight = np.asarray(self.before + t * (self.after - self.before), np.complex128)
        if self.arm == 0:
            return straight
        at, end = (np.exp(1j * s * self.turn) * (1 + (self.scale - 1) * s) for s in (t, 1.0))
        bent: ComplexArray = straight + self.arm * ((1 - t) - at + t * end)
        return bent


def place(a: ComplexArray, b: ComplexArray, lengths: FloatArray, turn: float) -> Still:
    """Plan that what travels little stays still.

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
    return Still(weights.astype(np.complex128), before, after, arm, own, scale)


@dataclass(frozen=True, eq=False)
class Centroid:
    """The centroid goes straight at even speed: that of the area, as a thrown thing does.

    Attributes
    ----------
    weights : (n,) complex array
        How much of the outlines each vertex stands for; sum 1.
    filled : tuple of (slice, float)
        The closed outlines, each with 1 or -1, so that its signed area counts as it is filled. None where the
        drawing has no area in a keyframe, or is filled otherwise in the other: the outlines' centroid counts.
    ends : (2, 2) complex array
        Centroids of the outlines, and of the area, before and after, px.
    area : float
        The lesser one of the keyframes, px^2.
    """

    weights: ComplexArray
    filled: tuple[tuple[slice, float], ...]
    ends: ComplexArray
    area: float

    def shift(self, frames: ComplexArray, t: FloatArray) -> ComplexArray:
        """See `Placement`."""
        wanted = self.ends[:, :1] * (1 - t) + self.ends[:, 1:] * t
        middle = frames @ self.weights
        outline = wanted[0] - middle
        if not self.filled:
            return np.asarray(outline, np.complex128)
        area, moment = _moments(frames - middle[:, None], self.filled)
        x = np.clip((area / self.area - BARE) / (FULL - BARE), 0.0, 1.0)
        trust = x * x * (3 - 2 * x)
        inner = moment / np.where(trust > 0, area, 1.0)
        return np.asarray(outline + trust * (wanted[1] - wanted[0] - inner), np.complex128)


def centre(
    a: ComplexArray, b: ComplexArray, rows: Sequence[slice], closed: Sequence[bool], lengths: FloatArray
) -> Centroid:
    """Plan that the centroid goes straight.

    Parameters
    ----------
    a, b : (n,) complex array
        Vertices of all outlines, px.
    rows, closed
        The outlines. Those inside others are holes (even-odd).
    lengths : (n,) float array
        How much of the outlines each vertex stands for; sum 1.
    """
    weights = lengths.astype(np.complex128)
    both = np.stack([a, b])
    middles = both @ weights
    filled = _filled(a, b, [row for row, ring in zip(rows, closed, strict=True) if ring])
    areas, moments = _moments(both - middles[:, None], filled)
    least = THIN * max(_extent(a, lengths), _extent(b, lengths)) ** 2
    if not filled or areas.min() <= least:
        return Centroid(weights, (), np.stack([middles, middles]), 0.0)
    return Centroid(weights, filled, np.stack([middles, middles + moments / areas]), float(areas.min()))


def _moments(frames: ComplexArray, filled: Sequence[tuple[slice, float]]) -> tuple[FloatArray, ComplexArray]:
    """Areas (T,) of frames (T, n), and their first moments."""
    area, moment = np.zeros(len(frames)), np.zeros(len(frames), np.complex128)
    for row, sign in filled:
        p = frames[:, row]
        q = np.roll(p, -1, axis=1)
        cross = sign * (p.conj() * q).imag
        area += cross.sum(axis=1) / 2
        moment += (cross * (p + q)).sum(axis=1) / 6
    return area, moment


def _filled(a: ComplexArray, b: ComplexArray, rows: Sequence[slice]) -> tuple[tuple[slice, float], ...]:
    """Closed outlines with the sign that their area counts by; none where the keyframes do not agree on it."""
    signs = np.stack([_signs([p[row] for row in rows]) for p in (a, b)]) if rows else np.zeros((2, 0))
    if (signs[0] * signs[1] < 0).any():
        return ()
    return tuple(zip(rows, np.sign(signs.sum(axis=0)).tolist(), strict=True))


def _signs(outlines: Sequence[ComplexArray]) -> FloatArray:
    """1 or -1 for each outline, by its direction and by whether it is a hole; 0 for a point or a line."""
    points = [np.stack([p.real, p.imag], axis=1) for p in outlines]
    found = np.zeros(len(outlines))
    for k, p in enumerate(outlines):
        q = p - p.mean()
        area = float((q.conj() * np.roll(q, -1)).imag.sum() / 2)
        if abs(area) > THIN * float(np.abs(q).max()) ** 2:
            around = sum(bool(contains(o, points[k][0])[0]) for i, o in enumerate(points) if i != k)
            found[k] = np.sign(area) * (-1) ** around
    return found


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
