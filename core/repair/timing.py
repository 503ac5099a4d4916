"""When to be where: a detour takes time, and no vertex shall jump."""

from collections.abc import Callable

import numpy as np

from core.geometry.outline import FloatArray
from core.repair.chains import ComplexArray

FASTEST = 2.4
"""Speed limit of a repaired part, in median speeds of the path."""

MOST_JUMP = 2.9
"""Median steps that the largest step between neighbouring frames may be, frames being a 240th apart."""

FILLED = 0.9
"""Share of a part's time that moves at the limit may fill before the part is widened."""


def move_lengths(places: ComplexArray) -> FloatArray:
    """How far the vertex that goes farthest goes in every move between places (K, n), (K - 1,)."""
    return np.asarray(np.abs(np.diff(places, axis=0)).max(axis=1), np.float64)


def jumps(path: Callable[[FloatArray], ComplexArray]) -> float:
    """Return the largest step between neighbouring ones of 241 frames, in median steps."""
    steps = move_lengths(path(np.linspace(0.0, 1.0, 241)))
    middle = float(np.median(steps))
    return float(steps.max()) / middle if middle > 0 else np.inf


def speed_limit(frames: ComplexArray) -> float:
    """Return the most a vertex may go in one span's time, from wished frames at even times."""
    return FASTEST * float(np.median(move_lengths(frames))) * (len(frames) - 1)


def durations(wished: FloatArray, lengths: FloatArray, whole: float, limit: float) -> FloatArray:
    """Return how long each move takes: as wished, but none faster than the limit, and `whole` in all.

    Parameters
    ----------
    wished, lengths : (K,) float array
        Durations had nothing been in the way; lengths of the moves.
    whole, limit : float
        Time there is, and the speed limit. If that is too little time, all moves have one speed.

    Notes
    -----
    The duration is max(a wished, length / limit) with the a that fills the time, found by bisection.
    """
    least = lengths / limit if limit > 0 else np.full(len(lengths), np.inf)
    if not least.sum() < whole:
        share = lengths / lengths.sum() if lengths.sum() > 0 else np.full(len(lengths), 1 / len(lengths))
        return np.asarray(whole * share, np.float64)
    low, high = 0.0, 1.0
    while np.maximum(high * wished, least).sum() < whole and high < 1e9:
        high *= 2
    for _ in range(60):
        middle = (low + high) / 2
        if np.maximum(middle * wished, least).sum() < whole:
            low = middle
        else:
            high = middle
    taken = np.maximum(high * wished, least)
    return np.asarray(taken * (whole / taken.sum()), np.float64)
