"""The items of the canvas, from the paper up; each paints one kind of thing in view px."""

from typing import TYPE_CHECKING

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QTransform
from PySide6.QtWidgets import QStyleOptionGraphicsItem, QWidget

from app.canvas.content import FILM_TIMES, Content
from app.canvas.hits import anchor_places, is_muted
from app.canvas.lines import HUE_PIECES, MOST_LOOKED_AT, hue_pieces, line_papers, shown_rows
from app.canvas.papers import AFTER, BEFORE, INBETWEEN, Paper
from app.painting import Outlines, paint_outlines, paint_picture, to_qcolor
from core.geometry.outline import FloatArray, perimeter

if TYPE_CHECKING:
    from app.canvas.canvas import Canvas

KEY_WIDTH = 1.8
INBETWEEN_WIDTH = 2.2
HUE_WIDTH = 3.0
HUES = ("#0072b2", "#56b4e9", "#009e73", "#f0e442", "#e69f00", "#d55e00", "#cc79a7")
"""The colours of M. Okabe and K. Ito (2008), which people with any kind of colour vision can tell apart."""

FEW_SKIN_VERTICES = 1000
CLOSEST_VERTICES = 7.0
"""View px: vertices nearer to each other on average are not marked one by one."""


class CanvasItem(pg.GraphicsObject):
    """Fills the view; paints from the canvas's content."""

    def __init__(self, canvas: "Canvas", z: int) -> None:
        super().__init__()
        self.canvas = canvas
        self.setZValue(z)
        self.setAcceptedMouseButtons(Qt.MouseButton.NoButton)

    def boundingRect(self) -> QRectF:
        return QRectF(self.canvas.viewport().rect())

    def paint(self, painter: QPainter, option: QStyleOptionGraphicsItem, widget: QWidget | None = None) -> None:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.draw(painter, self.canvas.content)

    def draw(self, painter: QPainter, content: Content) -> None:
        """Paint this kind of thing."""

    def paint_lines(
        self,
        painter: QPainter,
        outlines: Outlines,
        stroke: QColor | None,
        width: float,
        transform: QTransform,
        fill: QColor | None = None,
    ) -> None:
        """Paint outlines `width` view px wide."""
        paint_outlines(
            painter,
            outlines,
            fill=fill,
            stroke=stroke,
            width=width * self.canvas.devicePixelRatioF(),
            transform=transform,
            thin=self.canvas.thinner,
        )


class PaperItem(CanvasItem):
    """The stage: paper, border, and what is written on it."""

    def draw(self, painter: QPainter, content: Content) -> None:
        stage, theme = content.document.stage, self.canvas.theme
        fill = to_qcolor(stage.background) if stage.background else theme.color("stage")
        for paper in content.papers:
            rect = self.canvas.camera.transform().mapRect(paper.rect(stage))
            painter.setPen(QPen(theme.color("line"), 1))
            painter.setBrush(fill)
            painter.drawRoundedRect(rect, 4, 4)


class OthersItem(CanvasItem):
    """The visible layers behind, or in front of, the one that is drawn on."""

    def __init__(self, canvas: "Canvas", z: int, *, in_front: bool) -> None:
        super().__init__(canvas, z)
        self.in_front = in_front

    def draw(self, painter: QPainter, content: Content) -> None:
        painter.setOpacity(1.0 if content.options.final else 0.45)
        for picture, in_front in content.others:
            if in_front == self.in_front:
                for paper in content.papers:
                    paint_picture(painter, picture, self.canvas.camera.transform(paper.offset))


class FilmItem(CanvasItem):
    """A whole span at t = 0, 0.2 ... 1, from the colour of the keyframe before to that of the one after."""

    def draw(self, painter: QPainter, content: Content) -> None:
        theme = self.canvas.theme
        for paper, frames in content.films.items():
            transform = self.canvas.camera.transform(paper.offset)
            for t, outlines in zip(FILM_TIMES, frames, strict=True):
                color = blend(theme.color("before"), theme.color("after"), t)
                fill = QColor(color)
                fill.setAlphaF(0.10)
                self.paint_lines(painter, outlines, color, 1.3, transform, fill)


