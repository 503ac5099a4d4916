"""Which candidate a person would choose: little bending of the parts, and no needless turn of the whole."""

from dataclasses import dataclass

import numpy as np

from core.correspondence.cost import Grid
from core.correspondence.frames import Frames, frames
from core.correspondence.ring import ComplexArray, Ring
from core.correspondence.track import Knots, Track, spread
from core.geometry.outline import FloatArray

TANGENTS = 0.2
TURN = 0.05
TURN_OF_POOR_FIT = 4.0
"""A poor fit is no evidence for a big turn."""

STILL = 2e-3
"""Added to the misfit before it weighs the turn: where all fits are good, the one that turns least is wanted."""

FLOOR = 2e-4
"""Below this a residual is sampling, not shape; else noise would choose among the turns of a square."""


@dataclass(frozen=True)
class Verdict:
    """What a candidate costs, relative to the squared radius of the shapes; 0 is a rigid motion without a turn.

    Attributes
    ----------
    stretch : float
        What the local rigid frames leave: parts that grow, shrink or shear.
    bend : float
        Directions that the frames leave.
    turn : float
        The penalty on turning the whole.
    """

    stretch: float
    bend: float
    turn: float

    @property
    def cost(self) -> float:
        """The sum; the least is the answer."""
        return self.stretch + self.bend + self.turn

    def scaled(self, factor: float) -> "Verdict":
        """The same verdict, so many times worse."""
        return Verdict(factor * self.stretch, factor * self.bend, factor * self.turn)


def judged(before: Ring, after: Ring, tracks: list[Track], knots: Knots, nodes: int = 64) -> list[Verdict]:
    """Return the verdict on every track.

    The penalty on turning multiplies the misfit, so it decides between equals: a letter that fits as well upside
    down is left upright, whereas a limb that fits only when it is turned is turned.
    """
    g = spread(before, after, tracks, knots, nodes)
    f = frames(g)
    columns = zip(f.residuals[-1], TANGENTS * _tangents_left(g, f), f.whole_turn, strict=True)
    return [verdict(float(stretch), float(bend), float(turn)) for stretch, bend, turn in columns]


def verdict(stretch: float, bend: float, whole_turn: float) -> Verdict:
    """Return the verdict on a misfit and a turn of the whole (radians)."""
    stretch, bend = stretch + FLOOR / 2, bend + FLOOR / 2
    fit = stretch + bend
    return Verdict(stretch, bend, (fit + STILL) * (TURN + TURN_OF_POOR_FIT * fit) * whole_turn**2)


def _tangents_left(g: Grid, f: Frames) -> FloatArray:
    """Mean of 1 - cos between the tangents of after and the turned ones of before."""
    p, q = _edges(f.z, g.closed), _edges(f.y, g.closed)
    e = f.headings[-1][:, : p.shape[1]]
    alike = (np.conj(p * e) * q).real
    size = np.abs(p) * np.abs(q)
    cosines = np.divide(alike, size, out=np.ones_like(alike), where=size > 0)
    weights = np.diff(g.u, axis=1) + np.diff(g.v, axis=1)
    return np.asarray(((1 - cosines) * weights).sum(axis=1) / weights.sum(axis=1))


def _edges(z: ComplexArray, closed: bool) -> ComplexArray:
    return np.roll(z, -1, axis=1) - z if closed else np.diff(z, axis=1)
