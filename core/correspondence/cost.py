"""What it costs that a piece of one outline becomes a piece of the other."""

from dataclasses import dataclass

import numpy as np

from core.correspondence.cyclic import BARRED, MARGIN, STEPS, Float32Array, IntArray
from core.correspondence.ring import ComplexArray, Ring
from core.geometry.outline import FloatArray

SCALES = np.array([1 / 64, 1 / 32, 1 / 16, 1 / 8])
"""Shares of the perimeter on both sides of a point between which its angle is taken."""

NO_KNOTS: IntArray = np.zeros(0, dtype=np.intp)


@dataclass(frozen=True)
class Weights:
    """Weights of a step's cost: of the directions of its chords, and of its unequal lengths."""

    heading: float
    stretch: float


@dataclass(frozen=True, eq=False)
class Grid:
    """Nodes on two rings, R + 1 on each, node i of the one near what corresponds to node i of the other.

    Attributes
    ----------
    u, v : (B, R + 1) float array
        Shares, rising, for each of B candidates; on closed rings the last is the first plus 1.
    z, y : (B, M) complex array
        The nodes themselves; M = R where closed, R + 1 where open.
    knots : (k,) int array
        Rows whose two nodes must correspond.
    """

    before: Ring
    after: Ring
    u: FloatArray
    v: FloatArray
    z: ComplexArray
    y: ComplexArray
    knots: IntArray

    @property
    def closed(self) -> bool:
        """Whether the nodes go round."""
        return self.before.closed

    def neighbours(self, half: int) -> IntArray:
        """Index of the node j = i + w for every row i and offset w from -half to half: (R + 1, 2 half + 1)."""
        j = np.arange(self.u.shape[1])[:, None] + np.arange(-half, half + 1)
        m = self.z.shape[1]
        return np.asarray(j % m if self.closed else np.clip(j, 0, m - 1), np.intp)

    def rows(self) -> IntArray:
        """Index of the node of every row."""
        return np.asarray(np.arange(self.u.shape[1]) % self.z.shape[1], np.intp)


def grid(before: Ring, after: Ring, u: FloatArray, v: FloatArray, knots: IntArray = NO_KNOTS) -> Grid:
    """Return the grid with nodes at the shares `u`, `v` (B, R + 1)."""
    end = -1 if before.closed else None
    return Grid(before, after, u, v, before.at(u[:, :end]), after.at(v[:, :end]), knots)


def bends(r: Ring, shares: FloatArray) -> FloatArray:
    """Turning angles at `shares` (...,) -> (..., 4), one a scale, in radians; 0 at the ends of an open ring."""
    s = shares[..., None]
    here, back, on = r.at(s), r.at(s - SCALES), r.at(s + SCALES)
    turned = (on - here) * np.conj(here - back)
    return np.asarray(np.angle(np.where(turned == 0, 1.0, turned)))


def bend_costs(g: Grid, half: int) -> FloatArray:
    """Mean squared difference of the turning angles for every node and offset: (B, R + 1, 2 half + 1)."""
    end = -1 if g.closed else None
    p, q = bends(g.before, g.u[:, :end]), bends(g.after, g.v[:, :end])
    cross = p @ np.swapaxes(q, 1, 2)
    squares = (p * p).sum(axis=2)[:, :, None] + (q * q).sum(axis=2)[:, None, :] - 2 * cross
    return np.asarray(squares[:, g.rows()[:, None], g.neighbours(half)] / len(SCALES))


def square_distances(p: ComplexArray, q: ComplexArray) -> FloatArray:
    """|p - q|^2 without the square root that numpy's abs takes."""
    d = p - q
    return np.asarray(d.real**2 + d.imag**2)