class ShapesItem(CanvasItem):
    """The keyframes around the playhead and the in-between."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if content.options.final:
            if content.picture is not None:
                paint_picture(painter, content.picture, self.canvas.camera.transform())
            return
        for paper in content.papers:
            self._draw_inbetween(painter, content, paper)
            self._draw_keyframes(painter, content, paper)

    def _draw_keyframes(self, painter: QPainter, content: Content, paper: Paper) -> None:
        transform = self.canvas.camera.transform(paper.offset)
        for side in (BEFORE, AFTER):
            keyframe = content.editable(side)
            if keyframe is None or side not in paper.shows:
                continue
            if content.options.hues and content.plan is not None:
                self._draw_hues(painter, content, side, transform)
                continue
            alone = content.before is None or content.after is None
            held = alone and keyframe.frame != content.frame  # shown, though the playhead is elsewhere
            color = self.canvas.theme.color(side, 0.55 if held else 1.0)
            outlines = [(o.points, o.closed) for o in keyframe.drawing.outlines]
            self.paint_lines(painter, outlines, color, KEY_WIDTH, transform)

    def _draw_hues(self, painter: QPainter, content: Content, side: str, transform: QTransform) -> None:
        """Draw an outline in pieces, each in the colour of its share of the correspondence."""
        for link in content.plan.links if content.plan else ():
            points = link.aligned.left if side == BEFORE else link.aligned.right
            for i, rows in enumerate(hue_pieces(link)):
                piece = [(points[rows], False)]
                self.paint_lines(painter, piece, hue(i), HUE_WIDTH, transform)

    def _draw_inbetween(self, painter: QPainter, content: Content, paper: Paper) -> None:
        if content.picture is None or INBETWEEN not in paper.shows:
            return
        theme = self.canvas.theme
        on_key = content.frame in {k.frame for k in (content.before, content.after) if k is not None}
        beside = content.before is None or content.after is None
        stroke = None if on_key or beside else theme.color("inbetween")
        fill = theme.color("accent", 0.16)
        transform = self.canvas.camera.transform(paper.offset)
        areas = [x for x in content.picture.outlines if x[1]]
        lines = [x for x in content.picture.outlines if not x[1]]
        self.paint_lines(painter, areas, stroke, INBETWEEN_WIDTH, transform, fill)
        if lines and stroke is not None:  # an open outline has no inside
            self.paint_lines(painter, lines, stroke, INBETWEEN_WIDTH, transform)


class LinesItem(CanvasItem):
    """The correspondence: fine dotted lines from point to point, the anchors' solid."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if content.options.final or content.plan is None or content.films or self.canvas.shows_pins:
            return
        for start_paper, end_paper in line_papers(content):
            if content.options.lines == "all" and not content.options.paths:
                self._draw_all(painter, content, start_paper, end_paper)
            if content.options.lines != "none":
                self._draw_anchors(painter, content, start_paper, end_paper)

    def _draw_all(self, painter: QPainter, content: Content, start: Paper, end: Paper) -> None:
        camera = self.canvas.camera
        pen = QPen(self.canvas.theme.color("muted", 0.55), 1, Qt.PenStyle.CustomDashLine)
        pen.setDashPattern([1, 3])
        painter.setPen(pen)
        path = QPainterPath()
        for link in content.plan.links if content.plan else ():
            left, right = link.aligned.left, link.aligned.right
            rows = shown_rows(link)
            ends = camera.to_view(left[rows], start.offset), camera.to_view(right[rows], end.offset)
            for p, q in zip(*ends, strict=True):
                path.moveTo(p[0], p[1])
                path.lineTo(q[0], q[1])
        painter.drawPath(path)

    def _draw_anchors(self, painter: QPainter, content: Content, start: Paper, end: Paper) -> None:
        camera, theme = self.canvas.camera, self.canvas.theme
        chosen = self.canvas.session.selection.anchor
        for ref, p, q in anchor_places(content):
            pen = QPen(theme.color("accent"), 2.4 if ref == chosen else 1.5)
            if is_muted(content, ref):
                pen.setStyle(Qt.PenStyle.DashLine)
                pen.setColor(theme.color("muted"))
            painter.setPen(pen)
            a, b = camera.to_view(p, start.offset), camera.to_view(q, end.offset)
            painter.drawLine(QPointF(*a), QPointF(*b))


