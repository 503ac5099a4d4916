"""Plan once, evaluate often: all that needs thought about a span is done before the first frame is asked for."""

import operator
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.errors import GeometryError
from core.geometry.outline import FloatArray, as_points
from core.methods.assembly import assemble, natural_turn
from core.methods.intrinsic import IntrinsicPaths
from core.methods.linear import LinearPaths
from core.methods.pins import Paths, Pin, PinnedPaths, hold
from core.methods.placement import PLACEMENTS

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


def plan(
    a: npt.ArrayLike,
    b: npt.ArrayLike,
    *,
    method: str = "intrinsic",
    closed: bool = True,
    turns: int = 0,
    pins: Sequence[Pin] = (),
    placement: str = "still",
) -> Plan:
    """Return the paths from `a` to `b`, to be evaluated at any number of times.

    Parameters as of `core.inbetween` and `plan_drawing`.
    """
    left = as_points(a, name="before", closed=closed)
    right = as_points(b, name="after", closed=closed)
    pairs = [AlignedPair(left, right, closed)]
    return Plan(plan_drawing(pairs, method=method, turns=turns, pins=pins, placement=placement))


def plan_drawing(
    pairs: Sequence[AlignedPair],
    *,
    method: str = "intrinsic",
    turns: int = 0,
    pins: Sequence[Pin] = (),
    placement: str = "still",
) -> DrawingPlan:
    """Return the paths of all outlines of a drawing, which move as one thing: a hole stays in its place.

    Parameters
    ----------
    pairs : sequence of AlignedPair
        The outlines. Unlike in `plan`, a side may be a single point.
    method, turns, placement
        As of `core.inbetween`.
    pins : sequence of Pin
        Points whose way is given, on whatever outline; every frame has them exactly there. They decide where
        frames lie, and not the placement.

    Raises
    ------
    GeometryError
        As `core.inbetween`.
    """
    if method not in METHODS:
        raise GeometryError(f'unknown method "{method}"; known are {", ".join(METHODS)}')
    if placement not in PLACEMENTS:
        raise GeometryError(f'unknown placement "{placement}"; known are {", ".join(PLACEMENTS)}')
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
    paths, note = _paths([(p.left, p.right, p.closed) for p in pairs], method, turns, pins, placement)
    return DrawingPlan(tuple(pairs), paths, note)


def turn_of(pairs: Sequence[AlignedPair]) -> float:
    """Return the turn of a drawing as a whole without extra turns, radians in (-pi, pi], from x towards y.

    The mean over its edges, each by its length. An exact half turn (to a billionth) has no shorter side; it is pi.
    """
    return natural_turn([(p.left, p.right, p.closed) for p in pairs])


def other_way(turns: int, natural: float) -> int:
    """Return the extra turns with which a drawing goes round the other way, ending as before.

    Parameters
    ----------
    turns : int
        Extra turns now.
    natural : float
        As of `turn_of`. A drawing that does not turn counts as one that goes from x towards y.

    Notes
    -----
    By +60 degrees becomes by -300, by -60 becomes by +300; with an extra turn by +420 becomes by -660. Done twice
    it changes nothing.
    """
    return -turns - (1 if natural >= 0 else -1)


def _paths(
    outlines: Sequence[tuple[FloatArray, FloatArray, bool]],
    method: str,
    turns: int,
    pins: Sequence[Pin],
    placement: str,
) -> tuple[Paths, str]:
    """Return the paths of all vertices, led through the pins, and what the method could not do as it should."""
    bending, note = None, ""
    held = hold(pins, outlines) if pins else None
    paths: Paths
    if method == "linear" or not outlines:
        paths = LinearPaths.of([(left, right) for left, right, _ in outlines])
    elif method == "intrinsic":
        paths = IntrinsicPaths.of(assemble(outlines, turns=turns, placement=placement))
    else:
        from core.methods import rigid  # sparse solvers take a while to import

        paths, note = rigid.rigid_paths(outlines, turns=turns, placement=placement)
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
