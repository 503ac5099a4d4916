"""A plan whose in-betweens never cross themselves, where the keyframes do not."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from core.errors import CancelledError
from core.geometry.outline import FloatArray
from core.methods.assembly import in_a_row
from core.methods.pins import PinnedPaths
from core.methods.plan import AlignedPair, DrawingPlan, Plan, as_times, plan_drawing
from core.repair.barrier import Barrier
from core.repair.chains import Chains, ComplexArray, as_points
from core.repair.descent import Field
from core.repair.doubled import spread
from core.repair.join import Sketch
from core.repair.march import distance
from core.repair.pinned import Grip
from core.repair.route import Course, route
from core.repair.survey import TICKS
from core.repair.timing import jumps

LOOKS_A_TICK = 4
"""Times in the finest stretch of a span at which a repair with pins is looked at."""

MOST_PINNED_JUMP = 8.0
"""Largest step between neighbouring frames, in median steps, that a repair with pins may have."""

NO_WAY = "no way without a crossing was found; the in-betweens are as the method made them"
NO_WAY_WITH_PINS = "no way without a crossing was found that leaves the pins where they are; nothing is repaired"

Progress = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class RepairedDrawingPlan:
    """The paths of a drawing, bent where they led to a crossing; made by `repair_drawing`.

    Attributes
    ----------
    drawing : DrawingPlan
        The paths before the repair.
    parts : tuple of int
        The outlines that are repaired: all but those that are a point in one keyframe.
    course : Course or None
        Where these go instead, None where nothing is changed.
    notes : tuple of str
        What could not be repaired and why; empty when every in-between is simple.
    """

    drawing: DrawingPlan
    parts: tuple[int, ...] = ()
    course: Course | None = None
    notes: tuple[str, ...] = ()

    @property
    def changed(self) -> bool:
        """Whether any in-between is not the method's own."""
        return self.course is not None

    @cached_property
    def deviation(self) -> float:
        """Mean over time of the root mean square distance from the method's own vertices, in sizes of the drawing.

        Beyond a few hundredths the path is so tangled that another method, repaired, looks better.
        """
        if self.course is None:
            return 0.0
        times = np.linspace(0.0, 1.0, 65)
        both = (_row([plan.evaluate(times)[k] for k in self.parts]) for plan in (self, self.drawing))
        return float(distance(*both).mean()) / self.course.scale

    @property
    def pairs(self) -> tuple[AlignedPair, ...]:
        """The outlines in both keyframes."""
        return self.drawing.pairs

    def evaluate(self, t: npt.ArrayLike) -> tuple[FloatArray, ...]:
        """Return the in-betweens at the times `t` (T,): an array (T, k_i, 2) for every outline, in px.

        Within [0, 1] they are continuous in t; outside (easing that overshoots) the method's own, not repaired.
        """
        times = np.atleast_1d(as_times(t))
        outlines = self.drawing.evaluate(times)
        if self.course is None:
            return outlines
        rows, places = self.course.at(times)
        points = as_points(places)
        first = 0
        for outline in (outlines[k] for k in self.parts):
            outline[rows] = points[:, first : first + outline.shape[1]]
            first += outline.shape[1]
        return outlines


@dataclass(frozen=True, eq=False)
class RepairedPlan:
    """The paths of one outline, repaired; made by `plan_repair`."""

    drawing: RepairedDrawingPlan

    @property
    def changed(self) -> bool:
        """Whether any in-between is not the method's own."""
        return self.drawing.changed

    @property
    def deviation(self) -> float:
        """How far the in-betweens are bent; see `RepairedDrawingPlan.deviation`."""
        return self.drawing.deviation

    @property
    def notes(self) -> tuple[str, ...]:
        """What could not be repaired and why; empty when every in-between is simple."""
        return self.drawing.notes

    def evaluate(self, t: npt.ArrayLike) -> FloatArray:
        """Return the in-betweens at the times `t` (T,) as (T, n, 2), in px; see `RepairedDrawingPlan.evaluate`."""
        return self.drawing.evaluate(t)[0]


