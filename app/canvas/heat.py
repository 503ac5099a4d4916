"""The stretch of the in-between, painted along its outline and inside."""

from functools import cache

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QBrush, QColor, QImage, QPainter, QPainterPath, QPen, QTransform

from app.canvas.content import Content
from app.canvas.items import CanvasItem, blend
from app.canvas.papers import INBETWEEN
from app.theme import Theme
from core.certificate.inside import InnerStretch, inner_stretch
from core.geometry.outline import FloatArray
from core.model.checking import edge_stretch
from core.model.inbetweens import SpanPlan

WIDTH = 5.0
STEPS = 6
"""Shades on either side of the one for edges that are as long as between the keyframes."""

MOST = 1.0
"""Doublings, or halvings, from which on the colour is the strongest."""

CELLS = 56
"""Of the picture of the inside, along its longer side; the painter smooths it. With the margin 63: products of
such matrices are made in one thread, which a frame need not wait for."""

MARGIN = 3
"""Cells round the outline, so that no colour comes in from the other side."""

SIDE = CELLS + 2 * MARGIN + 1

NEAR, FAR = 0.9, 4.0
"""Cells over which the stretch of triangles is evened out, and from how far a place without any takes it."""

INNER_OPACITY = 0.75


class HeatItem(CanvasItem):
    """Every edge, and every place inside, in the colour of its stretch: shorter, the same, longer."""

    _meshed: tuple[SpanPlan, InnerStretch | None] | None = None

    def draw(self, painter: QPainter, content: Content) -> None:
        wanted = content.options.heat and not content.options.final
        if not wanted or content.picture is None or content.plan is None or content.t is None:
            return
        if content.frame in {k.frame for k in (content.before, content.after) if k is not None}:
            return
        inside = self._inside(content)
        for paper in content.papers:
            if INBETWEEN in paper.shows:
                if inside is not None:
                    self._draw_inside(painter, content, paper.offset, *inside)
                for link, (points, closed) in zip(content.plan.links, content.picture.outlines, strict=True):
                    shades = shades_of(edge_stretch(link.aligned, points, content.t))
                    self._draw_edges(painter, self.canvas.camera.to_view(points, paper.offset), closed, shades)

    def _inside(self, content: Content) -> tuple[QImage, FloatArray, float] | None:
        """The picture of the inside, the place of its corner and the size of its cells in stage px."""
        plan, picture = content.plan, content.picture
        if plan is None or picture is None:
            return None
        if self._meshed is None or self._meshed[0] is not plan:
            self._meshed = plan, inner_stretch([link.aligned for link in plan.links])
        mesh = self._meshed[1]
        if mesh is None:
            return None
        return heat_picture(self.canvas.theme, *mesh.at([points for points, _ in picture.outlines]))

    def _draw_inside(
        self,
        painter: QPainter,
        content: Content,
        offset: float,
        image: QImage,
        corner: FloatArray,
        cell: float,
    ) -> None:
        camera = self.canvas.camera
        x, y = camera.to_view(corner, offset).tolist()
        brush = QBrush(image)
        brush.setTransform(QTransform(camera.scale * cell, 0, 0, camera.scale * cell, x, y))
        path = QPainterPath()
        for points, closed in content.picture.outlines if content.picture else ():
            if closed:
                path.addPath(_outline(camera.to_view(points, offset)))
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform)
        painter.setOpacity(INNER_OPACITY)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(brush)
        painter.drawPath(path)
        painter.restore()
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _draw_edges(self, painter: QPainter, points: FloatArray, closed: bool, shades: FloatArray) -> None:
        """Draw all edges of a shade at once, the strongest shades last."""
        ends = np.roll(points, -1, axis=0)
        edges = np.stack([points, ends], axis=1)[: None if closed else -1]
        for shade in sorted(np.unique(shades).tolist(), key=abs):
            color = shade_color(self.canvas.theme, int(shade))
            painter.setPen(QPen(color, WIDTH, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawPath(_path(edges[shades == shade]))


def heat_picture(
    theme: Theme, places: FloatArray, doublings: FloatArray, areas: FloatArray
) -> tuple[QImage, FloatArray, float]:
    """Paint the stretch of triangles as smooth colours.

    Every triangle's stretch is laid on the cell of its middle, by its area, and evened out over those round it:
    one small picture is drawn much faster than a thousand triangles, and shows no seams.
    """
    low, high = places.min(axis=0), places.max(axis=0)
    cell = max(float((high - low).max()), 1e-9) / CELLS
    corner = low - MARGIN * cell
    column, row = ((places - corner) / cell).astype(np.intp).T
    spot = row * SIDE + column
    value = np.clip(doublings / MOST, -1, 1) * areas
    laid = [np.bincount(spot, x, SIDE * SIDE).reshape(SIDE, SIDE) for x in (areas, value)]
    weight, heat = (_evened(x, NEAR) + 1e-4 * _evened(x, FAR) for x in laid)
    shades = heat / np.maximum(weight, np.finfo(np.float64).tiny)
    index = np.round((np.clip(shades, -1, 1) + 1) * 127.5).astype(np.uint8)
    pixels = np.ascontiguousarray(_ramp(theme)[index])
    return QImage(pixels.data, SIDE, SIDE, 4 * SIDE, QImage.Format.Format_RGB32).copy(), corner, cell


def _evened(cells: FloatArray, reach: float) -> FloatArray:
    """Blur cells by a bell of the width `reach`."""
    return np.asarray(_bell(reach) @ cells @ _bell(reach), np.float64)


@cache
def _bell(reach: float) -> FloatArray:
    apart = np.subtract.outer(np.arange(SIDE), np.arange(SIDE)) / reach
    return np.asarray(np.exp(-0.5 * apart**2), np.float64)


@cache
def _ramp(theme: Theme) -> np.ndarray:
    """The colours of 256 shades, as 32-bit pixels."""
    shades = np.linspace(-STEPS, STEPS, 256)
    return np.array([shade_color(theme, s).rgb() for s in shades.tolist()], np.uint32)


def _outline(points: FloatArray) -> QPainterPath:
    path = pg.functions.arrayToQPath(points[:, 0], points[:, 1], connect="all")
    path.closeSubpath()
    return path


def shades_of(stretch: FloatArray) -> FloatArray:
    """Return a whole number from -STEPS, at most half as long, to STEPS, at least twice as long."""
    return np.round(np.clip(np.log2(stretch) / MOST, -1, 1) * STEPS)


def shade_color(theme: Theme, shade: float) -> QColor:
    """Return the colour of a shade; blue and orange are told apart by people with any kind of colour vision."""
    end = theme.color("shorter" if shade < 0 else "longer")
    return blend(theme.color("same"), end, abs(shade) / STEPS)


def _path(edges: FloatArray) -> QPainterPath:
    flat = edges.reshape(-1, 2)
    return pg.functions.arrayToQPath(flat[:, 0], flat[:, 1], connect="pairs")