def step_costs(
    g: Grid, node_costs: FloatArray, weights: Weights, headings: ComplexArray | None = None
) -> Float32Array:
    """Return the cost of every step into every cell.

    A step costs its mean length times (node costs along it + directions of its chords + unequal lengths).
    The last is bounded, 4 r^2 with r = (la - lb) / (la + lb), so that a short cap can grow into a long one.

    Parameters
    ----------
    g : Grid
    node_costs : (B, R + 1, 2 (W + MARGIN) + 1) float array
    weights : Weights
    headings : (B, M) complex array, optional
        By how much the neighbourhood of each node is turned from before to after; not at all if omitted.

    Returns
    -------
    (K, R + 1, B, 1, 2 W + 1) float32 array
    """
    half = node_costs.shape[2] // 2 - MARGIN
    rows = node_costs.shape[1]
    costs = np.full((len(STEPS), rows, len(node_costs), 1, 2 * half + 1), BARRED, dtype=np.float32)
    nodes = node_costs.astype(np.float32)
    chords = _Chords(g, half, headings)
    for k, (di, dj) in enumerate(STEPS):
        if di < rows:
            along = chords.costs(di, dj, weights, _mean_along(nodes, di, dj))
            costs[k, di:, :, 0] = np.swapaxes(along, 0, 1)
            costs[k, _jumping(g.knots, di, rows)] = BARRED
    aside = np.flatnonzero(np.arange(2 * half + 1) != half)
    costs[:, g.knots[:, None], :, :, aside] = BARRED
    return costs


def _mean_along(nodes: Float32Array, di: int, dj: int) -> Float32Array:
    """A quarter of the start, half of the middle, a quarter of the end of a step, for rows from `di` on."""
    rows, width = nodes.shape[1], nodes.shape[2] - 2 * MARGIN
    mi, mj = di // 2, dj // 2
    # going back by (di, dj) changes the offset w = j - i by di - dj
    first, middle = MARGIN + di - dj, MARGIN + mi - mj
    start = nodes[:, : rows - di, first : first + width]
    half_way = nodes[:, di - mi : rows - mi, middle : middle + width]
    end = nodes[:, di:, MARGIN : MARGIN + width]
    return np.asarray(np.float32(0.25) * (end + start) + np.float32(0.5) * half_way)


class _Chords:
    """Directions and lengths of the chords of all steps on both sides; steps of equal length share theirs."""

    def __init__(self, g: Grid, half: int, headings: ComplexArray | None) -> None:
        rows, j = g.rows(), g.neighbours(half)
        e = np.ones_like(g.z) if headings is None else headings
        self.before: dict[int, tuple[Float32Array, Float32Array]] = {}
        self.after: dict[int, tuple[Float32Array, Float32Array]] = {}
        for d in sorted({d for step in STEPS for d in step if d < len(rows)}):
            chord, length = _chords(g.z, g.u, d, g.closed)
            self.before[d] = 0.5 * _parts(chord * e, chord)[:, :, rows], length[:, rows, None]
            chord, length = _chords(g.y, g.v, d, g.closed)
            self.after[d] = _parts(chord, chord * np.conj(e))[:, :, j], length[:, j]

    def costs(self, di: int, dj: int, weights: Weights, along: Float32Array) -> Float32Array:
        """Add what the chords of one kind of step cost to the node costs `along` it, rows from `di` on."""
        (chord_a, length_a), (chord_b, length_b) = self.before[di], self.after[dj]
        length_a, length_b = length_a[:, di:], length_b[:, di:]
        whole = length_a + length_b
        uneven = (length_a - length_b) / whole
        costs = along + np.float32(4 * weights.stretch) * uneven * uneven
        if weights.heading:
            alike = np.einsum("cbr,cbrw->brw", chord_a[:, :, di:], chord_b[:, :, di:])
            costs += np.float32(weights.heading) * (1 - alike)
        return np.asarray(costs * whole * np.float32(0.5))


def _parts(*vectors: ComplexArray) -> Float32Array:
    """Real and imaginary parts one after the other: products of such are sums of scalar products."""
    return np.stack([part for v in vectors for part in (v.real, v.imag)]).astype(np.float32)


def _chords(z: ComplexArray, shares: FloatArray, step: int, closed: bool) -> tuple[ComplexArray, Float32Array]:
    """Unit chords that end at every node, `step` nodes long, and their shares of the length."""
    m = z.shape[1]
    start = (np.arange(m) - step) % m
    chord = z - z[:, start]
    length = shares[:, :m] - shares[:, start]
    length = length + (length <= 0) if closed else np.abs(length)  # an open ring's first few are never used
    size = np.abs(chord)
    unit = np.divide(chord, size, out=np.zeros_like(chord), where=size > 0)
    return unit, np.maximum(length, 1e-12).astype(np.float32)


def _jumping(knots: IntArray, di: int, rows: int) -> IntArray:
    """Rows at which a step of `di` rows would have jumped over a knot."""
    over = (knots[:, None] + np.arange(1, di)).ravel()
    return np.unique(over[over < rows])
