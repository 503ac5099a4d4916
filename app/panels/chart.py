"""The timing chart as animators draw it: a ladder from keyframe to keyframe, a tick for every drawing."""

from PySide6.QtCore import QPoint, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QContextMenuEvent, QFont, QKeyEvent, QMouseEvent, QPainter, QPen, QWheelEvent
from PySide6.QtWidgets import QMenu, QSizePolicy, QWidget

from app.panels.spacing import Spacing, SpacingView
from app.theme import Theme

WIDTH = 84
LADDER = 30.0
"""Where the ladder stands, from the left."""

LONG, SHORT = 13.0, 7.0
REACH = 7.0
LINE_HEIGHT = 12.0
NUDGE = 0.01
DRAG = 2.0
"""Px that the pointer travels before a press on a tick moves it."""


class TimingChart(SpacingView):
    """See the module. A press on a tick asks for its frame; the drawing at the playhead is the chosen one.

    `pressed` begins a drag, `moved` is every step of it (the drawing's number and its t), `released` its end,
    `escaped` that it shall not have been.
    """

    pressed = Signal()
    moved = Signal(int, float)
    released = Signal()
    escaped = Signal()
    frameWanted = Signal(int)
    nudged = Signal(int, float)  # number, t
    exposureWanted = Signal(int, int)  # number, frames
    divisionWanted = Signal(int, int)  # number of the drawing before, parts
    deletionWanted = Signal(int)
    hovered = Signal(int)  # number, -1 for none

    keys = SpacingView.keys | {Qt.Key.Key_Plus, Qt.Key.Key_Minus}

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(theme, parent)
        self._held: int | None = None
        self._from = QPointF()
        self._start_t = self._scale = 0.0
        self._under_way = False
        self._hover = -1
        self.setFixedWidth(WIDTH)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Fixed)
        self.setAccessibleName("Timing chart")
        self.setToolTip(
            "Every tick is a drawing. Click: go to it. Drag: its place between the keyframes.\n"
            "Up and down: a little. + and -, or the wheel: frames that it is held. Delete: take it out.\n"
            "Right click between two ticks: add a half or thirds."
        )

    def sizeHint(self) -> QSize:
        return QSize(WIDTH, self.height())

    def show_spacing(self, spacing: Spacing | None) -> None:
        """Show a span, or nothing; of other drawings none is under the pointer until it moves."""
        shown = self.spacing
        if spacing is None or shown is None or len(spacing.ticks) != len(shown.ticks):
            self._hover = -1
        super().show_spacing(spacing)

    @property
    def _live(self) -> bool:
        return self.spacing is not None and self.isEnabled()

    def tick_place(self, index: int) -> QPointF:
        """Return where a tick crosses the ladder; the one behind the last drawing is the keyframe after."""
        ticks = self.spacing.ticks
        return QPointF(LADDER, self.y_of(ticks[index][1] if index < len(ticks) else 1.0))

    def _under(self, at: QPointF) -> int:
        """Return the number of the tick at a place, the keyframe after counted last; -1 for none."""
        if not self._live:
            return -1
        count = len(self.spacing.ticks) + 1
        distance, index = min((abs(self.tick_place(i).y() - at.y()), i) for i in range(count))
        return index if distance <= REACH else -1

    def gap_at(self, at: QPointF) -> int:
        """Return the number of the drawing before the gap at a place."""
        t = self.t_of(at.y())
        ts = [x for _, x in self.spacing.ticks] + [1.0]
        for i in range(len(ts) - 1):
            if min(ts[i], ts[i + 1]) <= t < max(ts[i], ts[i + 1]):
                return i
        return 0 if t < 0.5 else len(ts) - 2

    # the pointer

    def mousePressEvent(self, event: QMouseEvent) -> None:
        index = self._under(event.position())
        if event.button() != Qt.MouseButton.LeftButton or index < 0:
            return
        s = self.spacing
        self.frameWanted.emit(s.last if index == len(s.ticks) else s.first + s.ticks[index][0])
        if 0 < index < len(s.ticks):
            self._held, self._under_way, self._from = index, False, event.position()
            self._start_t, self._scale = s.ticks[index][1], self.t_per_px()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._held is None:
            self._set_hover(self._under(event.position()))
            return
        way = event.position().y() - self._from.y()
        if not self._under_way and abs(way) >= DRAG:
            self._under_way = True
            self.pressed.emit()
        if self._under_way:
            self.moved.emit(self._held, round(self._start_t - way * self._scale, 4))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        if self._held is not None and event.button() == Qt.MouseButton.LeftButton:
            self._held = None
            if self._under_way:
                self.released.emit()
            self.update()

    def _set_hover(self, index: int) -> None:
        movable = self._live and 0 < index < len(self.spacing.ticks)
        self.setCursor(Qt.CursorShape.SizeVerCursor if movable else Qt.CursorShape.ArrowCursor)
        if index != self._hover:
            self._hover = index
            self.hovered.emit(index)
            self.update()

    def leaveEvent(self, _: object) -> None:
        self._set_hover(-1)

    def wheelEvent(self, event: QWheelEvent) -> None:
        """Change the exposure, but only with the focus: else the wheel scrolls the panel past."""
        index = self._under(event.position())
        if not self.hasFocus() or not self._live or not 0 <= index < len(self.spacing.ticks):
            event.ignore()
            return
        self.exposureWanted.emit(index, self.spacing.exposures[index] + (1 if event.angleDelta().y() > 0 else -1))
        event.accept()

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        if self._live and not self.spacing.span.hold:
            self.menu_at(QPointF(event.pos())).popup(event.globalPos())

    def menu_at(self, at: QPointF) -> QMenu:
        """Return what can be done with the tick or the gap at a place."""
        index, gap = self._under(at), self.gap_at(at)
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        menu.addAction("Add Half", lambda: self.divisionWanted.emit(gap, 2))
        menu.addAction("Add Thirds", lambda: self.divisionWanted.emit(gap, 3))
        if 0 <= index < len(self.spacing.ticks):
            count = self.spacing.exposures[index]
            menu.addSeparator()
            menu.addAction("Hold a Frame Longer", lambda: self.exposureWanted.emit(index, count + 1))
            shorter = menu.addAction("Hold a Frame Less", lambda: self.exposureWanted.emit(index, count - 1))
            shorter.setEnabled(count > 1)
            if index:
                menu.addAction("Delete Drawing", lambda: self.deletionWanted.emit(index))
        return menu

    # the keys

    def wants(self, event: QKeyEvent) -> bool:
        if event.key() == Qt.Key.Key_Escape:
            return self._held is not None
        return self._live and super().wants(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, s = event.key(), self.spacing
        if key == Qt.Key.Key_Escape and self._held is not None:
            self._held = None
            if self._under_way:
                self.escaped.emit()
        elif not self._live or Qt.Key(key) not in self.keys:
            super().keyPressEvent(event)
        elif key in (Qt.Key.Key_Left, Qt.Key.Key_Right):
            self._step(-1 if key == Qt.Key.Key_Left else 1)
        elif s.here is not None:
            self._change(s.here, Qt.Key(key), bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))

    def _step(self, step: int) -> None:
        """Go to the drawing before or after the one at the playhead."""
        s = self.spacing
        frames = [s.first + offset for offset, _ in s.ticks] + [s.last]
        here = len(s.ticks) if s.here is None else s.here
        self.frameWanted.emit(frames[min(max(here + step, 0), len(frames) - 1)])

    def _change(self, index: int, key: Qt.Key, far: bool) -> None:
        s = self.spacing
        if key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            step = (5 if far else 1) * (NUDGE if key == Qt.Key.Key_Up else -NUDGE)
            self.nudged.emit(index, s.ticks[index][1] + step)
        elif key in (Qt.Key.Key_Plus, Qt.Key.Key_Minus):
            self.exposureWanted.emit(index, s.exposures[index] + (1 if key == Qt.Key.Key_Plus else -1))
        elif key in (Qt.Key.Key_Delete, Qt.Key.Key_Backspace):
            self.deletionWanted.emit(index)

    # painting

    def paintEvent(self, _: object) -> None:
        with QPainter(self) as painter:  # ended whatever happens: under an open one an error ends the program
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            if self._live:
                font = QFont(self.font())
                font.setPixelSize(10)
                painter.setFont(font)
                painter.setPen(QPen(self.theme.color("text"), 1.4))
                places = [self.tick_place(i) for i in range(len(self.spacing.ticks) + 1)]
                ys = [p.y() for p in places]
                painter.drawLine(QPointF(LADDER, max(ys)), QPointF(LADDER, min(ys)))
                for i in self._in_order():
                    self._paint_tick(painter, i)
                self._paint_labels(painter)
                if self.spacing.span.hold:
                    self._paint_held(painter)

    def _in_order(self) -> list[int]:
        """Return the ticks' numbers, those that must not be covered last."""
        s = self.spacing
        strong = (s.here, self._held, self._hover if self._hover >= 0 else None)
        return sorted(range(len(s.ticks) + 1), key=lambda i: i in strong)

    def _paint_tick(self, painter: QPainter, index: int) -> None:
        s, theme, at = self.spacing, self.theme, self.tick_place(index)
        half = LONG if index in (0, len(s.ticks)) else SHORT
        here = index == (len(s.ticks) if s.here is None and s.frame == s.last else s.here)
        token = "accent" if here or index == self._held else "text"
        painter.setPen(QPen(theme.color(token), 2.6 if here or index == self._hover else 1.4))
        painter.drawLine(at - QPointF(half, 0), at + QPointF(half, 0))

    def _paint_labels(self, painter: QPainter) -> None:
        """Write the frames beside the ticks, as far as there is room: keyframes and the playhead's first."""
        s = self.spacing
        count = len(s.ticks)
        wanted = [s.here if s.here is not None else count, 0, count, *range(1, count)]
        if self._hover >= 0:
            wanted.insert(0, self._hover)
        taken: list[float] = []
        for i in wanted:
            y = self.tick_place(i).y()
            if all(abs(y - other) >= LINE_HEIGHT for other in taken):
                taken.append(y)
                self._paint_label(painter, i, y)

    def _paint_label(self, painter: QPainter, index: int, y: float) -> None:
        s, theme = self.spacing, self.theme
        key = index in (0, len(s.ticks))
        frame = s.last if index == len(s.ticks) else s.first + s.ticks[index][0]
        here = index == (len(s.ticks) if s.here is None else s.here)
        painter.setPen(theme.color("accent" if here else "text" if key else "muted"))
        left = LADDER + (LONG if key else SHORT) + 5
        box = QRectF(left, y - 8, self.width() - left, 16)
        painter.drawText(box, int(Qt.AlignmentFlag.AlignVCenter), str(frame))
        if index < len(s.ticks) and s.exposures[index] > 1:
            painter.setPen(theme.color("muted"))
            left = QRectF(0, y - 8, LADDER - LONG - 2, 16)
            align = Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignRight
            painter.drawText(left, int(align), f"×{s.exposures[index]}")

    def _paint_held(self, painter: QPainter) -> None:
        painter.setPen(self.theme.color("muted"))
        middle = self.height() / 2
        box = QRectF(LADDER + 8, middle - 10, self.width() - LADDER - 8, 20)
        painter.drawText(box, int(Qt.AlignmentFlag.AlignVCenter), "held")

    def at(self, index: int) -> QPoint:
        """Return a tick's place in whole px."""
        return self.tick_place(index).toPoint()
