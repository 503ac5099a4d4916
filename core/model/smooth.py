"""Smooth keyframes: vertices go through them without a jump in their velocity.

Every span has its own method and its own vertices, so nothing is known of its neighbour. What they share is the
drawing of the keyframe between them. Both velocities are asked for along its outlines, one velocity is agreed
on, and each span is bent by a cubic that has the difference as its velocity at that end and nothing at the other.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.model.drawing import Drawing
from core.model.inbetweens import Link, SpanPlan

STEEPEST = 3.0
"""The largest slope of an easing at a smooth keyframe; a monotone cubic needs no more (Fritsch, Carlson 1980)."""

STEP = 1e-3
"""Of the one-sided differences in t; small enough to lie within one step of a repaired path."""

FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12
"""Weights of f(0), f(h) ... f(4 h) for h f'(0), exact to the fourth order."""

Velocities = Mapping[int, FloatArray]
"""Of the vertices of a keyframe's outlines, by the outline's id: (n, 2), px a frame."""


@dataclass(frozen=True, slots=True, eq=False)
class Bend:
    """What is added to a span so that it starts, or ends, with other velocities.

    Attributes
    ----------
    first, last : tuple of (k, 2) float array, or None
        For every link the velocity to be added at the keyframe before, and at the one after, in px a span.
    """

    first: tuple[FloatArray, ...] | None = None
    last: tuple[FloatArray, ...] | None = None

    @property
    def is_empty(self) -> bool:
        """Whether nothing is added at all."""
        return self.first is None and self.last is None

    def offsets(self, ratio: FloatArray, link: int) -> FloatArray:
        """Return what to add to the vertices of a link, (T, k, 2) px, at the ratios (T,)."""
        u = ratio[:, None, None]
        total: FloatArray = np.zeros((len(ratio), 1, 2))
        if self.first is not None:
            total = total + u * (1 - u) ** 2 * self.first[link]
        if self.last is not None:
            total = total + u * u * (u - 1) * self.last[link]
        return total


def end_velocities(plan: SpanPlan, slope: float, length: int, *, last: bool) -> tuple[FloatArray, ...]:
    """Return the velocity of every link's vertices at one end of a span, (k, 2) px a frame.

    Parameters
    ----------
    plan : SpanPlan
    slope : float
        dt / dratio of the easing at that end.
    length : int
        Frames of the span.
    last : bool
        Whether the end at the keyframe after is meant.
    """
    if slope == 0:
        return tuple(np.zeros_like(link.aligned.left) for link in plan.links)
    times = np.arange(5) * STEP
    frames = plan.frames((1 - times if last else times).tolist())
    scale = slope / length / STEP * (-1 if last else 1)
    return tuple(np.tensordot(FORWARD, f, axes=1) * scale for f in frames)


def along_outlines(
    links: Sequence[Link], found: Sequence[FloatArray], drawing: Drawing, *, last: bool
) -> dict[int, FloatArray]:
    """Return the velocities that links have at the own vertices of a keyframe's outlines, by the outline's id."""
    result = {}
    for link, velocity in zip(links, found, strict=True):
        outline_id = link.after if last else link.before
        if outline_id is not None:
            outline = drawing.outline(outline_id)
            positions = link.after_positions if last else link.before_positions
            own = np.arange(len(outline.points), dtype=np.float64)
            result[outline_id] = _between(own, positions, velocity, len(outline.points), closed=outline.closed)
    return result


def agreed(left: Velocities, right: Velocities) -> dict[int, FloatArray]:
    """Return the velocity that both sides take: the harmonic mean, and none where one of them turns back.

    For two vectors (|r| l + |l| r) / (|l| + |r|): along a line the slope of Fritsch and Butland's monotone cubic,
    which never overshoots; it depends on no axes.
    """
    result = {}
    for outline_id in left.keys() & right.keys():
        a, b = left[outline_id], right[outline_id]
        fast_a, fast_b = (np.linalg.norm(v, axis=1, keepdims=True) for v in (a, b))
        both = fast_a + fast_b
        result[outline_id] = (fast_b * a + fast_a * b) / np.where(both > 0, both, 1.0)
    return result


def missing(
    links: Sequence[Link],
    found: Sequence[FloatArray],
    wanted: Velocities,
    drawing: Drawing,
    length: int,
    *,
    last: bool,
) -> tuple[FloatArray, ...]:
    """Return what links lack of the wanted velocities, in px a span: the entries of a Bend.

    Between two vertices of the keyframe the wanted velocity is linear, so that both spans move the edge alike,
    whatever vertices they have on it.
    """
    result = []
    for link, velocity in zip(links, found, strict=True):
        outline_id = link.after if last else link.before
        if outline_id is None or outline_id not in wanted:
            result.append(np.zeros_like(velocity))
            continue
        outline = drawing.outline(outline_id)
        positions = link.after_positions if last else link.before_positions
        own = np.arange(len(outline.points), dtype=np.float64)
        there = _between(positions, own, wanted[outline_id], len(own), closed=outline.closed)
        result.append((there - velocity) * length)
    return tuple(result)


def _between(at: FloatArray, positions: FloatArray, values: FloatArray, count: int, *, closed: bool) -> FloatArray:
    """Return values (k, 2) given at positions of an outline of `count` vertices, linear in between."""
    period = count if closed else None
    if not closed:
        order = np.argsort(positions, kind="stable")
        positions, values = positions[order], values[order]
    columns = [np.interp(at, positions, values[:, axis], period=period) for axis in (0, 1)]
    return np.stack(columns, axis=1)
