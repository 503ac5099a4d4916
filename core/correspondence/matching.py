"""The automatic correspondence of two outlines: the best one, the runners-up, and a quick one for dragging."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy.typing as npt

from core.correspondence.pairing import Anchor, Correspondence
from core.correspondence.problem import Problem, problems
from core.correspondence.quick import QUICK_FINE, quick_solution
from core.correspondence.solve import Solution, finished, ranked
from core.correspondence.track import apart
from core.geometry.outline import as_points

DIFFERENT = 0.03
"""Mean distance along the outline, as a share of the perimeter, at which two answers are truly different."""


@dataclass(frozen=True)
class Alternative:
    """One way to match two outlines, and what it costs.

    All costs are mean squares in units of the squared radius (root mean square) of the shapes; they do not depend
    on scale. They can be compared among the alternatives of one pair, not between pairs.

    Attributes
    ----------
    correspondence : Correspondence
    cost : float
        Sum of the three others, 0 or more; least for the best.
    stretch : float
        Parts that grow, shrink or shear.
    bend : float
        Directions of the outline that change against those of their neighbourhood.
    turn : float
        Turning of the whole.
    """

    correspondence: Correspondence
    cost: float
    stretch: float
    bend: float
    turn: float


def match(
    a: npt.ArrayLike, b: npt.ArrayLike, anchors: Sequence[Anchor] = (), *, closed: bool = True
) -> Correspondence:
    """Return the correspondence of two outlines that a person would most likely choose; it keeps every anchor.

    The answer does not depend on start vertices, directions of drawing, places and scales, nor on a common turn of
    both; exchanging the outlines gives its inverse. A shape drawn twice does not move.

    Parameters
    ----------
    a, b : (n, 2), (m, 2) array_like
        The outlines before and after, in px; any vertex counts.
    anchors : sequence of (float, float)
        Pairs of positions (edge index and fraction) that must correspond.
    closed : bool
        Whether the outlines are closed (both) or open (both). Ends of open ones go to ends.

    Returns
    -------
    Correspondence
        Holds every anchor among its pairs, exactly.

    Raises
    ------
    GeometryError
        If an outline cannot be drawn.
    CorrespondenceError
        If the anchors cross, share a point or lie off their outline.

    Notes
    -----
    A few guesses are found by cyclic dynamic programming (Sederberg and Greenwood 1992; starts as Maes 1990)
    with two plain costs, one that sees limbs which turn far and one that sees letters. Each is refined with
    local rigid frames and judged by the deformation it implies. Time hardly depends on the numbers of vertices:
    the search works on nodes set along the outlines.
    """
    return finished(ranked(_problems(a, b, anchors, closed))[0])


def alternatives(
    a: npt.ArrayLike, b: npt.ArrayLike, anchors: Sequence[Anchor] = (), *, closed: bool = True, count: int = 6
) -> tuple[Alternative, ...]:
    """Return truly different ways to match two outlines, best first; the first is what `match` answers.

    Parameters
    ----------
    a, b, anchors, closed
        As for `match`.
    count : int
        How many at most; there may be fewer, with anchors often only one.

    Returns
    -------
    tuple of Alternative
        At least one.

    Raises
    ------
    GeometryError, CorrespondenceError
        As `match`.
    """
    chosen: list[Solution] = []
    for s in ranked(_problems(a, b, anchors, closed), keep=max(6, count + 2)):
        if all(_different(s, c) for c in chosen):
            chosen.append(s)
    return tuple(_alternative(s) for s in chosen[: max(1, count)])


def match_quick(
    a: npt.ArrayLike,
    b: npt.ArrayLike,
    anchors: Sequence[Anchor] = (),
    *,
    closed: bool = True,
    near: Correspondence | None = None,
) -> Correspondence:
    """Return a correspondence that keeps every anchor, fast enough to follow the pointer.

    It differs from `match` in that it considers one candidate only, solved on fewer nodes: given `near`, the
    previous answer slid so that it goes through the anchors; else the better of two blind guesses. It never jumps
    to another solution while an anchor is dragged; `match` at the end of the drag may.

    Parameters
    ----------
    a, b, anchors, closed
        As for `match`.
    near : Correspondence, optional
        The answer before this step of the drag, of outlines with the same vertex counts; ignored if the
        anchors cannot be reached from it.

    Returns
    -------
    Correspondence

    Raises
    ------
    GeometryError, CorrespondenceError
        As `match`.
    """
    solution = quick_solution(_problems(a, b, anchors, closed), near)
    return finished(solution, QUICK_FINE, rounds=1)


def _problems(a: npt.ArrayLike, b: npt.ArrayLike, anchors: Sequence[Anchor], closed: bool) -> list[Problem]:
    p, q = as_points(a, name="before", closed=closed), as_points(b, name="after", closed=closed)
    return problems(p, q, anchors, closed=closed)


def _different(one: Solution, other: Solution) -> bool:
    if one.problem is not other.problem:
        return True
    return apart(one.track, other.track, closed=one.problem.first.closed) >= DIFFERENT


def _alternative(s: Solution) -> Alternative:
    v = s.verdict
    return Alternative(finished(s), v.cost, v.stretch, v.bend, v.turn)
