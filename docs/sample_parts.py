"""How the samples' shapes are made: smooth curves through knots, bent limbs, vertices set along them."""

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from core.geometry.outline import FloatArray
from core.model import edits
from core.model.document import Anchor, Document
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS, Easing

STEPS = 24
"""Points of the smooth curve between two knots."""


class Knot(NamedTuple):
    """A point that the drawn curve runs through; marked ones become vertices, so that anchors can sit on them."""

    x: float
    y: float
    mark: str = ""
    corner: bool = False


class Curve(NamedTuple):
    """A dense closed curve, and where on it the marks are."""

    points: FloatArray
    marks: dict[str, int]

    def mapped(self, change: Callable[[FloatArray], FloatArray]) -> "Curve":
        """Return the curve with every point moved."""
        return Curve(change(self.points), self.marks)


class Vertices(NamedTuple):
    """An outline ready to be drawn, and the positions of its marks."""

    points: FloatArray
    marks: dict[str, int]


class Joint(NamedTuple):
    """A place along the bone that bends: over `length` px round `at`."""

    at: float
    length: float


def smooth(knots: Sequence[Knot]) -> Curve:
    """Lay a closed Catmull-Rom curve through the knots; at a corner the tangent breaks."""
    p = np.array([k[:2] for k in knots], dtype=np.float64)
    u = np.arange(STEPS)[:, None] / STEPS
    parts = []
    for i, knot in enumerate(knots):
        a, b, c, d = p[i - 1], p[i], p[(i + 1) % len(p)], p[(i + 2) % len(p)]
        straight = c - b
        out = straight if knot.corner else _tangent(a, b, c)
        into = straight if knots[(i + 1) % len(p)].corner else _tangent(b, c, d)
        scale = np.hypot(*straight)
        m, n = out / np.hypot(*out) * scale, into / np.hypot(*into) * scale
        parts.append(
            (1 + 2 * u) * (1 - u) ** 2 * b + u * (1 - u) ** 2 * m + u**2 * (3 - 2 * u) * c - u**2 * (1 - u) * n
        )
    return Curve(np.concatenate(parts), {k.mark: i * STEPS for i, k in enumerate(knots) if k.mark})


def _tangent(a: FloatArray, b: FloatArray, c: FloatArray) -> FloatArray:
    """Direction at `b` of the circle through three points: round also where a short step follows a long one."""
    before, after = np.hypot(*(b - a)), np.hypot(*(c - b))
    tangent: FloatArray = (b - a) * after / before + (c - b) * before / after
    return tangent


def with_vertices(curve: Curve, spacing: float) -> Vertices:
    """Set vertices along a curve: on every mark, `spacing` px apart on straights, closer in turns."""
    p = curve.points
    step = np.roll(p, -1, axis=0) - p
    z = step[:, 0] + 1j * step[:, 1]
    turn = np.abs(np.angle(np.roll(z, -1) * np.conj(z)))
    weight = np.abs(z) / spacing + np.minimum(turn, 0.3) / np.radians(24)
    names, starts = zip(*sorted(curve.marks.items(), key=lambda item: item[1]), strict=True)
    chosen: list[FloatArray] = []
    marks = {}
    for name, first, last in zip(names, starts, (*starts[1:], starts[0] + len(p)), strict=True):
        marks[name] = sum(len(c) for c in chosen)
        run = np.arange(first, last + 1) % len(p)
        along = np.concatenate([[0.0], np.cumsum(weight[run[:-1]])])
        count = max(1, round(float(along[-1])))
        at = np.linspace(0, along[-1], count, endpoint=False)
        chosen.append(np.stack([np.interp(at, along, p[run, k]) for k in (0, 1)], axis=1))
    return Vertices(np.round(np.concatenate(chosen), 2) + 0.0, marks)


def bent(
    curve: Curve, root: tuple[float, float], heading: float, joints: Sequence[Joint], turns: Sequence[float]
) -> Curve:
    """Bend a stretched limb: its bone leaves `root` with `heading` and turns at every joint, all in degrees."""
    grid = np.arange(-300.0, 1500.0, 0.5)

    def heading_at(s: FloatArray) -> FloatArray:
        angle = np.full_like(s, heading)
        for joint, turn in zip(joints, turns, strict=True):
            u = np.clip((s - joint.at) / joint.length + 0.5, 0, 1)
            angle += turn * u * u * (3 - 2 * u)
        return np.radians(angle)

    a = heading_at(grid + 0.25)
    bone = np.cumsum(np.stack([np.cos(a), np.sin(a)], axis=1) * 0.5, axis=0)
    bone = np.concatenate([np.zeros((1, 2)), bone[:-1]])
    bone += np.array(root) - [np.interp(0.0, grid, bone[:, k]) for k in (0, 1)]

    def place(p: FloatArray) -> FloatArray:
        a = heading_at(p[:, 0])
        on_bone = np.stack([np.interp(p[:, 0], grid, bone[:, k]) for k in (0, 1)], axis=1)
        return on_bone + p[:, 1:] * np.stack([-np.sin(a), np.cos(a)], axis=1)

    return curve.mapped(place)


def document(
    name: str,
    keyframes: Mapping[int, Sequence[Vertices]],
    style: Style,
    *,
    easing: Easing = PRESETS["slow in and out"],
    anchors: Sequence[Sequence[str]] = (),
) -> Document:
    """Put the keyframes {frame: outlines} into a film, tied at the marks named in `anchors`, for every outline."""
    film = edits.set_layer(edits.set_length(Document(), max(keyframes)), 1, name=name)
    for frame, outlines in keyframes.items():
        drawing = Drawing(tuple(Outline(i, o.points) for i, o in enumerate(outlines, 1)), style)
        film = edits.put_drawing(film, 1, frame, drawing)
    frames = list(keyframes)
    for before, after in itertools.pairwise(frames):
        film = edits.set_span(film, 1, before, method="intrinsic", easing=easing)
        for i, marks in enumerate(anchors):
            a, b = keyframes[before][i], keyframes[after][i]
            for mark in marks:
                film = edits.add_anchor(film, 1, before, i + 1, i + 1, Anchor(a.marks[mark], b.marks[mark]))
    return film
