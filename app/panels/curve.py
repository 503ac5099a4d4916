"""The curve of an easing, t over ratio, edited on its plot."""

from typing import NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent, QPainter, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from app.panels.spacing import MARGIN, Spacing, SpacingView
from app.theme import Theme
from core.errors import InkbetweenError
from core.model.curve_edits import Side, add_knot, delete_knot, move_handle, move_knot, with_handles
from core.model.easing import Easing

REACH = 11.0
CURVE_REACH = 9.0
NUDGE = 0.01


class Grip(NamedTuple):
    """What can be taken hold of: a knot, or a handle of a knot, or (index None) of an end of the curve."""

    index: int | None
    part: str  # "knot", "in" or "out"


class EasingPlot(SpacingView):
    """See the module.

    `pressed` begins a drag, `moved` is every step of it, `released` its end, `escaped` that it shall not be.
    `changed` is an edit that is done at once: its label, and what it may merge with.
    """

    pressed = Signal()
    moved = Signal(object)  # Easing
    released = Signal()
    escaped = Signal()
    changed = Signal(str, object, object)  # label, Easing, merge key
    refused = Signal(str)

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self.chosen: int | None = None
        self._held: Grip | None = None
        self._start = Easing()
        self._from = QPointF()
        self._scale = 0.0  # of t a px, as it was at the press
        self._hover: Grip | None = None
        self.setAccessibleName("Easing curve")
        self.setToolTip(
            "Drag the handles. Double click the curve for a knot, a knot to take it away.\n"
            "Alt: only one handle of a knot. Arrow keys move the chosen knot. The dots are the drawings."
        )

    def show_spacing(self, spacing: Spacing | None) -> None:
        """Show a span, or nothing; a knot of another one is not the chosen one."""
        shown = self.spacing
        if spacing is None or shown is None or (spacing.first, spacing.last) != (shown.first, shown.last):
            self.chosen = None
        super().show_spacing(spacing)

    @property
    def easing(self) -> Easing:
        return with_handles(self.spacing.span.easing) if self.spacing else with_handles(Easing())

    @property
    def _shows_curve(self) -> bool:
        return self.spacing is not None and not self.spacing.span.hold and self.isEnabled()

    # places

    def place(self, ratio: float, t: float) -> QPointF:
        """Return where (ratio, t) lies in the widget."""
        return QPointF(MARGIN + ratio * self._wide(), self.y_of(t))

    def _wide(self) -> float:
        return self.width() - 2 * MARGIN

    def grips(self) -> list[tuple[Grip, QPointF]]:
        """Return everything that can be taken hold of, what lies on top first."""
        e, found = self.easing, []
        if self.chosen is not None and self.chosen < len(e.knots):
            k = e.knots[self.chosen]
            found.append((Grip(self.chosen, "in"), self.place(k.in_x, k.in_y)))
            found.append((Grip(self.chosen, "out"), self.place(k.out_x, k.out_y)))
        found.append((Grip(None, "out"), self.place(e.x1, e.y1)))
        found.append((Grip(None, "in"), self.place(e.x2, e.y2)))
        found += [(Grip(i, "knot"), self.place(k.x, k.y)) for i, k in enumerate(e.knots)]
        return found

    def _under(self, at: QPointF) -> Grip | None:
        if not self._shows_curve:
            return None
        distance, grip = min(((_distance(place, at), grip) for grip, place in self.grips()), key=lambda x: x[0])
        return grip if distance <= REACH else None

    def _ratio_on_curve(self, at: QPointF) -> float | None:
        """Return the ratio of the nearest point of the curve, if it is near."""
        x = np.linspace(0, 1, 257)
        places = [self.place(*p) for p in zip(x, self.easing.t_at(x), strict=True)]
        distances = [_distance(p, at) for p in places]
        i = int(np.argmin(distances))
        return float(x[i]) if distances[i] <= CURVE_REACH else None

    # the pointer

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() != Qt.MouseButton.LeftButton or not self._shows_curve:
            return
        grip = self._under(event.position())
        if grip is None or grip.part == "knot":
            self.chosen = grip.index if grip else None
            self.update()
        if grip is not None:
            self._held, self._start, self._from = grip, self.easing, event.position()
            self._scale = self.t_per_px()
            self.pressed.emit()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._held is None:
            hover = self._under(event.position())
            self.setCursor(Qt.CursorShape.SizeAllCursor if hover else Qt.CursorShape.ArrowCursor)
            if hover != self._hover:
                self._hover = hover
                self.update()
            return
        self.moved.emit(self._dragged(event.position() - self._from, event.modifiers()))

    def _dragged(self, way: QPointF, held: Qt.KeyboardModifier) -> Easing:
        """Return the easing with the grip moved `way` from where it was pressed.

        The scale may change under the hand when the curve goes beyond, so the px of the way are what counts.
        """
        index, part = self._held
        e, dx, dy = self._start, way.x() / self._wide(), -way.y() * self._scale
        if part == "knot":
            k = e.knots[index]
            return move_knot(e, index, round(k.x + dx, 3), round(k.y + dy, 3))
        side: Side = "in" if part == "in" else "out"
        x, y = _handle(e, index, side)
        alone = bool(held & Qt.KeyboardModifier.AltModifier)
        return move_handle(e, index, side, round(x + dx, 3), round(y + dy, 3), alone=alone)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._held is not None and event.button() == Qt.MouseButton.LeftButton:
            self._held = None
            self.released.emit()
            self.update()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        if not self._shows_curve:
            return
        grip = self._under(event.position())
        if grip is not None and grip.part == "knot":
            self._delete(grip.index)
            return
        ratio = self._ratio_on_curve(event.position())
        if grip is None and ratio is not None:
            self._add(ratio)

    def leaveEvent(self, _: object) -> None:
        self._hover = None
        self.update()

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self.update()

    # knots

    def _add(self, ratio: float) -> None:
        try:
            easing = add_knot(self.easing, ratio)
        except InkbetweenError as e:
            self.refused.emit(str(e))
            return
        self.chosen = next(i for i, k in enumerate(easing.knots) if abs(k.x - ratio) < 1e-6)
        self.changed.emit("Add Knot", easing, None)

    def _delete(self, index: int) -> None:
        self.chosen = None
        self.changed.emit("Delete Knot", delete_knot(self.easing, index), None)

    def wants(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape:
            return self._held is not None
        return self._knot_chosen and super().wants(event)

    @property
    def _knot_chosen(self) -> bool:
        return self.chosen is not None and self.chosen < len(self.easing.knots) and self._shows_curve

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = event.key()
        steps = {
            Qt.Key.Key_Left: (-1, 0),
            Qt.Key.Key_Right: (1, 0),
            Qt.Key.Key_Up: (0, 1),
            Qt.Key.Key_Down: (0, -1),
        }
        if key == Qt.Key.Key_Escape and self._held is not None:
            self._held = None
            self.escaped.emit()
        elif self._knot_chosen and key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self._delete(self.chosen)
        elif self._knot_chosen and key in steps:
            far = 5 if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else 1
            k, (dx, dy) = self.easing.knots[self.chosen], steps[key]
            moved = move_knot(self.easing, self.chosen, k.x + dx * far * NUDGE, k.y + dy * far * NUDGE)
            self.changed.emit("Move Knot", moved, ("knot", self.chosen))
        else:
            super().keyPressEvent(event)

    # painting

    def paintEvent(self, _: object) -> None:
        with QPainter(self) as painter:  # ended whatever happens: under an open one an error ends the program
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            theme, box = self.theme, QRectF(0.5, 0.5, self.width() - 1, self.height() - 1)
            painter.setPen(QPen(theme.color("line"), 1))
            painter.setBrush(theme.color("raised"))
            painter.drawRoundedRect(box, 7, 7)
            painter.setClipRect(box)
            if self.spacing is not None and self.isEnabled():
                self._paint_axes(painter)
                if self.spacing.span.hold:
                    self._paint_hold(painter)
                else:
                    self._paint_curve(painter)
                    self._paint_drawings(painter)
                    self._paint_grips(painter)

    def _paint_axes(self, painter: QPainter) -> None:
        """Paint the heights of the keyframes and the playhead."""
        painter.setPen(QPen(self.theme.color("line"), 1))
        for t in (0.0, 1.0):
            painter.drawLine(QPointF(4, self.y_of(t)), QPointF(self.width() - 4, self.y_of(t)))
        s = self.spacing
        if s is not None and s.first <= s.frame <= s.last:
            x = self.place((s.frame - s.first) / s.length, 0).x()
            painter.setPen(QPen(self.theme.color("accent", 0.5), 1))
            painter.drawLine(QPointF(x, 4), QPointF(x, self.height() - 4))

    def _paint_hold(self, painter: QPainter) -> None:
        painter.setPen(QPen(self.theme.color("accent"), 2.2))
        painter.drawPolyline(QPolygonF([self.place(0, 0), self.place(1, 0), self.place(1, 1)]))

    def _paint_curve(self, painter: QPainter) -> None:
        x = np.linspace(0, 1, 129)
        curve = [self.place(*p) for p in zip(x, self.easing.t_at(x), strict=True)]
        painter.setPen(QPen(self.theme.color("accent"), 2.0))
        painter.drawPolyline(QPolygonF(curve))

    def _paint_drawings(self, painter: QPainter) -> None:
        """Mark the drawings on the curve: the same ones as the ticks of the chart."""
        s = self.spacing
        painter.setPen(Qt.PenStyle.NoPen)
        for i, (offset, t) in enumerate((*s.ticks, (s.length, 1.0))):
            here = i == s.here
            painter.setBrush(self.theme.color("accent" if here else "text"))
            size = 3.6 if here else 2.0
            painter.drawEllipse(self.place(offset / s.length, t), size, size)

    def _paint_grips(self, painter: QPainter) -> None:
        theme, e = self.theme, self.easing
        ends = {Grip(None, "out"): self.place(0, 0), Grip(None, "in"): self.place(1, 1)}
        for grip, place in reversed(self.grips()):
            lit = grip in (self._hover, self._held)
            if grip.part == "knot":
                painter.setPen(QPen(theme.color("accent"), 1.8))
                painter.setBrush(theme.color("accent" if grip.index == self.chosen or lit else "panel"))
                painter.drawRect(QRectF(place.x() - 3.5, place.y() - 3.5, 7, 7))
                continue
            knot = e.knots[grip.index] if grip.index is not None else None
            root = self.place(knot.x, knot.y) if knot else ends[grip]
            painter.setPen(QPen(theme.color("accent", 0.45), 1))
            painter.drawLine(root, place)
            painter.setPen(QPen(theme.color("accent"), 1.8))
            painter.setBrush(theme.color("accent" if lit else "panel"))
            painter.drawEllipse(place, 4.5, 4.5)


def _handle(e: Easing, index: int | None, side: str) -> tuple[float, float]:
    if index is None:
        return (e.x1, e.y1) if side == "out" else (e.x2, e.y2)
    k = e.knots[index]
    return (k.out_x, k.out_y) if side == "out" else (k.in_x, k.in_y)


def _distance(p: QPointF, q: QPointF) -> float:
    d = p - q
    return float(np.hypot(d.x(), d.y()))
