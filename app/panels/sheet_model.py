"""The exposure sheet as a table: a row a frame, a column a layer; it only reads the session."""

from bisect import bisect_right
from dataclasses import dataclass

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QSize, Qt, Signal
from PySide6.QtGui import QColor, QFont, QPixmap

from app.layercolors import layer_color
from app.session import DocumentDiff, Session
from core.model.document import Layer
from core.model.sheet_edits import expose_drawing
from core.model.timing import Exposure, exposures_of

CELL = Qt.ItemDataRole.UserRole
EXPOSURE_LABEL = "Change Exposure"
NOWHERE = QModelIndex()


@dataclass(frozen=True, slots=True)
class Cell:
    """What a layer shows on one frame.

    Attributes
    ----------
    number : int
        Of the drawing in its layer, from 1.
    frame, count : int
        The drawing's first frame, and for how many it is held.
    keyframe : bool
        Whether the artist made it.
    first, last : bool
        Whether this is the first, or the last, frame of the drawing.
    """

    number: int
    frame: int
    count: int
    keyframe: bool
    first: bool
    last: bool


@dataclass(frozen=True, slots=True)
class Column:
    """The drawings of a layer, and what they were worked out of."""

    layer: Layer
    length: int
    exposures: tuple[Exposure, ...]
    starts: tuple[int, ...]

    def cell(self, frame: int) -> Cell | None:
        i = bisect_right(self.starts, frame) - 1
        if i < 0:
            return None
        e = self.exposures[i]
        end = e.frame + e.count - 1
        return Cell(i + 1, e.frame, e.count, e.keyframe, frame == e.frame, frame == end)


class SheetModel(QAbstractTableModel):
    """See the module. Columns are worked out when they are looked at, and anew only when their layer changes."""

    reshaped = Signal()

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self._columns: dict[int, Column] = {}
        self._ids = [layer.id for layer in session.document.layers]
        self._length = session.document.length
        session.documentChanged.connect(self._on_document_changed)

    def rowCount(self, parent: QModelIndex = NOWHERE) -> int:
        return 0 if parent.isValid() else self._length

    def columnCount(self, parent: QModelIndex = NOWHERE) -> int:
        return 0 if parent.isValid() else len(self._ids)

    @property
    def is_current(self) -> bool:
        """Whether the table has the shape of the open document."""
        document = self.session.document
        return self._length == document.length and self._ids == [layer.id for layer in document.layers]

    def layer(self, column: int) -> Layer:
        return self.session.document.layer(self._ids[column])

    def column_of(self, layer_id: int) -> int:
        return self._ids.index(layer_id)

    def cell(self, row: int, column: int) -> Cell | None:
        """Return what a layer shows in a row; None before its first keyframe."""
        layer = self.layer(column)
        kept = self._columns.get(layer.id)
        if kept is None or kept.layer is not layer or kept.length != self._length:
            exposures = exposures_of(layer, 1, self._length)
            kept = Column(layer, self._length, exposures, tuple(e.frame for e in exposures))
            self._columns[layer.id] = kept
        return kept.cell(row + 1)

    def data(self, index: QModelIndex, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        if role not in (CELL, Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole, Qt.ItemDataRole.ToolTipRole):
            return None
        cell = self.cell(index.row(), index.column())
        if role == CELL or cell is None:
            return cell
        if role == Qt.ItemDataRole.EditRole:
            return cell.count
        if role == Qt.ItemDataRole.ToolTipRole:
            return _told(cell)
        return str(cell.number) if cell.first else "|"

    def headerData(
        self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole
    ) -> object:
        if orientation == Qt.Orientation.Vertical:
            return str(section + 1) if role == Qt.ItemDataRole.DisplayRole else None
        layer = self.layer(section)
        if role == Qt.ItemDataRole.DisplayRole:
            return layer.name
        if role == Qt.ItemDataRole.ToolTipRole:
            return f"{layer.name} (locked)" if layer.locked else layer.name
        if role == Qt.ItemDataRole.DecorationRole:
            return _dot(layer_color(layer))
        if role == Qt.ItemDataRole.FontRole:
            font = QFont()
            font.setBold(layer.id == self.session.layer.id)
            return font
        return None

    def flags(self, index: QModelIndex) -> Qt.ItemFlag:
        flags = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        return flags | Qt.ItemFlag.ItemIsEditable if self.cell(index.row(), index.column()) else flags

    def setData(self, index: QModelIndex, value: object, role: int = Qt.ItemDataRole.EditRole) -> bool:
        """Hold the drawing of a cell for so many frames."""
        if role != Qt.ItemDataRole.EditRole or not str(value).isdigit():
            return False
        layer = self.layer(index.column())
        return self.session.apply(EXPOSURE_LABEL, expose_drawing, layer.id, index.row() + 1, int(str(value)))

    def _on_document_changed(self, diff: DocumentDiff) -> None:
        document = self.session.document
        ids = [layer.id for layer in document.layers]
        if ids != self._ids:
            self.beginResetModel()
            self._ids, self._length, self._columns = ids, document.length, {}
            self.endResetModel()
            self.reshaped.emit()
            return
        if document.length != self._length:
            self._set_length(document.length)
            self.reshaped.emit()
        for layer_id in diff.layers:
            column = ids.index(layer_id)
            self.dataChanged.emit(self.index(0, column), self.index(self._length - 1, column))
            self.headerDataChanged.emit(Qt.Orientation.Horizontal, column, column)

    def _set_length(self, length: int) -> None:
        if length > self._length:
            self.beginInsertRows(NOWHERE, self._length, length - 1)
            self._length = length
            self.endInsertRows()
        elif length < self._length:
            self.beginRemoveRows(NOWHERE, length, self._length - 1)
            self._length = length
            self.endRemoveRows()


def _told(cell: Cell) -> str:
    kind = "keyframe" if cell.keyframe else "in-between"
    frames = "1 frame" if cell.count == 1 else f"{cell.count} frames"
    return (
        f"drawing {cell.number}: {kind} of frame {cell.frame}, held {frames}\n"
        "Type a number to hold it for so many frames, or drag its lower edge."
    )


def _dot(color: QColor) -> QPixmap:
    picture = QPixmap(QSize(8, 8))
    picture.fill(color)
    return picture
