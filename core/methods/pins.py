"""Pins: points of a drawing whose way the artist has drawn; the rest is solved round them.

A pin is a weighted mean of vertices, so that it is a linear condition on every frame. It is met in three steps:
the frame is turned and shifted onto its pins; a rigid interior is joined again with the pins as conditions; and
what is left is spread over the drawing by a smooth field.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from core.errors import GeometryError
from core.geometry.outline import FloatArray
from core.methods.headings import ComplexArray

CHORDS = 256
"""Pieces in which the length of an arc is measured."""

REACH = 0.25
"""Distance over which the smooth field is rounded at a pin, in sizes of the drawing."""

REFINEMENTS = 2
"""Times that the rounding left by a solution is solved for again."""

Point = tuple[float, float]


@dataclass(frozen=True)
class OnOutline:
    """A point on an outline of a plan: which outline, and its position (vertex number plus share of the edge)."""

    outline: int
    position: float


@dataclass(frozen=True)
class Inside:
    """A point inside a drawing, by its place in the keyframe before, px; outside, the nearest vertex is meant."""

    x: float
    y: float


@dataclass(frozen=True)
class Pin:
    """A point whose way is given, in every frame exactly.

    Attributes
    ----------
    place : OnOutline or Inside
    handles : pair of (x, y), optional
        Of the cubic Bezier arc from its place in the keyframe before to that after, px. The arc is run through
        evenly, so that the easing alone times it. Without handles the way is straight, and a point that both
        keyframes have at the same place is held still.
    """

    place: OnOutline | Inside
    handles: tuple[Point, Point] | None = None


@dataclass(frozen=True, eq=False)
class Held:
    """The pins of a drawing, ready for its frames.

    Attributes
    ----------
    weights : (k, n) float array
        The vertices of which each pin is the mean; each row has the sum 1.
    corners : (k, 4) complex array
        Ends and handles of the ways.
    lengths : (k, CHORDS + 1) float array
        Share of the length of each way up to even steps of its parameter; 0 to 1.
    """

    weights: FloatArray
    corners: ComplexArray
    lengths: FloatArray

    def wanted(self, t: FloatArray) -> ComplexArray:
        """Where the pins must be at the times `t` (T,), as (T, k); before 0 and after 1 straight on."""
        even = np.linspace(0, 1, CHORDS + 1)
        inside = np.clip(t, 0.0, 1.0)
        out = np.zeros((len(t), len(self.corners)), np.complex128)
        for k, (corners, lengths) in enumerate(zip(self.corners, self.lengths, strict=True)):
            way = _bezier(corners, np.interp(inside, lengths, even))
            first, last = (corners[1] - corners[0], corners[3] - corners[2])
            speed = _length(corners)
            out[:, k] = way + speed * (np.minimum(t, 0) * _unit(first) + np.maximum(t - 1, 0) * _unit(last))
        return out

    def at(self, frames: ComplexArray) -> ComplexArray:
        """Where the pins are in `frames` (T, n), as (T, k)."""
        return np.asarray(frames @ self.weights.T, np.complex128)


class Paths(Protocol):
    """The paths of all vertices of a drawing."""

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2) in px."""


class Bending(Protocol):
    """Paths that can be bent by the method's own means."""

    def near(self, t: FloatArray, frames: ComplexArray, wanted: ComplexArray) -> ComplexArray:
        """Return `frames` (T, n) bent so that the pins are nearer to where they are wanted (T, k)."""


@dataclass(frozen=True, eq=False)
class PinnedPaths:
    """The paths of a method, led through the pins.

    Attributes
    ----------
    free : Paths
    held : Held
    bending : Bending, optional
        How the method itself bends towards pins.
    """

    free: Paths
    held: Held
    bending: Bending | None = None

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2) in px."""
        points = self.free.evaluate(t)
        frames = points[..., 0] + 1j * points[..., 1]
        wanted = self.held.wanted(t)
        turn, shift = _onto(self.held.at(frames), wanted)
        if self.bending is not None and len(self.held.corners) > 1:
            # the method bends its own frame, so the pins are brought to it and not it to the pins
            frames = self.bending.near(t, frames, (wanted - shift) / turn)
        frames = spread(frames * turn + shift, self.held, wanted)
        return np.stack([frames.real, frames.imag], axis=-1)


def hold(pins: Sequence[Pin], outlines: Sequence[tuple[FloatArray, FloatArray, bool]]) -> Held:
    """Return the pins of a drawing with the outlines (left (n, 2), right (n, 2), closed), ready for its frames.

    Raises
    ------
    GeometryError
        If a pin is on an outline that is not there, or a number is not finite.
    """
    if not outlines:
        raise GeometryError("a drawing without outlines has no place for a pin")
    a, b = (np.concatenate([pair[side] for pair in outlines]) @ np.array([1, 1j]) for side in (0, 1))
    weights = np.stack([_weights(k, pin, outlines, a) for k, pin in enumerate(pins)])
    first, last = weights @ a, weights @ b
    ways = []
    for k, pin in enumerate(pins):
        third = (last[k] - first[k]) / 3
        handles = [first[k] + third, last[k] - third]
        if pin.handles is not None:
            handles = [complex(x, y) for x, y in pin.handles]
        ways.append([first[k], *handles, last[k]])
    corners = np.array(ways, np.complex128)
    if not np.isfinite(corners).all():
        raise GeometryError(f"a handle of pin {int(np.isfinite(corners).all(axis=1).argmin())} is not finite")
    return Held(weights, corners, np.stack([_shares(c) for c in corners]))


def spread(frames: ComplexArray, held: Held, wanted: ComplexArray) -> ComplexArray:
    """Return `frames` (T, n) moved by a smooth field that brings the pins where they are `wanted` (T, k).

    Notes
    -----
    Multiquadrics round the pins and a shift (Hardy 1971): a field without kinks whatever the number of pins, and 0
    where nothing is missing. The conditions are on the weighted means themselves, hence exact.
    """
    missing = wanted - held.at(frames)
    if not missing.any():
        return frames
    count = missing.shape[1]
    at = held.at(frames)
    size = np.maximum(np.abs(frames - frames.mean(axis=1, keepdims=True)).max(axis=1), 1e-300)
    offset = np.abs(frames[:, :, None] - at[:, None, :]) / size[:, None, None]
    field = -np.hypot(offset, REACH)
    matrix = np.ones((len(frames), count + 1, count + 1))
    matrix[:, :count, :count] = held.weights @ field
    matrix[:, count, count] = 0.0
    back = np.linalg.pinv(matrix, rcond=1e-14)
    for _ in range(REFINEMENTS):
        right = np.concatenate([missing, np.zeros((len(frames), 1))], axis=1)
        share = (back @ right[:, :, None])[:, :, 0]
        frames = frames + (field @ share[:, :count, None])[:, :, 0] + share[:, count:]
        missing = wanted - held.at(frames)
    return frames


def _onto(at: ComplexArray, wanted: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Turn and shift, as (T, 1) complex numbers, that bring `at` (T, k) nearest to `wanted`."""
    p, q = (x - x.mean(axis=1, keepdims=True) for x in (at, wanted))
    # a little is added, so that pins that pass through each other turn nothing over at once
    both = (p.conj() * q).sum(axis=1) + 1e-3 * (np.abs(p) ** 2).sum(axis=1)
    turn = np.where(np.abs(both) > 0, both / np.maximum(np.abs(both), 1e-300), 1.0)[:, None]
    return turn, wanted.mean(axis=1, keepdims=True) - turn * at.mean(axis=1, keepdims=True)


