"""How the exposure sheet is written: keyframes circled, in-betweens as numbers, what is held as a line."""

from collections.abc import Callable

from PySide6.QtCore import QModelIndex, QObject, QPersistentModelIndex, QPointF, QRectF, Qt
from PySide6.QtGui import QFont, QIntValidator, QPainter, QPen
from PySide6.QtWidgets import QLineEdit, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from app.panels.sheet_model import CELL, Cell
from app.session import Session
from app.theme import Theme
from core.model.document import LONGEST

AnyIndex = QModelIndex | QPersistentModelIndex


class SheetCells(QStyledItemDelegate):
    """Paints and edits cells. `lit` tells whether the edge below a row of a column lies under the pointer."""

    def __init__(
        self, session: Session, theme: Theme, lit: Callable[[int, int], bool], parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.session, self.theme, self.lit = session, theme, lit

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        layer = self.session.document.layers[index.column()]
        active = layer.id == self.session.layer.id
        here = index.row() + 1 == self.session.frame
        rect = QRectF(option.rect)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.fillRect(rect, self.theme.color("raised" if active else "panel"))
        if here:
            painter.fillRect(rect, self.theme.color("accent", 0.38 if active else 0.2))
        self._paint_grid(painter, rect, index.row())
        cell = index.data(CELL)
        if cell is not None:
            painter.setOpacity(0.5 if layer.locked or not self.session.shows(layer) else 1.0)
            self._paint_drawing(painter, rect, cell)
            painter.setOpacity(1.0)
            self._paint_edge(painter, rect, cell, index)
        painter.restore()

    def _paint_grid(self, painter: QPainter, rect: QRectF, row: int) -> None:
        """Paint the right edge of the column, and a line behind every second of the film."""
        theme = self.theme
        painter.setPen(QPen(theme.color("line"), 1))
        painter.drawLine(rect.topRight(), rect.bottomRight())
        if (row + 1) % max(1, round(self.session.document.rate)) == 0:
            painter.setPen(QPen(theme.color("muted"), 1))
            painter.drawLine(rect.bottomLeft(), rect.bottomRight())

    def _paint_drawing(self, painter: QPainter, rect: QRectF, cell: Cell) -> None:
        theme, middle = self.theme, rect.center()
        if not cell.first:
            painter.setPen(QPen(theme.color("muted"), 1.4))
            bottom = middle.y() if cell.last else rect.bottom() + 1
            painter.drawLine(QPointF(middle.x(), rect.top()), QPointF(middle.x(), bottom))
            if cell.last:
                painter.drawLine(QPointF(middle.x() - 4, bottom), QPointF(middle.x() + 4, bottom))
            return
        font = QFont(painter.font())
        font.setPixelSize(11)
        font.setBold(cell.keyframe)
        painter.setFont(font)
        painter.setPen(theme.color("text" if cell.keyframe else "muted"))
        painter.drawText(rect, int(Qt.AlignmentFlag.AlignCenter), str(cell.number))
        if cell.keyframe:
            width = max(rect.height() - 3, painter.fontMetrics().horizontalAdvance(str(cell.number)) + 10)
            circle = QRectF(0, 0, width, rect.height() - 3)
            circle.moveCenter(middle)
            painter.setPen(QPen(theme.color("text"), 1.3))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(circle, circle.height() / 2, circle.height() / 2)

    def _paint_edge(self, painter: QPainter, rect: QRectF, cell: Cell, index: AnyIndex) -> None:
        """Paint where a drawing ends: the edge that can be dragged."""
        if not cell.last:
            return
        lit = self.lit(index.row(), index.column())
        painter.setPen(QPen(self.theme.color("accent" if lit else "line"), 3 if lit else 1))
        painter.drawLine(rect.bottomLeft(), rect.bottomRight())

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: AnyIndex) -> QWidget:
        editor = QLineEdit(parent)
        editor.setProperty("cell", True)
        editor.setValidator(QIntValidator(1, LONGEST, editor))
        editor.setAlignment(Qt.AlignmentFlag.AlignCenter)
        return editor

    def setEditorData(self, editor: QWidget, index: AnyIndex) -> None:
        if isinstance(editor, QLineEdit):
            editor.setText(str(index.data(Qt.ItemDataRole.EditRole)))
