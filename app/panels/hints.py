"""The status bar's hint: what the tool in the hand does, and what each modifier changes, lit while it is held."""

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QHBoxLayout, QLabel, QWidget

from app.canvas.canvas import Canvas

MODIFIERS = {
    "Shift": (Qt.Key.Key_Shift, Qt.KeyboardModifier.ShiftModifier),
    "Alt": (Qt.Key.Key_Alt, Qt.KeyboardModifier.AltModifier),
    "Ctrl": (Qt.Key.Key_Control, Qt.KeyboardModifier.ControlModifier),
}
PADDING = 12
"""px, as the style sheet gives the other labels of the status bar."""


class CutLabel(QLabel):
    """A line that ends in … where it has no room; a narrow window cuts it, not the window's width."""

    def __init__(self) -> None:
        super().__init__()
        self.setMinimumWidth(1)

    def paintEvent(self, _: QPaintEvent) -> None:
        room = self.rect().adjusted(PADDING, 0, -PADDING, 0)
        cut = self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, room.width())
        QPainter(self).drawText(room, int(Qt.AlignmentFlag.AlignVCenter), cut)


class HintBar(QWidget):
    """See the module. It listens to the canvas; `held` names the modifiers that are down over it."""

    def __init__(self, canvas: Canvas, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._canvas = canvas
        self.held: frozenset[str] = frozenset()
        row = QHBoxLayout(self)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self.text = CutLabel()
        self.labels: dict[str, QLabel] = {}
        for name in MODIFIERS:
            self.labels[name] = QLabel()
            self.labels[name].setProperty("held", False)
            self.labels[name].hide()
        row.addWidget(self.text, 1)
        for label in self.labels.values():
            row.addWidget(label)
        canvas.toolChanged.connect(self._show_tool)
        for watched in (canvas, canvas.viewport()):
            watched.installEventFilter(self)

    def _show_tool(self) -> None:
        tool = self._canvas.tool
        if tool is None:
            return
        self.text.setText(f"{tool.name}: {tool.hint}")
        told = dict(tool.held)
        self.setToolTip("\n".join([self.text.text(), *(f"{k}: {what}" for k, what in told.items())]))
        for name, label in self.labels.items():
            label.setText(f"{name}: {told[name]}" if name in told else "")
            label.setVisible(name in told)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent) and event.type() in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease):
            for name, (key, _) in MODIFIERS.items():
                if event.key() == key:
                    down = event.type() == QEvent.Type.KeyPress
                    self._hold(self.held | {name} if down else self.held - {name})
        elif isinstance(event, QMouseEvent):
            self._hold(frozenset(n for n, (_, flag) in MODIFIERS.items() if event.modifiers() & flag))
        elif event.type() == QEvent.Type.FocusOut:
            self._hold(frozenset())
        return False

    def _hold(self, held: frozenset[str]) -> None:
        for name in held ^ self.held:
            label = self.labels[name]
            label.setProperty("held", name in held)
            label.style().unpolish(label)
            label.style().polish(label)
        self.held = held
