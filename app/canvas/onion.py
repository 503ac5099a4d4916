"""The onion skin: each neighbouring drawing is painted once and kept as a picture.

A repaint only lays pictures over each other, and while nothing changes not even that: one picture holds them all.
"""

import math
from collections import OrderedDict
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from PySide6.QtCore import QPointF, QRect, QRectF, QSizeF, Qt
from PySide6.QtGui import QColor, QPainter, QPixmap, QTransform

from app.canvas.content import Content
from app.canvas.items import CanvasItem, spaced
from app.canvas.papers import INBETWEEN
from app.canvas.skins import OnionSkin, OutlineShapes
from app.painting import paint_outlines
from app.view import TINTS

if TYPE_CHECKING:
    from app.canvas.canvas import Canvas

SKIN_WIDTH = 1.0
FILL = 0.4
"""Of a filled skin: the opacity of the inside beside that of its outline."""

MOST_PIXELS = 32_000_000
"""Of all pictures together: 128 MB."""


class _Kept(NamedTuple):
    """A picture, where its corner lies in the view, and what it was made of."""

    picture: QPixmap
    at: QPointF
    sources: tuple[object, ...]

    @property
    def size(self) -> int:
        return self.picture.width() * self.picture.height()


class Pictures:
    """Painted skins by what they look like; the longest unused ones go when there are too many pixels."""

    def __init__(self, capacity: int = MOST_PIXELS) -> None:
        self.capacity = capacity
        self.painted = 0
        self._kept: OrderedDict[object, _Kept] = OrderedDict()

    @property
    def pixels(self) -> int:
        """How many pixels are kept."""
        return sum(kept.size for kept in self._kept.values())

    def get(self, key: object) -> _Kept | None:
        found = self._kept.get(key)
        if found is not None:
            self._kept.move_to_end(key)
        return found

    def keep(self, key: object, made: _Kept) -> _Kept:
        self.painted += 1
        self._kept[key] = made
        pixels = self.pixels
        while pixels > self.capacity and len(self._kept) > 1:
            pixels -= self._kept.popitem(last=False)[1].size
        return made


