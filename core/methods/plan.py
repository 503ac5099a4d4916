"""Plan once, evaluate often: all that needs thought about a span is done before the first frame is asked for."""

import operator
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.errors import GeometryError
from core.geometry.outline import FloatArray, as_points
from core.methods.assembly import assemble
from core.methods.intrinsic import IntrinsicPaths
from core.methods.linear import LinearPaths
from core.methods.pins import Paths, Pin, PinnedPaths, hold

METHODS: tuple[str, ...] = ("linear", "intrinsic", "rigid")
"""The names of the methods, from the simplest to the best."""


LARGEST_TIME = 1e6
"""No easing overshoots so far; beyond it headings lose their digits and at last overflow."""


@dataclass(frozen=True, eq=False)
class AlignedPair:
    """One outline in both keyframes: left[i] corresponds to right[i].

    Attributes
    ----------
    left, right : (k, 2) float array
        Vertices in stage px. One side may be a single point k times: the outline grows out of it or shrinks to it.
    closed : bool
    """

    left: FloatArray
    right: FloatArray
    closed: bool = True


@dataclass(frozen=True, eq=False)
class DrawingPlan:
    """Paths of all vertices of a drawing over one span; made by `plan_drawing`.

    Attributes
    ----------
    pairs : tuple of AlignedPair
    paths : Paths
        What places the vertices.
    note : str
        What the method could not do as it should, in a sentence for the artist; empty when all is well.
    """

    pairs: tuple[AlignedPair, ...]
    paths: Paths
    note: str = ""

    def evaluate(self, t: npt.ArrayLike) -> tuple[FloatArray, ...]:
        """Return the in-betweens at the times `t` (T,): an array (T, k_i, 2) for every outline, in px.

        At t = 0 and t = 1 they are the keyframes bit for bit. t may leave [0, 1] (easing that overshoots).

        Raises
        ------
        GeometryError
            If a t is not a finite number.
        """
        times = np.atleast_1d(as_times(t))
        frames = self.paths.evaluate(times)
        first = 0
        outlines = []
        for pair in self.pairs:
            outline = frames[:, first : first + len(pair.left)]
            outline[times == 0] = pair.left
            outline[times == 1] = pair.right
            outlines.append(outline)
            first += len(pair.left)
        return tuple(outlines)


@dataclass(frozen=True, eq=False)
class Plan:
    """Paths of the vertices of one outline over one span; made by `plan`."""

    drawing: DrawingPlan

    @property
    def note(self) -> str:
        """See `DrawingPlan`."""
        return self.drawing.note

    def evaluate(self, t: npt.ArrayLike) -> FloatArray:
        """Return the in-betweens at the times `t` (T,) as (T, n, 2), in px; see `DrawingPlan.evaluate`."""
        return self.drawing.evaluate(t)[0]


def inbetween(
    a: npt.ArrayLike,
    b: npt.ArrayLike,
    t: npt.ArrayLike,
    method: str = "intrinsic",
    *,
    closed: bool = True,
    turns: int = 0,
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

    Returns
    -------
    (n, 2) or (T, n, 2) float array
        Finite; at t = 0 and t = 1 the keyframes bit for bit.

    Raises
    ------
    GeometryError
        If a keyframe is no outline, the vertex counts differ (both are named), the method is unknown, the
        turns are not whole or a t is not finite (or beyond a million).

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
    """
    times = as_times(t)
    frames = plan(a, b, method=method, closed=closed, turns=turns).evaluate(np.atleast_1d(times))
    return frames if times.ndim else frames[0]


def plan(
    a: npt.ArrayLike,
    b: npt.ArrayLike,
    *,
    method: str = "intrinsic",
    closed: bool = True,
    turns: int = 0,
    pins: Sequence[Pin] = (),
) -> Plan:
    """Return the paths from `a` to `b`, to be evaluated at any number of times.

    Parameters as of `inbetween` and `plan_drawing`.
    """
    left = as_points(a, name="before", closed=closed)
    right = as_points(b, name="after", closed=closed)
    return Plan(plan_drawing([AlignedPair(left, right, closed)], method=method, turns=turns, pins=pins))


def plan_drawing(
    pairs: Sequence[AlignedPair], *, method: str = "intrinsic", turns: int = 0, pins: Sequence[Pin] = ()
) -> DrawingPlan:
    """Return the paths of all outlines of a drawing, which move as one thing: a hole stays in its place.

    Parameters
    ----------
    pairs : sequence of AlignedPair
        The outlines. Unlike in `plan`, a side may be a single point.
    method, turns
        As of `inbetween`.
    pins : sequence of Pin
        Points whose way is given, on whatever outline; every frame has them exactly there.

    Raises
    ------
    GeometryError
        As `inbetween`.
    """
    if method not in METHODS:
        raise GeometryError(f'unknown method "{method}"; known are {", ".join(METHODS)}')
    try:
        turns = operator.index(turns)
    except TypeError:
        raise GeometryError(f"turns is {turns!r}; expected a whole number") from None
    for k, pair in enumerate(pairs):
        if len(pair.left) != len(pair.right):
            where = f"outline {k}: " if len(pairs) > 1 else ""
            raise GeometryError(
                f"{where}before has {len(pair.left)} vertices, after has {len(pair.right)}; match them first"
            )
    paths, note = _paths([(p.left, p.right, p.closed) for p in pairs], method, turns, pins)
    return DrawingPlan(tuple(pairs), paths, note)


def _paths(
    outlines: Sequence[tuple[FloatArray, FloatArray, bool]], method: str, turns: int, pins: Sequence[Pin]
) -> tuple[Paths, str]:
    """Return the paths of all vertices, led through the pins, and what the method could not do as it should."""
    bending, note = None, ""
    held = hold(pins, outlines) if pins else None
    paths: Paths
    if method == "linear" or not outlines:
        paths = LinearPaths.of([(left, right) for left, right, _ in outlines])
    elif method == "intrinsic":
        paths = IntrinsicPaths.of(assemble(outlines, turns=turns))
    else:
        from core.methods import rigid  # sparse solvers take a while to import

        paths, note = rigid.rigid_paths(outlines, turns=turns)
        if held is not None and isinstance(paths, rigid.RigidPaths):
            bending = rigid.RigidBending.of(paths, held.weights)
    return (paths if held is None else PinnedPaths(paths, held, bending)), note


def as_times(t: npt.ArrayLike) -> FloatArray:
    """Return `t`, a number or a row of them, as a checked float array; `GeometryError` where it is neither."""
    try:
        times = np.asarray(t, dtype=np.float64)
    except (TypeError, ValueError):
        raise GeometryError(f"t must be a number or a row of numbers, not {t!r}") from None
    if times.ndim > 1:
        raise GeometryError(f"t has the shape {times.shape}; expected a number or (T,)")
    if not np.isfinite(times).all():
        raise GeometryError("t is not a finite number")
    if times.size and (largest := float(np.abs(times).max())) > LARGEST_TIME:
        raise GeometryError(f"t is {largest:.3g}; the limit is {LARGEST_TIME:.0e} spans away")
    return times
