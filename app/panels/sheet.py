"""The exposure sheet: a table of frames and layers, in which drawings are held, moved and taken out."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QModelIndex, QPoint, QSize, Qt
from PySide6.QtGui import QAction, QContextMenuEvent, QKeyEvent, QMouseEvent, QResizeEvent
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QMenu,
    QTableView,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from app.panels.parts import label
from app.panels.sheet_cells import SheetCells
from app.panels.sheet_model import CELL, EXPOSURE_LABEL, Cell, SheetModel
from app.session import Gesture, Session
from app.theme import Theme
from core.errors import InkbetweenError
from core.model.document import Document, Keyframe
from core.model.edits import delete_keyframe, delete_tick, divide_tick, move_keyframe, set_span, set_step
from core.model.parts import check_open
from core.model.sheet_edits import expose_drawing
from core.model.timing import drawn_offsets

ROW, COLUMN, WIDEST_COLUMN = 19, 76, 132
WIDTH = 290
EDGE = 4
"""Px on either side of the lower edge of a drawing within which it is dragged."""

STEPS = (("On Ones", 1), ("On Twos", 2), ("On Threes", 3))


@dataclass
class Drag:
    """What the button holds: the lower edge of a drawing, or a keyframe."""

    layer_id: int
    frame: int
    edge: bool
    row: int
    gesture: Gesture | None = None


class SheetTable(QTableView):
    """The table. A click goes to the frame and the layer; every edit is one undo step."""

    def __init__(self, session: Session, theme: Theme, actions: Mapping[str, QAction]) -> None:
        super().__init__()
        self.session, self.menu_actions = session, actions
        self.sheet = SheetModel(session, self)
        self._drag: Drag | None = None
        self._lit: tuple[int, int] | None = None
        self.setModel(self.sheet)
        self.cells = SheetCells(self.sheet, theme, lambda row, column: (row, column) == self._lit, self)
        self.setItemDelegate(self.cells)
        self.setShowGrid(False)
        self.setMouseTracking(True)
        self.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.setEditTriggers(QAbstractItemView.EditTrigger.AnyKeyPressed)
        self.setTabKeyNavigation(False)
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        self.setAccessibleName("Exposure sheet")
        for header, size in ((self.verticalHeader(), ROW), (self.horizontalHeader(), COLUMN)):
            header.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
            header.setMinimumSectionSize(size)
            header.setDefaultSectionSize(size)
            header.setHighlightSections(False)
        self.horizontalHeader().setTextElideMode(Qt.TextElideMode.ElideRight)
        self.horizontalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.verticalHeader().setDefaultAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        self.horizontalHeader().sectionPressed.connect(lambda i: session.set_layer(self.sheet.layer(i).id))
        self.verticalHeader().sectionPressed.connect(lambda i: session.go_to(i + 1))
        self.sheet.reshaped.connect(self._show_current)
        session.frameChanged.connect(self._on_frame_changed)
        session.layerChanged.connect(self._show_current)
        session.soloChanged.connect(self.viewport().update)
        self._shown_row = 0
        self._show_current()

    # where we are

    def _show_current(self) -> None:
        """Make the playhead's frame in the active layer the current cell, and keep it in sight."""
        self._fit_columns()
        self._follow()
        self.viewport().update()
        self.horizontalHeader().viewport().update()

    def _fit_columns(self) -> None:
        """Give the columns the room that there is, for the layers' names."""
        room = self.viewport().width() // max(1, self.sheet.columnCount())
        self.horizontalHeader().setDefaultSectionSize(min(max(room, COLUMN), WIDEST_COLUMN))

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_columns()

    def _on_frame_changed(self, frame: int) -> None:
        """Follow the playhead; while the film plays only two rows are painted anew."""
        self._follow()
        for row in (self._shown_row, frame - 1):
            self.viewport().update(0, self.rowViewportPosition(row), self.viewport().width(), ROW)
        self._shown_row = frame - 1

    def _follow(self) -> None:
        if self._drag is None and self.sheet.is_current:  # else the other document's news is on its way
            column = self.sheet.column_of(self.session.layer.id)
            self.setCurrentIndex(self.sheet.index(self.session.frame - 1, column))

    def currentChanged(self, current: QModelIndex, previous: QModelIndex) -> None:
        """Go where the keys went."""
        super().currentChanged(current, previous)
        if current.isValid() and self._drag is None and self.sheet.is_current:
            self._go_to(current)

    def _go_to(self, index: QModelIndex) -> None:
        self.session.set_layer(self.sheet.layer(index.column()).id)
        self.session.go_to(index.row() + 1)

    def _cell(self, index: QModelIndex) -> Cell | None:
        return index.data(CELL) if index.isValid() else None

    def _here(self) -> Cell | None:
        return self._cell(self.currentIndex())

    # the pointer

    def _edge_at(self, at: QPoint) -> QModelIndex | None:
        """Return the last cell of the drawing whose lower edge lies at a place."""
        for y in (at.y() - EDGE, at.y() + EDGE):  # from below and from above
            index = self.indexAt(QPoint(at.x(), y))
            cell = self._cell(index)
            if cell is not None and cell.last and abs(self.visualRect(index).bottom() - at.y()) <= EDGE:
                return index
        return None

    def mousePressEvent(self, event: QMouseEvent) -> None:
        at = event.position().toPoint()
        edge, index = self._edge_at(at), self.indexAt(at)
        if event.button() != Qt.MouseButton.LeftButton or not index.isValid():
            super().mousePressEvent(event)
            return
        self.setFocus()
        taken = edge if edge is not None else index
        cell, layer = self._cell(taken), self.sheet.layer(taken.column())
        self.setCurrentIndex(index if edge is None else self.sheet.index(taken.row(), taken.column()))
        if cell is not None and (edge is not None or (cell.keyframe and cell.first)):
            self._drag = Drag(layer.id, cell.frame, edge is not None, taken.row())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        at = event.position().toPoint()
        if self._drag is not None:
            self._drag_to(self._row_at(at.y()))
        elif event.buttons() & Qt.MouseButton.LeftButton:
            self.session.go_to(self._row_at(at.y()) + 1)
        else:
            edge = self._edge_at(at)
            self._light((edge.row(), edge.column()) if edge is not None else None)

    def _row_at(self, y: int) -> int:
        """Return the row at a height, those behind the film's end counted on."""
        return max(0, (y + self.verticalOffset()) // ROW)

    def _drag_to(self, row: int) -> None:
        drag = self._drag
        if drag.gesture is None:
            if row == drag.row or not self._may_change(drag.layer_id):
                return
            drag.gesture = self.session.begin(EXPOSURE_LABEL if drag.edge else "Move Keyframe")
        if drag.edge:
            count = max(1, row + 2 - drag.frame)
            drag.gesture.update(lambda d: expose_drawing(d, drag.layer_id, drag.frame, count), quiet=True)
        else:
            drag.gesture.update(lambda d: move_keyframe(d, drag.layer_id, drag.frame, row + 1), quiet=True)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton:
            self._end_drag(keep=True, row=self._row_at(event.position().toPoint().y()))

    def _end_drag(self, *, keep: bool, row: int = 0) -> None:
        drag, self._drag = self._drag, None
        if drag is not None and drag.gesture is not None:
            if keep:
                drag.gesture.commit()
                self.session.go_to(drag.frame if drag.edge else row + 1)
            else:
                drag.gesture.cancel()
        self._show_current()

    def _may_change(self, layer_id: int) -> bool:
        """Whether a layer can be changed; else say why not, and drop it."""
        try:
            check_open(self.session.document.layer(layer_id))
        except InkbetweenError as e:
            self._drag = None
            self.session.problem.emit(str(e))
            return False
        return True

    def _light(self, lit: tuple[int, int] | None) -> None:
        if lit != self._lit:
            self._lit = lit
            shape = Qt.CursorShape.SizeVerCursor if lit else Qt.CursorShape.ArrowCursor
            self.viewport().setCursor(shape)
            self.viewport().update()

    def leaveEvent(self, event: QEvent) -> None:
        self._light(None)
        super().leaveEvent(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """A double click is two clicks: nothing is opened by it."""
        self.mousePressEvent(event)

    # the keys

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self._wants(event):
            event.accept()
            return True
        return super().event(event)

    def _wants(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape:
            return self._drag is not None
        walks = event.key() in (
            Qt.Key.Key_Left,
            Qt.Key.Key_Right,
            Qt.Key.Key_Home,
            Qt.Key.Key_End,
            Qt.Key.Key_Delete,
        )
        plain = not event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        return plain and (walks or event.text().isdigit())

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key = event.key()
        if key == Qt.Key.Key_Escape and self._drag is not None:
            self._end_drag(keep=False)
        elif key == Qt.Key.Key_Delete:
            self.delete_drawing()
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_F2):
            self.edit(self.currentIndex(), QAbstractItemView.EditTrigger.AllEditTriggers, event)
        elif event.text().isdigit():
            self.edit(self.currentIndex(), QAbstractItemView.EditTrigger.AnyKeyPressed, event)
        elif not event.text() or key == Qt.Key.Key_Escape:
            super().keyPressEvent(event)
        else:
            event.ignore()

    # edits of the drawing in the current cell

    def _apply(self, text: str, edit: Callable[..., Document], *args: object, **options: object) -> None:
        self.session.apply(text, edit, self.session.layer.id, *args, **options)

    def _span(self) -> Keyframe | None:
        """Return the keyframe whose span the current cell lies in; a sentence if there is none."""
        before, after = self.session.span_keyframes()
        if before is None or after is None or self.session.frame == after.frame:
            self.session.problem.emit("No span runs through this frame: it needs a keyframe before and after it.")
            return None
        return before

    def _index_in_span(self, before: Keyframe) -> int:
        _, after = self.session.layer.around(before.frame)
        offsets = drawn_offsets(before.span, after.frame - before.frame)
        return sum(before.frame + o <= self.session.frame for o in offsets) - 1

    def delete_drawing(self) -> None:
        """Take the drawing out whose number stands in the current cell: a keyframe, or an in-between."""
        cell = self._here()
        if cell is None or not cell.first:
            self.session.problem.emit("No drawing begins here: go to a cell with a number first.")
        elif cell.keyframe:
            self._apply("Delete Keyframe", delete_keyframe, cell.frame)
        else:
            before = self._span()
            if before is not None:
                self._apply("Delete Drawing", delete_tick, before.frame, self._index_in_span(before))

    def divide(self, parts: int) -> None:
        """Add drawings between that of the current cell and the next one."""
        before = self._span()
        if before is not None:
            text = "Add Half" if parts == 2 else "Add Thirds"
            self._apply(text, divide_tick, before.frame, self._index_in_span(before), parts)

    def put_on(self, step: int) -> None:
        """Put the span of the current cell on ones, twos, threes."""
        before = self._span()
        if before is not None:
            self._apply("Change Exposures", set_step, before.frame, step)

    def toggle_hold(self) -> None:
        """Hold the keyframe before until the next one, or let there be in-betweens again."""
        before = self._span()
        if before is not None:
            text = "Give Up Hold" if before.span.hold else "Hold Keyframe"
            self._apply(text, set_span, before.frame, hold=not before.span.hold)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        index = self.indexAt(event.pos())
        if index.isValid():
            self.setCurrentIndex(index)
            self.menu().popup(event.globalPos())

    def menu(self) -> QMenu:
        """Return what can be done at the current cell."""
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        before, after = self.session.span_keyframes()
        spanned = before is not None and after is not None and self.session.frame < after.frame
        for name in ("key.add", "key.copy", "key.delete"):
            menu.addAction(self.menu_actions[name])
        menu.addSeparator()
        hold = menu.addAction("Hold Until Next Keyframe", self.toggle_hold)
        hold.setCheckable(True)
        hold.setChecked(spanned and before.span.hold)
        moving = [menu.addAction(text, lambda n=step: self.put_on(n)) for text, step in STEPS]
        menu.addSeparator()
        moving.append(menu.addAction("Add Half", lambda: self.divide(2)))
        moving.append(menu.addAction("Add Thirds", lambda: self.divide(3)))
        menu.addAction("Delete Drawing", self.delete_drawing)
        menu.addSeparator()
        for name in ("edit.copy", "edit.paste"):
            menu.addAction(self.menu_actions[name])
        hold.setEnabled(spanned)
        for action in moving:
            action.setEnabled(spanned and not before.span.hold)
        return menu


class SheetPanel(QWidget):
    """The exposure sheet with its title."""

    def __init__(self, session: Session, theme: Theme, actions: Mapping[str, QAction]) -> None:
        super().__init__()
        self.setObjectName("sheet")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        self.setMinimumWidth(140)
        self.table = SheetTable(session, theme, actions)
        box = QVBoxLayout(self)
        box.setContentsMargins(1, 12, 0, 0)
        box.setSpacing(8)
        head = QHBoxLayout()
        head.setContentsMargins(12, 0, 8, 0)
        head.addWidget(label("EXPOSURE SHEET", "title"))
        head.addStretch(1)
        self.close_button = QToolButton()
        self.close_button.setText("×")
        self.close_button.setFixedSize(22, 20)
        self.close_button.setToolTip("Close the exposure sheet (X)")
        self.close_button.setAccessibleName("Close the exposure sheet")
        self.close_button.clicked.connect(actions["view.sheet"].trigger)
        head.addWidget(self.close_button)
        box.addLayout(head)
        box.addWidget(self.table, 1)

    def sizeHint(self) -> QSize:
        return QSize(WIDTH, 400)

    def set_theme(self, theme: Theme) -> None:
        self.table.cells.set_theme(theme)
        self.table.viewport().update()
