"""Plans of spans for the canvas: at once with what is known, better as soon as the worker has solved it."""

import threading
from collections import OrderedDict
from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QObject, QTimer, Signal

from app.preview.tasks import (
    Planned,
    PlanTask,
    Progress,
    Solved,
    SolvedAhead,
    SpanRef,
    Task,
    solve_all,
    solve_plan,
    unseen,
)
from app.preview.worker import NewestWins
from core.correspondence.pairing import Correspondence
from core.geometry.outline import FloatArray, perimeter
from core.model.document import Document, Keyframe, Span
from core.model.drawing import Drawing, Outline
from core.model.edits import store_answer
from core.model.inbetweens import Rows, SpanPlan, paired_outlines
from core.model.motion import Motions

PAUSE_MS = 40
"""The worker starts when nothing new was asked for this long: while a vertex is dragged, the pairs stay put."""

MOST_AT_ONCE = 4
"""Outlines that the worker matches before it shows what it has."""

QUICK_METHODS = ("linear", "intrinsic")
QUICK_SECONDS = 0.012
"""A plan that takes no longer is made at every step of a drag."""

MOST_DRAGGED_ROWS = 6000
KEPT_BESIDE = 3
"""Neighbours of a moved vertex that are kept on either side."""

MOST_KEPT = 1024

Pairs = tuple[tuple[int, int], ...]
PairRef = tuple[SpanRef, int, int]
"""A span, and the ids of two of its outlines."""


class _Active:
    """The preview's plans for motions, by each span's own method."""

    def __init__(self, preview: "SpanPreview") -> None:
        self._preview = preview

    def plan(self, before: Keyframe, after: Keyframe, layer: int = 0) -> SpanPlan:
        return self._preview.plan(before, after, layer)


