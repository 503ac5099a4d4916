"""The certificates of the active layer's spans, made beside the window when the hand rests."""

from collections import OrderedDict
from dataclasses import dataclass
from itertools import pairwise

from PySide6.QtCore import QObject, QTimer, Signal

from app.preview.spans import SpanPreview
from app.preview.worker import NewestWins
from app.session import Session
from core.model.checking import SpanCertificate, certify_span
from core.model.document import Keyframe
from core.model.motion import SpanMotion

PAUSE_MS = 300
"""After the last change: what the hand is still at need not be judged."""

MOST_SPANS = 100
"""So many around the playhead are looked at; a longer film is looked at as the playhead comes by."""

MOST_KEPT = 400

SpanKey = tuple[int, int, int, int, int]


@dataclass(frozen=True, slots=True, eq=False)
class _Task:
    """A span in time; it keeps the keyframes, so that no other object can take the ids in their key."""

    before: Keyframe
    after: Keyframe
    motion: SpanMotion

    def certify(self) -> "_Certified":
        return _Certified(self, certify_span(self.motion))


@dataclass(frozen=True, slots=True, eq=False)
class _Certified:
    task: _Task
    certificate: SpanCertificate


class CertificatePreview(QObject):
    """`changed` tells that spans have got a certificate."""

    changed = Signal()

    def __init__(self, session: Session, preview: SpanPreview, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session, self._preview = session, preview
        self._made: OrderedDict[SpanKey, _Certified] = OrderedDict()
        self._left: list[tuple[Keyframe, Keyframe]] = []
        self._wanted: list[_Task] = []
        self._under_way: list[_Task] = []
        self._worker = NewestWins(self)
        self._worker.finished.connect(self._on_certified)
        self._pause = _single_shot(self, PAUSE_MS, self._on_paused)
        self._next = _single_shot(self, 0, self._on_next)
        for signal in (session.documentChanged, session.layerChanged, session.gestureChanged, preview.planned):
            signal.connect(self._restart)

    @property
    def settled(self) -> bool:
        """Whether every span that has its final plan has its certificate."""
        return not (self._pause.isActive() or self._next.isActive() or self._under_way)

    def stop(self) -> None:
        self._pause.stop()
        self._next.stop()
        self._worker.stop()

    def of(self, before: Keyframe, after: Keyframe) -> SpanCertificate | None:
        """Return the certificate of a span, if it has been made."""
        found = self._made.get(_key(before, after))
        return found.certificate if found else None

    def _restart(self, *_: object) -> None:
        self._next.stop()
        self._pause.start()

    def _on_paused(self) -> None:
        """Look at the spans one after the other, the nearest first, so that the window can breathe."""
        if self._session.in_gesture or self._preview.trying:
            return  # the end of either starts the pause again
        frame = self._session.frame
        spans = pairwise(self._session.layer.keyframes)
        near = sorted(spans, key=lambda s: max(s[0].frame - frame, frame - s[1].frame))
        self._left, self._wanted = near[:MOST_SPANS], []
        self._on_next()

    def _on_next(self) -> None:
        if self._left:
            before, after = self._left.pop(0)
            document, layer = self._session.document, self._session.layer
            motion = self._preview.motions.of(document, layer, before, after)
            known = self._made.get(_key(before, after))
            waiting = self._preview.waiting(before, layer.id)
            if not waiting and (known is None or known.task.motion is not motion):
                self._wanted.append(_Task(before, after, motion))
            self._next.start()
        elif self._wanted:
            self._under_way = wanted = self._wanted
            self._worker.submit(lambda: [task.certify() for task in wanted])

    def _on_certified(self, result: object) -> None:
        if isinstance(result, Exception):
            raise result
        if isinstance(result, list):
            if [made.task for made in result] == self._under_way:
                self._under_way = []
            for made in result:
                key = _key(made.task.before, made.task.after)
                self._made[key] = made
                self._made.move_to_end(key)
            while len(self._made) > MOST_KEPT:
                self._made.popitem(last=False)
            self.changed.emit()


def _key(before: Keyframe, after: Keyframe) -> SpanKey:
    return id(before.drawing), id(after.drawing), id(before.span), before.frame, after.frame


def _single_shot(parent: QObject, milliseconds: int, run) -> QTimer:
    timer = QTimer(parent)
    timer.setSingleShot(True)
    timer.setInterval(milliseconds)
    timer.timeout.connect(run)
    return timer
