"""The names of the timeline's rows, with what can be switched on each layer: eye, lock, solo."""

from collections.abc import Callable
from functools import cache

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFocusEvent, QFont, QKeyEvent, QPainter, QPen, QPixmap
from PySide6.QtWidgets import QLineEdit, QWidget

from app.layercolors import layer_color
from app.panels.track_view import HEADER, ROW, TrackView
from app.theme import Theme, pixmap
from core.model.document import Document, Layer
from core.model.edits import set_layer

BUTTON = 22.0
PARTS = ("solo", "locked", "visible")
"""From the left, at the end of the names."""

NAME_LEFT = 30.0
TIPS = {
    "solo": ("Show this layer alone", "Show the other layers too"),
    "locked": ("Lock: seen, but not changed", "Unlock"),
    "visible": ("Show", "Hide"),
}


def part_rect(rect: QRectF, part: str) -> QRectF:
    """Return where one of PARTS lies in a row."""
    left = HEADER - 8 - BUTTON * (len(PARTS) - PARTS.index(part))
    return QRectF(left, rect.center().y() - BUTTON / 2, BUTTON, BUTTON)


def name_rect(rect: QRectF) -> QRectF:
    return QRectF(NAME_LEFT, rect.top(), HEADER - 12 - BUTTON * len(PARTS) - NAME_LEFT, rect.height())


def part_under(view: TrackView, at: QPointF) -> tuple[int, str] | None:
    """Return the row under the pointer and which part of its head: one of PARTS, or "name"."""
    row = view.row_at(at.y())
    if row is None or at.x() >= HEADER:
        return None
    rect = view.row_rect(row)
    return row, next((p for p in PARTS if part_rect(rect, p).contains(at)), "name")


def is_on(view: TrackView, layer: Layer, part: str) -> bool:
    """Whether a layer's switch is on."""
    return layer.id in view.session.solo if part == "solo" else getattr(layer, part)


def tip_of(view: TrackView, layer: Layer, part: str) -> str:
    if part == "name":
        return f"{layer.name}: double click to rename, drag to reorder"
    return TIPS[part][is_on(view, layer, part)]


def switched(layer: Layer, part: str) -> tuple[str, Callable[[Document], Document]]:
    """Return the edit that turns a layer's eye or lock, with its label, for `Session.apply`."""
    on = getattr(layer, part)
    labels = {"visible": ("Show Layer", "Hide Layer"), "locked": ("Lock Layer", "Unlock Layer")}

    def edit(document: Document) -> Document:
        return set_layer(document, layer.id, **{part: not on})

    return labels[part][on], edit


class HeaderPainter:
    """Paints the heads of rows; what is as usual stays quiet until the pointer is near."""

    def __init__(self, painter: QPainter, view: TrackView, theme: Theme, font: QFont) -> None:
        self.painter, self.view, self.theme, self.font = painter, view, theme, font

    def paint(self, row: int, layer: Layer, hover: tuple[int, str] | None) -> None:
        rect, theme, painter = self.view.row_rect(row), self.theme, self.painter
        active = layer.id == self.view.session.layer.id
        shown = self.view.session.shows(layer)
        painter.fillRect(QRectF(0, rect.top(), HEADER, ROW), theme.color("raised" if active else "panel"))
        painter.setPen(Qt.PenStyle.NoPen)
        color = layer_color(layer)
        color.setAlphaF(1.0 if shown else 0.4)
        painter.setBrush(color)
        painter.drawRoundedRect(QRectF(14, rect.center().y() - 7, 6, 14), 3, 3)
        near = hover if hover and hover[0] == row else None
        parts = [p for p in PARTS if near or p == "visible" or is_on(self.view, layer, p)]
        place = name_rect(rect)
        place.setRight(part_rect(rect, parts[0]).left() - 4)
        self._paint_name(place, layer, active=active, shown=shown)
        for part in parts:
            self._paint_part(part_rect(rect, part), layer, part, near)

    def _paint_name(self, place: QRectF, layer: Layer, *, active: bool, shown: bool) -> None:
        painter, theme = self.painter, self.theme
        if layer.parent is not None:  # an elbow: it hangs on another one
            painter.setPen(QPen(theme.color("muted"), 1.3))
            x, y = place.left() + 2, place.center().y()
            painter.drawPolyline([QPointF(x, y - 5), QPointF(x, y + 1), QPointF(x + 6, y + 1)])
            place = place.adjusted(13, 0, 0, 0)
        font = QFont(self.font)
        font.setBold(active)
        painter.setFont(font)
        painter.setPen(theme.color("text" if active else "muted", 1.0 if shown else 0.55))
        name = painter.fontMetrics().elidedText(layer.name, Qt.TextElideMode.ElideRight, int(place.width()))
        painter.drawText(place, int(Qt.AlignmentFlag.AlignVCenter), name)

    def _paint_part(self, place: QRectF, layer: Layer, part: str, hover: tuple[int, str] | None) -> None:
        on = is_on(self.view, layer, part)
        if hover is not None and hover[1] == part:
            self.painter.setPen(Qt.PenStyle.NoPen)
            self.painter.setBrush(self.theme.color("line"))
            self.painter.drawRoundedRect(place.adjusted(1, 1, -1, -1), 5, 5)
        usual = on if part == "visible" else not on
        token = "accent" if part == "solo" and on else "text" if not usual else "muted"
        names = {"solo": "solo", "locked": "lock" if on else "unlock", "visible": "visible" if on else "hidden"}
        faint = usual and hover is None
        picture = _picture(names[part], self.theme.color(token).name(), 0.6 if faint else 1.0)
        self.painter.drawPixmap(QPointF(place.center().x() - 7.5, place.center().y() - 7.5), picture)


@cache
def _picture(name: str, color: str, alpha: float) -> QPixmap:
    made = QColor(color)
    made.setAlphaF(alpha)
    return pixmap(name, made, 15)


class NameField(QLineEdit):
    """A name that is being changed in its place; Escape leaves it as it was."""

    def __init__(self, parent: QWidget, place: QRectF, name: str, done: Callable[[str], object]) -> None:
        super().__init__(name, parent)
        self._done: Callable[[str], object] | None = done
        self.setGeometry(place.adjusted(-8, 2, 4, -2).toRect())
        self.setStyleSheet("padding: 0 6px; min-height: 0;")
        self.setAccessibleName("Name of the layer")
        self.returnPressed.connect(self._finish)
        self.selectAll()
        self.show()
        self.setFocus()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_Escape:
            self._done = None
            self._finish()
        else:
            super().keyPressEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        super().focusOutEvent(event)
        self._finish()

    def _finish(self) -> None:
        done, self._done = self._done, None
        name = self.text().strip()
        if done is not None and name:
            done(name)
        if self.isVisible():
            self.hide()
            parent = self.parentWidget()
            if parent is not None:
                parent.setFocus()
            self.deleteLater()