class OnionItem(CanvasItem):
    """Neighbouring drawings in the colour of their side, fading with the distance."""

    def __init__(self, canvas: "Canvas", z: int) -> None:
        super().__init__(canvas, z)
        self.pictures = Pictures()
        self.sheets = Pictures(MOST_PIXELS // 4)

    def draw(self, painter: QPainter, content: Content) -> None:
        if not content.onion:
            return
        for paper in content.papers:
            if INBETWEEN in paper.shows:
                transform = self.canvas.camera.transform(paper.offset)
                if self.canvas.session.in_gesture:  # other shapes at every step: not worth keeping
                    self.paint_plainly(painter, content, transform)
                else:
                    sheet = self._sheet(content, transform)
                    painter.drawPixmap(sheet.at, sheet.picture)

    def paint_plainly(self, painter: QPainter, content: Content, transform: QTransform) -> None:
        """Paint the skins without keeping anything."""
        for skin in content.onion:
            painter.save()
            painter.setOpacity(skin.strength)
            self._paint_skin(painter, skin.outlines, self._look(skin, content), transform)
            painter.restore()

    def _sheet(self, content: Content, transform: QTransform) -> _Kept:
        """Return all skins in one picture: this is what a repaint costs while nothing changes."""
        looks = tuple((s.key, self._look(s, content).rgb(), round(s.strength, 4)) for s in content.onion)
        key = looks, content.options.onion_filled, self._where(transform), transform.dx(), transform.dy()
        found = self.sheets.get(key)
        if found is None:
            parts = [(self._picture(s, content, transform), s) for s in content.onion]
            found = self.sheets.keep(key, self._laid_out(parts, transform))
        return found

    def _laid_out(self, parts: list[tuple[_Kept, OnionSkin]], transform: QTransform) -> _Kept:
        origin = _whole(transform, self._ratio)
        places = [(kept, kept.at + origin, skin) for kept, skin in parts]
        area = QRectF()
        for kept, at, _ in places:
            area = area.united(QRectF(at, QSizeF(kept.picture.size()) / self._ratio))
        area = area.intersected(QRectF(self.boundingRect())).toAlignedRect()
        sheet = self._blank(area)
        painter = QPainter(sheet)
        for kept, at, skin in places:
            painter.setOpacity(skin.strength)
            painter.drawPixmap(at - QPointF(area.topLeft()), kept.picture)
        painter.end()
        return _Kept(sheet, QPointF(area.topLeft()), tuple(x for s in parts for x in s[1].source))

    def _picture(self, skin: OnionSkin, content: Content, transform: QTransform) -> _Kept:
        """Return a skin at full strength; its corner is kept beside the stage's, so panning finds it again."""
        color, filled = self._look(skin, content), content.options.onion_filled
        key = skin.key, color.rgb(), filled, self._where(transform)
        found = self.pictures.get(key)
        if found is None or not self._covers(found, transform):
            found = self.pictures.keep(key, self._painted(skin, color, transform))
        return found

    def _painted(self, skin: OnionSkin, color: QColor, transform: QTransform) -> _Kept:
        origin = _whole(transform, self._ratio)
        outlines = skin.outlines
        rect = _box(outlines, transform).intersected(self._room())
        picture = self._blank(rect)
        painter = QPainter(picture)
        moved = transform * QTransform.fromTranslate(-rect.left(), -rect.top())
        self._paint_skin(painter, outlines, color, moved)
        painter.end()
        return _Kept(picture, QPointF(rect.topLeft()) - origin, (*skin.source, outlines))

    def _paint_skin(
        self, painter: QPainter, outlines: OutlineShapes, color: QColor, transform: QTransform
    ) -> None:
        fill = QColor(color)
        fill.setAlphaF(FILL)
        paint_outlines(
            painter,
            [(spaced(p, self.canvas.camera.scale), closed) for p, closed in outlines],
            fill=fill if self.canvas.content.options.onion_filled else None,
            stroke=color,
            width=SKIN_WIDTH * self._ratio,
            transform=transform,
        )

    def _look(self, skin: OnionSkin, content: Content) -> QColor:
        tokens = TINTS[content.options.onion_tints]
        return self.canvas.theme.color(tokens[skin.side == "after"])

    def _covers(self, kept: _Kept, transform: QTransform) -> bool:
        """Whether a picture that was cut off at the view's edge still has all that is to be seen."""
        whole = kept.sources[-1]
        wanted = _box(whole, transform).intersected(self.boundingRect().toRect())  # type: ignore[arg-type]
        at = kept.at + _whole(transform, self._ratio)
        return wanted.isEmpty() or QRectF(at, QSizeF(kept.picture.size()) / self._ratio).contains(QRectF(wanted))

    def _room(self) -> QRect:
        """The view and half as much on every side: what a picture may cover."""
        rect = self.boundingRect().toRect()
        return rect.adjusted(-rect.width() // 2, -rect.height() // 2, rect.width() // 2, rect.height() // 2)

    def _blank(self, rect: QRect) -> QPixmap:
        picture = QPixmap(max(1, round(rect.width() * self._ratio)), max(1, round(rect.height() * self._ratio)))
        picture.setDevicePixelRatio(self._ratio)
        picture.fill(Qt.GlobalColor.transparent)
        return picture

    @property
    def _ratio(self) -> float:
        return self.canvas.devicePixelRatioF()

    def _where(self, transform: QTransform) -> tuple[float, ...]:
        """What of the camera changes a picture: all but whole pixels of panning."""
        rest = QPointF(transform.dx(), transform.dy()) - _whole(transform, self._ratio)
        return round(transform.m11(), 6), round(rest.x(), 3), round(rest.y(), 3), self._ratio


def _whole(transform: QTransform, ratio: float) -> QPointF:
    """Return the shift of a transform in view px that are whole device px."""
    return QPointF(math.floor(transform.dx() * ratio) / ratio, math.floor(transform.dy() * ratio) / ratio)


def _box(outlines: OutlineShapes, transform: QTransform) -> QRect:
    """Return a rectangle of whole view px round outlines and their strokes."""
    if not outlines:
        return QRect()
    low = np.min([p.min(axis=0) for p, _ in outlines], axis=0)
    high = np.max([p.max(axis=0) for p, _ in outlines], axis=0)
    rect = transform.mapRect(QRectF(QPointF(*low), QPointF(*high)))
    return rect.adjusted(-2, -2, 2, 2).toAlignedRect()
