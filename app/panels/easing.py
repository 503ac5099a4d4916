"""The easing of a span: presets, a curve with two handles, and the timing chart that follows from it."""

from dataclasses import replace

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QComboBox, QSizePolicy, QWidget

from app.panels.parts import Section
from app.session import Gesture, Session
from app.theme import Theme
from core.model.easing import PRESETS, Easing, preset_name
from core.model.edits import set_span

OWN_CURVE = "own curve"
MARGIN = 14.0
CHART = 58.0
REACH = 12.0
LOW, HIGH = -0.5, 1.5


class EasingPlot(QWidget):
    """The curve t over ratio with its handles; beside it the frames as ticks, as animators draw a timing chart.

    `handleMoved` tells every step of a drag, `released` its end, `escaped` that it shall not have been.
    """

    handlePressed = Signal()
    handleMoved = Signal(object)  # Easing
    released = Signal()
    escaped = Signal()

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme = theme
        self.easing = Easing()
        self.frames = (1, 24)
        self.ratio: float | None = None
        self._held: int | None = None
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.ClickFocus)
        self.setToolTip("Drag the two handles; the ticks on the right are the frames of the span")

    def sizeHint(self) -> QSize:
        return QSize(240, 124)

    def show_easing(self, easing: Easing, frames: tuple[int, int], ratio: float | None) -> None:
        if (easing, frames, ratio) != (self.easing, self.frames, self.ratio):
            self.easing, self.frames, self.ratio = easing, frames, ratio
            self.update()

    def _plot(self) -> QRectF:
        return QRectF(0.5, 0.5, self.width() - CHART, self.height() - 1)

    def _spread(self) -> tuple[float, float]:
        """The range of t that is shown: 0 to 1, or more where a handle goes beyond."""
        return min(0.0, self.easing.y1, self.easing.y2, LOW if self._held else 0.0), max(
            1.0, self.easing.y1, self.easing.y2
        )

    def place(self, x: float, y: float) -> QPointF:
        """Return where (ratio, t) lies in the widget."""
        box = self._plot().adjusted(MARGIN, MARGIN, -MARGIN, -MARGIN)
        low, high = self._spread()
        return QPointF(box.left() + x * box.width(), box.bottom() - (y - low) / (high - low) * box.height())

    def handle_places(self) -> tuple[QPointF, QPointF]:
        e = self.easing
        if e.is_linear:
            return self.place(1 / 3, 1 / 3), self.place(2 / 3, 2 / 3)  # else they would lie on the ends
        return self.place(e.x1, e.y1), self.place(e.x2, e.y2)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        for i, place in enumerate(self.handle_places()):
            d = place - event.position()
            if d.x() ** 2 + d.y() ** 2 <= REACH**2:
                self._held = i + 1
                self.handlePressed.emit()
                return

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._held is None:
            near = any((p - event.position()).manhattanLength() <= REACH for p in self.handle_places())
            self.setCursor(Qt.CursorShape.SizeAllCursor if near else Qt.CursorShape.ArrowCursor)
            return
        box = self._plot().adjusted(MARGIN, MARGIN, -MARGIN, -MARGIN)
        low, high = self._spread()
        x = min(max((event.position().x() - box.left()) / box.width(), 0.0), 1.0)
        y = low + (box.bottom() - event.position().y()) / box.height() * (high - low)
        y = min(max(y, LOW), HIGH)
        base = Easing(1 / 3, 1 / 3, 2 / 3, 2 / 3) if self.easing.is_linear else self.easing
        x, y = round(x, 3), round(y, 3)
        self.handleMoved.emit(replace(base, x1=x, y1=y) if self._held == 1 else replace(base, x2=x, y2=y))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._held is not None:
            self._held = None
            self.released.emit()
            self.update()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape and self._held is not None:
            self._held = None
            self.escaped.emit()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, _: object) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        theme = self.theme
        painter.setPen(QPen(theme.color("line"), 1))
        painter.setBrush(theme.color("raised"))
        painter.drawRoundedRect(self._plot(), 7, 7)
        self._paint_curve(painter)
        self._paint_chart(painter)
        painter.end()

    def _paint_curve(self, painter: QPainter) -> None:
        theme, enabled = self.theme, self.isEnabled()
        if not enabled:
            return
        x = np.linspace(0, 1, 65)
        curve = QPolygonF([self.place(*p) for p in zip(x, self.easing.t_at(x), strict=True)])
        if self.ratio is not None:
            at = self.place(self.ratio, 0).x()
            painter.setPen(QPen(theme.color("accent", 0.5), 1))
            painter.drawLine(QPointF(at, self._plot().top() + 4), QPointF(at, self._plot().bottom() - 4))
        painter.setPen(QPen(theme.color("accent"), 2.2))
        painter.drawPolyline(curve)
        for end, handle in zip((self.place(0, 0), self.place(1, 1)), self.handle_places(), strict=True):
            painter.setPen(QPen(theme.color("accent", 0.45), 1))
            painter.drawLine(end, handle)
            painter.setPen(QPen(theme.color("accent"), 1.8))
            painter.setBrush(theme.color("panel"))
            painter.drawEllipse(handle, 4.5, 4.5)

    def _paint_chart(self, painter: QPainter) -> None:
        if not self.isEnabled():
            return
        theme = self.theme
        first, last = self.frames
        x = self.width() - CHART / 2
        top, bottom = 10.0, self.height() - 10.0
        painter.setPen(QPen(theme.color("text"), 1.4))
        painter.drawLine(QPointF(x, top), QPointF(x, bottom))
        count = last - first
        ratios = np.arange(count + 1) / max(count, 1)
        for i, t in enumerate(np.clip(self.easing.t_at(ratios), 0, 1)):
            half = 9 if i in (0, count) else 5
            y = bottom - float(t) * (bottom - top)
            painter.drawLine(QPointF(x - half, y), QPointF(x + half, y))
        font = painter.font()
        font.setPixelSize(10)
        painter.setFont(font)
        painter.setPen(theme.color("muted"))
        painter.drawText(QPointF(x + 12, bottom + 4), str(first))
        painter.drawText(QPointF(x + 12, top + 4), str(last))