def plan_repair(
    plan: Plan, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None
) -> RepairedPlan:
    """Return the plan with every crossing bent away; parameters and limits as of `repair_drawing`."""
    return RepairedPlan(repair_drawing(plan.drawing, progress=progress, cancelled=cancelled))


def repair_drawing(
    plan: DrawingPlan, *, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None
) -> RepairedDrawingPlan:
    """Return the plan of a drawing with every crossing of its in-betweens bent away.

    May take seconds: ask for it in a worker. The same plan gives the same bytes.

    Parameters
    ----------
    plan : DrawingPlan
        Of any method.
    progress : callable, optional
        Called with the share of the work that is done, from 0 to 1.
    cancelled : callable, optional
        Asked again and again; when it says True, the work stops.

    Returns
    -------
    RepairedDrawingPlan
        Every in-between simple, continuous in t, the keyframes bit for bit; the method's own wherever that was
        simple, but for the neighbourhood of a repair. If a keyframe crosses itself or the outlines run opposite
        ways round no such path exists: then the method's own, and `notes` says why. Pinned points are where they
        must be in any case; where these leave no way that could be found, nothing is changed and `notes` says so.

    Raises
    ------
    CancelledError
        When `cancelled` says so.

    Notes
    -----
    The path is marched along from both ends, each step a minimum of the distance from it under a barrier (Li et
    al., "Incremental potential contact", 2020), cut by continuous collision detection (additive, Li et al. 2021).
    Where the marches do not meet, both sides are smoothed until they do. That a way exists follows from the
    Carpenter's rule theorem (Connelly, Demaine and Rote, "Straightening polygonal arcs and convexifying polygonal
    cycles", 2003): no simple polygon is stuck. The result is sound by construction; no bound on the work is known.
    """
    watch = _Watch(progress, cancelled)
    watch.tell(0.0)
    parts = tuple(k for k, pair in enumerate(plan.pairs) if not _is_point(pair.left) and not _is_point(pair.right))
    course, notes = _course(plan, parts, watch) if parts else (None, ())
    repaired = RepairedDrawingPlan(plan, parts, course, notes)
    watch.tell(1.0)
    if notes or len(parts) == len(plan.pairs):
        return repaired
    return replace(repaired, notes=_growth_notes(repaired))


def _course(plan: DrawingPlan, parts: tuple[int, ...], watch: "_Watch") -> tuple[Course | None, tuple[str, ...]]:
    """Where some outlines of a drawing go, None if where they went before, and why that is so if not by luck."""
    pairs = [plan.pairs[k] for k in parts]
    chains = Chains.of([len(p.left) for p in pairs], [p.closed for p in pairs])
    corners = np.concatenate([q for p in pairs for q in (p.left, p.right)])
    low, high = corners.min(axis=0), corners.max(axis=0)
    origin, scale = complex(*((low + high) / 2)), float((high - low).max())
    ends = (np.stack([_row([p.left for p in pairs]), _row([p.right for p in pairs])]) - origin) / scale
    moves = np.stack([spread(chains, z) for z in ends])
    refusal = _refusal(chains, ends + moves)
    if refusal:
        return None, (refusal,)

    def path(t: FloatArray) -> ComplexArray:
        frames = plan.evaluate(t)
        apart = (1 - t)[:, None] * moves[0] + t[:, None] * moves[1]
        return np.asarray((_row([frames[k] for k in parts]) - origin) / scale + apart, np.complex128)

    before, after = ends + moves
    chains = replace(chains, keyframes=ends + moves)
    mass, springs = chains.stiffness(before, after)
    grip = _grip(plan, parts, origin, scale)
    sketches = tuple(_sketch(pairs, method, steps, grip) for method, steps in (("intrinsic", 16), ("linear", 10)))
    tell = watch.tell
    for held in (None,) if grip is None else grip.attempts:
        field = Field(chains, Barrier(before, after), mass, springs, watch.check, held)
        found = route(field, path, sketches, tell)
        tell = watch.keep  # progress never falls back
        if found.whole and not found.bent and not moves.any():
            return None, ()
        course = Course(found, path, ends, bool(moves.any()), origin, scale, grip)
        if found.whole and (grip is None or _pins_met(course, chains)):
            return course, ()
    return None, (NO_WAY if grip is None else NO_WAY_WITH_PINS,)


