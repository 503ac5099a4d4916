"""What the curve and the timing chart of a span have in common: its drawings, and one height for every t."""

from bisect import bisect_right
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from PySide6.QtCore import QEvent, Qt
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QSizePolicy, QWidget

from app.theme import Theme
from core.model.document import Span
from core.model.timing import exposures_in
from core.model.timing_edits import Tick, ticks_of

MARGIN = 16.0
HEIGHT = 190
HEADROOM = 0.06
"""Of the range of t, left free where the curve goes beyond 0 or 1."""


@dataclass(frozen=True)
class Spacing:
    """The drawings of one span.

    Attributes
    ----------
    span : Span
    first, last : int
        Frames of the keyframes.
    frame : int
        The playhead's.
    """

    span: Span
    first: int
    last: int
    frame: int

    @property
    def length(self) -> int:
        return self.last - self.first

    @cached_property
    def ticks(self) -> tuple[Tick, ...]:
        """Offset and t of every drawing, the keyframe before's first."""
        return ticks_of(self.span, self.length)

    @cached_property
    def exposures(self) -> tuple[int, ...]:
        return exposures_in(self.span, self.length)

    @property
    def here(self) -> int | None:
        """The number of the drawing that is shown at the playhead; None on the keyframe after."""
        offset = self.frame - self.first
        if not 0 <= offset < self.length:
            return None
        return bisect_right([o for o, _ in self.ticks], offset) - 1

    @cached_property
    def reach(self) -> tuple[float, float]:
        """The range of t that is shown: 0 to 1, and whatever lies beyond."""
        easing = self.span.easing
        ts = [t for _, t in self.ticks] + [easing.y1, easing.y2] + [k.y for k in easing.knots]
        curve = easing.t_at(np.linspace(0, 1, 65))
        low, high = min(0.0, *ts, curve.min()), max(1.0, *ts, curve.max())
        room = HEADROOM * (high - low)
        return float(low - room if low < 0 else 0.0), float(high + room if high > 1 else 1.0)

    def told(self, index: int) -> str:
        """Return frame, t and exposure of a drawing in words."""
        offset, t = self.ticks[index]
        count = self.exposures[index]
        held = f"held {count} frames" if count > 1 else "held 1 frame"
        return f"frame {self.first + offset}  t {t:.2f}  {held}"


class SpacingView(QWidget):
    """A widget in which a t has its height; keys that it wants do not go to the menus while it has the focus."""

    keys = frozenset(
        {
            Qt.Key.Key_Escape,
            Qt.Key.Key_Delete,
            Qt.Key.Key_Backspace,
            Qt.Key.Key_Left,
            Qt.Key.Key_Right,
            Qt.Key.Key_Up,
            Qt.Key.Key_Down,
        }
    )

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme = theme
        self.spacing: Spacing | None = None
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setFixedHeight(HEIGHT)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)

    def show_spacing(self, spacing: Spacing | None) -> None:
        """Show a span, or nothing."""
        if spacing != self.spacing:
            self.spacing = spacing
            self.update()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    def y_of(self, t: float) -> float:
        """Return the height of a t in the widget."""
        low, high = self.spacing.reach if self.spacing else (0.0, 1.0)
        return self.height() - MARGIN - (t - low) / (high - low) * self._room()

    def t_of(self, y: float) -> float:
        """Return the t at a height."""
        low, high = self.spacing.reach if self.spacing else (0.0, 1.0)
        return low + (self.height() - MARGIN - y) / self._room() * (high - low)

    def t_per_px(self) -> float:
        """Return how much t a px is, upwards."""
        return self.t_of(0) - self.t_of(1)

    def _room(self) -> float:
        return self.height() - 2 * MARGIN

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self.wants(event):
            event.accept()
            return True
        return super().event(event)

    def wants(self, event: QKeyEvent) -> bool:
        """Whether a key is for this widget, before any menu gets it."""
        plain = Qt.KeyboardModifier.ShiftModifier | Qt.KeyboardModifier.KeypadModifier
        return Qt.Key(event.key()) in self.keys and not event.modifiers() & ~plain
