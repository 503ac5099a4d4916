"""The pencil: draw an outline freehand; it is simplified on release."""

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QPainter, QPen, QPolygonF

from app.canvas.papers import Paper, paper_at
from app.canvas.tool import Pointer, Tool
from app.penoptions import PenOptions
from core.geometry.outline import FloatArray, size
from core.geometry.simplify import simplify, simplify_closed, smooth, without_repeats
from core.model.edits import add_outline

SMALLEST_DRAWING = 4.0
"""View px; a shorter scratch is a slip of the hand."""


class PencilTool(Tool):
    name, icon = "Pencil", "pencil"
    hint = "Draw with the button down; closed or open as the drawing panel says. Escape: give up."
    held = (("Alt", "the other way"),)
    cursor = Qt.CursorShape.CrossCursor
    only_draws = True

    def __init__(self, canvas, options: PenOptions) -> None:
        super().__init__(canvas)
        self.options = options
        self._trail: list[QPointF] = []
        self._paper: Paper | None = None

    @property
    def busy(self) -> bool:
        return bool(self._trail)

    def press(self, pointer: Pointer) -> None:
        content = self.canvas.content
        x, _ = self.canvas.camera.to_stage(pointer.at)
        self._paper = paper_at(content.papers, content.document.stage, x)
        self._trail = [pointer.at]

    def drag(self, pointer: Pointer) -> None:
        if self._trail:
            self._trail.append(pointer.at)
            self.canvas.refresh()

    def release(self, pointer: Pointer) -> None:
        trail, self._trail = self._trail, []
        self.canvas.refresh()
        if not trail:
            return
        view = np.array([(p.x(), p.y()) for p in trail])
        if size(view) < SMALLEST_DRAWING:
            return
        closed = self.options.closed != pointer.alt
        camera = self.canvas.camera
        offset = self._paper.offset if self._paper else 0.0
        stage = np.array([camera.to_stage(p, offset) for p in trail])
        points = tidy(stage, self.options.tolerance, 1 / camera.scale, closed=closed)
        if len(points) < (3 if closed else 2):
            self.canvas.session.problem.emit(
                "That line encloses nothing: draw round a shape, or draw open outlines (Alt)."
            )
            return
        session = self.canvas.session
        session.apply("Draw Outline", add_outline, session.layer.id, session.frame, points, closed=closed)

    def key(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape and self._trail:
            self.cancel()
            return True
        return False

    def cancel(self) -> None:
        self._trail = []
        self.canvas.refresh()

    def paint(self, painter: QPainter) -> None:
        if self._trail:
            painter.setPen(QPen(self.canvas.theme.color("accent"), 1.8))
            painter.drawPolyline(QPolygonF(self._trail))


def tidy(points: FloatArray, tolerance: float, pixel: float, *, closed: bool) -> FloatArray:
    """Return a hand-drawn line without its trembling and with few vertices.

    `tolerance` is in stage px; `pixel` is the size of one screen px in stage px, the grain of the trembling.
    """
    line = without_repeats(points)
    if closed and len(line) > 1:
        line = without_repeats(np.concatenate([line, line[:1]]))
    if len(line) < 3:
        return line
    even = smooth(line, step=3 * pixel)
    if closed:
        return simplify_closed(even[:-1], tolerance) if len(even) > 3 else even[:-1]
    return simplify(even, tolerance)
