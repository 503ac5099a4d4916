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

FOLD = 1e-7
"""Radians: a turning angle this near a half turn, or none, has no side of its own."""

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

    def only(self, edges: BoolArray) -> "Headings":
        """Return some of the edges."""
        return Headings(self.before[edges], self.after[edges], self.start[edges], self.turn[edges], self.known)

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
    left, right = _Side.of(a, closed), _Side.of(b, closed)
    firm = left.solid & right.solid
    turn = _turns(left, right, closed) if firm.any() else np.zeros(len(a))
    start = np.where(left.solid, left.heading, np.where(right.solid, right.heading - turn, 0.0))
    return Headings(left.lengths, right.lengths, start, turn, bool(firm.any()))


def unit(angle: FloatArray) -> ComplexArray:
    """Return cos + i sin of `angle`, by the tangent of its half: a third of the time of the two themselves."""
    h = np.tan(angle / 2)
    q = 2 / (1 + h * h)
    out = np.zeros(angle.shape, dtype=np.complex128)
    out.real = q - 1
    out.imag = q * h
    return out


def shortest(mean: float) -> float:
    """Whole turns, in radians, that bring a turn of `mean` into (-pi, pi]; a half turn, to rounding, is +pi."""
    return float(-TURN * np.ceil((mean - np.pi) / TURN - 1e-9))


@dataclass(frozen=True, eq=False)
class _Side:
    """The edges of an outline in one keyframe: lengths, headings in (-pi, pi], and which of them are solid."""

    points: ComplexArray
    lengths: FloatArray
    heading: FloatArray
    solid: BoolArray

    @classmethod
    def of(cls, p: ComplexArray, closed: bool) -> "_Side":
        z = np.append(p[1:], p[0] if closed else p[-1]) - p
        lengths = np.abs(z)
        noise = 8 * np.finfo(np.float64).eps * float(np.abs(p).max())
        return cls(p, lengths, np.angle(z), lengths > max(SOLID * float(lengths.mean()), noise))

    def turnings(self) -> FloatArray:
        """Turning angle from the solid edge before to every solid edge, in (-pi, pi]; 0 at the others."""
        heading = self.heading[self.solid]
        raw = heading - np.roll(heading, 1)
        out = np.zeros(len(self.lengths))
        out[self.solid] = raw - TURN * np.ceil((raw - np.pi) / TURN)
        return out

    def unwrapped(self, turnings: FloatArray) -> FloatArray:
        """Heading of the solid edges without jumps; 0 at the others."""
        i = np.flatnonzero(self.solid)
        out = np.zeros(len(turnings))
        out[i] = self.heading[i[0]] + np.concatenate([[0.0], np.cumsum(turnings[i[1:]])])
        return out


def _turns(left: _Side, right: _Side, closed: bool) -> FloatArray:
    """Turn of every edge; between the edges solid in both keyframes it is interpolated along the outline.

    So an edge that grows out of a vertex takes part in the turn of its neighbours, whatever its own direction.
    """
    n = len(left.points)
    i = np.flatnonzero(left.solid & right.solid)
    before, after = _turning_angles(left, right)
    difference = right.unwrapped(after)[i] - left.unwrapped(before)[i]
    gained = float(after.sum() - before.sum())
    steps = np.diff(difference, append=difference[0] + gained)  # change of turn after each of these edges
    if closed:
        steps -= TURN * _breaks(steps, np.abs(right.points - left.points)[(i + 1) % n])
    turn: FloatArray = difference[0] + np.concatenate([[0.0], np.cumsum(steps[:-1])])
    if len(i) == n:
        return turn
    if closed:  # once round, the turn is the first one again
        i, turn = np.append(i, i[0] + n), np.append(turn, turn[0])
    every = np.arange(n)
    at = np.where(every < i[0], every + n, every) if closed else every
    return np.asarray(np.interp(at, i, turn), np.float64)


def _turning_angles(left: _Side, right: _Side) -> tuple[FloatArray, FloatArray]:
    """Turning angles in both keyframes, with each fold-back turning to the side that the other keyframe shows.

    A fold-back, such as the tip of a line drawn there and back, turns by +pi or by -pi as rounding will have it.
    """
    before, after = left.turnings(), right.turnings()
    if max(np.abs(before).max(), np.abs(after).max()) <= np.pi - FOLD:
        return before, after
    hand = _hand(left.points) + _hand(right.points)
    hand = -1.0 if hand < -FOLD else 1.0
    return _unfolded(before, after, hand), _unfolded(after, before, hand)


def _unfolded(turnings: FloatArray, other: FloatArray, hand: float) -> FloatArray:
    folded = np.abs(turnings) > np.pi - FOLD
    plain = (np.abs(other) > FOLD) & (np.abs(other) < np.pi - FOLD)
    return np.where(folded, np.copysign(np.pi, np.where(plain, other, hand)), turnings)


def _hand(p: ComplexArray) -> float:
    """Area that the outline goes round, from x towards y, for a size of 1: its sign is what a mirror changes."""
    q = p - p[0]
    q = q / float(np.abs(q).max())
    return float((q.real * np.roll(q.imag, -1) - q.imag * np.roll(q.real, -1)).sum())


def _breaks(steps: FloatArray, travel: FloatArray) -> FloatArray:
    """Whole turns to take from each step so that their sum is 0: one each from the widest steps.

    Ties (a square and its mirror image) go to the vertex that travels least, then to the first.
    """
    count = int(np.rint(steps.sum() / TURN))
    if count == 0:
        return np.zeros(len(steps))
    sign = np.sign(count)
    reach = np.round(travel / (travel.max() or 1.0), TIE)
    widest = np.lexsort((reach, -np.round(sign * steps, TIE)))
    places = widest[np.arange(abs(count)) % len(steps)]
    breaks: FloatArray = sign * np.bincount(places, minlength=len(steps))
    return breaks
