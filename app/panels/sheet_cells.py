"""How the exposure sheet is written: keyframes circled, in-betweens as numbers, what is held as a line."""

from collections.abc import Callable

from PySide6.QtCore import QModelIndex, QObject, QPersistentModelIndex, QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QIntValidator, QPainter, QPen
from PySide6.QtWidgets import QLineEdit, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from app.panels.sheet_model import Cell, SheetModel
from app.theme import Theme
from core.model.document import LONGEST

AnyIndex = QModelIndex | QPersistentModelIndex


class SheetCells(QStyledItemDelegate):
    """Paints and edits cells. `lit` tells whether the edge below a row of a column lies under the pointer."""

    def __init__(
        self, sheet: SheetModel, theme: Theme, lit: Callable[[int, int], bool], parent: QObject | None = None
    ) -> None:
        super().__init__(parent)
        self.sheet, self.session, self.lit = sheet, sheet.session, lit
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        self._pens = {
            "line": QPen(theme.color("line"), 1),
            "second": QPen(theme.color("muted"), 1),
            "held": QPen(theme.color("muted"), 1.4),
            "circle": QPen(theme.color("text"), 1.3),
            "lit": QPen(theme.color("accent"), 3),
        }
        self._papers = {
            (active, here): _mixed(theme, "raised" if active else "panel", (0.38 if active else 0.2) * here)
            for active in (False, True)
            for here in (False, True)
        }
        self._inks = {True: theme.color("text"), False: theme.color("muted")}
        self._fonts = {True: _font(bold=True), False: _font(bold=False)}

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: AnyIndex) -> None:
        row, column = index.row(), index.column()
        layer = self.sheet.layer(column)
        active, here = layer.id == self.session.layer.id, row + 1 == self.session.frame
        rect = QRectF(option.rect)
        painter.save()
        painter.fillRect(rect, self._papers[active, here])
        self._paint_grid(painter, rect, row)
        cell = self.sheet.cell(row, column)
        if cell is not None:
            painter.setOpacity(0.5 if layer.locked or not self.session.shows(layer) else 1.0)
            self._paint_drawing(painter, rect, cell)
            painter.setOpacity(1.0)
            if cell.last:  # the edge that can be dragged
                painter.setPen(self._pens["lit" if self.lit(row, column) else "line"])
                painter.drawLine(rect.bottomLeft() - QPointF(0, 1), rect.bottomRight() - QPointF(0, 1))
        painter.restore()

    def _paint_grid(self, painter: QPainter, rect: QRectF, row: int) -> None:
        """Paint the right edge of the column, and a line behind every second of the film."""
        painter.setPen(self._pens["line"])
        painter.drawLine(rect.topRight() - QPointF(1, 0), rect.bottomRight() - QPointF(1, 0))
        if (row + 1) % max(1, round(self.session.document.rate)) == 0:
            painter.setPen(self._pens["second"])
            painter.drawLine(rect.bottomLeft() - QPointF(0, 1), rect.bottomRight() - QPointF(0, 1))

    def _paint_drawing(self, painter: QPainter, rect: QRectF, cell: Cell) -> None:
        middle = rect.center()
        if not cell.first:
            painter.setPen(self._pens["held"])
            bottom = middle.y() if cell.last else rect.bottom() + 1
            painter.drawLine(QPointF(middle.x(), rect.top()), QPointF(middle.x(), bottom))
            if cell.last:
                painter.drawLine(QPointF(middle.x() - 4, bottom), QPointF(middle.x() + 4, bottom))
            return
        painter.setFont(self._fonts[cell.keyframe])
        painter.setPen(self._inks[cell.keyframe])
        painter.drawText(rect, int(Qt.AlignmentFlag.AlignCenter), str(cell.number))
        if cell.keyframe:
            width = max(rect.height() - 3, painter.fontMetrics().horizontalAdvance(str(cell.number)) + 10)
            circle = QRectF(0, 0, width, rect.height() - 3)
            circle.moveCenter(middle)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setPen(self._pens["circle"])
            painter.drawRoundedRect(circle, circle.height() / 2, circle.height() / 2)

    def createEditor(self, parent: QWidget, option: QStyleOptionViewItem, index: AnyIndex) -> QWidget:
        editor = QLineEdit(parent)
        editor.setProperty("cell", True)
        editor.setValidator(QIntValidator(1, LONGEST, editor))
        editor.setAlignment(Qt.AlignmentFlag.AlignCenter)
        return editor

    def setEditorData(self, editor: QWidget, index: AnyIndex) -> None:
        if isinstance(editor, QLineEdit):
            editor.setText(str(index.data(Qt.ItemDataRole.EditRole)))


def _mixed(theme: Theme, token: str, share: float) -> QColor:
    """Return a colour of the theme with a share of the accent on it."""
    below, above = theme.color(token), theme.color("accent")
    parts = zip(below.getRgbF()[:3], above.getRgbF()[:3], strict=True)
    return QColor.fromRgbF(*(a + (b - a) * share for a, b in parts))


def _font(*, bold: bool) -> QFont:
    font = QFont()
    font.setPixelSize(11)
    font.setBold(bold)
    return font
