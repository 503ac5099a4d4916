"""One candidate instead of a search: follows an anchor while it is dragged."""

import numpy as np

from core.correspondence.candidates import candidates
from core.correspondence.judge import judged
from core.correspondence.pairing import Correspondence
from core.correspondence.problem import Problem
from core.correspondence.refine import Band, refined
from core.correspondence.solve import Solution
from core.correspondence.track import Knots, Track
from core.geometry.outline import FloatArray

QUICK = Band(nodes=64, width=16, starts=4, reach=0.5)
QUICK_FINE = Band(nodes=128, width=6, starts=2, reach=0.4)


def quick_solution(posed: list[Problem], near: Correspondence | None) -> Solution:
    """Return the solution near a previous correspondence, or the better of the blind guesses."""
    if near is not None:
        for p in posed:
            guess = _guess(p, near)
            if guess is not None:
                return _refined_best(p, [guess])
    solutions = [_refined_best(p, candidates(p.first, p.second, p.knots)) for p in posed]
    return min(solutions, key=lambda s: round(s.verdict.cost, 9))


def _refined_best(p: Problem, tracks: list[Track]) -> Solution:
    tracks = refined(p.first, p.second, tracks, p.knots, QUICK)
    verdicts = judged(p.first, p.second, tracks, p.knots)
    best = min(range(len(tracks)), key=lambda i: round(verdicts[i].cost, 9))
    return Solution(p, tracks[best], verdicts[best])


def _guess(p: Problem, near: Correspondence) -> Track | None:
    """The previous pairs as a track, slid through the knots; None if it cannot be."""
    if near.counts != p.counts or (near.closed, near.flipped) != (p.first.closed, p.flipped):
        return None
    columns = (near.after, near.before) if p.swapped else (near.before, near.after)
    u, v = p.first.shares_of(columns[0]), p.second.shares_of(columns[1])
    track = _track(u, v, p.first.closed)
    return _slid(track, p.knots, p.first.closed) if p.knots else track


def _track(u: FloatArray, v: FloatArray, closed: bool) -> Track:
    order = np.argsort(u)
    u, v = u[order], v[order]
    if not closed:
        return Track(u, v)
    v = v[0] + np.mod(v - v[0], 1.0)
    return Track(np.append(u, u[0] + 1), np.append(v, v[0] + 1))


def _slid(track: Track, knots: Knots, closed: bool) -> Track | None:
    images = track.images(knots.u, closed=closed)
    at = np.unique(np.append(knots.u[0] + np.mod(track.u - knots.u[0], 1.0) if closed else track.u, knots.u))
    # the walk stays between the first knot and itself a round later
    at = at[(at >= knots.u[0]) & (at <= knots.u[-1])]
    return Track(at, np.interp(track.images(at, closed=closed), images, knots.v))
