"""Vertices that come near edges: their distances, and how far a straight move may go before two meet.

When nothing but straight moves carries the vertices, outlines can only begin to cross where a vertex meets an edge
to which it does not belong. So a move that keeps every such pair apart carries a simple outline to a simple one.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from core.geometry.boxes import IndexArray, box_pairs_between
from core.geometry.outline import FloatArray
from core.repair.chains import BoolArray, Chains, ComplexArray, as_points

ROUNDS = 24
"""Advances of a pair before the quadratic decides."""

BOXES = 150_000
"""Vertices of several moves looked at in one go."""


@dataclass(frozen=True, eq=False)
class Pairs:
    """Vertices and edges, by their places in frames laid end to end.

    Attributes
    ----------
    frame, vertex, start, end : (k,) int arrays
        The frame, the vertex, and both ends of the edge.
    """

    frame: IndexArray
    vertex: IndexArray
    start: IndexArray
    end: IndexArray

    def __getitem__(self, rows: Any) -> "Pairs":
        return Pairs(self.frame[rows], self.vertex[rows], self.start[rows], self.end[rows])

    def of(self, values: Any) -> tuple[Any, Any, Any]:
        """Values (N,) of all vertices at the vertex, the start and the end of every pair."""
        return values[self.vertex], values[self.start], values[self.end]

    def within(self, values: Any) -> tuple[Any, Any, Any]:
        """As `of`, for values (n,) that all frames share."""
        n = len(values)
        return values[self.vertex % n], values[self.start % n], values[self.end % n]


@dataclass(frozen=True)
class Gap:
    """How near a pair may come: `share` of its distance at the start, or `floor` where that is more.

    The floor is in sizes of the drawing; a pair nearer than it, there or in a keyframe, may lose `most` of that
    distance. Without the floor a march closes gaps until rounding decides whether something crosses.
    """

    share: float
    most: float
    floor: float

    def of(self, apart: FloatArray, narrow: FloatArray) -> FloatArray:
        """Return the least distances for pairs so far `apart`, and so `narrow` at the start or in a keyframe."""
        return np.maximum(self.share * apart, np.minimum(self.most * narrow, self.floor))


STEPPING = Gap(0.1, 0.5, 1e-6)
"""For moves that may stop anywhere, against the distance at their start."""

ARRIVING = Gap(0.1, 0.5, 1e-6)
"""For moves to a known place, against the lesser of the distances at both ends, as the next."""

CERTIFYING = Gap(0.01, 0.2, 4e-7)
"""For moves that have been made: laxer, else one that only just passed would be refused later."""


def near_pairs(chains: Chains, z: ComplexArray, move: ComplexArray, reach: float) -> Pairs:
    """Return all pairs of a vertex and an edge not its own whose boxes, swept by a move, come within `reach`.

    Parameters
    ----------
    z, move : (T, n) complex array
        Frames, and where their vertices go from there.
    """
    still = move - move.mean(axis=1, keepdims=True)  # what all have in common brings nothing nearer
    p, q = as_points(z), as_points(z + still)
    low, high = np.minimum(p, q) - reach, np.maximum(p, q) + reach
    start, end = chains.edges.T
    edge_low, edge_high = np.minimum(low[:, start], low[:, end]), np.maximum(high[:, start], high[:, end])
    frame, vertex, edge = box_pairs_between(low + reach, high - reach, edge_low, edge_high)
    other = (vertex != start[edge]) & (vertex != end[edge])
    frame, vertex, edge = frame[other], vertex[other], edge[other]
    first = frame * z.shape[1]
    return Pairs(frame, first + vertex, first + start[edge], first + end[edge])


def distances(v: ComplexArray, u: ComplexArray, w: ComplexArray) -> tuple[FloatArray, FloatArray, ComplexArray]:
    """Distances from v to the edges uw, the share along the edge of the nearest point, and the vector from it."""
    along, offset = w - u, v - u
    squared = along.real**2 + along.imag**2
    share = (offset.real * along.real + offset.imag * along.imag) / np.maximum(squared, 1e-300)
    share = np.minimum(np.maximum(share, 0.0), 1.0)
    arm = offset - share * along
    return np.sqrt(arm.real**2 + arm.imag**2), share, arm


def free_share(z: ComplexArray, move: ComplexArray, pairs: Pairs) -> float:
    """Return the share of a move (n,) from z (n,) that keeps all pairs apart, 0 to 1."""
    reached, clear = _advance(z, move, None, pairs, STEPPING, None)
    return float(reached[~clear].min()) if not clear.all() else 1.0


def clear_moves(
    chains: Chains,
    starts: ComplexArray,
    ends: ComplexArray,
    bends: ComplexArray | None = None,
    gap: Gap = CERTIFYING,
) -> BoolArray:
    """Whether moves (T, n) -> (T, n) keep every vertex off every edge, as (T,).

    Parameters
    ----------
    bends : (T, n) complex array, optional
        How far the true path leaves the straight one at its middle. Then every path within that of the straight
        one is clear, too.
    """
    step = max(1, BOXES // starts.shape[1])
    if len(starts) > step:
        parts = [slice(k, k + step) for k in range(0, len(starts), step)]
        found = [clear_moves(chains, starts[k], ends[k], None if bends is None else bends[k], gap) for k in parts]
        return np.concatenate(found)
    move = ends - starts
    thick = 0.0 if bends is None else float(np.abs(bends - bends.mean(axis=1, keepdims=True)).max(initial=0.0))
    pairs = near_pairs(chains, starts, move, 2 * thick)
    bend = None if bends is None else bends.ravel()
    _, clear = _advance(starts.ravel(), move.ravel(), bend, pairs, gap, chains.keyframes)
    fine = np.ones(len(starts), np.bool_)
    fine[pairs.frame[~clear]] = False
    return fine


Triple = tuple[ComplexArray, ComplexArray, ComplexArray]
"""Values at the vertex, the start and the end of the edge."""


def _approach(move: Triple) -> FloatArray:
    """Bound on how much moves of a vertex and of the ends of an edge change their distance.

    A point of the edge moves by a mixture of the moves of its ends, so one of these bounds them all.
    """
    v, u, w = move
    return np.asarray(np.maximum(np.abs(v - u), np.abs(v - w)), np.float64)


def _trimmed(place: Triple, move: Triple, bend: Triple | None) -> tuple[Triple, Triple, Triple | None]:
    """The same with only that part of the edge to which the vertex can come nearest, and its near end first.

    Beyond the share 2 q / L, where q is the most that the vertex ever is from the near end and L the least length
    of the edge, all points are further away than the near end. A tiny edge beside a long one that turns would
    otherwise seem to be swept away by the far end of it.
    """
    v, u, w = place
    near = np.abs(v - u) <= np.abs(v - w)

    def turned(x: Triple) -> Triple:
        return x[0], np.where(near, x[1], x[2]), np.where(near, x[2], x[1])

    place, move = turned(place), turned(move)
    bend = None if bend is None else turned(bend)
    known = [move] if bend is None else [move, bend]
    reach = np.abs(place[0] - place[1]) + sum(np.abs(x[0] - x[1]) for x in known)
    length = np.abs(place[2] - place[1]) - sum(np.abs(x[2] - x[1]) for x in known)
    share = np.minimum(2 * reach / np.maximum(length, 1e-300), 1.0)

    def cut(x: Triple) -> Triple:
        return x[0], x[1], x[1] + share * (x[2] - x[1])

    return cut(place), cut(move), None if bend is None else cut(bend)


def _advance(
    z: ComplexArray,
    moves: ComplexArray,
    bends: ComplexArray | None,
    pairs: Pairs,
    gap: Gap,
    keyframes: ComplexArray | None,
) -> tuple[FloatArray, BoolArray]:
    """How far every pair surely stays apart, and whether that is all the way.

    Conservative advancement: a pair at the distance d of which the parts approach by at most l may advance by d/l
    (Li et al., "Codimensional incremental potential contact", 2021, section 5: additive CCD). What takes too long
    is decided by the roots of the quadratic at which the three points are in line.
    """
    place, move, bend = pairs.of(z), pairs.of(moves), None if bends is None else pairs.of(bends)
    start = distances(*place)[0]
    slack = start - _approach(move) - (0.0 if bend is None else _approach(bend))
    clear = slack > gap.of(start, start)
    reached = np.zeros(len(start))
    rest = np.flatnonzero(~clear)

    def picked(x: Triple) -> Triple:
        return x[0][rest], x[1][rest], x[2][rest]

    place, move, bend = _trimmed(picked(place), picked(move), None if bend is None else picked(bend))
    thick = np.zeros(len(rest)) if bend is None else _approach(bend)
    narrow = start[rest]
    for z in () if keyframes is None else keyframes:
        narrow = np.minimum(narrow, distances(*pairs[rest].within(z))[0])
    reached[rest], clear[rest] = _advance_slowly(place, move, thick, start[rest], narrow, gap)
    return reached, clear


def _advance_slowly(
    place: Triple, move: Triple, thick: FloatArray, start: FloatArray, narrow: FloatArray, gap: Gap
) -> tuple[FloatArray, BoolArray]:
    (v, u, w), (pv, pu, pw) = place, move
    apart = start if gap is STEPPING else np.minimum(start, distances(v + pv, u + pu, w + pw)[0])
    rate = np.maximum(_approach(move), 1e-300)
    least = gap.of(apart - thick, narrow) + thick
    reached, clear = np.zeros(len(rate)), np.zeros(len(rate), np.bool_)
    todo = np.flatnonzero(start > thick)
    at = 0.9 * (start - thick)[todo] / rate[todo]
    for _ in range(ROUNDS):
        if not len(todo):
            break
        past = at >= 1.0
        at = np.minimum(at, 1.0)
        d = distances(v[todo] + at * pv[todo], u[todo] + at * pu[todo], w[todo] + at * pw[todo])[0]
        safe = d > least[todo]
        reached[todo[safe]] = at[safe]
        clear[todo[safe & past]] = True
        on = safe & ~past
        todo, at, d = todo[on], at[on], d[on]
        at = at + 0.9 * (d - thick[todo]) / rate[todo]
    late = todo[thick[todo] == 0]
    if len(late):
        clear[late] = _never_in_line(
            (v[late], u[late], w[late]), (pv[late], pu[late], pw[late]), least[late], reached[late]
        )
    return reached, clear


def _never_in_line(place: Triple, move: Triple, least: FloatArray, reached: FloatArray) -> BoolArray:
    """Whether moving points stay `least` apart from the time reached on, wherever the vertex meets the line."""
    (v, u, w), (pv, pu, pw) = place, move
    edge, edge_move, arm, arm_move = w - u, pw - pu, v - u, pv - pu
    c0, c2 = _cross(edge, arm), _cross(edge_move, arm_move)
    c1 = _cross(edge, arm_move) + _cross(edge_move, arm)
    root = -0.5 * (c1 + np.copysign(np.sqrt(np.maximum(c1 * c1 - 4 * c0 * c2, 0.0)), c1))
    with np.errstate(all="ignore"):
        times = np.stack([root / c2, c0 / root, -0.5 * c1 / c2, np.ones(len(c0))])
    times = np.clip(np.nan_to_num(times, nan=1.0, posinf=1.0, neginf=0.0), reached, 1.0)
    apart = np.stack([distances(v + s * pv, u + s * pu, w + s * pw)[0] for s in times])
    return np.asarray((apart > least).all(axis=0))


def _cross(a: ComplexArray, b: ComplexArray) -> FloatArray:
    return a.real * b.imag - a.imag * b.real
