"""What the worker solves for the spans on the canvas: correspondences and plans."""

import time
from collections.abc import Callable
from dataclasses import dataclass

from core.correspondence.matching import match, match_quick
from core.correspondence.pairing import Correspondence
from core.errors import CancelledError, InkbetweenError
from core.model.document import Keyframe, Span
from core.model.drawing import Outline
from core.model.inbetweens import PairMatch, Rows, SpanMatch, SpanPlan, plan_span

Progress = Callable[[float], None]
SpanRef = tuple[int, int]
"""The id of a layer, and the frame that a span of it begins at."""


@dataclass(frozen=True, slots=True)
class Task:
    """Two outlines to be matched, the span they belong to and the frame that it ends at."""

    before: Outline
    after: Outline
    anchors: tuple[tuple[float, float], ...]
    span: SpanRef
    end: int
    kept: Correspondence | None = None

    @property
    def closed(self) -> bool:
        return self.before.closed and self.after.closed

    def key(self) -> tuple[object, ...]:
        return id(self.before), id(self.after), self.anchors, id(self.kept)

    def likeness(self) -> tuple[object, ...]:
        """Equal for tasks whose vertices can share a correspondence."""
        a, b = self.before, self.after
        return self.span, self.end, a.id, b.id, len(a.points), len(b.points), a.closed, b.closed

    def solve(self) -> Correspondence:
        """Return the kept correspondence, or the solver's answer."""
        if self.kept is not None:
            return self.kept
        return match(self.before.points, self.after.points, self.anchors, closed=self.closed)

    def solve_quickly(self, near: Correspondence | None) -> Correspondence:
        return match_quick(self.before.points, self.after.points, self.anchors, closed=self.closed, near=near)

    def rows(self, correspondence: Correspondence) -> Rows:
        return correspondence.aligned_positions(self.before.points, self.after.points)


@dataclass(frozen=True, slots=True, eq=False)
class Solved:
    """A task's answer; `rows` are worked out once and hold while vertices are only moved."""

    task: Task
    correspondence: Correspondence
    rows: Rows


@dataclass(frozen=True, slots=True, eq=False)
class PlanTask:
    """A span to be planned, with its solved correspondences."""

    layer: int
    before: Keyframe
    after: Keyframe
    span: Span
    solved: tuple[Solved, ...]

    @property
    def ref(self) -> SpanRef:
        return self.layer, self.before.frame

    @property
    def key(self) -> tuple[object, ...]:
        drawings, s = (id(self.before.drawing), id(self.after.drawing)), self.span
        return *drawings, s.method, s.turns, s.repair, s.placement, s.pins, *(id(x) for x in self.solved)

    def likeness(self) -> tuple[object, ...]:
        """Equal for plans that take about as long."""
        return self.span.method, self.span.repair, *(x.task.likeness() for x in self.solved)

    def solve(self, progress: Progress | None = None, cancelled: Callable[[], bool] | None = None) -> "Planned":
        began = time.perf_counter()
        pairs = (PairMatch(s.task.before.id, s.task.after.id, s.correspondence, s.rows) for s in self.solved)
        match = SpanMatch(tuple(pairs))
        plan = plan_span(
            self.before.drawing, self.after.drawing, self.span, match, progress=progress, cancelled=cancelled
        )
        return Planned(self, plan, time.perf_counter() - began)


@dataclass(frozen=True, slots=True, eq=False)
class Planned:
    """A plan; it keeps its task, so that no other object can take the ids in its key."""

    task: PlanTask
    plan: SpanPlan
    seconds: float


def solve_plan(task: "PlanTask", progress: Progress, cancelled: Callable[[], bool]) -> "Planned | None":
    try:
        return task.solve(progress, cancelled)
    except CancelledError:
        return None


def solve_all(tasks: tuple[Task, ...]) -> list[Solved]:
    found = []
    for task in tasks:
        try:
            correspondence = task.solve()
        except InkbetweenError:
            correspondence = task.solve_quickly(None)
        found.append(Solved(task, correspondence, task.rows(correspondence)))
    return found


@dataclass(frozen=True, slots=True, eq=False)
class SolvedAhead:
    """Answers for a span that nobody has seen yet."""

    solved: list[Solved]

    @classmethod
    def of(cls, tasks: tuple[Task, ...]) -> "SolvedAhead":
        return cls(solve_all(tasks))


def unseen(_: float) -> None:
    """The progress of what is solved ahead is shown nowhere."""
