"""What lies under the pointer on the timeline, in words, and where a click there leads."""

from PySide6.QtCore import QPointF

from app.keys import Keys
from app.panels import track_header
from app.panels.track_rows import BAR
from app.panels.track_ruler import range_edge_under
from app.panels.track_view import HEADER, RULER, TrackView
from app.preview.certificates import CertificatePreview
from core.certificate import Problem
from core.model.checking import SpanCertificate, finding
from core.model.frame_edits import KeyRef

NEAR_GRIP = 4
"""Px beside a handle that still take it."""


class Spot:
    """Answers for one track."""

    def __init__(self, view: TrackView, certificates: CertificatePreview, keys: Keys) -> None:
        self.view, self.certificates, self.keys = view, certificates, keys

    def grip(self, at: QPointF) -> int | None:
        """Return which handle of the selected keyframes is there: 0 the first, 1 the last."""
        grips = self.view.grips(self.keys.chosen) or ()
        wide = [g.adjusted(-NEAR_GRIP, -NEAR_GRIP, NEAR_GRIP, NEAR_GRIP) for g in grips]
        return next((i for i, g in enumerate(wide) if g.contains(at)), None)

    def edge(self, at: QPointF) -> str:
        """Return what a drag here would do to an edge, as a tooltip, or ""."""
        if range_edge_under(self.view, at):
            return "Drag to play more or less of the film"
        return "Drag to stretch the selected keyframes" if self.grip(at) is not None else ""

    def tip(self, at: QPointF, key: KeyRef | None, part: tuple[int, str] | None) -> str:
        """Return the tooltip: of a frame with a problem the sentence of the worst one."""
        if part is not None:
            return track_header.tip_of(self.view, self.view.rows[part[0]], part[1])
        if key is not None:
            return f"Keyframe at frame {key[1]}: drag to move it"
        if self.edge(at):
            return self.edge(at)
        if at.x() >= HEADER and at.y() < RULER:
            return "Drag to scrub; with Shift to play only a part"
        frame, certificate = self.view.frame_at(at.x()), self._certificate(at)
        problem = certificate.worst.get(frame) if certificate else None
        return f"Frame {frame}: {finding(problem)}" if problem else ""

    def goal(self, at: QPointF) -> int:
        """Return the frame that a click goes to: on a problem's colour the worst one of that stretch."""
        frame, certificate = self.view.frame_at(at.x()), self._certificate(at)
        return certificate.worst_near(frame) if certificate else frame

    def problem(self, at: QPointF) -> Problem | None:
        """Return the problem of the frame that a click goes to."""
        certificate = self._certificate(at)
        return certificate.worst.get(self.goal(at)) if certificate else None

    def _certificate(self, at: QPointF) -> SpanCertificate | None:
        """Return the certificate of the span whose bar is there, if its layer is the active one."""
        row = self.view.row_at(at.y())
        if row is None or at.x() < HEADER or abs(self.view.row_rect(row).center().y() - at.y()) > BAR + 4:
            return None
        layer = self.view.rows[row]
        before, after = layer.around(self.view.frame_at(at.x()))
        known = layer.id == self.view.session.layer.id and before is not None and after is not None
        return self.certificates.of(before, after) if known else None