class SpanPreview(QObject):
    """Gives plans without ever making the window wait; `planned` says that a better one is there."""

    planned = Signal()
    progressed = Signal(float)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.motions = Motions(_Active(self))
        self._exact: OrderedDict[object, Solved] = OrderedDict()
        self._alike: OrderedDict[object, Solved] = OrderedDict()
        self._plans: OrderedDict[object, Planned] = OrderedDict()
        self._slow: dict[SpanRef, PlanTask] = {}
        self._ahead: OrderedDict[SpanRef, tuple[Keyframe, Keyframe]] = OrderedDict()
        self._planning: PlanTask | None = None
        self._seconds: dict[object, float] = {}
        self._cancel = threading.Event()
        self._pairs: OrderedDict[object, tuple[object, Pairs]] = OrderedDict()
        self._wanted: OrderedDict[object, Task] = OrderedDict()
        self._trial: tuple[PairRef, Correspondence] | None = None
        self._tried: tuple[int, int, str] | None = None
        self._coarse: tuple[Solved, bool, Solved] | None = None
        self._worker = NewestWins(self)
        self._worker.finished.connect(self._on_solved)
        self._planner = NewestWins(self)
        self._planner.finished.connect(self._on_planned)
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE_MS)
        self._pause.timeout.connect(self._on_paused)

    @property
    def settled(self) -> bool:
        """Whether every plan given so far is the final one."""
        return not self._wanted and not self._slow and self._worker.idle and self._planner.idle

    def stop(self) -> None:
        self._pause.stop()
        self._cancel.set()
        self._worker.stop()
        self._planner.stop()

    def plan(self, before: Keyframe, after: Keyframe, layer: int, method: str | None = None) -> SpanPlan:
        """Return a plan of the span of the layer with that id, with another method if one is named.

        While a slow one (rigid, auto, a repair) is being solved, it is intrinsic's, or that of the method without
        the repair; `waiting` tells.
        """
        named = method or self.tried_method(before, layer)
        span = before.span if named is None else replace(before.span, method=named)
        wanted = self._wanted_plan(before, after, layer, span)
        found = self._plans.get(wanted.key)
        if found is None and self._is_quick(wanted):
            found = self._keep_plan(wanted.solve())
        if method is None and found is not None:
            self._slow.pop(wanted.ref, None)
        if found is None:
            asked = self._slow.pop(wanted.ref, None)
            known = asked is not None and asked.key == wanted.key
            self._slow[wanted.ref] = asked if known else wanted  # the last one asked for is solved first
            if not known:
                self._pause.start()
            quick = span.method if span.method in QUICK_METHODS else "intrinsic"
            return self._stand_in(before, after, layer, quick)
        _touch(self._plans, wanted.key)
        return found.plan

    def at_hand(self, before: Keyframe, after: Keyframe, layer: int) -> bool:
        """Whether the span can be planned without matching anything first; if not, the worker is asked to."""
        tasks = [t for t in self._tasks(before, after, layer) if t.kept is None and t.key() not in self._exact]
        for task in tasks:
            self._wanted[task.likeness()] = task
            self._pause.start()
        return all(t.likeness() in self._alike for t in tasks)

    def prepare(self, spans: Iterable[tuple[int, Keyframe, Keyframe]]) -> None:
        """Have spans that are not seen yet, (layer, before, after), solved while nothing else is asked for."""
        self._ahead = OrderedDict(((layer, before.frame), (before, after)) for layer, before, after in spans)
        self._pause.start()

    def _solve_ahead(self) -> None:
        """Give a worker the next span that lacks something."""
        while self._ahead:
            (layer, _), (before, after) = next(iter(self._ahead.items()))
            missing = [
                t for t in self._tasks(before, after, layer) if t.kept is None and t.key() not in self._exact
            ]
            if missing:
                self._worker.submit(partial(SolvedAhead.of, tuple(missing)))
                return
            wanted = self._wanted_plan(before, after, layer, before.span)
            if not (wanted.key in self._plans or self._is_quick(wanted) or before.span.hold):
                self._start_planning(wanted, unseen)
                return
            self._ahead.popitem(last=False)

    def _start_planning(self, wanted: PlanTask, progress: Progress) -> None:
        self._cancel.set()  # of what is solved now, the span has changed since
        self._cancel = cancel = threading.Event()
        self._planning = wanted
        self._planner.submit(partial(solve_plan, wanted, progress, cancel.is_set))

    def waiting(self, before: Keyframe, layer: int) -> bool:
        """Whether what is shown of the span that begins here stands in for a plan that is being solved."""
        return (layer, before.frame) in self._slow

    def _stand_in(self, before: Keyframe, after: Keyframe, layer: int, method: str) -> SpanPlan:
        wanted = self._wanted_plan(before, after, layer, replace(before.span, method=method, repair=False))
        found = self._plans.get(wanted.key) or self._keep_plan(wanted.solve())
        _touch(self._plans, wanted.key)
        return found.plan

    def _wanted_plan(self, before: Keyframe, after: Keyframe, layer: int, span: Span) -> "PlanTask":
        solved = tuple(self._solved(task) for task in self._tasks(before, after, layer))
        return PlanTask(layer, before, after, span, solved)

    def _is_quick(self, wanted: "PlanTask") -> bool:
        """Whether a plan can be made between two frames of a drag: as the last one like it could."""
        span = wanted.span
        if span.repair:
            return False
        return span.method in QUICK_METHODS or self._seconds.get(wanted.likeness(), 1.0) < QUICK_SECONDS

    def _keep_plan(self, made: "Planned") -> "Planned":
        self._plans[made.task.key] = made
        self._seconds[made.task.likeness()] = made.seconds
        return made

    def main_pair(self, before: Keyframe, after: Keyframe) -> tuple[Outline, Outline] | None:
        """Return the pair of outlines that a person means by "the" correspondence: that of the longest outline."""
        pairs = self._paired(before.drawing, after.drawing, before)
        outlines = [(before.drawing.outline(i), after.drawing.outline(j)) for i, j in pairs]
        return max(outlines, key=lambda ab: perimeter(ab[0].points, closed=ab[0].closed), default=None)

    def correspondence(
        self, before: Keyframe, after: Keyframe, layer: int, pair: tuple[int, int]
    ) -> Correspondence:
        """Return the correspondence of two outlines that the canvas shows now."""
        for task in self._tasks(before, after, layer):
            if (task.before.id, task.after.id) == pair:
                return self._solved(task).correspondence
        raise KeyError(f"outlines {pair} are no pair")

    def try_out(self, ref: PairRef | None, correspondence: Correspondence | None = None) -> None:
        """Show the in-betweens of another correspondence for a while, or, without one, the real ones again."""
        trial = (ref, correspondence) if ref is not None and correspondence is not None else None
        if trial != self._trial:
            self._trial = trial
            self.planned.emit()

    def try_method(self, before: Keyframe | None, layer: int = 0, method: str = "") -> None:
        """Show a span's in-betweens by another method for a while, or, without a keyframe, by its own again."""
        tried = (layer, before.frame, method) if before is not None and method != before.span.method else None
        if tried != self._tried:
            self._tried = tried
            self.planned.emit()

    def tried_method(self, before: Keyframe, layer: int) -> str | None:
        """Return the method that the span beginning here is shown by for a while, if it is not its own."""
        return self._tried[2] if self._tried is not None and self._tried[:2] == (layer, before.frame) else None

    @property
    def trying(self) -> bool:
        """Whether another correspondence or method is shown for a while."""
        return self._trial is not None or self._tried is not None

    def with_answers(self, document: Document) -> Document:
        """Return the document with every answer of the solver that is known stored in its spans.

        A later version of the solver may answer differently; a film that was saved shall not change with it.
        """
        for layer in document.layers:
            for before, after in pairwise(layer.keyframes):
                for task in self._tasks(before, after, layer.id):
                    solved = self._exact.get(task.key())
                    if task.kept is None and solved is not None:
                        ids = task.before.id, task.after.id
                        document = store_answer(document, layer.id, before.frame, *ids, solved.correspondence)
        return document

    def _tasks(self, before: Keyframe, after: Keyframe, layer: int) -> list[Task]:
        tasks, span = [], (layer, before.frame)
        for i, j in self._paired(before.drawing, after.drawing, before):
            made = before.span.pair_of(i, j)
            kept = made.correspondence if made else None
            if self._trial is not None and self._trial[0] == (span, i, j):
                kept = self._trial[1]
            a, b = before.drawing.outline(i), after.drawing.outline(j)
            tasks.append(Task(a, b, made.held if made else (), span, after.frame, kept))
        return tasks

    def _paired(self, before: Drawing, after: Drawing, keyframe: Keyframe) -> Pairs:
        key = (id(before), id(after), tuple((p.before, p.after) for p in keyframe.span.pairs))
        found = self._pairs.get(key)
        if found is None:
            found = self._pairs[key] = ((before, after), paired_outlines(before, after, keyframe.span))
        _touch(self._pairs, key)
        return found[1]

    def _solved(self, task: Task) -> Solved:
        """Return the exact answer, or else the last one for outlines alike, and ask the worker for the exact."""
        exact = self._exact.get(task.key())
        if exact is not None:
            _touch(self._exact, task.key())
            return exact
        alike = self._alike.get(task.likeness())
        if task.kept is not None:
            return self._keep_exact(Solved(task, task.kept, self._kept_rows(task, alike)))
        waiting = self._wanted.get(task.likeness())
        if waiting is None or waiting.key() != task.key():
            self._wanted[task.likeness()] = task  # of two steps of one drag only the last is worth solving
            self._pause.start()
        if alike is not None and alike.task.anchors == task.anchors:
            return self._thinner(alike, task)
        quick = task.solve_quickly(alike.correspondence if alike else None)
        return self._keep_alike(Solved(task, quick, task.rows(quick)))

    def _thinner(self, alike: Solved, task: Task) -> Solved:
        """Leave out, while a huge outline is dragged, the images of the other one's vertices: nobody sees them."""
        p, q = alike.rows
        if len(p) <= MOST_DRAGGED_ROWS:
            return alike
        before_moves = task.before is not alike.task.before
        if self._coarse is None or self._coarse[:2] != (alike, before_moves):
            old, new = (alike.task.before, task.before) if before_moves else (alike.task.after, task.after)
            kept = _dragged_rows(p if before_moves else q, old, new)
            self._coarse = alike, before_moves, replace(alike, rows=(p[kept], q[kept]))
        return self._coarse[2]

    def _kept_rows(self, task: Task, alike: Solved | None) -> Rows:
        """Walk along both outlines only when the correspondence is a new one."""
        if alike is not None and alike.correspondence is task.kept:
            return alike.rows
        return task.rows(task.solve())

    def _keep_exact(self, solved: Solved) -> Solved:
        self._exact[solved.task.key()] = solved
        _touch(self._exact, solved.task.key())
        return self._keep_alike(solved)

    def _keep_alike(self, solved: Solved) -> Solved:
        self._alike[solved.task.likeness()] = solved
        _touch(self._alike, solved.task.likeness())
        return solved

    def _on_paused(self) -> None:
        tasks = tuple(self._wanted.values())[-MOST_AT_ONCE:]  # what was asked for last is in sight
        if tasks:
            self._worker.submit(lambda: solve_all(tasks))
        elif self._slow and self._planning not in self._slow.values():
            self._start_planning(next(reversed(self._slow.values())), self.progressed.emit)
        elif not self._slow and self._planner.idle and self._worker.idle:
            self._solve_ahead()

    def cancel_slow(self) -> None:
        """Stop solving; it begins again with the next plan that is asked for."""
        self._cancel.set()
        self._slow.clear()
        self._planning = None

    def _on_solved(self, result: object) -> None:
        if isinstance(result, Exception):
            raise result
        if isinstance(result, SolvedAhead):
            for solved in result.solved:
                self._keep_exact(solved)
            self._pause.start()
        elif isinstance(result, list):
            for solved in result:
                self._keep_exact(solved)
                waiting = self._wanted.get(solved.task.likeness())
                if waiting is not None and waiting.key() == solved.task.key():
                    del self._wanted[solved.task.likeness()]
            self.planned.emit()
            if self._wanted or self._slow or self._ahead:
                self._pause.start()

    def _on_planned(self, result: object) -> None:
        if isinstance(result, Exception):
            self._planning = None
            raise result
        if isinstance(result, Planned):  # else it was cancelled, and what came after it is under way
            self._keep_plan(result)
            _touch(self._plans, result.task.key)
            if self._planning is result.task:
                self._planning = None
            waiting = self._slow.get(result.task.ref)
            if waiting is not None and waiting.key == result.task.key:
                del self._slow[result.task.ref]
            if result.task.ref in self._ahead and waiting is None:
                del self._ahead[result.task.ref]  # nobody has seen the span yet
            else:
                self.planned.emit()
            if self._slow or self._ahead:
                self._pause.start()


def _dragged_rows(positions: FloatArray, old: Outline, new: Outline) -> npt.NDArray[np.bool_]:
    """Return which rows stay: every other vertex of the outline in the hand, but all of them where it moves."""
    moved = (old.points != new.points).any(axis=1)
    for _ in range(KEPT_BESIDE):
        moved |= np.roll(moved, 1) | np.roll(moved, -1)
    vertex = positions.astype(np.intp)
    return (positions == vertex) & ((vertex % 2 == 0) | moved[vertex % len(moved)])


def _touch(kept: OrderedDict, key: object) -> None:  # type: ignore[type-arg]
    """Mark as used last, and forget what was not used for the longest time."""
    kept.move_to_end(key)
    while len(kept) > MOST_KEPT:
        kept.popitem(last=False)
