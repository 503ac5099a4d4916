"""What holds the outlines of one drawing together: each is carried by the nearest parts of another one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray
from core.methods.headings import ComplexArray, Headings

PROBES = 24
"""Points of an outline that stand for it where neighbours are sought."""

REACH = 1e-3
"""Edges whose weight is below this share of the nearest one's do not carry: about six times as far away."""


@dataclass(frozen=True, eq=False)
class Bridge:
    """Vectors from some edges of an outline, the carrier, to the middle of the one carried.

    Each vector turns with its edge and its length is interpolated, as if the outline were an edge itself.

    Attributes
    ----------
    carried : slice
        Rows of the drawing: the outline that is moved.
    edges, ends : (m,) int array
        Rows between which the edges run; the vectors begin at their middles.
    weights : (m,) float array
        Sum 1; large for near edges.
    before, after : (m,) complex array
        The vectors in the keyframes, the ones after turned back, px.
    turn : (m,) float array
        Turn of the edges, radians.
    middle : (k,) float array
        Weights of the carried vertices, sum 1; they make its middle.
    """

    carried: slice
    edges: npt.NDArray[np.intp]
    ends: npt.NDArray[np.intp]
    weights: FloatArray
    before: ComplexArray
    after: ComplexArray
    turn: FloatArray
    middle: FloatArray

    def turned(self, radians: float) -> "Bridge":
        """Return the same vectors with `radians`, a number of whole turns, added to every turn."""
        return replace(self, turn=self.turn + radians)

    def shift(self, frames: ComplexArray, t: FloatArray) -> ComplexArray:
        """How far (T,) the carried outline must move to its place in `frames` (T, n), where the carrier lies."""
        s = t[:, None]
        arms = np.exp(1j * s * self.turn) * (self.before + s * (self.after - self.before))
        start = (frames[:, self.edges] + frames[:, self.ends]) / 2
        place: ComplexArray = (start + arms) @ self.weights - frames[:, self.carried] @ self.middle
        return place


def connect(
    a: ComplexArray, b: ComplexArray, rows: Sequence[slice], outlines: Sequence[Headings]
) -> tuple[list[Headings], list[Bridge]]:
    """Join the outlines of a drawing to one tree, from the longest on, each to the nearest one joined so far.

    Parameters
    ----------
    a, b : (n,) complex array
        Vertices of all outlines, px.
    rows, outlines : sequences of slice and of Headings
        The outlines.

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
    for k, carrier in _tree(a, b, rows, root):
        bridge = _bridge(a, b, rows[k], found[k].vertex_shares(), rows[carrier], found[carrier])
        found[k] = found[k].following(float(bridge.turn @ bridge.weights))
        bridges.append(bridge)
    return found, bridges


def _tree(a: ComplexArray, b: ComplexArray, rows: Sequence[slice], root: int) -> Iterator[tuple[int, int]]:
    """Pairs (outline, its carrier), nearest first: a minimum spanning tree by the gaps in both keyframes."""
    probes = [np.unique(np.linspace(r.start, r.stop - 1, PROBES).astype(np.intp)) for r in rows]
    gap = {k: _gap(a, b, probes[k], probes[root]) for k in range(len(rows)) if k != root}
    carrier = dict.fromkeys(gap, root)
    while gap:
        k = min(gap, key=gap.__getitem__)
        yield k, carrier[k]
        del gap[k]
        for j in gap:
            to_k = _gap(a, b, probes[j], probes[k])
            if to_k < gap[j]:
                gap[j], carrier[j] = to_k, k


def _gap(a: ComplexArray, b: ComplexArray, i: npt.NDArray[np.intp], j: npt.NDArray[np.intp]) -> float:
    """Least distance between two outlines, of the sum of squares over both keyframes."""
    da, db = a[i, None] - a[j], b[i, None] - b[j]
    return float((da.real**2 + da.imag**2 + db.real**2 + db.imag**2).min())


def _bridge(
    a: ComplexArray, b: ComplexArray, carried: slice, middle: FloatArray, carrier: slice, headings: Headings
) -> Bridge:
    edges = np.arange(carrier.start, carrier.stop)
    ends = np.append(edges[1:], edges[0])
    arm_a = a[carried] @ middle - (a[edges] + a[ends]) / 2
    arm_b = b[carried] @ middle - (b[edges] + b[ends]) / 2
    reach = np.abs(arm_a) ** 2 + np.abs(arm_b) ** 2
    reach += 1e-6 * reach.max() + np.finfo(np.float64).tiny
    # cut off continuously, so that only the near edges need be turned in every frame
    weights = headings.shares * np.maximum((reach.min() / reach) ** 2 - REACH, 0.0)
    if not weights.any():  # the carrier is a point in both keyframes, or only doubled vertices are near
        weights = np.ones(len(edges))
    near = np.flatnonzero(weights)
    share, turn = weights[near] / weights.sum(), headings.turn[near]
    back = np.exp(-1j * turn)
    return Bridge(carried, edges[near], ends[near], share, arm_a[near], arm_b[near] * back, turn, middle)
