"""First guesses: the cheapest paths of two plain costs over all starts, each right for another kind of drawing."""

import numpy as np

from core.correspondence.cost import Grid, Weights, bend_costs, grid, square_distances, step_costs
from core.correspondence.cyclic import MARGIN, Float32Array, IntArray, ends, sweep, trace
from core.correspondence.ring import Ring
from core.correspondence.track import Knots, Track, apart, spread, track_through
from core.geometry.outline import FloatArray

NODES = 64
EVERY = 2
"""Starts are tried at every second node."""

BAND = 28
"""How far a path may leave even arc length, in nodes."""

KEPT = 5
"""Local minima over the start that are kept of each cost."""

SAME = 0.015
"""Tracks nearer than this share of the perimeter are one candidate."""

BENDING = Weights(heading=0.0, stretch=0.5)
"""Only angles count: sees limbs that turn far, is blind to a letter that is turned over."""

POSING = Weights(heading=1.0, stretch=0.2)
"""Places and directions count: sees letters, loses limbs that turn far."""


def candidates(before: Ring, after: Ring, knots: Knots) -> list[Track]:
    """Return the first guesses, the cheapest of each cost first, no two alike."""
    found = _between(before, after, knots) if knots else _over_all_starts(before, after)
    return distinct(found, closed=before.closed)


def distinct(tracks: list[Track], *, closed: bool, distance: float = SAME) -> list[Track]:
    """Drop every track that lies near an earlier one."""
    kept: list[Track] = []
    for t in tracks:
        if all(apart(t, k, closed=closed) >= distance for k in kept):
            kept.append(t)
    return kept


def _blind_costs(g: Grid, half: int) -> Float32Array:
    """Steps of both costs, as two candidates of a batch; the grid holds the same nodes twice."""
    bend = bend_costs(g, half + MARGIN)[:1]
    j = g.neighbours(half + MARGIN)
    place = square_distances(g.z[0][g.rows()][:, None], g.y[0][j])
    one = grid(g.before, g.after, g.u[:1], g.v[:1], g.knots)
    bending = step_costs(one, bend, BENDING)
    return np.concatenate([bending, step_costs(one, 0.2 * bend + place, POSING)], axis=2)


def _over_all_starts(before: Ring, after: Ring) -> list[Track]:
    share = np.arange(NODES + 1) / NODES
    g = grid(before, after, np.tile(share, (2, 1)), np.tile(share, (2, 1)))
    costs = _blind_costs(g, BAND + NODES // 2)[:, :, :, 0]
    windows = np.lib.stride_tricks.sliding_window_view(costs, 2 * BAND + 1, axis=3)[:, :, :, :NODES:EVERY]
    start = np.zeros(NODES // EVERY, dtype=np.intp)
    table = sweep(windows, start)
    kind, which = _minima(ends(table, start))
    paths = trace(table, windows, (kind, which), np.zeros_like(which))
    shifts = which * EVERY - NODES // 2
    return [track_through(g, 0, rows, w + shift) for (rows, w), shift in zip(paths, shifts, strict=True)]


def _minima(costs: FloatArray | Float32Array) -> tuple[IntArray, IntArray]:
    """Local minima over the start (cyclic), the few cheapest of each cost: indices of cost and start."""
    low = (costs <= np.roll(costs, 1, axis=1)) & (costs <= np.roll(costs, -1, axis=1))
    ranked = np.argsort(np.where(low, costs, np.inf), axis=1, kind="stable")[:, :KEPT]
    kind = np.repeat(np.arange(len(costs)), ranked.shape[1])
    keep = low[kind, ranked.ravel()]
    return kind[keep], ranked.ravel()[keep]


def _between(before: Ring, after: Ring, knots: Knots) -> list[Track]:
    """Two guesses, no choice of start: the pieces between the knots are solved by each cost."""
    g = spread(before, after, [knots.straight()] * 2, knots, NODES)
    half = min(int(np.diff(g.knots).max()), BAND)
    costs = _blind_costs(g, half)
    start = np.zeros(1, dtype=np.intp)
    table = sweep(costs, start)
    both = np.arange(2)
    paths = trace(table, costs, (both, np.zeros_like(both)), np.zeros_like(both))
    return [track_through(g, 0, rows, w) for rows, w in paths]
