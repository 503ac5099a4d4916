"""Easing: from the linear ratio in a span to the t of its in-betweens."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from core.errors import DocumentError
from core.geometry.outline import FloatArray

LOWEST, HIGHEST = -4.0, 5.0
MOST_KNOTS = 1000

UPRIGHT = 1e-12
"""A handle that is no farther than this from the upright stands upright."""


class Knot(NamedTuple):
    """A point that the curve goes through between its ends, with the handle on either side.

    `x` is a ratio and `y` a t; `in_x, in_y` is the handle towards the knot before, `out_x, out_y` the one towards
    the knot after, all as places, not as distances from the knot.
    """

    x: float
    y: float
    in_x: float
    in_y: float
    out_x: float
    out_y: float


@dataclass(frozen=True, slots=True)
class Easing:
    """A chain of cubic Bezier curves from (0, 0) to (1, 1) over the ratio; mostly a single one, as in CSS.

    Attributes
    ----------
    x1, y1 : float
        The handle of the first end; x in [0, 1], y in [-4, 5] so that t may overshoot.
    x2, y2 : float
        The handle of the last end, in the same ranges.
    knots : tuple of Knot
        Points in between, ratios strictly rising within (0, 1). Each piece's handles lie within the ratios of the
        piece, so that every ratio has one t.
    """

    x1: float = 0.0
    y1: float = 0.0
    x2: float = 1.0
    y2: float = 1.0
    knots: tuple[Knot, ...] = ()

    def __post_init__(self) -> None:
        if len(self.knots) > MOST_KNOTS:
            raise DocumentError(f"an easing of {len(self.knots)} knots; the limit is {MOST_KNOTS}")
        if not (0 <= self.x1 <= 1 and 0 <= self.x2 <= 1):
            raise DocumentError(f"the easing's handles are at ratios {self.x1} and {self.x2}; they must be 0 to 1")
        if not all(LOWEST <= y <= HIGHEST for y in self._heights()):
            raise DocumentError(f"the easing's handles are at t {self.y1} and {self.y2}; they must be -4 to 5")
        for x0, x1, x2, x3 in self.pieces()[:, :, 0] if self.knots else ():
            if not (x0 < x3 and x0 <= x1 <= x3 and x0 <= x2 <= x3):
                raise DocumentError(f"the easing's handles between ratios {x0:g} and {x3:g} reach beyond them")

    def _heights(self) -> tuple[float, ...]:
        inside = (y for k in self.knots for y in (k.y, k.in_y, k.out_y))
        return self.y1, self.y2, *inside

    def pieces(self) -> FloatArray:
        """Return the k + 1 pieces as (k + 1, 4, 2): each one's start, its two handles and its end."""
        starts = [(0.0, 0.0, self.x1, self.y1), *((k.x, k.y, k.out_x, k.out_y) for k in self.knots)]
        ends = [*((k.in_x, k.in_y, k.x, k.y) for k in self.knots), (self.x2, self.y2, 1.0, 1.0)]
        return np.array([s + e for s, e in zip(starts, ends, strict=True)]).reshape(-1, 4, 2)

    @property
    def is_linear(self) -> bool:
        """Whether t is the ratio itself."""
        return not self.knots and self.x1 == self.y1 and self.x2 == self.y2

    def t_at(self, ratio: npt.ArrayLike) -> FloatArray:
        """Return t for every ratio in [0, 1]; exactly 0 at 0, 1 at 1, and the knot's t at a knot.

        Bisection on the curve's x, which rises: 52 halvings reach the last bit, and no handle makes it diverge.
        """
        r = np.asarray(ratio, dtype=np.float64)
        if self.is_linear:
            return r.copy()
        pieces = self.pieces()
        piece = np.clip(np.searchsorted(pieces[:, 0, 0], r, side="right") - 1, 0, len(pieces) - 1)
        x, y = np.moveaxis(pieces[piece], (-1, -2), (0, 1))
        low, high = np.zeros_like(r), np.ones_like(r)
        for _ in range(52):
            middle = (low + high) / 2
            below = _bezier(x, middle) < r
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        t = _bezier(y, (low + high) / 2)
        return np.where(r <= x[0], y[0], np.where(r >= x[3], y[3], t))

    def slopes(self) -> tuple[float, float]:
        """Return dt / dratio at the two ends; infinite where a handle stands upright."""
        pieces = self.pieces()
        return _slope(pieces[0]), _slope(1 - pieces[-1][::-1])

    def gentle(self, steepest: float, *, first: bool, last: bool) -> "Easing":
        """Return an easing at most as steep as `steepest` at the named ends: handles lean over just so far."""
        gentle = self
        for _ in range(2):  # an end without a handle of its own is as steep as the other end's handle makes it
            if last and abs(gentle.slopes()[1]) > steepest:
                x, y = _leaning(1 - gentle.pieces()[-1][::-1], steepest)
                gentle = replace(gentle, x2=1 - x, y2=1 - y)
            if first and abs(gentle.slopes()[0]) > steepest:
                x, y = _leaning(gentle.pieces()[0], steepest)
                gentle = replace(gentle, x1=x, y1=y)
        return gentle

    def cut(self, ratio: float) -> "tuple[Easing, Easing] | None":
        """Return the two easings that run as this one does before and behind a ratio, each from 0 to 1 again.

        None where t is not strictly between 0 and 1 there, or a part would leave the range of an easing.
        """
        pieces = self.pieces()
        i = int(np.clip(np.searchsorted(pieces[:, 0, 0], ratio, side="right") - 1, 0, len(pieces) - 1))
        left, right = split(pieces[i], ratio)
        middle = left[3]
        if not (0 < middle[0] < 1 and 1e-6 < middle[1] < 1 - 1e-6):
            return None
        try:
            return (
                chained([p / middle for p in (*pieces[:i], left)]),
                chained([(p - middle) / (1 - middle) for p in (right, *pieces[i + 1 :])]),
            )
        except DocumentError:
            return None


