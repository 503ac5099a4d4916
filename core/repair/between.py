"""In-betweens by any method, repaired if wanted."""

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray
from core.methods import plan as methods


def inbetween(
    a: npt.ArrayLike,
    b: npt.ArrayLike,
    t: npt.ArrayLike,
    method: str = "intrinsic",
    *,
    closed: bool = True,
    turns: int = 0,
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
        Whole turns added to the shortest one (not for linear); positive from x towards y.
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
        If a keyframe is no outline, the vertex counts differ (both are named), the method is unknown, the
        turns are not whole or a t is not finite (or beyond a million).

    Examples
    --------
    >>> square = [[0, 0], [2, 0], [2, 2], [0, 2]]
    >>> half_turned = [[2, 2], [0, 2], [0, 0], [2, 0]]
    >>> float(abs(inbetween(square, half_turned, 0.5, "linear") - 1).max())
    0.0
    >>> float(abs(inbetween(square, half_turned, 0.5, "linear", repair=True) - 1).max()) > 0.1
    True
    """
    if not repair:
        return methods.inbetween(a, b, t, method, closed=closed, turns=turns)
    from core.repair.plan import plan_repair  # sparse solvers take a while to import

    times = methods.as_times(t)
    plan = methods.plan(a, b, method=method, closed=closed, turns=turns)
    frames = plan_repair(plan).evaluate(np.atleast_1d(times))
    return frames if times.ndim else frames[0]
