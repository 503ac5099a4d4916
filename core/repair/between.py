"""In-betweens by any method, repaired if wanted."""

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray
from core.methods.plan import Plan, as_times, plan

if TYPE_CHECKING:
    from core.repair.plan import RepairedPlan


def inbetween(
    a: npt.ArrayLike,
    b: npt.ArrayLike,
    t: npt.ArrayLike,
    method: str = "intrinsic",
    *,
    closed: bool = True,
    turns: int = 0,
    placement: str = "still",
    repair: bool = False,
) -> FloatArray:
    """Return the outline between two keyframes at the time t, or at many times at once.

    Parameters
    ----------
    a, b : (n, 2) array_like
        The keyframes in stage px; a[i] corresponds to b[i] (see `core.match` where it does not).
    t : float or (T,) array_like
        0 is `a`, 1 is `b`; may leave [0, 1] (easing that overshoots).
    method : str
        One of `METHODS`.
    closed : bool
        Whether the last vertex is joined to the first.
    turns : int
        Whole turns added to the shortest one (not for linear); positive from x towards y. The other way round is
        one turn against the shortest one, see `core.methods.plan.other_way`.
    placement : str
        Where the in-betweens lie (not for linear): "still", where what hardly moves between the keyframes stays
        still, or "centroid": the centroid of the area goes straight.
    repair : bool
        Whether to bend the paths where they lead to a crossing. If the keyframes do not cross themselves and run
        the same way round, no in-between within [0, 1] does; else nothing is changed (`plan_repair` says why).
        Takes a tenth of a second where nothing is wrong and seconds where much is.

    Returns
    -------
    (n, 2) or (T, n, 2) float array
        Finite; at t = 0 and t = 1 the keyframes bit for bit.

    Raises
    ------
    GeometryError
        If a keyframe is no outline, the vertex counts differ (both are named), the method or the placement is
        unknown, the turns are not whole or a t is not finite (or beyond a million).

    Notes
    -----
    `linear` is (1 - t) a + t b. `intrinsic` interpolates lengths and headings of the edges (Sederberg, Gao, Wang
    and Mu, "2-D shape blending", SIGGRAPH 1993). `rigid` lets the interior turn and stretch as one (Alexa,
    Cohen-Or and Levin, SIGGRAPH 2000); where that cannot be it falls back to intrinsic, which the `note` of the
    plan says. Both depend neither on scale, position, start vertex and drawing direction nor on which keyframe
    comes first (rigid up to its choice of a mesh); only an exact half turn has no shorter side and goes from x
    towards y.

    Examples
    --------
    >>> square = [[0, 0], [2, 0], [2, 2], [0, 2]]
    >>> quarter_turned = [[2, 0], [2, 2], [0, 2], [0, 0]]
    >>> inbetween(square, quarter_turned, 0.5).round(3) + 0.0
    array([[ 1.   , -0.414],
           [ 2.414,  1.   ],
           [ 1.   ,  2.414],
           [-0.414,  1.   ]])
    >>> half_turned = [[2, 2], [0, 2], [0, 0], [2, 0]]
    >>> float(abs(inbetween(square, half_turned, 0.5, "linear") - 1).max())
    0.0
    >>> float(abs(inbetween(square, half_turned, 0.5, "linear", repair=True) - 1).max()) > 0.1
    True
    """
    times = as_times(t)
    made = plan(a, b, method=method, closed=closed, turns=turns, placement=placement)
    frames = (_repaired(made) if repair else made).evaluate(np.atleast_1d(times))
    return frames if times.ndim else frames[0]


def _repaired(made: Plan) -> "RepairedPlan":
    from core.repair.plan import plan_repair  # sparse solvers take a while to import

    return plan_repair(made)