class EasingPanel(Section):
    """Presets and the plot, for the span under the playhead."""

    def __init__(self, session: Session, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Easing", parent)
        self.session = session
        self._gesture: Gesture | None = None
        self.presets = QComboBox()
        self.presets.addItems([*PRESETS, OWN_CURVE])
        self.presets.setToolTip("How the drawings are spaced between the two keyframes")
        self.presets.activated.connect(self._on_preset)
        self.plot = EasingPlot(theme)
        self.box.addWidget(self.presets)
        self.box.addWidget(self.plot)
        self.plot.handlePressed.connect(self._on_pressed)
        self.plot.handleMoved.connect(self._on_moved)
        self.plot.released.connect(lambda: self._end(keep=True))
        self.plot.escaped.connect(lambda: self._end(keep=False))
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def set_theme(self, theme: Theme) -> None:
        self.plot.theme = theme
        self.plot.update()

    def _refresh(self, *_: object) -> None:
        before, after = self.session.span_keyframes()
        there = before is not None and after is not None
        self.presets.setEnabled(there)
        self.plot.setEnabled(there)
        if before is None or after is None:
            self.plot.show_easing(Easing(), (1, 1), None)
            return
        easing = before.span.easing
        self.presets.setCurrentText(preset_name(easing) or OWN_CURVE)
        ratio = (self.session.frame - before.frame) / (after.frame - before.frame)
        self.plot.show_easing(easing, (before.frame, after.frame), ratio)

    def _frame(self) -> int | None:
        before, after = self.session.span_keyframes()
        return before.frame if before is not None and after is not None else None

    def _on_preset(self, _: int) -> None:
        frame, easing = self._frame(), PRESETS.get(self.presets.currentText())
        if frame is not None and easing is not None:
            self.session.apply("Change Easing", set_span, self.session.layer.id, frame, easing=easing)
        self._refresh()

    def _on_pressed(self) -> None:
        if self._frame() is not None:
            self._gesture = self.session.begin("Change Easing")

    def _on_moved(self, easing: Easing) -> None:
        frame = self._frame()
        if self._gesture is not None and frame is not None:
            layer_id = self.session.layer.id
            self._gesture.update(lambda d: set_span(d, layer_id, frame, easing=easing))

    def _end(self, *, keep: bool) -> None:
        gesture, self._gesture = self._gesture, None
        if gesture is not None:
            if keep:
                gesture.commit()
            else:
                gesture.cancel()
