"""The stretch of the in-between, painted along its outline."""

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor, QPainter, QPainterPath, QPen

from app.canvas.content import Content
from app.canvas.items import CanvasItem, blend
from app.canvas.papers import INBETWEEN
from app.theme import Theme
from core.geometry.outline import FloatArray
from core.model.checking import edge_stretch

WIDTH = 5.0
STEPS = 6
"""Shades on either side of the one for edges that are as long as between the keyframes."""

MOST = 1.0
"""Doublings, or halvings, from which on the colour is the strongest."""


class HeatItem(CanvasItem):
    """Every edge in the colour of its stretch: shorter, the same, longer."""

    def draw(self, painter: QPainter, content: Content) -> None:
        wanted = content.options.heat and not content.options.final
        if not wanted or content.picture is None or content.plan is None or content.t is None:
            return
        if content.frame in {k.frame for k in (content.before, content.after) if k is not None}:
            return
        for paper in content.papers:
            if INBETWEEN in paper.shows:
                for link, (points, closed) in zip(content.plan.links, content.picture.outlines, strict=True):
                    shades = shades_of(edge_stretch(link.aligned, points, content.t))
                    self._draw_edges(painter, self.canvas.camera.to_view(points, paper.offset), closed, shades)

    def _draw_edges(self, painter: QPainter, points: FloatArray, closed: bool, shades: FloatArray) -> None:
        """Draw all edges of a shade at once, the strongest shades last."""
        ends = np.roll(points, -1, axis=0)
        edges = np.stack([points, ends], axis=1)[: None if closed else -1]
        for shade in sorted(np.unique(shades).tolist(), key=abs):
            color = shade_color(self.canvas.theme, int(shade))
            painter.setPen(QPen(color, WIDTH, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
            painter.drawPath(_path(edges[shades == shade]))


def shades_of(stretch: FloatArray) -> FloatArray:
    """Return a whole number from -STEPS, at most half as long, to STEPS, at least twice as long."""
    return np.round(np.clip(np.log2(stretch) / MOST, -1, 1) * STEPS)


def shade_color(theme: Theme, shade: int) -> QColor:
    """Return the colour of a shade; blue and orange are told apart by people with any kind of colour vision."""
    end = theme.color("shorter" if shade < 0 else "longer")
    return blend(theme.color("same"), end, abs(shade) / STEPS)


def _path(edges: FloatArray) -> QPainterPath:
    flat = edges.reshape(-1, 2)
    return pg.functions.arrayToQPath(flat[:, 0], flat[:, 1], connect="pairs")