def _bezier(ends: FloatArray, u: FloatArray) -> FloatArray:
    """Return the value at `u` (...) of the curve with the control values `ends` (4, ...)."""
    v = 1 - u
    result: FloatArray = (
        v * v * v * ends[0] + 3 * v * v * u * ends[1] + 3 * v * u * u * ends[2] + u * u * u * ends[3]
    )
    return result


def split(piece: FloatArray, x: float) -> tuple[FloatArray, FloatArray]:
    """Cut a piece at a ratio."""
    low, high = 0.0, 1.0
    for _ in range(52):
        u = (low + high) / 2
        low, high = (u, high) if _bezier(piece[:, 0], np.array(u)) < x else (low, u)
    return _halved(piece, (low + high) / 2)


def _halved(piece: FloatArray, u: float = 0.5) -> tuple[FloatArray, FloatArray]:
    """Cut a piece at its parameter `u`, after de Casteljau."""
    rows = [piece]
    for _ in range(3):
        rows.append((1 - u) * rows[-1][:-1] + u * rows[-1][1:])
    return np.stack([r[0] for r in rows]), np.stack([r[-1] for r in rows[::-1]])


def _tamed(piece: FloatArray, depth: int = 6) -> list[FloatArray]:
    """Cut a piece until the handles of each part lie within its ratios; near the upright they are moved there."""
    x0, x1, x2, x3 = piece[:, 0]
    if depth == 0 or min(x1 - x0, x3 - x1, x2 - x0, x3 - x2) >= -UPRIGHT:
        tame = piece.copy()
        tame[1:3, 0] = np.clip(piece[1:3, 0], x0, x3)
        return [tame]
    return [part for half in _halved(piece) for part in _tamed(half, depth - 1)]


def chained(pieces: Sequence[FloatArray]) -> Easing:
    """Return the easing of pieces that join from (0, 0) to (1, 1)."""
    tame = [part for piece in pieces for part in _tamed(piece)]
    knots = tuple(Knot(*map(float, (*b[0], *a[2], *b[1]))) for a, b in pairwise(tame))
    ends = np.clip([tame[0][1, 0], tame[-1][2, 0]], 0, 1).tolist()
    return Easing(ends[0], float(tame[0][1, 1]), ends[1], float(tame[-1][2, 1]), knots)


