"""A look at the film that a candidate makes: whether in-betweens cross themselves, whether their area runs away.

The in-betweens are sketches: turning angles and edge lengths between the keyframes' (Sederberg, Gao, Wang and Mu
1993), what does not close spread over the edges in proportion to their lengths.
"""

import numpy as np
import numpy.typing as npt

from core.correspondence.cyclic import IntArray
from core.correspondence.ring import ComplexArray
from core.geometry.outline import FloatArray

MOMENTS = np.arange(1, 8) / 8

CROSSING = 0.25
SWELLING = 0.1

MOST_PAIRS = 2_000_000
"""Pairs of edges beyond which a film is not searched for crossings: a comb of thousands of teeth has them."""

FLAT = 1e-6
"""Area, in squared radii, below which an outline has none."""


def film_factor(z: ComplexArray, y: ComplexArray) -> float:
    """Return by how much the film of two closed keyframes, (n,) each, worsens their cost; 1 or more."""
    frames = sketches(z, y, MOMENTS)
    crosses = bool(crossing(frames).any()) and not bool(crossing(np.stack([z, y])).any())
    areas, (low, high) = np.abs(_areas(frames)), sorted(np.abs(_areas(np.stack([z, y]))))
    swelling = max(0.0, (areas.max() - high) / max(high, FLAT), (low - areas.min()) / max(low, FLAT))
    return float(1 + CROSSING * crosses) * (1 + SWELLING * min(1.0, float(swelling)))


def sketches(z: ComplexArray, y: ComplexArray, t: FloatArray) -> ComplexArray:
    """Return intrinsic in-betweens of two closed outlines in correspondence: (n,), (n,), (T,) -> (T, n)."""
    d, e = (np.roll(x, -1) - x for x in (z, y))
    turns = [np.angle(_ratio(x, np.roll(x, 1))) for x in (d, e)]
    # both outlines turn once in all, so the angles between them do too
    start = np.angle(_ratio(e[:1], d[:1]))[0]
    s = t[:, None]
    turn = (1 - s) * turns[0] + s * turns[1]
    direction = np.angle(d[0]) if d[0] else 0.0
    heading = direction + s * start + np.cumsum(turn, axis=1) - turn[:, :1]
    lengths = (1 - s) * np.abs(d) + s * np.abs(e)
    edges = lengths * np.exp(1j * heading)
    edges -= lengths * (edges.sum(axis=1) / np.maximum(lengths.sum(axis=1), np.finfo(float).tiny))[:, None]
    return np.asarray(np.cumsum(edges, axis=1) - edges)


def _ratio(p: ComplexArray, q: ComplexArray) -> ComplexArray:
    product = p * np.conj(q)
    return np.where(product == 0, 1.0, product)


def _areas(z: ComplexArray) -> FloatArray:
    return np.asarray(0.5 * (np.conj(z) * np.roll(z, -1, axis=1)).imag.sum(axis=1))


def crossing(z: ComplexArray) -> npt.NDArray[np.bool_]:
    """Whether closed outlines cross themselves: (T, n) -> (T,). Touching is not crossing."""
    return np.array([_crosses(p, np.roll(p, -1)) for p in z])


def _crosses(p: ComplexArray, q: ComplexArray) -> bool:
    """Whether any two of the segments from `p` to `q` cross; those whose boxes are apart are not compared."""
    swept = min((_Overlaps(x, y) for x, y in ((p.real, q.real), (p.imag, q.imag))), key=lambda o: o.count)
    if swept.count > MOST_PAIRS:
        return False
    i, j = swept.pairs()
    for x, y in ((p.real, q.real), (p.imag, q.imag)):
        low, high = np.minimum(x, y), np.maximum(x, y)
        near = (low[i] <= high[j]) & (low[j] <= high[i])
        i, j = i[near], j[near]
    return bool((_astride(p[i], q[i], p[j], q[j]) & _astride(p[j], q[j], p[i], q[i])).any())


class _Overlaps:
    """Pairs of intervals that overlap, found by sorting their lower ends; counted before they are listed."""

    def __init__(self, p: FloatArray, q: FloatArray) -> None:
        low, high = np.minimum(p, q), np.maximum(p, q)
        self.order = np.argsort(low, kind="stable")
        self.next = np.arange(1, len(p) + 1)
        end = np.searchsorted(low[self.order], high[self.order], side="right")
        self.counts = np.maximum(end - self.next, 0)
        self.count = int(self.counts.sum())

    def pairs(self) -> tuple[IntArray, IntArray]:
        begin = np.cumsum(self.counts) - self.counts
        later = np.arange(self.count) - np.repeat(begin - self.next, self.counts)
        return self.order[np.repeat(self.next - 1, self.counts)], self.order[later]


def _astride(p: ComplexArray, q: ComplexArray, r: ComplexArray, s: ComplexArray) -> npt.NDArray[np.bool_]:
    """Whether `r` and `s` lie on different sides of the line through `p` and `q`."""
    d = np.conj(q - p)
    return np.asarray((d * (r - p)).imag * (d * (s - p)).imag < 0)
