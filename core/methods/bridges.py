"""What holds the outlines of one drawing together: each is carried by the nearest parts of another one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.headings import ComplexArray, Headings, unit

PROBES = 12
"""Points of an outline that stand for it where neighbours are sought."""

REACH = 1e-3
"""Edges whose weight is below this share of the nearest one's do not carry: about six times as far away."""


@dataclass(frozen=True, eq=False)
class Bridge:
    """Vectors from some edges of an outline, the carrier, to the middle of the one carried.

    Each vector turns with its edge and its length is interpolated, as if the outline were an edge itself.

    Attributes
    ----------
    carried, carrier : slice
        Rows of the drawing: the outline that is moved, and the one whose edges do it.
    start, middle : (k,) complex array
        Weights of the carrier's and of the carried vertices, sum 1. They make the mean of the points where the
        vectors begin, and the one to which they lead.
    arms : (m, 2) complex array
        The vectors before, and what they gain in length; weighted, so that they need only be added; px.
    turn : (m,) float array
        Turn of their edges, radians.
    mean_turn : float
        Weighted mean of these.
    """

    carried: slice
    carrier: slice
    start: ComplexArray
    middle: ComplexArray
    arms: ComplexArray
    turn: FloatArray
    mean_turn: float

    def turned(self, radians: float) -> "Bridge":
        """Return the same vectors with `radians`, a number of whole turns, added to every turn."""
        return replace(self, turn=self.turn + radians, mean_turn=self.mean_turn + radians)

    def shift(self, frames: ComplexArray, t: FloatArray) -> ComplexArray:
        """How far (T,) the carried outline must move to its place in `frames` (T, n), where the carrier lies."""
        before, gain = (unit(t[:, None] * self.turn) @ self.arms).T
        place: ComplexArray = frames[:, self.carrier] @ self.start + before + t * gain
        return place - frames[:, self.carried] @ self.middle


def connect(
    a: ComplexArray,
    b: ComplexArray,
    rows: Sequence[slice],
    outlines: Sequence[Headings],
    bodies: Sequence[int] | None = None,
) -> tuple[list[Headings], list[Bridge]]:
    """Join the outlines of a drawing to one tree, from the longest on, each to the nearest one joined so far.

    Parameters
    ----------
    a, b : (n,) complex array
        Vertices of all outlines, px.
    rows, outlines : sequences of slice and of Headings
        The outlines.
    bodies : sequence of int, optional
        Outlines of equal number are joined to each other before all others, whatever lies between them.

    Returns
    -------
    outlines : list of Headings
        As given, but with the whole turns of every outline as near to those of its carrier as may be.
    bridges : list of Bridge
        In the order in which outlines must be moved.
    """
    found = list(outlines)
    root = max(range(len(found)), key=lambda k: (found[k].known, found[k].perimeters))
    if not found[root].known:
        found[root] = found[root].carried(0.0)
    bridges = []
    for k, carrier in _tree(a, b, rows, root, bodies):
        bridge = _bridge(a, b, rows[k], found[k].vertex_shares(), rows[carrier], found[carrier])
        found[k] = found[k].following(bridge.mean_turn)
        bridges.append(bridge)
    return found, bridges


def _tree(
    a: ComplexArray, b: ComplexArray, rows: Sequence[slice], root: int, bodies: Sequence[int] | None
) -> Iterator[tuple[int, int]]:
    """Pairs (outline, its carrier), nearest first: a minimum spanning tree by the gaps in both keyframes."""
    probes = np.stack([np.linspace(r.start, r.stop - 1, PROBES).astype(np.intp) for r in rows])
    left, right = a[probes], b[probes]
    gap = np.full(len(rows), np.inf)
    carrier = np.full(len(rows), root)
    body = np.arange(len(rows)) if bodies is None else np.asarray(bodies)
    free = np.arange(len(rows)) != root
    k = root
    for _ in range(len(rows) - 1):
        nearer = _gaps(left, k) + _gaps(right, k)
        nearest = np.where(body == body[k], -1.0, nearer.min(axis=(1, 2)))
        carrier[nearest < gap] = k
        gap = np.minimum(gap, nearest)
        k = int(np.where(free, gap, np.inf).argmin())
        free[k] = False
        yield k, int(carrier[k])


def _gaps(probes: ComplexArray, k: int) -> FloatArray:
    """Squares of the distances from the probes (m, p) of all outlines to those of outline k, (m, p, p)."""
    d = probes[:, :, None] - probes[k]
    return np.asarray(d.real**2 + d.imag**2)


def _bridge(
    a: ComplexArray, b: ComplexArray, carried: slice, middle: FloatArray, carrier: slice, headings: Headings
) -> Bridge:
    arm_a = a[carried] @ middle - _edge_middles(a[carrier])
    arm_b = b[carried] @ middle - _edge_middles(b[carrier])
    reach = np.abs(arm_a) ** 2 + np.abs(arm_b) ** 2
    reach += 1e-6 * reach.max() + np.finfo(np.float64).tiny
    # cut off continuously, so that only the near edges need be turned in every frame
    weights = headings.shares * np.maximum((reach.min() / reach) ** 2 - REACH, 0.0)
    if not weights.any():  # the carrier is a point in both keyframes, or only doubled vertices are near
        weights = np.ones(len(reach))
    weights = weights / weights.sum()
    near = np.flatnonzero(weights)
    turn = headings.turn[near]
    first, last = arm_a[near], arm_b[near] * unit(-turn)
    return Bridge(
        carried,
        carrier,
        ((weights + np.roll(weights, 1)) / 2).astype(np.complex128),
        middle.astype(np.complex128),
        weights[near, None] * np.stack([first, last - first], axis=1),
        turn,
        float(turn @ weights[near]),
    )


def _edge_middles(p: ComplexArray) -> ComplexArray:
    return np.asarray((p + np.append(p[1:], p[0])) / 2, np.complex128)