def _grip(plan: DrawingPlan, parts: tuple[int, ...], origin: complex, scale: float) -> Grip | None:
    """The pins on the outlines that are repaired."""
    if not isinstance(plan.paths, PinnedPaths):
        return None
    rows = in_a_row([len(pair.left) for pair in plan.pairs])
    return Grip.of(plan.paths.held, [rows[k] for k in parts], origin, scale)


def _pins_met(course: Course, chains: Chains) -> bool:
    """Whether a course, brought onto its pins, still crosses nothing and jumps nowhere."""

    def repaired(times: FloatArray) -> ComplexArray:
        frames = course.path(times)
        rows, places = course.at(times)
        if len(rows):
            frames[rows] = (places - course.origin) / course.scale
        return frames

    one = course.grip is not None and len(course.grip.held.weights) == 1  # it only shifts frames
    frames = repaired(np.arange(1, LOOKS_A_TICK * TICKS) / (LOOKS_A_TICK * TICKS))
    signs = chains.signs(frames)
    if not chains.simple(frames).all() or (signs != signs[:1]).any():
        return False
    return one or jumps(repaired) <= max(MOST_PINNED_JUMP, 2 * jumps(course.path))


def _is_point(points: FloatArray) -> bool:
    return not np.ptp(points, axis=0).any()


def _growth_notes(repaired: RepairedDrawingPlan) -> tuple[str, ...]:
    """Whether an outline that grows out of a point crosses something meanwhile; it is never bent."""
    chains = Chains.of([len(p.left) for p in repaired.pairs], [p.closed for p in repaired.pairs])
    if chains.simple(_row(repaired.evaluate(np.arange(1, TICKS) / TICKS))).all():
        return ()
    return (
        "an outline that grows out of a point or shrinks to one crosses itself or another; it is not repaired",
    )


def _row(outlines: Sequence[FloatArray]) -> ComplexArray:
    """All outlines (..., k_i, 2) in one row of complex numbers (..., n)."""
    points = np.concatenate(outlines, axis=-2)
    return np.asarray(points[..., 0] + 1j * points[..., 1], np.complex128)


def _refusal(chains: Chains, ends: ComplexArray) -> str:
    """Why no repair is possible, or an empty text."""
    simple = chains.simple(ends)
    for name, fine in zip(("before", "after"), simple, strict=True):
        if not fine:
            return f"the keyframe {name} crosses itself, so its in-betweens may; they are not repaired"
    signs = chains.signs(ends)
    if (signs[0] != signs[1]).any():
        return "the keyframes run opposite ways round: every path between them crosses itself; reverse one of them"
    return ""


def _sketch(outlines: list[AlignedPair], method: str, steps: int, grip: Grip | None) -> Sketch:
    """In-betweens of two frames of these outlines by another method, as wishes for a march."""
    chains = Chains.of([len(p.left) for p in outlines], [p.closed for p in outlines])
    times = np.linspace(0.0, 1.0, steps + 1)

    def sketch(x: ComplexArray, y: ComplexArray) -> ComplexArray:
        p, q = as_points(x), as_points(y)
        pairs = [AlignedPair(p[r], q[r], c) for r, c in zip(chains.rows, chains.closed, strict=True)]
        frames = _row(plan_drawing(pairs, method=method).evaluate(times))
        return frames if grip is None else grip.between(frames)

    return sketch


@dataclass(frozen=True, eq=False)
class _Watch:
    progress: Progress | None
    cancelled: Callable[[], bool] | None

    def check(self) -> None:
        if self.cancelled is not None and self.cancelled():
            raise CancelledError("the repair was cancelled")

    def keep(self, share: float) -> None:
        self.check()

    def tell(self, share: float) -> None:
        self.check()
        if self.progress is not None:
            self.progress(share)
