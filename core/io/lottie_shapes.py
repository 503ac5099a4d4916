"""Paths of Lottie as polygons that keep their vertices while they move."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from core.errors import FileFormatError
from core.geometry.curves import ComplexArray
from core.geometry.outline import FloatArray
from core.io.lottie_values import FARTHEST, Key, numbers, share_at, vector_at

TOLERANCE = 0.25
MOST_CHORDS = 64
ROUND = 4 * (np.sqrt(2) - 1) / 3
"""Length of the handles of a quarter circle of radius 1."""


@dataclass(frozen=True, slots=True, eq=False)
class Bezier:
    """A path at one time: vertices and the handles of each, as x + iy."""

    places: ComplexArray
    into: ComplexArray
    out: ComplexArray
    closed: bool

    def curves(self) -> ComplexArray:
        """Return the control points of every curve, (k, 4)."""
        ends = np.roll(np.arange(len(self.places)), -1)
        if not self.closed:
            ends = ends[:-1]
        starts = np.arange(len(ends))
        first, last = self.places[starts], self.places[ends]
        return np.column_stack([first, first + self.out[starts], last + self.into[ends], last])


def beziers(keys: list[Key], times: Sequence[float]) -> list[Bezier]:
    """Return a path at every time; raises FileFormatError where its vertices come and go."""
    shapes = [_bezier(k.value) for k in keys]
    if len({(len(s.places), s.closed) for s in shapes}) > 1:
        raise FileFormatError("a path has other vertices in another keyframe")
    return [_between(shapes, *share_at(keys, t)) for t in times]


def _between(shapes: list[Bezier], index: int, share: float) -> Bezier:
    here = shapes[index]
    if share == 0:
        return here
    there = shapes[index + 1]

    def mixed(a: ComplexArray, b: ComplexArray) -> ComplexArray:
        return a + share * (b - a)

    places = mixed(here.places, there.places)
    return Bezier(places, mixed(here.into, there.into), mixed(here.out, there.out), here.closed)


def _bezier(value: Any) -> Bezier:
    if isinstance(value, list):
        value = value[0]
    places, into, out = (_complex(value[name]) for name in ("v", "i", "o"))
    if not len(places) == len(into) == len(out) > 0:
        raise FileFormatError("a path has not as many handles as vertices")
    return Bezier(places, into, out, bool(value.get("c", False)))


def _complex(points: Any) -> ComplexArray:
    rows = np.array([numbers(p, 2) for p in points]).reshape(-1, 2)
    if rows.size and np.abs(rows).max() > FARTHEST:
        raise FileFormatError("a path lies too far away")
    found: ComplexArray = rows[:, 0] + 1j * rows[:, 1]
    return found


def rectangle(times: Sequence[float], keys: dict[str, list[Key]]) -> list[Bezier]:
    """Return a rectangle, its corners round or not, at every time."""
    return [_rounded(*_box(keys, t), float(vector_at(keys["r"], t, 1)[0])) for t in times]


def ellipse(times: Sequence[float], keys: dict[str, list[Key]]) -> list[Bezier]:
    """Return an ellipse at every time, from its top clockwise."""
    return [_ellipse(*_box(keys, t)) for t in times]


def _box(keys: dict[str, list[Key]], time: float) -> tuple[complex, FloatArray]:
    middle, half = vector_at(keys["p"], time, 2), np.abs(vector_at(keys["s"], time, 2)) / 2
    return complex(middle[0], middle[1]), half


def _ellipse(middle: complex, half: FloatArray) -> Bezier:
    turns = np.array([-1j, 1, 1j, -1])
    places = turns.real * half[0] + 1j * turns.imag * half[1]
    along = turns * 1j * ROUND
    out = along.real * half[0] + 1j * along.imag * half[1]
    return Bezier(middle + places, -out, out, True)


def _rounded(middle: complex, half: FloatArray, radius: float) -> Bezier:
    r = min(max(radius, 0.0), float(half.min()))
    if r <= 0:
        corners = np.array([1 - 1j, 1 + 1j, -1 + 1j, -1 - 1j])
        places = middle + corners.real * half[0] + 1j * corners.imag * half[1]
        return Bezier(places, np.zeros(4, complex), np.zeros(4, complex), True)
    x, y = half
    handle = r * (1 - ROUND)
    places = np.array(
        [
            x + 1j * (r - y), x + 1j * (y - r), x - r + 1j * y, r - x + 1j * y,
            -x + 1j * (y - r), -x + 1j * (r - y), r - x - 1j * y, x - r - 1j * y,
        ]
    )  # fmt: skip
    reach = r - handle
    out = np.array([0, 1j, 0, -1, 0, -1j, 0, 1]) * reach
    into = np.array([-1j, 0, 1, 0, 1j, 0, -1, 0]) * reach
    return Bezier(middle + places, into, out, True)


def _are_straight(curves: ComplexArray) -> npt.NDArray[np.bool_]:
    """Whether each curve is a straight line at every time: its handles lie on the way from end to end."""
    chord = curves[..., 3] - curves[..., 0]
    first, last = curves[..., 1] - curves[..., 0], curves[..., 3] - curves[..., 2]
    square = np.abs(chord) ** 2
    found = np.full(chord.shape[1], True)
    for handle in (first, last):
        along, aside = (handle * chord.conj()).real, (handle * chord.conj()).imag
        found &= ((np.abs(aside) <= 1e-9 * square) & (along >= 0) & (along <= square)).all(axis=0)
    return found


def polygons(shapes: list[Bezier], scale: float) -> list[FloatArray]:
    """Return a polygon for every time, all with the same number of vertices, in the same order.

    `scale` is how much larger the path will be seen.
    """
    curves = np.stack([s.curves() for s in shapes])  # (times, curves, 4)
    bend = np.maximum(
        np.abs(curves[..., 0] - 2 * curves[..., 1] + curves[..., 2]),
        np.abs(curves[..., 1] - 2 * curves[..., 2] + curves[..., 3]),
    ).max(axis=0)
    bend[_are_straight(curves)] = 0.0
    counts = np.clip(np.ceil(np.sqrt(0.75 * bend * max(scale, 1e-9) / TOLERANCE)), 1, MOST_CHORDS).astype(int)
    parts = []
    for i, count in enumerate(counts.tolist()):
        t = np.arange(count) / count
        powers = np.stack([(1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t * t, t**3])
        parts.append(curves[:, i] @ powers)
    if not shapes[0].closed:
        parts.append(curves[:, -1, 3:])
    chain = np.concatenate(parts, axis=1)
    return [np.column_stack([row.real, row.imag]) for row in chain]
