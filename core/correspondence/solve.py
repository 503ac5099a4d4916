"""From a problem to its ranked solutions, and from a solution to the finished track."""

from dataclasses import dataclass, replace

import numpy as np

from core.correspondence.candidates import candidates, distinct
from core.correspondence.corners import with_corners
from core.correspondence.film import film_factor
from core.correspondence.judge import Verdict, judged, verdict
from core.correspondence.pairing import Correspondence
from core.correspondence.problem import Problem
from core.correspondence.refine import COARSE, FINE, Band, refined
from core.correspondence.same import same_shape, whole_turn
from core.correspondence.settle import events, settled
from core.correspondence.track import Track
from core.geometry.outline import FloatArray

CLOSE_CALL = 1.3
"""Candidates that cost at most so many times the least are told apart by their films."""

NOISE = 1e-3
"""Candidates whose costs differ by less are told apart so, too: on few nodes it is where these happen to lie."""

MOST_FILMS = 4

JUDGED_NODES = 128

EXACT = 1e-11
"""Tolerance of the pairs of one shape drawn twice: it must not move at all."""


@dataclass(frozen=True, eq=False)
class Solution:
    """A track that solves a problem, and what it costs.

    Attributes
    ----------
    problem : Problem
    track : Track
    verdict : Verdict
    fine : bool
        Whether the track has been through the fine pass.
    """

    problem: Problem
    track: Track
    verdict: Verdict
    fine: bool = False


def ranked(problems: list[Problem], keep: int = 6) -> list[Solution]:
    """Return the solutions of one question, posed in one or in both directions, best first."""
    found = sorted((s for p in problems for s in _solutions(p, keep)), key=_rank)
    limit = CLOSE_CALL * found[0].verdict.cost + NOISE
    close = [s for s in found[:MOST_FILMS] if s.verdict.cost <= limit]
    if len(close) < 2 or not close[0].problem.first.closed:
        return found
    seen = [_after_the_film(s) for p in problems for s in _judged_finely(p, [s for s in close if s.problem is p])]
    return sorted(seen + found[len(close) :], key=_rank)


def _judged_finely(p: Problem, close: list[Solution]) -> list[Solution]:
    """Solve and judge again on many nodes: on few, where they happen to lie beside the corners decides."""
    if not close:
        return []
    fine = _fine(p, close, FINE, 2)
    verdicts = judged(p.first, p.second, [s.track for s in fine], p.knots, JUDGED_NODES)
    return [_exactly(replace(s, verdict=v)) for s, v in zip(fine, verdicts, strict=True)]


def _exactly(s: Solution) -> Solution:
    """One shape drawn twice has no misfit; only its turn counts."""
    p = s.problem
    same = same_shape(p.first, p.second, s.track, p.knots)
    return s if same is None else replace(s, verdict=verdict(0.0, 0.0, whole_turn(p.first, p.second, same)))


def _rank(s: Solution) -> tuple[float, bool]:
    """Nine digits of the cost; the same direction of both outlines decides a tie."""
    return round(s.verdict.cost, 9), s.problem.flipped


def _solutions(p: Problem, keep: int) -> list[Solution]:
    tracks = refined(p.first, p.second, candidates(p.first, p.second, p.knots), p.knots, COARSE)
    best = _judged(p, distinct(tracks, closed=p.first.closed))[:keep]
    tracks = [s.track for s in best]
    for _ in range(2):
        tracks = refined(p.first, p.second, tracks, p.knots, COARSE)
    return _judged(p, distinct(tracks, closed=p.first.closed))


def _judged(p: Problem, tracks: list[Track]) -> list[Solution]:
    verdicts = judged(p.first, p.second, tracks, p.knots)
    return sorted((Solution(p, t, v) for t, v in zip(tracks, verdicts, strict=True)), key=_rank)


def _fine(p: Problem, solutions: list[Solution], band: Band, rounds: int) -> list[Solution]:
    """Solve again on many nodes, near the tracks."""
    tracks = [s.track for s in solutions]
    for _ in range(rounds if tracks else 0):
        tracks = refined(p.first, p.second, tracks, p.knots, band)
    return [replace(s, track=t, fine=True) for s, t in zip(solutions, tracks, strict=True)]


def _after_the_film(s: Solution) -> Solution:
    """Worsen a solution by what its in-betweens, with every vertex, show."""
    u, v, _ = events(s.problem, s.track)
    return replace(s, verdict=s.verdict.scaled(film_factor(s.problem.first.at(u), s.problem.second.at(v))))


def finished(s: Solution, band: Band = FINE, rounds: int = 2) -> Correspondence:
    """Return the correspondence of a solution: finely solved, corners joined; exact for one shape drawn twice."""
    p = s.problem
    same = same_shape(p.first, p.second, s.track, p.knots)
    if same is not None:
        return settled(p, same, EXACT)
    track = s.track if s.fine else _fine(p, [s], band, rounds)[0].track
    knots = with_corners(p.first, p.second, track, p.knots)
    if len(knots.u) > len(p.knots.u):
        joined = _through(track, knots.u, knots.v, p.first.closed)
        track = refined(p.first, p.second, [joined], knots, band)[0]
    return settled(p, track)


def _through(track: Track, u: FloatArray, v: FloatArray, closed: bool) -> Track:
    """Bend a track so that it goes through knots near it, the rest following evenly."""
    images = track.images(u, closed=closed)
    at = np.unique(np.concatenate([_from(track.u, u[0], closed), u]))
    return Track(at, np.interp(track.images(at, closed=closed), images, v))


def _from(shares: FloatArray, start: float, closed: bool) -> FloatArray:
    return start + np.mod(shares - start, 1.0) if closed else shares
