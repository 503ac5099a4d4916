"""Where everything of the timeline's track lies: frames along x, a row a layer down y, scrolled and zoomed."""

from collections.abc import Iterable

from PySide6.QtCore import QPointF, QRectF

from app.session import Session
from core.model.document import Layer
from core.model.frame_edits import KeyRef

HEADER = 196
"""Width of the rows' names, px."""

START = 16
"""From the end of the names to frame 1, px."""

RULER = 32
ROW = 30
RIGHT = 28
NARROWEST = 5.0
WIDEST = 60.0
SMALLEST_ZOOM = 0.05
DIAMOND = 6.5
GRIP = 13.0
"""From the first or last selected keyframe to the handle that stretches them, px."""


class TrackView:
    """Places in px of the widget; `zoom` is the width of a frame, None: all frames fit if they can."""

    def __init__(self, session: Session) -> None:
        self.session = session
        self.width, self.height = 600, 150
        self.zoom: float | None = None
        self.left = self.top = 0.0

    # along x

    @property
    def room(self) -> float:
        """The width that is there for frames."""
        return max(self.width - HEADER - START - RIGHT, 1.0)

    @property
    def step(self) -> float:
        """The width of a frame."""
        fitting = self.room / max(self.session.document.length - 1, 1)
        return min(max(fitting, NARROWEST), WIDEST) if self.zoom is None else self.zoom

    def x_of(self, frame: float) -> float:
        return HEADER + START + (frame - 1) * self.step - self.left

    def frame_at(self, x: float) -> int:
        return round((x - HEADER - START + self.left) / self.step) + 1

    @property
    def most_left(self) -> float:
        """How far the frames can be scrolled."""
        return max((self.session.document.length - 1) * self.step - self.room, 0.0)

    # down y

    @property
    def rows(self) -> tuple[Layer, ...]:
        """Layers from the front one down, as they lie on the stage."""
        return self.session.document.layers[::-1]

    @property
    def most_top(self) -> float:
        """How far the rows can be scrolled."""
        return max(RULER + len(self.rows) * ROW + 4.0 - self.height, 0.0)

    def row_rect(self, row: int) -> QRectF:
        return QRectF(0, RULER + row * ROW - self.top, self.width, ROW)

    def row_at(self, y: float) -> int | None:
        row = int((y - RULER + self.top) // ROW)
        return row if y >= RULER and 0 <= row < len(self.rows) else None

    def row_of(self, layer_id: int) -> int:
        return next(i for i, x in enumerate(self.rows) if x.id == layer_id)

    # keyframes

    def key_place(self, layer: Layer, frame: int) -> QPointF:
        """Return where a keyframe's diamond lies."""
        return QPointF(self.x_of(frame), self.row_rect(self.row_of(layer.id)).center().y())

    def key_under(self, at: QPointF) -> KeyRef | None:
        row = self.row_at(at.y())
        if row is None or at.x() < HEADER:
            return None
        layer = self.rows[row]
        near = [k.frame for k in layer.keyframes if abs(self.x_of(k.frame) - at.x()) <= DIAMOND + 2]
        if not near or abs(self.row_rect(row).center().y() - at.y()) > DIAMOND + 4:
            return None
        return layer.id, min(near, key=lambda f: abs(self.x_of(f) - at.x()))

    def keys_in(self, rect: QRectF) -> set[KeyRef]:
        """Return the keyframes whose place lies in a rectangle."""
        found = set()
        for row, layer in enumerate(self.rows):
            if rect.top() <= self.row_rect(row).center().y() <= rect.bottom():
                found |= {(layer.id, f) for f in layer.frames() if rect.left() <= self.x_of(f) <= rect.right()}
        return found

    def grips(self, keys: Iterable[KeyRef]) -> tuple[QRectF, QRectF] | None:
        """Return the handles that stretch these keyframes; None where there is nothing to stretch."""
        keys = tuple(keys)
        frames = {frame for _, frame in keys}
        if len(frames) < 2:
            return None
        rows = {self.row_of(layer_id) for layer_id, _ in keys}
        top, bottom = self.row_rect(min(rows)).top() + 6, self.row_rect(max(rows)).bottom() - 6
        left, right = self.x_of(min(frames)) - GRIP, self.x_of(max(frames)) + GRIP
        return QRectF(left - 2, top, 4, bottom - top), QRectF(right - 2, top, 4, bottom - top)

    # moving about

    def clip(self) -> None:
        """Stay where there is something."""
        self.left = min(max(self.left, 0.0), self.most_left)
        self.top = min(max(self.top, 0.0), self.most_top)

    def scroll(self, dx: float, dy: float) -> None:
        self.left += dx
        self.top += dy
        self.clip()

    def zoom_at(self, x: float, factor: float) -> None:
        """Make frames wider or narrower; the one under x stays there."""
        x = max(x, HEADER + START)
        frame = (x - HEADER - START + self.left) / self.step
        self.zoom = min(max(self.step * factor, SMALLEST_ZOOM), WIDEST)
        if self.zoom * (self.session.document.length - 1) < self.room / 2 and factor < 1:
            self.fit()  # smaller than the film needs is of no use
        self.left = frame * self.step - (x - HEADER - START)
        self.clip()

    def fit(self) -> None:
        """Show all frames, however narrow they get."""
        fitting = self.room / max(self.session.document.length - 1, 1)
        self.zoom = None if fitting >= NARROWEST else fitting
        self.left = 0.0

    def show(self, frame: int) -> None:
        """Scroll so far that a frame is seen."""
        x = self.x_of(frame)
        if x < HEADER + START:
            self.left -= HEADER + START - x + 40
        elif x > self.width - RIGHT / 2:
            self.left += x - self.width + RIGHT / 2 + 40
        self.clip()

    def show_row(self, row: int) -> None:
        """Scroll so far that a row is seen."""
        rect = self.row_rect(row)
        self.top += min(rect.top() - RULER, 0.0) + max(rect.bottom() - self.height, 0.0)
        self.clip()