class HandlesItem(CanvasItem):
    """Vertices, selected and hovered ones, and the ends of anchors."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if content.options.final:
            return
        tool = self.canvas.tool
        if tool is not None and tool.shows_vertices:
            self._draw_vertices(painter, content)
        wanted = content.options.lines != "none" and not content.films and not self.canvas.shows_pins
        if wanted or (tool is not None and tool.shows_anchors):
            self._draw_anchors(painter, content)
        self._draw_hover(painter)

    def _draw_vertices(self, painter: QPainter, content: Content) -> None:
        camera, theme = self.canvas.camera, self.canvas.theme
        selected = self.canvas.session.selection.vertices
        for paper, side, ref, outline in content.outlines():
            points = camera.to_view(outline.points, paper.offset)
            if vertex_spacing(points) >= CLOSEST_VERTICES and not content.films:
                draw_dots(painter, points, theme.color(side), theme.color("stage"))
            chosen = selected.get(ref)
            if chosen:
                draw_dots(painter, points[list(chosen)], theme.color("accent_text"), theme.color("accent"), 9.0)

    def _draw_anchors(self, painter: QPainter, content: Content) -> None:
        camera, theme = self.canvas.camera, self.canvas.theme
        chosen = self.canvas.session.selection.anchor
        for start_paper, end_paper in line_papers(content):
            for ref, p, q in anchor_places(content):
                for side, place, paper in ((BEFORE, p, start_paper), (AFTER, q, end_paper)):
                    painter.setPen(QPen(theme.color(side), 2.2))
                    painter.setBrush(theme.color("accent" if ref == chosen else "stage"))
                    painter.drawEllipse(QPointF(*camera.to_view(place, paper.offset)), 5.5, 5.5)

    def _draw_hover(self, painter: QPainter) -> None:
        spot = self.canvas.hover
        if spot is None:
            return
        painter.setPen(QPen(self.canvas.theme.color("accent"), 2))
        painter.setBrush(self.canvas.theme.color("accent", 0.25))
        painter.drawEllipse(spot, 7.5, 7.5)


class MarkItem(CanvasItem):
    """A ring around the place of a problem."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if self.canvas.marked is None or content.options.final:
            return
        place, token = self.canvas.marked
        painter.setBrush(self.canvas.theme.color(token, 0.14))
        painter.setPen(QPen(self.canvas.theme.color(token), 2.4))
        for paper in content.papers:
            if INBETWEEN in paper.shows:
                painter.drawEllipse(QPointF(*self.canvas.camera.to_view(np.array(place), paper.offset)), 15, 15)


