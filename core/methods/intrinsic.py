"""Intrinsic vertex paths: lengths and headings of the edges are interpolated, so that a turn keeps its size.

Sederberg, Gao, Wang and Mu, "2-D shape blending: an intrinsic solution to the vertex path problem", SIGGRAPH 1993;
with another closure, see docs/decisions/0002-intrinsic-closure.md.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.bridges import Bridge, connect
from core.methods.headings import TURN, ComplexArray, Headings, headings, joined, shortest
from core.methods.placement import Placement, place

CELLS = 8192
"""Vertices times frames computed in one go: so few that the work arrays stay in the fast cache."""

FIRM = 0.03
"""Compliance of an edge that changes neither length nor direction against its neighbours: not quite zero, so that
an outline without any change to take up the closure error closes too."""


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed outline in the row of edges, and how readily each of its edges gives way to close it."""

    rows: slice
    compliance: FloatArray


@dataclass(frozen=True, eq=False)
class IntrinsicPaths:
    """The paths of all vertices of a drawing, outline after outline in one row.

    Attributes
    ----------
    half_heading, half_turn : (n,) float array
        Of every edge, radians: where it points before, and how far it turns.
    before, growth : (n,) float array
        Length of every edge before, and how much it gains, px.
    outlines : tuple of slice
    rings : tuple of Ring
    bridges : tuple of Bridge
    placement : Placement
    """

    half_heading: FloatArray
    half_turn: FloatArray
    before: FloatArray
    growth: FloatArray
    outlines: tuple[slice, ...]
    rings: tuple[Ring, ...]
    bridges: tuple[Bridge, ...]
    placement: Placement

    @classmethod
    def of(cls, pairs: Sequence[tuple[FloatArray, FloatArray, bool]], *, turns: int = 0) -> "IntrinsicPaths":
        """Plan the paths of outlines (left (k, 2), right (k, 2), closed); `turns` are added to the shortest."""
        a = _complex([left for left, _, _ in pairs])
        b = _complex([right for _, right, _ in pairs])
        stops = np.cumsum([len(left) for left, _, _ in pairs]).tolist()
        rows = [slice(stop - len(left), stop) for stop, (left, _, _) in zip(stops, pairs, strict=True)]
        closed = [c for _, _, c in pairs]
        found = [headings(a[r], b[r], closed=c) for r, c in zip(rows, closed, strict=True)]
        found, bridges = connect(a, b, rows, found)
        whole = joined(found)
        extra = shortest(whole.mean_turn()) + TURN * turns
        return cls(
            whole.start / 2,
            (whole.turn + extra) / 2,
            whole.before,
            whole.after - whole.before,
            tuple(rows),
            tuple(Ring(r, _compliance(h)) for r, h, c in zip(rows, found, closed, strict=True) if c),
            tuple(bridge.turned(extra) for bridge in bridges),
            place(a, b, _vertex_shares(found), whole.mean_turn() + extra),
        )

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2) in px."""
        n = len(self.before)
        frames = np.zeros((len(t), n), dtype=np.complex128)
        step = max(1, CELLS // n)
        work = _Work.of(min(step, len(t)), n)
        for k in range(0, len(t), step):
            self._fill(frames[k : k + step], t[k : k + step], work)
        return frames.view(np.float64).reshape(len(t), n, 2)

    def _fill(self, frames: ComplexArray, t: FloatArray, work: "_Work") -> None:
        edges, lengths = self._edges(t, work)
        for ring in self.rings:
            _close(edges[:, ring.rows], lengths[:, ring.rows], ring.compliance)
        for rows in self.outlines:
            np.cumsum(edges[:, rows.start : rows.stop - 1], axis=1, out=frames[:, rows.start + 1 : rows.stop])
        for bridge in self.bridges:
            frames[:, bridge.carried] += bridge.shift(frames, t)[:, None]
        frames += (self.placement.path(t) - frames @ self.placement.weights)[:, None]

    def _edges(self, t: FloatArray, work: "_Work") -> tuple[ComplexArray, FloatArray]:
        """Edge vectors and lengths (T, n), not yet closed.

        With h the tangent of half the heading, cos = 2 / (1 + h^2) - 1 and sin = 2 h / (1 + h^2): one tangent
        costs a tenth of a sine and a cosine.
        """
        s = t[:, None]
        h, lengths, part = work.tangent[: len(t)], work.lengths[: len(t)], work.part[: len(t)]
        edges = work.edges[: len(t)]
        np.multiply(s, self.half_turn, out=h)
        h += self.half_heading
        np.tan(h, out=h)
        np.multiply(s, self.growth, out=lengths)
        lengths += self.before
        if t.min() < 0 or t.max() > 1:
            np.maximum(lengths, 0.0, out=lengths)  # easing that overshoots must not turn a shrinking edge over
        np.multiply(h, h, out=part)
        part += 1.0
        np.divide(lengths, part, out=part)
        part += part
        np.subtract(part, lengths, out=edges.real)
        np.multiply(part, h, out=edges.imag)
        return edges, lengths


@dataclass(frozen=True, eq=False)
class _Work:
    """Arrays that are filled again for every few frames: fresh memory would cost more than the arithmetic."""

    tangent: FloatArray
    lengths: FloatArray
    part: FloatArray
    edges: ComplexArray

    @classmethod
    def of(cls, frames: int, n: int) -> "_Work":
        tangent, lengths, part = np.zeros((3, frames, n))
        return cls(tangent, lengths, part, np.zeros((frames, n), dtype=np.complex128))


def _complex(outlines: list[FloatArray]) -> ComplexArray:
    p = np.concatenate(outlines)
    z: ComplexArray = p[:, 0] + 1j * p[:, 1]
    return z


def _vertex_shares(outlines: Sequence[Headings]) -> FloatArray:
    """How much of the drawing each vertex stands for, 1 in all."""
    shares = np.concatenate([h.vertex_shares() * h.perimeters for h in outlines])
    return shares / shares.sum() if shares.any() else np.full(len(shares), 1 / len(shares))


def _compliance(headings: Headings) -> FloatArray:
    """How readily each edge of a ring gives way: where it stretches or bends it does, a rigid bone does not."""
    before, after = headings.before, headings.after
    if not before.any() or not after.any():
        return np.ones(len(before))
    x, y = before / before.sum(), after / after.sum()
    stretch = 2 * np.divide(x - y, x + y, out=np.zeros_like(x), where=x + y > 0)
    step = np.abs(np.diff(headings.turn, append=headings.turn[0]))
    bend = (step + np.roll(step, 1)) / 2
    compliance: FloatArray = FIRM + stretch**2 + bend**2
    return compliance


def _close(edges: ComplexArray, lengths: FloatArray, compliance: FloatArray) -> None:
    """Close polygons (T, n), in place, by adding to every edge its share of the gap.

    Shares go by length times compliance. Where that would take more than an edge can give, it goes over smoothly
    into shares by length alone, which are less than the edge itself whatever the gap (triangle inequality).
    """
    gap = edges.sum(axis=1)
    tiny = np.finfo(np.float64).tiny
    whole = np.maximum(lengths.sum(axis=1), tiny)
    soft = np.maximum(lengths @ compliance, tiny)
    least = np.abs(gap) / whole  # largest change of an edge in lengths of it, by length alone
    most = np.abs(gap) / soft * compliance.max()
    room, excess = np.maximum(1 - least, 0.0) ** 2 + tiny, np.maximum(most - least, 0.0) ** 2
    trust = room / (room + excess)
    by_length, by_compliance = -gap * (1 - trust) / whole, -gap * trust / soft
    edges += lengths * (by_length[:, None] + by_compliance[:, None] * compliance)