def _weights(
    k: int, pin: Pin, outlines: Sequence[tuple[FloatArray, FloatArray, bool]], a: ComplexArray
) -> FloatArray:
    """Weights (n,) of the vertices of all outlines of which a pin is the mean."""
    stops = np.cumsum([len(left) for left, _, _ in outlines])
    if isinstance(pin.place, Inside):
        return _inner_weights(k, complex(pin.place.x, pin.place.y), outlines, a)
    number, position = pin.place.outline, float(pin.place.position)
    if not 0 <= number < len(outlines):
        raise GeometryError(f"pin {k} is on outline {number}; the drawing has {len(outlines)}")
    n, closed = len(outlines[number][0]), outlines[number][2]
    if not np.isfinite(position):
        raise GeometryError(f"the position of pin {k} is not a finite number")
    position = position % n if closed else min(max(position, 0.0), n - 1.0)
    i = int(position) % n
    weights = np.zeros(len(a))
    start = int(stops[number]) - n
    weights[start + i] += 1 - position % 1
    weights[start + (i + 1) % n] += position % 1
    return weights


def _inner_weights(
    k: int, x: complex, outlines: Sequence[tuple[FloatArray, FloatArray, bool]], a: ComplexArray
) -> FloatArray:
    """Mean value coordinates (Floater 2003) in the smallest outline round x; outside, the nearest vertex."""
    if not np.isfinite(x):
        raise GeometryError(f"the place of pin {k} is not a finite number")
    weights = np.zeros(len(a))
    best, least = None, np.inf
    start = 0
    for left, _, closed in outlines:
        d = a[start : start + len(left)] - x
        area = abs(float((d.conj() * np.roll(d, -1)).imag.sum()))
        turning = np.angle(np.roll(d, -1) * d.conj()).sum()
        if closed and abs(turning) > np.pi and area < least and np.abs(d).min() > 0:
            best, least = (start, d), area
        start += len(left)
    if best is None:
        weights[int(np.abs(a - x).argmin())] = 1.0
        return weights
    start, d = best
    half = np.tan(np.angle(np.roll(d, -1) * d.conj()) / 2)
    own = (half + np.roll(half, 1)) / np.abs(d)
    if not np.isfinite(own).all() or abs(own.sum()) < 1e-12 * np.abs(own).sum() or np.abs(half).max() > 1e9:
        weights[int(np.abs(a - x).argmin())] = 1.0
        return weights
    weights[start : start + len(d)] = own / own.sum()
    return weights


def _bezier(corners: ComplexArray, s: FloatArray) -> ComplexArray:
    r = 1 - s
    a, b, c, d = corners
    return np.asarray(r**3 * a + 3 * r * r * s * b + 3 * r * s * s * c + s**3 * d, np.complex128)


def _shares(corners: ComplexArray) -> FloatArray:
    """Share of the length up to even steps of the parameter; even ones where the way has no length."""
    even = np.linspace(0, 1, CHORDS + 1)
    steps = np.abs(np.diff(_bezier(corners, even)))
    whole = float(steps.sum())
    if whole <= 1e-12 * float(np.abs(corners).max()):
        return even
    shares = np.concatenate([[0.0], np.cumsum(steps)]) / whole
    shares[-1] = 1.0
    return np.asarray(shares, np.float64)


def _length(corners: ComplexArray) -> float:
    return float(np.abs(np.diff(_bezier(corners, np.linspace(0, 1, CHORDS + 1)))).sum())


def _unit(z: complex) -> complex:
    return z / abs(z) if z != 0 else 0.0
