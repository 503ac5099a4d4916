"""The pen: click the vertices of an outline one by one."""

import math

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QPainter, QPen, QPolygonF

from app.canvas.papers import Paper, paper_at
from app.canvas.tool import Pointer, Tool
from app.penoptions import PenOptions
from core.model.edits import add_outline

CLOSE_REACH = 10.0


class PenTool(Tool):
    name, icon = "Pen", "pen"
    hint = (
        "Click vertices. The first again: close. Double click: open. "
        "Enter: end as the panel says. Backspace: one back. Escape: give up."
    )
    held = (("Shift", "steps of 45°; Enter the other way"),)
    cursor = Qt.CursorShape.CrossCursor
    only_draws = True

    def __init__(self, canvas, options: PenOptions) -> None:
        super().__init__(canvas)
        self.options = options
        self._points: list[tuple[float, float]] = []
        self._next: tuple[float, float] | None = None
        self._paper: Paper | None = None

    @property
    def busy(self) -> bool:
        return bool(self._points)

    def wants_key(self, event: QKeyEvent) -> bool:
        keys = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Backspace, Qt.Key.Key_Escape, Qt.Key.Key_Delete)
        return self.busy and event.key() in keys

    def press(self, pointer: Pointer) -> None:
        if not self._points:
            self._start_on_paper(pointer)
        place = self._place(pointer)
        if self._closes(pointer):
            self._finish(closed=True)
            return
        if not self._points or place != self._points[-1]:
            self._points.append(place)
        self._next = place
        self.canvas.refresh()

    def double_click(self, pointer: Pointer) -> None:
        """End an open outline; but two quick clicks at different places are two vertices."""
        if not self._points:
            return  # the first click has just closed the outline
        if pointer.far_from(self._view(self._points[-1])):
            self.press(pointer)
        elif len(self._points) > 1:
            self._finish(closed=False)

    def right_press(self, pointer: Pointer) -> None:
        if len(self._points) > 1:
            self._finish(closed=False)

    def hover(self, pointer: Pointer) -> None:
        if self._points:
            self._next = self._place(pointer)
            spot = self._view(self._points[0]) if self._closes(pointer) else None
            self.canvas.set_hover(spot)
            self.canvas.refresh()

    drag = hover

    def key(self, event: QKeyEvent) -> bool:
        if not self._points:
            return False
        key = event.key()
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            other_way = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
            self._finish(closed=self.options.closed != other_way)
        elif key in (Qt.Key.Key_Backspace, Qt.Key.Key_Delete):
            self._points.pop()
            self.canvas.refresh()
        elif key == Qt.Key.Key_Escape:
            self.cancel()
        else:
            return False
        return True

    def cancel(self) -> None:
        self._points, self._next = [], None
        self.canvas.set_hover(None)
        self.canvas.refresh()

    def paint(self, painter: QPainter) -> None:
        if not self._points:
            return
        theme = self.canvas.theme
        places = [self._view(p) for p in self._points]
        painter.setPen(QPen(theme.color("accent"), 1.8))
        painter.drawPolyline(QPolygonF(places))
        if self._next is not None:
            painter.setPen(QPen(theme.color("accent", 0.6), 1.4, Qt.PenStyle.DashLine))
            painter.drawLine(places[-1], self._view(self._next))
        painter.setPen(QPen(theme.color("accent"), 1.8))
        painter.setBrush(theme.color("stage"))
        for place in places:
            painter.drawEllipse(place, 3.5, 3.5)

    def _start_on_paper(self, pointer: Pointer) -> None:
        content = self.canvas.content
        x, _ = self.canvas.camera.to_stage(pointer.at)
        self._paper = paper_at(content.papers, content.document.stage, x)

    @property
    def _offset(self) -> float:
        return self._paper.offset if self._paper else 0.0

    def _place(self, pointer: Pointer) -> tuple[float, float]:
        x, y = self.canvas.camera.to_stage(pointer.at, self._offset)
        if pointer.shift and self._points:
            return snapped_direction(self._points[-1], (x, y))
        return x, y

    def _view(self, place: tuple[float, float]) -> QPointF:
        return QPointF(*self.canvas.camera.to_view(np.array(place), self._offset))

    def _closes(self, pointer: Pointer) -> bool:
        if len(self._points) < 3:
            return False
        d = self._view(self._points[0]) - pointer.at
        return math.hypot(d.x(), d.y()) <= CLOSE_REACH

    def _finish(self, *, closed: bool) -> None:
        points = np.array(self._points)
        least = 3 if closed else 2
        if len(points) < least:
            self.canvas.session.problem.emit(
                f"{len(points)} vertices are too few: click at least {least}, or press Escape to give up."
            )
            return
        session = self.canvas.session
        if session.apply("Draw Outline", add_outline, session.layer.id, session.frame, points, closed=closed):
            self.cancel()


def snapped_direction(start: tuple[float, float], end: tuple[float, float]) -> tuple[float, float]:
    """Turn the way from start to end to the nearest multiple of 45 degrees."""
    dx, dy = end[0] - start[0], end[1] - start[1]
    angle = round(math.atan2(dy, dx) / (math.pi / 4)) * math.pi / 4
    length = dx * math.cos(angle) + dy * math.sin(angle)
    return start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)
