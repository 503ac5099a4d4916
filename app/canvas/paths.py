"""The ways that points take through the span: those of pins, and of vertices where they are wanted."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen, QPolygonF

from app.canvas.content import Content
from app.canvas.items import CanvasItem, draw_dots
from app.canvas.lines import MOST_LINES, shown_rows
from app.canvas.papers import INBETWEEN, Paper
from app.canvas.pins import PinMark, pin_papers
from core.geometry.outline import FloatArray
from core.model.motion import SpanMotion

if TYPE_CHECKING:
    from app.canvas.canvas import Canvas

STILL = 1.5
"""View px: a pin that moves less is shown as held still."""

MOST_STEPS = 48
"""Frames at which the ways of vertices are worked out."""


class PathsItem(CanvasItem):
    """Where vertices go, with a dot a frame; of at most MOST_LINES of them."""

    def __init__(self, canvas: "Canvas", z: int) -> None:
        super().__init__(canvas, z)
        self._kept: tuple[object, FloatArray] | None = None

    def draw(self, painter: QPainter, content: Content) -> None:
        options = content.options
        if not options.paths or options.final or content.films or content.motion is None:
            return
        ways = self._ways(content)
        for paper in content.papers:
            if INBETWEEN in paper.shows:
                self._draw_ways(painter, self.canvas.camera.to_view(ways, paper.offset))

    def _ways(self, content: Content) -> FloatArray:
        """Return (frames, rows, 2) in stage px; worked out once a plan."""
        motion = content.motion
        if self._kept is None or self._kept[0] is not motion:
            frames = range(motion.before.frame, motion.after.frame + 1)
            self._kept = motion, vertex_ways(motion, frames[:: -(-len(frames) // MOST_STEPS)])
        return self._kept[1]

    def _draw_ways(self, painter: QPainter, ways: FloatArray) -> None:
        theme = self.canvas.theme
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(theme.color("inbetween", 0.45), 1))
        path = QPainterPath()
        for way in ways.swapaxes(0, 1):
            path.addPolygon(polygon(way))
        painter.drawPath(path)
        painter.setPen(QPen(theme.color("inbetween", 0.8), 2.6, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawPoints(polygon(ways.reshape(-1, 2)))


class PinsItem(CanvasItem):
    """Pins; with the pin tool also their ways, a dot a frame, and the handles of the chosen one."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if content.options.final:
            return
        whole = self.canvas.shows_pins
        if not whole and (content.options.lines == "none" or content.films):
            return
        marks = self.canvas.pin_marks
        for paper in pin_papers(content):
            if whole:
                for mark in marks:
                    self._draw_way(painter, content, mark, paper)
            for mark in marks:
                self._draw_pin(painter, mark, paper)
            if whole:
                self._draw_handles(painter, marks, paper)

    def _draw_way(self, painter: QPainter, content: Content, mark: PinMark, paper: Paper) -> None:
        camera, theme = self.canvas.camera, self.canvas.theme
        way = camera.to_view(mark.way, paper.offset)
        if np.ptp(way, axis=0).max() < STILL:
            return
        chosen = mark.ref == self.canvas.session.selection.pin
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(theme.color("accent", 1.0 if chosen else 0.75), 1.8 if chosen else 1.3))
        painter.drawPolyline(polygon(way))
        dots = camera.to_view(mark.dots, paper.offset)
        draw_dots(painter, dots, theme.color("stage"), theme.color("accent"), 8.2)
        self._draw_now(painter, content, mark, paper)

    def _draw_now(self, painter: QPainter, content: Content, mark: PinMark, paper: Paper) -> None:
        """Show where the pinned point is at the playhead."""
        if content.t is None or content.plan is None:
            return
        here = content.plan.paths.pinned(np.array([content.t]))[:, mark.ref.index]
        view = self.canvas.camera.to_view(here, paper.offset)
        draw_dots(painter, view, self.canvas.theme.color("accent"), self.canvas.theme.color("inbetween"), 10.5)

    def _draw_pin(self, painter: QPainter, mark: PinMark, paper: Paper) -> None:
        theme = self.canvas.theme
        at = QPointF(*self.canvas.camera.to_view(mark.start, paper.offset))
        chosen = mark.ref == self.canvas.session.selection.pin
        painter.setPen(QPen(theme.color("accent"), 2))
        painter.setBrush(theme.color("accent" if chosen else "stage"))
        painter.drawPolygon(diamond(at, 7.0))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(theme.color("accent_text" if chosen else "accent"))
        painter.drawEllipse(at, 2.0, 2.0)

    def _draw_handles(self, painter: QPainter, marks: tuple[PinMark, ...], paper: Paper) -> None:
        camera, theme = self.canvas.camera, self.canvas.theme
        for mark in marks:
            if mark.ref != self.canvas.session.selection.pin or mark.handles is None:
                continue
            ends = camera.to_view(np.array([mark.start, mark.end]), paper.offset)
            handles = camera.to_view(np.array(mark.handles), paper.offset)
            for end, handle in zip(ends, handles, strict=True):
                painter.setPen(QPen(theme.color("muted"), 1))
                painter.drawLine(QPointF(*end), QPointF(*handle))
                draw_square(painter, QPointF(*handle), theme.color("accent"), theme.color("stage"))


def vertex_ways(motion: SpanMotion, frames: Sequence[int]) -> FloatArray:
    """Return where at most MOST_LINES vertices are at frames of the film, as (frames, rows, 2)."""
    shapes = motion.at((np.array(frames) - motion.before.frame) / motion.length)
    links = motion.plan.links
    ways = np.concatenate([s[:, shown_rows(link)] for s, link in zip(shapes, links, strict=True)], axis=1)
    return ways[:, :: max(1, -(-ways.shape[1] // MOST_LINES))]


def polygon(points: FloatArray) -> QPolygonF:
    return pg.functions.arrayToQPolygonF(points[:, 0], points[:, 1])


def diamond(at: QPointF, reach: float) -> QPolygonF:
    corners = (0, -reach), (reach, 0), (0, reach), (-reach, 0)
    return QPolygonF([at + QPointF(x, y) for x, y in corners])


def draw_square(painter: QPainter, at: QPointF, ring: QColor, fill: QColor) -> None:
    painter.setPen(QPen(ring, 1.6))
    painter.setBrush(fill)
    painter.drawRect(QRectF(at.x() - 3.5, at.y() - 3.5, 7, 7))