def _slope(piece: FloatArray) -> float:
    """Return the slope at the start of a piece: towards the first of its points that is not the start."""
    for dx, dy in piece[1:] - piece[0]:
        if max(abs(dx), abs(dy)) > UPRIGHT:
            return float(dy / dx) if dx > UPRIGHT else float(np.copysign(np.inf, dy))
    return 0.0


def _leaning(piece: FloatArray, steepest: float) -> tuple[float, float]:
    """Return where the first handle of a piece that is too steep at its start, (0, 0), has to be."""
    y, end = float(piece[1, 1]), float(piece[3, 0])
    if abs(y) <= UPRIGHT:  # no handle: the next point is what is too steep
        return end / 10, float(np.copysign(steepest * end / 10, piece[2, 1] or piece[3, 1]))
    x = min(abs(y) / steepest, end)
    return x, float(np.copysign(min(abs(y), steepest * x), y))


def through(points: Sequence[tuple[float, float]]) -> Easing:
    """Return the monotone curve through points, without overshoot between them.

    Parameters
    ----------
    points : sequence of (ratio, t)
        Ratios strictly rising within (0, 1); (0, 0) and (1, 1) are added.

    Notes
    -----
    Slopes after Fritsch and Butland 1984 (a weighted harmonic mean, 0 at a turning point), handles at a third.
    """
    at = np.array([(0.0, 0.0), *points, (1.0, 1.0)])
    dx, dy = np.diff(at, axis=0).T
    slope = dy / dx
    m = np.concatenate([slope[:1], _butland(dx, slope), slope[-1:]])
    handle = np.concatenate([dx[:1], dx]), np.concatenate([dx, dx[-1:]])
    before = at - np.stack([handle[0], handle[0] * m], axis=1) / 3
    behind = at + np.stack([handle[1], handle[1] * m], axis=1) / 3
    knots = tuple(
        Knot(*(float(z) for z in (*p, *a, *b)))
        for p, a, b in zip(at[1:-1], before[1:-1], behind[1:-1], strict=True)
    )
    (x1, y1), (x2, y2) = behind[0].tolist(), before[-1].tolist()
    return Easing(x1, y1, x2, y2, knots)


def _butland(dx: FloatArray, slope: FloatArray) -> FloatArray:
    left, right = slope[:-1], slope[1:]
    wide = 2 * dx[1:] + dx[:-1], dx[1:] + 2 * dx[:-1]
    same = left * right > 0
    divisor = np.where(same, wide[0] * right + wide[1] * left, 1.0)
    return np.where(same, (wide[0] + wide[1]) * left * right / divisor, 0.0)


def _bounces(heights: Sequence[float]) -> Easing:
    """Return a ball's fall from 0 to 1 and its bounces up to `heights`, each as long as its height asks for.

    Every half bounce is a parabola, which a cubic with handles at a third of its time is exactly.
    """
    times = np.array([1.0, *(2 * np.sqrt(heights))])
    landings = (np.cumsum(times) / times.sum()).tolist()
    knots = []
    coming = landings[0] * 2 / 3, 1 / 3
    for height, landing, end in zip(heights, landings, landings[1:], strict=False):
        top, third = (landing + end) / 2, (end - landing) / 6
        steep = 1 - height * 2 / 3
        knots.append(Knot(landing, 1.0, *coming, landing + third, steep))
        knots.append(Knot(top, 1 - height, top - third, 1 - height, top + third, 1 - height))
        coming = end - third, steep
    return Easing(landings[0] / 3, 0.0, *coming, tuple(knots))


PRESETS: dict[str, Easing] = {
    "linear": Easing(),
    "slow in and out": Easing(0.42, 0.0, 0.58, 1.0),
    "slow out": Easing(0.42, 0.0, 1.0, 1.0),
    "slow in": Easing(0.0, 0.0, 0.58, 1.0),
    "anticipation": Easing(0.36, -0.4, 0.6, 1.0),
    "overshoot": Easing(0.4, 0.0, 0.64, 1.4),
    "bounce": _bounces((0.25, 0.0625)),
}
"""By animators' words: slow out leaves the keyframe before slowly, slow in arrives slowly at the one after."""


def preset_name(easing: Easing) -> str | None:
    """Return the name of the preset that `easing` equals, or None for a curve of its own."""
    return next((name for name, preset in PRESETS.items() if preset == easing), None)
