"""Intrinsic vertex paths: lengths and headings of the edges are interpolated, so that a turn keeps its size.

Sederberg, Gao, Wang and Mu, "2-D shape blending: an intrinsic solution to the vertex path problem", SIGGRAPH 1993;
with another closure, see docs/decisions/0002-intrinsic-closure.md.
"""

import threading
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.bridges import Bridge, connect
from core.methods.headings import TURN, ComplexArray, Headings, headings, joined, shortest
from core.methods.placement import Placement, place

CELLS = 24576
"""Vertices times frames computed in one go: few enough for the work arrays (1.4 MB) to stay in the cache."""

FIRM = 0.03
"""Compliance of an edge that changes neither length nor direction against its neighbours: not quite zero, so that
an outline without any change to take up the closure error closes too."""

ROUNDING = 1e-30
"""Keeps a quotient of squares finite where both are zero."""


@dataclass(frozen=True, eq=False)
class Ring:
    """A closed outline in the row of edges, and how readily its edges give way to close it.

    Attributes
    ----------
    rows : slice
    shares : (2, k) complex array
        Two ways to share a gap among the edges, per px of length: evenly, and by compliance.
    weights : (k, 2) float array
        The same, to sum lengths with.
    largest : (2,) float array
        The largest of each.
    """

    rows: slice
    shares: ComplexArray
    weights: FloatArray
    largest: FloatArray

    @classmethod
    def of(cls, rows: slice, headings: Headings) -> "Ring":
        """Return the ring of the outline in `rows`."""
        shares = np.stack([np.ones(len(headings.turn)), _compliance(headings)])
        return cls(rows, shares.astype(np.complex128), shares.T.copy(), shares.max(axis=1))

    def close(self, work: "_Work") -> None:
        """Close the polygons in `work` by adding to every edge its share of the gap.

        Shares go by length times compliance. Where that would take more than an edge can give, it goes over
        smoothly into shares by length alone, which are less than the edge itself whatever the gap (triangle
        inequality).
        """
        edges, lengths, change = (x[:, self.rows] for x in (work.edges, work.lengths, work.change))
        gap = edges.sum(axis=1)[:, None]
        shares = gap / (lengths @ self.weights + np.finfo(np.float64).tiny)
        # the largest change of an edge, in lengths of it, if shared evenly and if shared by compliance
        least, most = (np.abs(shares) * self.largest).T
        room = (1 - least) ** 2 + ROUNDING
        trust = room / (room + (most - least) ** 2)
        shares[:, 0] *= trust - 1
        shares[:, 1] *= -trust
        np.matmul(shares, self.shares, out=change)
        change *= lengths
        edges += change


@dataclass(frozen=True, eq=False)
class IntrinsicPaths:
    """The paths of all vertices of a drawing, outline after outline in one row.

    Attributes
    ----------
    half_headings : (2, n) float array
        Half the heading of every edge before and after, radians, whole turns between them included.
    lengths : (2, n) float array
        Length of every edge before and after, px.
    outlines : tuple of slice
    rings : tuple of Ring
    bridges : tuple of Bridge
    placement : Placement
    """

    half_headings: FloatArray
    lengths: FloatArray
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
            np.stack([whole.start, whole.start + whole.turn + extra]) / 2,
            np.stack([whole.before, whole.after]),
            tuple(rows),
            tuple(Ring.of(r, h) for r, h, c in zip(rows, found, closed, strict=True) if c),
            tuple(bridge.turned(extra) for bridge in bridges),
            place(a, b, _vertex_shares(found), whole.mean_turn() + extra),
        )

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2) in px."""
        n = self.lengths.shape[1]
        frames = np.zeros((len(t), n), dtype=np.complex128)
        step = max(1, CELLS // n)
        path = self.placement.path(t)
        for k in range(0, len(t), step):
            few = slice(k, k + step)
            self._fill(frames[few], t[few], path[few])
        return frames.view(np.float64).reshape(len(t), n, 2)

    def _fill(self, frames: ComplexArray, t: FloatArray, path: ComplexArray) -> None:
        work = _Work.of(*frames.shape)
        self._edges(t, work)
        for ring in self.rings:
            ring.close(work)
        for rows in self.outlines:
            np.cumsum(work.edges[:, rows.start : rows.stop - 1], axis=1, out=frames[:, rows.start + 1 : rows.stop])
        for bridge in self.bridges:
            frames[:, bridge.carried] += bridge.shift(frames, t)[:, None]
        frames += (path - frames @ self.placement.weights)[:, None]

    def _edges(self, t: FloatArray, work: "_Work") -> None:
        """Fill in the edge vectors and their lengths, not yet closed.

        With h the tangent of half the heading, cos = 2 / (1 + h^2) - 1 and sin = 2 h / (1 + h^2): one tangent
        costs a tenth of a sine and a cosine.
        """
        h, lengths, part, edges = work.tangent, work.lengths, work.part, work.edges
        shares = np.stack([1 - t, t], axis=1)
        np.matmul(shares, self.half_headings, out=h)
        np.tan(h, out=h)
        np.matmul(shares, self.lengths, out=lengths)
        if t.min() < 0 or t.max() > 1:
            np.maximum(lengths, 0.0, out=lengths)  # easing that overshoots must not turn a shrinking edge over
        np.multiply(h, h, out=part)
        part += 1.0
        np.divide(lengths, part, out=part)
        part += part
        np.subtract(part, lengths, out=edges.real)
        np.multiply(part, h, out=edges.imag)


@dataclass(frozen=True, eq=False)
class _Work:
    """Arrays (T, n) for a few frames at a time."""

    tangent: FloatArray
    lengths: FloatArray
    part: FloatArray
    edges: ComplexArray
    change: ComplexArray

    @classmethod
    def of(cls, frames: int, n: int) -> "_Work":
        """Return kept memory, whatever it holds: fresh memory costs more than the arithmetic done in it."""
        cells = frames * n
        if cells > _kept.real.shape[1]:
            _kept.real = np.zeros((3, cells))
            _kept.complex = np.zeros((2, cells), dtype=np.complex128)
        tangent, lengths, part = _kept.real[:, :cells].reshape(3, frames, n)
        edges, change = _kept.complex[:, :cells].reshape(2, frames, n)
        return cls(tangent, lengths, part, edges, change)


class _Kept(threading.local):
    """Work memory of one thread, so that previews may be computed beside the window."""

    def __init__(self) -> None:
        self.real: FloatArray = np.zeros((3, 0))
        self.complex: ComplexArray = np.zeros((2, 0), dtype=np.complex128)


_kept = _Kept()


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
