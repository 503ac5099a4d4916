"""Intrinsic vertex paths: lengths and headings of the edges are interpolated, so that a turn keeps its size.

Sederberg, Gao, Wang and Mu, "2-D shape blending: an intrinsic solution to the vertex path problem", SIGGRAPH 1993;
with another closure, see docs/decisions/0002-intrinsic-closure.md.
"""

import threading
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.assembly import Assembly
from core.methods.bridges import Bridge
from core.methods.headings import ComplexArray, Headings, joined
from core.methods.placement import Placement

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
    def of(cls, assembly: Assembly) -> "IntrinsicPaths":
        """Plan the paths of the outlines of a drawing."""
        whole = joined(assembly.outlines)
        rings = zip(assembly.rows, assembly.outlines, assembly.closed, strict=True)
        return cls(
            np.stack([whole.start, whole.start + whole.turn]) / 2,
            np.stack([whole.before, whole.after]),
            assembly.rows,
            tuple(Ring.of(r, h) for r, h, closed in rings if closed),
            assembly.bridges,
            assembly.placement,
        )

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2) in px."""
        frames = self._by_few(t, self._fill)
        return frames.view(np.float64).reshape(*frames.shape, 2)

    def forms(self, t: FloatArray) -> ComplexArray:
        """Vertices (T, n) of every outline on its own, its first vertex in the origin."""
        return self._by_few(t, self._form)

    def _by_few(self, t: FloatArray, fill: Callable[[ComplexArray, FloatArray], None]) -> ComplexArray:
        n = self.lengths.shape[1]
        frames = np.zeros((len(t), n), dtype=np.complex128)
        step = max(1, CELLS // n)
        for k in range(0, len(t), step):
            fill(frames[k : k + step], t[k : k + step])
        return frames

    def _fill(self, frames: ComplexArray, t: FloatArray) -> None:
        self._form(frames, t)
        for bridge in self.bridges:
            frames[:, bridge.carried] += bridge.shift(frames, t)[:, None]
        frames += self.placement.shift(frames, t)[:, None]

    def _form(self, frames: ComplexArray, t: FloatArray) -> None:
        work = _Work.of(*frames.shape)
        self._edges(t, work)
        for ring in self.rings:
            ring.close(work)
        for rows in self.outlines:
            np.cumsum(work.edges[:, rows.start : rows.stop - 1], axis=1, out=frames[:, rows.start + 1 : rows.stop])

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
