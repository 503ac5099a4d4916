"""What the canvas asks of a tool. One tool is active; it gets the pointer and the keys."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QKeyEvent, QPainter

if TYPE_CHECKING:
    from app.canvas.canvas import Canvas

DRAG_DISTANCE = 3.0
"""View px that the pointer travels before a press becomes a drag."""


@dataclass(frozen=True, slots=True)
class Pointer:
    """Where the pointer is, in view px, and what is held down with it."""

    at: QPointF
    modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier

    @property
    def shift(self) -> bool:
        return bool(self.modifiers & Qt.KeyboardModifier.ShiftModifier)

    @property
    def alt(self) -> bool:
        return bool(self.modifiers & Qt.KeyboardModifier.AltModifier)

    def far_from(self, other: QPointF) -> bool:
        """Whether a press at `other` has become a drag."""
        d = self.at - other
        return d.x() * d.x() + d.y() * d.y() >= DRAG_DISTANCE * DRAG_DISTANCE


class Tool:
    """A tool that does nothing; the real ones override what they need."""

    name = ""
    icon = ""
    hint = ""
    held: tuple[tuple[str, str], ...] = ()  # what holding Shift, Alt or Ctrl does
    cursor = Qt.CursorShape.ArrowCursor
    shows_vertices = False
    shows_anchors = False
    shows_pins = False
    only_draws = False  # of no use on a locked layer

    def __init__(self, canvas: "Canvas") -> None:
        self.canvas = canvas

    def press(self, pointer: Pointer) -> None:
        """The left button went down."""

    def drag(self, pointer: Pointer) -> None:
        """The pointer moved with the left button down."""

    def release(self, pointer: Pointer) -> None:
        """The left button went up."""

    def hover(self, pointer: Pointer) -> None:
        """The pointer moved with no button down."""

    def double_click(self, pointer: Pointer) -> None:
        """The second press of a double click; `press` came for the first one only."""

    def right_press(self, pointer: Pointer) -> None:
        """The right button went down."""

    def key(self, event: QKeyEvent) -> bool:
        """A key was pressed; True if it was meant for the tool."""
        return False

    def wants_key(self, event: QKeyEvent) -> bool:
        """Whether the tool needs this key now, before any menu shortcut gets it."""
        return event.key() == Qt.Key.Key_Escape and self.busy

    @property
    def busy(self) -> bool:
        """Whether a gesture is under way that Escape would cancel."""
        return False

    def cancel(self) -> None:
        """Escape, or another tool was chosen: leave no trace."""

    def paint(self, painter: QPainter) -> None:
        """Paint what the tool shows on top, in view px."""
