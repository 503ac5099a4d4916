"""Plans of spans for the canvas: at once with what is known, better as soon as the worker has solved it."""

from collections import OrderedDict
from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer, Signal

from app.preview.worker import NewestWins
from core.correspondence.matching import match
from core.correspondence.pairing import Correspondence
from core.errors import InkbetweenError
from core.model.document import Anchor, Keyframe
from core.model.drawing import Outline
from core.model.inbetweens import PairMatch, SpanMatch, SpanPlan, paired_outlines, plan_span

PAUSE_MS = 40
"""The worker starts when nothing new was asked for this long: while a vertex is dragged, the pairs stay put."""

MOST_KEPT = 256
QUICK_CELLS = 40_000
"""Outlines with at most this many vertex pairs are matched at once, between two frames of a drag."""


@dataclass(frozen=True, slots=True)
class _Task:
    """Two outlines to be matched."""

    before: Outline
    after: Outline
    anchors: tuple[Anchor, ...]

    def key(self) -> tuple[int, int, tuple[Anchor, ...]]:
        return id(self.before), id(self.after), self.anchors

    def likeness(self) -> tuple[object, ...]:
        """Equal for tasks whose correspondences fit each other's outlines."""
        a, b = self.before, self.after
        return a.id, b.id, len(a.points), len(b.points), a.closed, b.closed, self.anchors

    def solve(self) -> Correspondence:
        closed = self.before.closed and self.after.closed
        return match(self.before.points, self.after.points, self.anchors, closed=closed)


@dataclass(frozen=True, slots=True)
class _Solved:
    task: _Task
    correspondence: Correspondence


class SpanPreview(QObject):
    """Gives plans without ever making the window wait; `planned` says that a better one is there."""

    planned = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._exact: OrderedDict[object, _Solved] = OrderedDict()
        self._alike: OrderedDict[object, Correspondence] = OrderedDict()
        self._plans: OrderedDict[object, tuple[object, SpanPlan]] = OrderedDict()
        self._wanted: dict[object, _Task] = {}
        self._worker = NewestWins(self)
        self._worker.finished.connect(self._on_solved)
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE_MS)
        self._pause.timeout.connect(self._on_paused)

    @property
    def settled(self) -> bool:
        """Whether every plan given so far is the final one."""
        return not self._wanted and self._worker.idle

    def stop(self) -> None:
        self._pause.stop()
        self._worker.stop()

    def plan(self, before: Keyframe, after: Keyframe, method: str | None = None) -> SpanPlan:
        """Return a plan of the span, with another method if one is named."""
        span = before.span
        matched, final = self._matched(before, after)
        key = (id(before.drawing), id(after.drawing), method or span.method, span.turns, matched)
        found = self._plans.get(key)
        if found is None:
            parts = (before.drawing, after.drawing)  # kept, so that no other object can take their ids
            changed = type(span)(method or span.method, span.easing, span.turns, span.pairs)
            found = self._plans[key] = (parts, plan_span(*parts, changed, matched))
        self._plans.move_to_end(key)
        _forget(self._plans, MOST_KEPT if final else 8)
        return found[1]

    def _matched(self, before: Keyframe, after: Keyframe) -> tuple[SpanMatch, bool]:
        pairs = []
        self._wanted.clear()
        for i, j in paired_outlines(before.drawing, after.drawing, before.span):
            made = before.span.pair_of(i, j)
            a, b = before.drawing.outline(i), after.drawing.outline(j)
            if made is not None and made.correspondence is not None:
                pairs.append(PairMatch(i, j, made.correspondence))
            else:
                task = _Task(a, b, made.anchors if made else ())
                pairs.append(PairMatch(i, j, self._correspondence(task)))
        if self._wanted:
            self._pause.start()
        return SpanMatch(tuple(pairs)), not self._wanted

    def _correspondence(self, task: _Task) -> Correspondence:
        found = self._exact.get(task.key())
        if found is not None:
            self._exact.move_to_end(task.key())
            return found.correspondence
        alike = self._alike.get(task.likeness())
        if alike is not None:
            self._wanted[task.key()] = task
            return alike
        solved = task.solve()
        self._keep(_Solved(task, solved))
        return solved

    def _keep(self, solved: _Solved) -> None:
        self._exact[solved.task.key()] = solved
        self._alike[solved.task.likeness()] = solved.correspondence
        self._alike.move_to_end(solved.task.likeness())
        _forget(self._exact, MOST_KEPT)
        _forget(self._alike, MOST_KEPT)

    def _on_paused(self) -> None:
        tasks = tuple(self._wanted.values())
        if tasks:
            self._worker.submit(lambda: _solve(tasks))

    def _on_solved(self, result: object) -> None:
        if isinstance(result, Exception):
            raise result
        if isinstance(result, list):
            for solved in result:
                self._keep(solved)
                self._wanted.pop(solved.task.key(), None)
            self.planned.emit()


def _solve(tasks: tuple[_Task, ...]) -> list[_Solved]:
    found = []
    for task in tasks:
        try:
            found.append(_Solved(task, task.solve()))
        except InkbetweenError:
            continue  # refused drawings never reach a document; the last good plan stays
    return found


def _forget(kept: OrderedDict[object, object] | OrderedDict, most: int) -> None:  # type: ignore[type-arg]
    while len(kept) > most:
        kept.popitem(last=False)
