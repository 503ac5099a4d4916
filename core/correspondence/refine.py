"""Make a guess better: fit local rigid frames to it, solve again with what they say, and so on.

This is the iterated closest point scheme with many frames in place of one, and a monotone path in place of
the closest points.
"""

from dataclasses import dataclass

import numpy as np

from core.correspondence.cost import Grid, Weights, bend_costs, square_distances, step_costs
from core.correspondence.cyclic import MARGIN, IntArray, ends, sweep, trace
from core.correspondence.frames import Frames, frames
from core.correspondence.ring import Ring
from core.correspondence.track import Knots, Track, spread, track_through
from core.geometry.outline import FloatArray

REFINING = Weights(heading=2.0, stretch=0.15)

BENDS = 0.02
"""Weight of the turning angles: only where places and directions say nothing."""


@dataclass(frozen=True)
class Band:
    """How finely and how far from the guess to look.

    Attributes
    ----------
    nodes : int
    width, starts : int
        Largest offsets of paths and of their starts, in nodes.
    reach : float
        Width of the local frames in radii. Narrower ones follow a bend more closely, but lose their way where the
        guess is not near yet.
    """

    nodes: int
    width: int
    starts: int
    reach: float


COARSE = Band(nodes=64, width=16, starts=4, reach=0.5)
FINE = Band(nodes=256, width=8, starts=3, reach=0.4)


def refined(before: Ring, after: Ring, tracks: list[Track], knots: Knots, band: Band) -> list[Track]:
    """Return every track solved again in the frames that it implies."""
    g = spread(before, after, tracks, knots, band.nodes)
    costs = step_costs(g, _node_costs(g, f := frames(g, band.reach), band.width + MARGIN), REFINING, f.heading)
    starts = np.zeros(1, dtype=np.intp) if knots else np.arange(-band.starts, band.starts + 1)
    table = sweep(costs, starts)
    best = ends(table, starts).argmin(axis=1)
    which: tuple[IntArray, IntArray] = (np.arange(len(tracks)), best)
    paths = trace(table, costs, which, starts[best])
    return [track_through(g, b, rows, w) for b, (rows, w) in enumerate(paths)]


def _node_costs(g: Grid, f: Frames, half: int) -> FloatArray:
    """How far the frames of both nodes miss each other, squared: (B, R + 1, 2 half + 1)."""
    rows, j = g.rows()[:, None], g.neighbours(half)
    total = BENDS * bend_costs(g, half)
    for trust, forward, backward in zip(f.trust, f.forward, f.backward, strict=True):
        there = square_distances(forward[:, rows], f.y[:, j])
        back = square_distances(f.z[:, rows], backward[:, j])
        total += 0.5 * trust[:, None, None] * (there + back)
    return total
