"""From a span's method to paths: "auto" decided, repaired if wanted."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from core.certificate import SEVERITIES, certify_drawing
from core.geometry.outline import FloatArray
from core.methods.pins import Pin, PinnedPaths
from core.methods.plan import AlignedPair, DrawingPlan, plan_drawing
from core.model.document import AUTO
from core.repair.plan import RepairedDrawingPlan, repair_drawing

CANDIDATES = ("rigid", "intrinsic")
"""What auto chooses from; the first one wins a tie."""

LOOKS = np.arange(1, 16) / 16
"""Times at which auto looks at the in-betweens."""

TIE = 0.02
"""Relative difference in stretch below which two methods are equally good."""


@dataclass(frozen=True, slots=True, eq=False)
class Paths:
    """Where the vertices of a span go.

    Attributes
    ----------
    plan : DrawingPlan or RepairedDrawingPlan
    method : str
        The method that was taken.
    reason : str
        One sentence why, when it was auto; else empty.
    notes : tuple of str
        What did not go as asked: a fallback, a repair that was not possible.
    """

    plan: DrawingPlan | RepairedDrawingPlan
    method: str
    reason: str = ""
    notes: tuple[str, ...] = ()

    @property
    def pins(self) -> PinnedPaths | None:
        """The paths before a repair, if they are led through pins."""
        drawing = self.plan if isinstance(self.plan, DrawingPlan) else self.plan.drawing
        return drawing.paths if isinstance(drawing.paths, PinnedPaths) else None

    def pinned(self, t: FloatArray) -> FloatArray:
        """Return where the k pinned points are at the times `t` (T,), as (T, k, 2) in px, repaired or not."""
        if self.pins is None:
            return np.zeros((len(t), 0, 2))
        places = self.pins.held.wanted(t)
        return np.stack([places.real, places.imag], axis=-1)


def solve_paths(
    pairs: Sequence[AlignedPair],
    method: str,
    turns: int,
    *,
    pins: Sequence[Pin] = (),
    placement: str = "still",
    repair: bool = False,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Paths:
    """Return the paths of a drawing.

    Parameters
    ----------
    pairs : sequence of AlignedPair
    method : str
        One of `core.METHODS`, or "auto": the one of rigid and intrinsic with the better certificate, then the
        lesser stretch.
    turns : int
        Extra whole turns.
    pins : sequence of Pin
        Points whose way is given.
    placement : str
        One of `PLACEMENTS`.
    repair : bool
        Whether crossings are bent away; may take seconds.
    progress, cancelled
        Of the repair, as of `core.repair.plan.repair_drawing`.
    """
    if method == AUTO:
        paths = _best(pairs, turns, pins, placement)
    else:
        plan = plan_drawing(pairs, method=method, turns=turns, pins=pins, placement=placement)
        paths = Paths(plan, method, notes=(plan.note,) if plan.note else ())
    if not repair or not isinstance(paths.plan, DrawingPlan):
        return paths
    repaired = repair_drawing(paths.plan, progress=progress, cancelled=cancelled)
    notes = (*paths.notes, *repaired.notes)
    return Paths(repaired, paths.method, paths.reason, notes)


def _best(pairs: Sequence[AlignedPair], turns: int, pins: Sequence[Pin], placement: str) -> Paths:
    """Look at both methods' in-betweens, and take the one with fewer and lesser problems, then less stretch."""
    plans = [plan_drawing(pairs, method=m, turns=turns, pins=pins, placement=placement) for m in CANDIDATES]
    if plans[0].note.startswith("fell back"):  # there is nothing to choose from
        reason = f"auto chose intrinsic: {plans[0].note}"
        return Paths(plans[1], "intrinsic", reason)
    marks = [_mark(plan, pairs) for plan in plans]
    (rigid_errors, rigid_stretch), (other_errors, other_stretch) = marks
    if rigid_errors != other_errors:
        best = 0 if rigid_errors < other_errors else 1
        reason = f"auto chose {CANDIDATES[best]}: fewer problems"
    else:
        best = 0 if rigid_stretch <= other_stretch * (1 + TIE) else 1
        clean = "no problem, " if not any(rigid_errors) else ""
        reason = f"auto chose {CANDIDATES[best]}: {clean}least stretch"
    notes = (plans[best].note,) if plans[best].note else ()
    return Paths(plans[best], CANDIDATES[best], reason, notes)


def _mark(plan: DrawingPlan, pairs: Sequence[AlignedPair]) -> tuple[tuple[int, ...], float]:
    """Return the numbers of problems, errors first, and the mean of the largest stretch."""
    whole = [i for i, p in enumerate(pairs) if _extends(p.left) and _extends(p.right)]
    if not whole:  # what grows out of a point or shrinks into one has nothing to compare with
        return (0, 0), 0.0
    frames = plan.evaluate(LOOKS)
    certificate = certify_drawing(
        [frames[i] for i in whole],
        [pairs[i].closed for i in whole],
        [pairs[i].left for i in whole],
        [pairs[i].right for i in whole],
        times=LOOKS,
    )
    found = [p.severity for p in certificate.problems]
    return tuple(found.count(s) for s in SEVERITIES[:2]), float(certificate.stretch.mean())


def _extends(points: FloatArray) -> bool:
    """Whether an outline is more than a point."""
    return bool((points != points[0]).any())