class LabelsItem(CanvasItem):
    """Which frame has which colour, in the corner of the paper; and what to do on an empty one."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if content.options.final:
            return
        stage, camera = content.document.stage, self.canvas.camera
        for paper in content.papers:
            rect = camera.transform().mapRect(paper.rect(stage))
            # small papers beside each other leave no room for words on them
            top = rect.top() + 24 if len(content.papers) == 1 else rect.top() - 10
            self._draw_words(painter, self._words(content, paper), rect.left() + 14, top, rect.width())
        if content.before is None and content.after is None and not self._busy():
            rect = camera.transform().mapRect(content.papers[0].rect(stage))
            painter.setPen(self.canvas.theme.color("muted"))
            painter.drawText(rect, int(Qt.AlignmentFlag.AlignCenter), self._advice())
        elif len(self.canvas.session.layer.keyframes) == 1 and not self._busy():
            rect = camera.transform().mapRect(content.papers[0].rect(stage)).adjusted(0, 0, 0, -14)
            place = Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignBottom
            painter.setPen(self.canvas.theme.color("muted"))
            painter.drawText(rect, int(place), self._second_advice(content))

    def _advice(self) -> str:
        """Say how a first drawing is made, with the keys as they are now."""
        pen, pencil = (self.canvas.key_of(f"tool.{tool}") for tool in ("pen", "pencil"))
        by_pen = f"Press {pen} and click" if pen else "Take the pen and click"
        by_pencil = f"press {pencil} and draw" if pencil else "take the pencil and draw"
        others = any(x.keyframes for x in self.canvas.session.document.layers)
        which = "the first drawing of this layer" if others else "your first drawing"
        return f"{by_pen} the corners of {which},\nor {by_pencil} it freehand."

    def _second_advice(self, content: Content) -> str:
        """Say how one keyframe becomes a span."""
        if content.frame != self.canvas.session.layer.keyframes[0].frame:
            return "Now draw it as it is here: the drawings between come by themselves."
        last = self.canvas.key_of("play.last")
        there = f"press {last} for the last frame" if last else "drag the playhead"
        return f"Go to another frame ({there}) and draw the second keyframe."

    def _busy(self) -> bool:
        return self.canvas.tool is not None and self.canvas.tool.busy

    def _words(self, content: Content, paper: Paper) -> list[tuple[str, str]]:
        words = [(paper.title, "text")] if paper.title else []
        if content.before is not None and BEFORE in paper.shows:
            words.append((f"before  frame {content.before.frame}", "before"))
        if content.after is not None and AFTER in paper.shows:
            words.append((f"after  frame {content.after.frame}", "after"))
        if INBETWEEN in paper.shows and content.t is not None and self._between(content):
            words.append((f"in-between  frame {content.frame}{content.drawing_words}", "inbetween"))
            if content.options.heat:
                words += [("shorter", "shorter"), ("longer than the keyframes", "longer")]
        if INBETWEEN in paper.shows and content.is_held:
            words.append((f"held  frame {content.frame}", "inbetween"))
        if content.waiting and INBETWEEN in paper.shows and content.plan is not None:
            words.append((f"solving … ({content.plan.paths.method} shown)", "muted"))
        return words

    def _between(self, content: Content) -> bool:
        return content.frame not in {k.frame for k in (content.before, content.after) if k is not None}

    def _draw_words(
        self, painter: QPainter, words: list[tuple[str, str]], x: float, y: float, room: float
    ) -> None:
        font = QFont(painter.font())
        font.setPixelSize(12)
        painter.setFont(font)
        measure = QFontMetricsF(font)
        width = sum(measure.horizontalAdvance(text) + 24 for text, _ in words)
        if width > room:
            return
        for text, token in words:
            painter.setPen(self.canvas.theme.color(token))
            painter.drawText(QPointF(x, y), text)
            x += measure.horizontalAdvance(text) + 24


class ToolItem(CanvasItem):
    """Whatever the active tool paints on top."""

    def draw(self, painter: QPainter, content: Content) -> None:
        if self.canvas.tool is not None and not content.options.final:
            self.canvas.tool.paint(painter)


def hue(piece: int) -> QColor:
    """Return the colour of a piece of the correspondence."""
    place = piece / HUE_PIECES * len(HUES)
    i = int(place)
    return blend(QColor(HUES[i]), QColor(HUES[(i + 1) % len(HUES)]), place - i)


def spaced(points: FloatArray, scale: float) -> FloatArray:
    """Leave out vertices of a skin where many share one view px: a ghost needs no better."""
    if len(points) <= FEW_SKIN_VERTICES:
        return points
    wide, high = np.ptp(points[:: len(points) // 256], axis=0) * scale
    return points[:: max(1, int(len(points) / (1.5 * max(wide + high, 1.0))))]


def vertex_spacing(points: FloatArray) -> float:
    """Return the mean distance of neighbouring vertices, of a part of them where there are very many."""
    if len(points) > 4 * MOST_LOOKED_AT:
        points = points[:MOST_LOOKED_AT]
    return perimeter(points, closed=False) / max(len(points) - 1, 1)


def draw_dots(painter: QPainter, points: FloatArray, ring: QColor, fill: QColor, size: float = 7.0) -> None:
    """Draw round marks, all in two calls: a dot in the ring's colour, a smaller one on top."""
    polygon = pg.functions.arrayToQPolygonF(points[:, 0], points[:, 1])
    for width, color in ((size, ring), (size - 3.2, fill)):
        painter.setPen(QPen(color, width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
        painter.drawPoints(polygon)


def blend(a: QColor, b: QColor, t: float) -> QColor:
    """Mix two colours of the theme, for helpers on the canvas."""
    return QColor.fromRgbF(*(float(x + (y - x) * t) for x, y in zip(a.getRgbF(), b.getRgbF(), strict=True)))
