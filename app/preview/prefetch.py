"""Has the spans of the whole film solved beside the window, so that scrubbing finds them there."""

from itertools import pairwise

from PySide6.QtCore import QObject, QTimer

from app.preview.spans import SpanPreview
from app.session import Session
from core.model.document import Keyframe

PAUSE_MS = 500
"""After the last change of the document and of the playhead; what is seen comes first."""

MOST_SPANS = 400
"""So many around the playhead: their plans are what the preview keeps."""


class Prefetch(QObject):
    """Asks for the spans of visible layers that no parent carries, the nearest to the playhead first."""

    def __init__(self, session: Session, preview: SpanPreview, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session, self._preview = session, preview
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE_MS)
        self._pause.timeout.connect(self._on_paused)
        for signal in (session.documentChanged, session.soloChanged, session.gestureChanged):
            signal.connect(self._restart)
        session.frameChanged.connect(self._on_frame_changed)

    def stop(self) -> None:
        self._pause.stop()
        self._preview.prepare(())

    def _on_frame_changed(self, _: int) -> None:
        """While the playhead moves every core is wanted for what is in sight."""
        self._preview.prepare(())
        self._pause.start()

    def _restart(self, *_: object) -> None:
        self._pause.start()

    def _on_paused(self) -> None:
        if self._session.in_gesture or self._preview.trying:
            return  # the end of either starts the pause again
        spans = sorted(self._spans(), key=self._distance)
        self._preview.prepare(spans[:MOST_SPANS])

    def _spans(self) -> list[tuple[int, Keyframe, Keyframe]]:
        """Spans that a parent carries are planned in its pose, which is known only when they are seen."""
        layers = [x for x in self._session.document.layers if self._session.shows(x) and x.parent is None]
        active = self._session.layer.id
        return [(x.id, *span) for x in layers if x.id != active for span in pairwise(x.keyframes)]

    def _distance(self, span: tuple[int, Keyframe, Keyframe]) -> int:
        _, before, after = span
        frame = self._session.frame
        return max(before.frame - frame, frame - after.frame, 0)
