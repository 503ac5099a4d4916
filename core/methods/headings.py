"""How far every edge of an outline turns from one keyframe to the other, whole turns told apart.

Points and edges are complex numbers here: x + iy. An edge is *solid* in a keyframe where it has a length, and
so a direction; where vertices coincide it has none.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray

ComplexArray = npt.NDArray[np.complex128]
BoolArray = npt.NDArray[np.bool_]

TURN = 2 * np.pi

SOLID = 1e-9
"""Share of the mean length above which an edge has a direction of its own and not one made of rounding."""

TIE = 6
"""Decimals to which two turning angles are told apart; finer differences are rounding and must not decide."""


@dataclass(frozen=True, eq=False)
class Headings:
    """Lengths of corresponding edges, their heading before, and their turn from before to after.

    Attributes
    ----------
    before, after : (n,) float array
        Lengths in px.
    start : (n,) float array
        Heading in the keyframe before, radians; sensible where the edge has no length there.
    turn : (n,) float array
        Radians to add to arrive at the heading after; continuous along the outline, up to whole turns over all.
    known : bool
        Whether any edge is solid in both keyframes. If not, `turn` is 0 and says nothing.
    """

    before: FloatArray
    after: FloatArray
    start: FloatArray
    turn: FloatArray
    known: bool

    @property
    def shares(self) -> FloatArray:
        """Weight of every edge, 1 in all: mean of its shares of both perimeters. Zero when all is one point."""
        parts = [lengths / whole for lengths in (self.before, self.after) if (whole := lengths.sum()) > 0]
        shares: FloatArray = np.sum(parts, axis=0) / len(parts) if parts else np.zeros(len(self.before))
        return shares

    @property
    def perimeters(self) -> float:
        """Sum of both perimeters, px."""
        return float(self.before.sum() + self.after.sum())

    def mean_turn(self) -> float:
        """Turn of the outline as a whole: the mean over its length, independent of the start vertex."""
        return float(self.turn @ self.shares)

    def vertex_shares(self) -> FloatArray:
        """How much of the outline each vertex stands for, 1 in all: half of both edges beside it."""
        edge = self.shares
        if not edge.any():
            return np.full(len(edge), 1 / len(edge))
        shares: FloatArray = (edge + np.roll(edge, 1)) / 2
        return shares

    def turned(self, radians: float) -> "Headings":
        """Return the same edges with `radians`, a number of whole turns, added to every turn."""
        return Headings(self.before, self.after, self.start, self.turn + radians, self.known)

    def following(self, radians: float) -> "Headings":
        """Return the same edges with the whole turns added that bring the mean turn nearest to `radians`."""
        if not self.known:
            return self.carried(radians)
        return self.turned(TURN * float(np.rint((radians - self.mean_turn()) / TURN)))

    def carried(self, radians: float) -> "Headings":
        """Return edges that all turn by `radians`: for an outline that is a point in one of the keyframes."""
        turn = np.full_like(self.turn, radians)
        grown = (self.before == 0) & (self.after > 0)
        return Headings(self.before, self.after, self.start - np.where(grown, turn, 0.0), turn, True)


def joined(outlines: Sequence[Headings]) -> Headings:
    """Return the edges of all outlines of a drawing in one row."""
    before, after, start, turn = (
        np.concatenate([getattr(h, name) for h in outlines]) for name in ("before", "after", "start", "turn")
    )
    return Headings(before, after, start, turn, any(h.known for h in outlines))


def headings(a: ComplexArray, b: ComplexArray, *, closed: bool) -> Headings:
    """Return the headings of the edges from `a` (n,) to `b` (n,); the last edge of an open outline has no length.

    Notes
    -----
    The turning angles at the vertices, in (-pi, pi], are compared rather than the headings themselves, so that a
    limb that curls up by several turns uncurls the same way (Sederberg, Gao, Wang and Mu 1993). Where the
    outlines go round differently often (opposite directions), whole turns have to break somewhere: they do
    at the vertices whose turning angles differ most, which depends on no start vertex.
    """
    za, zb = _edges(a, closed), _edges(b, closed)
    before, after = np.abs(za), np.abs(zb)
    solid_a, solid_b = _solid(before, a), _solid(after, b)
    firm = solid_a & solid_b
    turn = np.zeros(len(a))
    if firm.any():
        turn = _turns(za, zb, solid_a, solid_b, np.abs(b - a), closed)
    start = np.where(solid_a, np.angle(za), np.where(solid_b, np.angle(zb) - turn, 0.0))
    return Headings(before, after, start, turn, bool(firm.any()))


def shortest(mean: float) -> float:
    """Whole turns, in radians, that bring a turn of `mean` into (-pi, pi]; a half turn, to rounding, is +pi."""
    return float(-TURN * np.ceil((mean - np.pi) / TURN - 1e-9))


def _edges(p: ComplexArray, closed: bool) -> ComplexArray:
    return np.append(p[1:], p[0] if closed else p[-1]) - p


def _solid(lengths: FloatArray, p: ComplexArray) -> BoolArray:
    noise = 8 * np.finfo(np.float64).eps * float(np.abs(p).max())
    return lengths > max(SOLID * float(lengths.mean()), noise)


def _turns(
    za: ComplexArray, zb: ComplexArray, solid_a: BoolArray, solid_b: BoolArray, travel: FloatArray, closed: bool
) -> FloatArray:
    """Turn of every edge; between the edges solid in both keyframes it is interpolated along the outline.

    So an edge that grows out of a vertex takes part in the turn of its neighbours, whatever its own direction.
    """
    i = np.flatnonzero(solid_a & solid_b)
    ha, whole_a = _unwrapped(za, solid_a)
    hb, whole_b = _unwrapped(zb, solid_b)
    difference = hb[i] - ha[i]
    steps = np.diff(difference, append=difference[0] + whole_b - whole_a)  # change of turn after each firm edge
    if closed:
        steps -= TURN * _breaks(steps, travel[(i + 1) % len(za)])
    turn: FloatArray = difference[0] + np.concatenate([[0.0], np.cumsum(steps[:-1])])
    if len(i) == len(za):
        return turn
    if closed:  # once round, the turn is the first one again
        i, turn = np.append(i, i[0] + len(za)), np.append(turn, turn[0])
    every = np.arange(len(za))
    at = np.where(every < i[0], every + len(za), every) if closed else every
    return np.asarray(np.interp(at, i, turn), np.float64)


def _unwrapped(z: ComplexArray, solid: BoolArray) -> tuple[FloatArray, float]:
    """Heading of the solid edges without jumps (the others are 0), and the turning angle once round."""
    z_solid = z[solid]
    turning = np.angle(np.roll(z_solid, -1) * np.conj(z_solid))
    out = np.zeros(len(z))
    out[solid] = np.angle(z_solid[0]) + np.concatenate([[0.0], np.cumsum(turning[:-1])])
    return out, float(turning.sum())


def _breaks(steps: FloatArray, travel: FloatArray) -> FloatArray:
    """Whole turns to take from each step so that their sum is 0: always from the step that is widest then.

    Ties (a square and its mirror image) go to the vertex that travels least, then to the first.
    """
    left = steps.copy()
    count = int(np.rint(steps.sum() / TURN))
    sign = np.sign(count)
    reach = np.round(travel / (travel.max() or 1.0), TIE)
    for _ in range(abs(count)):
        k = np.lexsort((reach, -np.round(sign * left, TIE)))[0]
        left[k] -= sign * TURN
    breaks: FloatArray = np.rint((steps - left) / TURN)
    return breaks
