"""A look at the film that a candidate makes: whether in-betweens cross themselves, whether their area runs away.

The in-betweens are sketches: turning angles and edge lengths between the keyframes' (Sederberg, Gao, Wang and Mu
1993), what does not close spread over the edges in proportion to their lengths.
"""

import numpy as np
import numpy.typing as npt

from core.correspondence.ring import ComplexArray
from core.geometry.outline import FloatArray

MOMENTS = np.array([0.125, 0.25, 0.5, 0.75, 0.875])

CROSSING = 0.15
SWELLING = 0.1

FLAT = 1e-6
"""Area, in squared radii, below which an outline has none."""


def film_factor(z: ComplexArray, y: ComplexArray) -> float:
    """Return by how much the film of two closed keyframes, (n,) each, worsens their cost; 1 or more."""
    frames = sketches(z, y, MOMENTS)
    crosses = bool(crossing(frames).any()) and not bool(crossing(np.stack([z, y])).any())
    areas, (low, high) = np.abs(_areas(frames)), sorted(np.abs(_areas(np.stack([z, y]))))
    swelling = max(0.0, float(areas.max() / max(high, FLAT)) - 1, 1 - float(areas.min() / max(low, FLAT)))
    return (1 + CROSSING * crosses) * (1 + SWELLING * min(1.0, swelling))


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
    p, q = z[:, :, None], np.roll(z, -1, axis=1)[:, :, None]
    d = q - p
    ahead = (np.conj(d) * (p.swapaxes(1, 2) - p)).imag
    beyond = np.roll(ahead, -1, axis=2)
    astride = ahead * beyond < 0
    return np.asarray((astride & astride.swapaxes(1, 2)).any(axis=(1, 2)))
