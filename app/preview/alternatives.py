"""The ranked correspondences of the span under the playhead, solved beside the window."""

from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer, Signal

from app.preview.spans import SpanPreview
from app.preview.tasks import SpanRef
from app.preview.worker import NewestWins
from core.correspondence.by_hand import mean_shift
from core.correspondence.matching import Alternative, alternatives
from core.correspondence.pairing import Correspondence
from core.errors import InkbetweenError
from core.model.document import Keyframe
from core.model.drawing import Outline

PAUSE_MS = 350
"""Ranking takes longer than solving: it begins when the hand has rested this long."""

COUNT = 6
SAME = 0.005
"""Mean shift, as a share of the outline's length, below which two correspondences are the same to the eye."""


@dataclass(frozen=True, slots=True)
class Question:
    """Two outlines and the anchors between them, and the span that they are in."""

    span: SpanRef
    before: Outline
    after: Outline
    anchors: tuple[tuple[float, float], ...]

    @property
    def closed(self) -> bool:
        return self.before.closed and self.after.closed

    def key(self) -> tuple[object, ...]:
        return self.span, id(self.before), id(self.after), self.anchors


@dataclass(frozen=True, slots=True, eq=False)
class Ranking:
    """The answer: the best correspondences, best first."""

    question: Question
    alternatives: tuple[Alternative, ...]

    def index_of(self, correspondence: Correspondence) -> int | None:
        """Return which of them a correspondence is, if it is one of them."""
        q = self.question
        if correspondence.counts != (len(q.before.points), len(q.after.points)):
            return None
        for i, x in enumerate(self.alternatives):
            if mean_shift(x.correspondence, correspondence, q.before.points, q.after.points) < SAME:
                return i
        return None


class AlternativesPreview(QObject):
    """`changed` tells that `ranking` is another one, or that there is none."""

    changed = Signal()

    def __init__(self, preview: SpanPreview, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._preview = preview
        self._question: Question | None = None
        self.ranking: Ranking | None = None
        self._worker = NewestWins(self)
        self._worker.finished.connect(self._on_ranked)
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE_MS)
        self._pause.timeout.connect(self._on_paused)

    def stop(self) -> None:
        self._pause.stop()
        self._worker.stop()

    def ask(self, before: Keyframe | None, after: Keyframe | None, layer: int) -> None:
        """Rank the correspondences of this span, unless that is done or under way."""
        question = None
        pair = self._preview.main_pair(before, after) if before is not None and after is not None else None
        if pair is not None and before is not None:
            made = before.span.pair_of(pair[0].id, pair[1].id)
            question = Question((layer, before.frame), *pair, made.held if made else ())
        if (question and question.key()) == (self._question and self._question.key()):
            return
        self._question = question
        if self.ranking is not None:
            self.ranking = None
            self.changed.emit()
        if question is None:
            self._pause.stop()
        else:
            self._pause.start()

    def _on_paused(self) -> None:
        question = self._question
        if question is not None:
            self._worker.submit(lambda: _ranked(question))

    def _on_ranked(self, result: object) -> None:
        if isinstance(result, Exception):
            raise result
        asked = self._question
        if isinstance(result, Ranking) and asked is not None and result.question.key() == asked.key():
            self.ranking = result
            self.changed.emit()


def _ranked(question: Question) -> Ranking:
    a, b = question.before.points, question.after.points
    try:
        found = alternatives(a, b, question.anchors, closed=question.closed, count=COUNT)
    except InkbetweenError:
        found = ()  # a drawing that cannot be matched has no alternatives either
    return Ranking(question, tuple(found))
