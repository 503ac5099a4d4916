"""How the pen and the pencil draw: remembered between runs."""

from PySide6.QtCore import QObject, Signal

from app.settings import Settings

FARTHEST = 50.0
"""Stage px; a pencil's outline that lies farther off the hand's is not that drawing any more."""


class PenOptions(QObject):
    """See the module; `changed` after each change.

    Attributes
    ----------
    closed : bool
        New outlines are closed; otherwise they are open: strokes.
    tolerance : float
        Stage px that a simplified outline of the pencil may lie off the hand's.
    """

    changed = Signal()

    def __init__(self, settings: Settings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._settings = settings
        self.closed = settings.flag("pen/closed", True)
        self.tolerance = settings.number("pencil/tolerance", 2.0, 0, FARTHEST)

    def set_closed(self, closed: bool) -> None:
        if closed != self.closed:
            self.closed = closed
            self._settings.keep("pen/closed", closed)
            self.changed.emit()

    def set_tolerance(self, tolerance: float) -> None:
        if tolerance != self.tolerance:
            self.tolerance = tolerance
            self._settings.keep("pencil/tolerance", tolerance)
            self.changed.emit()
