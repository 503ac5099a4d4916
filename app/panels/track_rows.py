"""What a row of the timeline shows: keyframes, the spans between them, the drawings that they hold."""

from itertools import pairwise

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen, QPolygonF

from app.panels.track_view import DIAMOND, HEADER, ROW, TrackView
from app.preview.certificates import CertificatePreview
from app.theme import Theme
from core.model.document import Keyframe, Layer
from core.model.frame_edits import KeyRef
from core.model.timing import drawn_offsets

BAR = 5.0
"""Half the height of a span's bar."""

SEVERITY_COLORS = {"": "good", "info": "good", "warning": "warning", "error": "error"}
FAINT = 0.4
"""How strong a layer is that is not shown on the stage."""


def _diamond(r: float) -> QPolygonF:
    return QPolygonF([QPointF(*c) for c in ((0, -r), (r, 0), (0, r), (-r, 0))])


SMALL, LARGE = _diamond(DIAMOND), _diamond(DIAMOND + 1.5)


class RowPainter:
    """Paints one row after the other with one painter."""

    def __init__(self, painter: QPainter, view: TrackView, theme: Theme, certificates: CertificatePreview) -> None:
        self.painter, self.view, self.theme, self.certificates = painter, view, theme, certificates
        self.session = view.session
        self.step, self.start = view.step, view.x_of(0)
        self.pens = [QPen(theme.color(token), 1.6) for token in ("panel", "accent", "text")]
        self.brushes = [theme.color("text"), theme.color("accent")]

    def x_of(self, frame: float) -> float:
        return self.start + frame * self.step

    def paint(self, row: int, layer: Layer, chosen: frozenset[KeyRef], hover: KeyRef | None) -> None:
        """Paint the spans and keyframes of a layer."""
        painter, rect = self.painter, self.view.row_rect(row)
        active = layer.id == self.session.layer.id
        painter.save()
        painter.setClipRect(QRectF(HEADER, rect.top(), self.view.width, ROW), Qt.ClipOperation.IntersectClip)
        painter.setOpacity(1.0 if self.session.shows(layer) else FAINT)
        here = {k.frame for k in self.session.span_keyframes() if k is not None} if active else set()
        y = rect.center().y()
        for before, after in pairwise(layer.keyframes):
            if before.span.hold:
                self._paint_hold(y, before, after)
            else:
                self._paint_bar(y, before, after, active=active, lit={before.frame, after.frame} <= here)
                self._paint_drawings(y, before, after)
        seen = range(self.view.frame_at(HEADER) - 9, self.view.frame_at(self.view.width) + 9)
        for k in layer.keyframes:
            if k.frame not in seen:
                continue
            self._paint_key(k, QPointF(self.x_of(k.frame), y), (layer.id, k.frame), chosen, hover)
        if not layer.keyframes and active:
            self._paint_advice(rect)
        painter.restore()

    def _paint_advice(self, rect: QRectF) -> None:
        """Say how an empty layer gets its first keyframe."""
        self.painter.setPen(self.theme.color("muted"))
        place = QRectF(rect).adjusted(HEADER + 40 - rect.left(), 0, 0, 0)
        text = "A drawing on the stage becomes a keyframe at the playhead."
        self.painter.drawText(place, int(Qt.AlignmentFlag.AlignVCenter), text)

    def _paint_bar(self, y: float, before: Keyframe, after: Keyframe, *, active: bool, lit: bool) -> None:
        """Paint a span, one of the active layer in the colours of its certificate or, without one, the accent."""
        certificate = self.certificates.of(before, after) if active else None
        x0, x1 = self.x_of(before.frame), self.x_of(after.frame)
        token, strength = ("good", (0.65, 0.4)) if certificate else ("accent", (0.55, 0.28))
        color = self.theme.color(token, strength[0 if lit else 1]) if active else self.theme.color("muted", 0.28)
        self.painter.fillRect(QRectF(x0, y - BAR, x1 - x0, 2 * BAR), color)
        for first, last, severity in certificate.runs if certificate else ():
            if SEVERITY_COLORS[severity] != "good":
                left, right = self.x_of(first - 0.5), self.x_of(last + 0.5)
                rect = QRectF(left, y - BAR, right - left, 2 * BAR)
                self.painter.fillRect(rect, self.theme.color("panel"))
                self.painter.fillRect(rect, self.theme.color(SEVERITY_COLORS[severity], 0.95 if lit else 0.7))

    def _paint_drawings(self, y: float, before: Keyframe, after: Keyframe) -> None:
        """Mark where drawings begin: a dot a frame on ones, else a stroke, so that each is a block of its own."""
        length, step = after.frame - before.frame, self.step
        on_ones = before.span.step == 1 and not before.span.exposures
        if step < (8 if on_ones else 1):
            return
        seen = range(max(before.frame + 1, self.view.frame_at(HEADER)), self.view.frame_at(self.view.width) + 1)
        starts = [f for o in drawn_offsets(before.span, length) if (f := before.frame + o) in seen]
        if not on_ones and step * length < 5 * len(drawn_offsets(before.span, length)):
            return
        pen = QPen(self.theme.color("panel", 0.9), 2.2, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)
        if on_ones:
            self.painter.setPen(pen)
            self.painter.drawPoints(QPolygonF([QPointF(self.x_of(f), y) for f in starts]))
            return
        for frame in starts:
            x = self.x_of(frame) - min(self.step / 2, 4.0)
            self.painter.fillRect(QRectF(x - 1, y - BAR, 2, 2 * BAR), self.theme.color("panel"))

    def _paint_hold(self, y: float, before: Keyframe, after: Keyframe) -> None:
        """Paint a line that ends in a block before the keyframe after: nothing moves here."""
        x0, x1 = self.x_of(before.frame), self.x_of(after.frame) - DIAMOND - 4
        color = self.theme.color("muted", 0.8)
        self.painter.fillRect(QRectF(x0, y - 1, max(x1 - x0, 0), 2), color)
        if x1 - x0 > DIAMOND + 6:
            self.painter.fillRect(QRectF(x1 - 2, y - 4, 3, 8), color)

    def _paint_key(
        self, k: Keyframe, at: QPointF, key: KeyRef, chosen: frozenset[KeyRef], hover: KeyRef | None
    ) -> None:
        painter, picked = self.painter, key in chosen
        current = key[1] == self.session.frame and key[0] == self.session.layer.id
        painter.setPen(self.pens[2 if picked else 1 if current else 0])
        painter.setBrush(self.brushes[picked])
        if k.smooth:
            painter.drawEllipse(at, DIAMOND - 0.5 + (key == hover), DIAMOND - 0.5 + (key == hover))
        else:
            painter.drawPolygon((LARGE if key == hover else SMALL).translated(at))

    def paint_grips(self, chosen: frozenset[KeyRef]) -> None:
        """Paint the handles that stretch the selected keyframes, and a hint of the block between them."""
        grips = self.view.grips(chosen)
        if grips is None:
            return
        self.painter.save()
        self.painter.setClipRect(
            QRectF(HEADER, 0, self.view.width, self.view.height), Qt.ClipOperation.IntersectClip
        )
        self.painter.setPen(Qt.PenStyle.NoPen)
        block = grips[0].united(grips[1])
        self.painter.fillRect(block, self.theme.color("accent", 0.08))
        self.painter.setBrush(self.theme.color("accent"))
        for grip in grips:
            self.painter.drawRoundedRect(grip, 2, 2)
        self.painter.restore()
