"""The frames of the timeline: a ruler, a row a layer, keyframes as diamonds, spans as bars, the playhead."""

from itertools import pairwise

from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QFont, QKeyEvent, QMouseEvent, QPainter, QPen, QPolygonF, QWheelEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.preview.certificates import CertificatePreview
from app.session import DocumentDiff, Gesture, Session
from app.theme import Theme
from core.model.checking import SpanCertificate, finding
from core.model.document import Document, Keyframe, Layer
from core.model.edits import move_keyframe

HEADER = 120
RULER = 34
ROW = 36
RIGHT = 28
NARROWEST = 5.0
WIDEST = 60.0
DIAMOND = 7.0
BAR = 5.0
"""Half the height of a span's bar."""

STILL_PX = 2
"""A press that moves no farther is a click."""

SEVERITY_COLORS = {"": "good", "info": "good", "warning": "warning", "error": "error"}
SELDOM = (1, 2, 5, 6, 12, 24, 48, 120, 240, 600, 1200, 6000, 12000, 60000)


def _shown(document: Document) -> list[tuple[object, ...]]:
    return [(layer.id, layer.name, layer.visible, layer.frames()) for layer in document.layers]


class Track(QWidget):
    """Drag to scrub; drag a diamond to move its keyframe; click a row's name to draw on that layer.

    A click on a bar where it is amber or red goes to the worst of these frames; `problemChosen` tells the place
    and the colour of the problem.
    """

    problemChosen = Signal(object, str)
    menuWanted = Signal(int, object)  # frame, place on the screen

    def __init__(
        self, session: Session, certificates: CertificatePreview, theme: Theme, parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.session, self.certificates, self.theme = session, certificates, theme
        self._painted: list[SpanCertificate | None] = []
        self._gesture: Gesture | None = None
        self._held: int | None = None
        self._scrubbing = False
        self._press_x = 0.0
        self._left = 0.0
        self._top = 0.0
        self._hover_key: tuple[int, int] | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setToolTip("")
        session.documentChanged.connect(self._on_document_changed)
        session.layerChanged.connect(self.update)
        session.frameChanged.connect(self._on_frame_changed)
        certificates.changed.connect(self.update)

    def sizeHint(self) -> QSize:
        return QSize(600, RULER + 3 * ROW)

    def minimumSizeHint(self) -> QSize:
        return QSize(300, RULER + ROW + 8)

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    # places

    @property
    def step(self) -> float:
        """Width of a frame in px: all frames fit if they can."""
        room = self.width() - HEADER - RIGHT
        return min(max(room / max(self.session.document.length - 1, 1), NARROWEST), WIDEST)

    def x_of(self, frame: float) -> float:
        return HEADER + (frame - 1) * self.step - self._left

    def frame_at(self, x: float) -> int:
        return round((x - HEADER + self._left) / self.step) + 1

    def row_rect(self, row: int) -> QRectF:
        return QRectF(0, RULER + row * ROW - self._top, self.width(), ROW)

    def _rows(self) -> tuple[Layer, ...]:
        """Layers from the front one down, as they lie on the stage."""
        return self.session.document.layers[::-1]

    def _row_at(self, y: float) -> int | None:
        row = int((y - RULER + self._top) // ROW)
        return row if y >= RULER and 0 <= row < len(self._rows()) else None

    def key_place(self, layer: Layer, frame: int) -> QPointF:
        """Return where a keyframe's diamond lies."""
        row = next(i for i, x in enumerate(self._rows()) if x.id == layer.id)
        return QPointF(self.x_of(frame), self.row_rect(row).center().y())

    def _key_under(self, at: QPointF) -> tuple[int, int] | None:
        row = self._row_at(at.y())
        if row is None:
            return None
        layer = self._rows()[row]
        near = [k.frame for k in layer.keyframes if abs(self.x_of(k.frame) - at.x()) <= DIAMOND + 2]
        if not near or abs(self.row_rect(row).center().y() - at.y()) > DIAMOND + 4:
            return None
        return layer.id, min(near, key=lambda f: abs(self.x_of(f) - at.x()))

    # the pointer

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton:
            return
        at = event.position()
        self._press_x = at.x()
        row = self._row_at(at.y())
        if row is not None:
            self.session.set_layer(self._rows()[row].id)
        if at.x() < HEADER - DIAMOND:
            return
        key = self._key_under(at)
        if key is not None:
            self._held = key[1]
            self.session.go_to(key[1])
        else:
            self._scrubbing = True
            self.session.go_to(self.frame_at(at.x()))

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        at = event.position()
        if self._scrubbing:
            self.session.go_to(self.frame_at(at.x()))
        elif self._held is not None and (self._gesture or abs(at.x() - self._press_x) > 4):
            self._drag_key(max(1, self.frame_at(at.x())))
        else:
            self._hover(at)

    def _hover(self, at: QPointF) -> None:
        hover = self._key_under(at)
        tip = f"Keyframe at frame {hover[1]}: drag to move it" if hover else self._problem_under(at)
        if tip != self.toolTip():
            self.setToolTip(tip)
        if hover != self._hover_key:
            self._hover_key = hover
            self.setCursor(Qt.CursorShape.SizeHorCursor if hover else Qt.CursorShape.ArrowCursor)
            self.update()

    def _problem_under(self, at: QPointF) -> str:
        """Return the sentence of the worst problem of the frame under the pointer, "" where there is none."""
        certificate, frame = self._certificate_under(at)
        problem = certificate.worst.get(frame) if certificate else None
        return f"Frame {frame}: {finding(problem)}" if problem else ""

    def _certificate_under(self, at: QPointF) -> tuple[SpanCertificate | None, int]:
        """Return the certificate of the bar under the pointer, None beside every bar; and the frame there."""
        row, frame = self._row_at(at.y()), self.frame_at(at.x())
        if row is None or abs(self.row_rect(row).center().y() - at.y()) > BAR + 4:
            return None, frame
        before, after = self._rows()[row].around(frame)
        return (self.certificates.of(before, after) if before and after else None), frame

    def _go_to_worst(self, at: QPointF) -> None:
        """Go where the problem of the frames as bad as the one clicked is worst, and tell its place."""
        certificate, frame = self._certificate_under(at)
        problem = certificate.worst_near(frame) if certificate else None
        if certificate is not None and problem is not None:
            self.session.go_to(certificate.frame_of(problem))
            self.problemChosen.emit(problem.place, SEVERITY_COLORS[problem.severity])

    def _drag_key(self, to: int) -> None:
        if self._gesture is None:
            self._gesture = self.session.begin("Move Keyframe")
        layer_id, held = self.session.layer.id, self._held
        taken = {k.frame for k in self._gesture.document.layer(layer_id).keyframes} - {held}
        if to in taken:
            return  # it stays beside the keyframe that it was dragged onto
        if self._gesture.update(lambda d: move_keyframe(d, layer_id, held, to)):
            self.session.go_to(to)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._scrubbing and abs(event.position().x() - self._press_x) <= STILL_PX:
            self._go_to_worst(event.position())
        self._end_drag(keep=True)

    def _end_drag(self, *, keep: bool) -> None:
        gesture, self._gesture = self._gesture, None
        held, self._held, self._scrubbing = self._held, None, False
        if gesture is not None:
            if keep:
                gesture.commit()
            else:
                gesture.cancel()
                self.session.go_to(held)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._gesture is not None:
            self._end_drag(keep=False)
        else:
            super().keyPressEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        at = QPointF(event.pos())
        row = self._row_at(at.y())
        if row is not None:
            self.session.set_layer(self._rows()[row].id)
        key = self._key_under(at)
        frame = key[1] if key else self.frame_at(at.x())
        self.session.go_to(frame)
        self.menuWanted.emit(frame, event.globalPos())

    def wheelEvent(self, event: QWheelEvent) -> None:
        delta = event.angleDelta()
        whole_width = (self.session.document.length - 1) * self.step + RIGHT
        self._left = self._clipped(self._left - (delta.x() or delta.y()) / 2, whole_width - self.width() + HEADER)
        if not delta.x():
            rows = RULER + len(self._rows()) * ROW
            self._top = self._clipped(self._top - delta.y() / 3, rows - self.height())
        self.update()
        event.accept()

    @staticmethod
    def _clipped(value: float, most: float) -> float:
        return min(max(value, 0.0), max(most, 0.0))

    def _on_document_changed(self, diff: DocumentDiff) -> None:
        """Paint again only what shows here: of a drag of a vertex only that the certificate is gone."""
        shown = _shown(diff.before), _shown(diff.after)
        if diff.frame_range or shown[0] != shown[1] or self._certificates() != self._painted:
            self.update()

    def _on_frame_changed(self, frame: int) -> None:
        x = self.x_of(frame)
        if x < HEADER:
            self._left = max(0.0, self._left - (HEADER - x) - 40)
        elif x > self.width() - RIGHT / 2:
            self._left += x - self.width() + RIGHT / 2 + 40
        if (self.session.document.length - 1) * self.step <= self.width() - HEADER - RIGHT + 1:
            self._left = 0.0
        self.update()

    def _certificates(self) -> list[SpanCertificate | None]:
        return [self.certificates.of(*pair) for layer in self._rows() for pair in pairwise(layer.keyframes)]

    # painting

    def paintEvent(self, _: object) -> None:
        self._painted = self._certificates()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(self.rect(), self.theme.color("panel"))
        for row, layer in enumerate(self._rows()):
            self._paint_row(painter, row, layer)
        painter.fillRect(QRectF(0, 0, self.width(), RULER), self.theme.color("panel"))
        self._paint_ruler(painter)
        self._paint_playhead(painter)
        painter.end()

    def _paint_ruler(self, painter: QPainter) -> None:
        length, theme = self.session.document.length, self.theme
        font = QFont(self.font())
        font.setPixelSize(11)
        painter.setFont(font)
        first, last = max(1, self.frame_at(HEADER)), min(length, self.frame_at(self.width()))
        each = next((n for n in SELDOM if n * self.step >= 44), SELDOM[-1])
        fine = next((n for n in SELDOM if n * self.step >= 6), SELDOM[-1])
        for frame in range(first, last + 1):
            numbered = frame == 1 or frame % each == 0 or frame == length
            if not numbered and frame % fine:
                continue
            x = self.x_of(frame)
            painter.setPen(QPen(theme.color("muted" if numbered else "line"), 1))
            painter.drawLine(QPointF(x, RULER - (8 if numbered else 5)), QPointF(x, RULER - 1))
            crowded = frame == length and frame % each and (frame % each) * self.step < 26
            if numbered and not crowded:
                painter.drawText(QRectF(x - 24, 4, 48, 18), int(Qt.AlignmentFlag.AlignCenter), str(frame))

    def _paint_row(self, painter: QPainter, row: int, layer: Layer) -> None:
        theme, rect = self.theme, self.row_rect(row)
        active = layer.id == self.session.layer.id
        if active:
            painter.fillRect(rect, theme.color("raised"))
        painter.save()
        painter.setClipRect(QRectF(HEADER - DIAMOND - 3, rect.top(), self.width(), ROW))
        self._paint_spans(painter, rect, layer, active)
        painter.restore()
        font = QFont(self.font())
        font.setBold(active)
        painter.setFont(font)
        painter.setPen(theme.color("text" if active else "muted"))
        name = painter.fontMetrics().elidedText(layer.name, Qt.TextElideMode.ElideRight, HEADER - 32)
        painter.drawText(rect.adjusted(18, 0, 0, 0), int(Qt.AlignmentFlag.AlignVCenter), name)

    def _paint_spans(self, painter: QPainter, rect: QRectF, layer: Layer, active: bool) -> None:
        theme, y = self.theme, rect.center().y()
        here = {k.frame for k in self.session.span_keyframes() if k is not None} if active else set()
        for k, following in pairwise(layer.keyframes):
            chosen = {k.frame, following.frame} <= here
            self._paint_bar(painter, y, k, following, chosen=chosen)
            if self.step >= 8:
                painter.setPen(
                    QPen(theme.color("panel", 0.9), 2.2, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap)
                )
                painter.drawPoints(
                    QPolygonF([QPointF(self.x_of(f), y) for f in range(k.frame + 1, following.frame)])
                )
        for k in layer.keyframes:
            self._paint_diamond(painter, QPointF(self.x_of(k.frame), y), (layer.id, k.frame))

    def _paint_bar(self, painter: QPainter, y: float, before: Keyframe, after: Keyframe, *, chosen: bool) -> None:
        """Paint a span in the colours of its certificate, or, while it has none, in the accent."""
        certificate = self.certificates.of(before, after)
        x0, x1 = self.x_of(before.frame), self.x_of(after.frame)
        token, strength = ("good", (0.65, 0.4)) if certificate else ("accent", (0.55, 0.28))
        color = self.theme.color(token, strength[0 if chosen else 1])
        painter.fillRect(QRectF(x0, y - BAR, x1 - x0, 2 * BAR), color)
        for first, last, severity in certificate.runs if certificate else ():
            if SEVERITY_COLORS[severity] != "good":
                left, right = self.x_of(first - 0.5), self.x_of(last + 0.5)
                rect = QRectF(left, y - BAR, right - left, 2 * BAR)
                painter.fillRect(rect, self.theme.color("panel"))
                painter.fillRect(rect, self.theme.color(SEVERITY_COLORS[severity], 0.95 if chosen else 0.7))

    def _paint_diamond(self, painter: QPainter, at: QPointF, key: tuple[int, int]) -> None:
        theme = self.theme
        r = DIAMOND + (1.5 if key == self._hover_key else 0)
        current = key == (self.session.layer.id, self.session.frame)
        painter.setPen(QPen(theme.color("accent" if current else "panel"), 1.6))
        painter.setBrush(theme.color("text"))
        painter.drawPolygon(
            QPolygonF([at + QPointF(0, -r), at + QPointF(r, 0), at + QPointF(0, r), at + QPointF(-r, 0)])
        )

    def _paint_playhead(self, painter: QPainter) -> None:
        theme, frame = self.theme, self.session.frame
        x = self.x_of(frame)
        if x < HEADER - 1:
            return
        painter.setPen(QPen(theme.color("accent"), 1.8))
        painter.drawLine(QPointF(x, 22), QPointF(x, self.height()))
        text = str(frame)
        width = max(26.0, painter.fontMetrics().horizontalAdvance(text) + 14)
        badge = QRectF(x - width / 2, 3, width, 19)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.color("accent"))
        painter.drawRoundedRect(badge, 5, 5)
        font = QFont(self.font())
        font.setPixelSize(11)
        font.setBold(True)
        painter.setFont(font)
        painter.setPen(theme.color("accent_text"))
        painter.drawText(badge, int(Qt.AlignmentFlag.AlignCenter), text)
