"""What is dragged on the timeline: each drag lives from press to release and knows how to take itself back."""

from typing import Protocol

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QPainter, QPen

from app.keys import Keys
from app.panels.track_view import HEADER, ROW, TrackView
from app.session import Gesture, Session
from app.theme import Theme
from core.errors import InkbetweenError
from core.model.document import Document
from core.model.edits import move_layer
from core.model.frame_edits import KeyRef, move_keyframes, stretch_keyframes, stretched
from core.model.parts import check_open

START_PX = 4
"""A press that moves no farther is a click."""


class Track(Protocol):
    """What a drag needs of the widget."""

    session: Session
    view: TrackView
    keys: Keys
    theme: Theme

    def update(self) -> None: ...


class Drag:
    """A press; `move` may be called often, `release` or `cancel` once."""

    def __init__(self, track: Track, at: QPointF) -> None:
        self.track, self.session, self.view, self.keys = track, track.session, track.view, track.keys
        self.pressed = at
        self.going = False

    def move(self, at: QPointF) -> None:
        if not self.going and (at - self.pressed).manhattanLength() > START_PX:
            self.going = True
            self.start()
        if self.going:
            self.follow(at)
            self.track.update()

    def start(self) -> None:
        """Called once, when a press turns out to be a drag."""

    def follow(self, at: QPointF) -> None:
        """Show what would be if the button were released here."""

    def release(self, at: QPointF) -> None:
        """Keep what is shown, or, of a press that did not move, do what a click does."""

    def cancel(self) -> None:
        """Leave everything as it was at the press."""

    def paint(self, painter: QPainter) -> None:
        """Paint what is only there while one drags."""


class Scrub(Drag):
    """The playhead follows the pointer."""

    def __init__(self, track: Track, at: QPointF) -> None:
        super().__init__(track, at)
        self.session.go_to(self.view.frame_at(at.x()))

    def move(self, at: QPointF) -> None:
        self.session.go_to(self.view.frame_at(at.x()))


class SetRange(Drag):
    """One edge of the range that is played follows the pointer, the other one stays."""

    def __init__(self, track: Track, at: QPointF, fixed: int) -> None:
        super().__init__(track, at)
        self.fixed = fixed
        self.before = self.session.range if self.session.has_range else None

    def follow(self, at: QPointF) -> None:
        frame = min(max(self.view.frame_at(at.x()), 1), self.session.document.length)
        self.session.set_range((min(self.fixed, frame), max(self.fixed, frame)))

    def release(self, at: QPointF) -> None:
        if not self.going:
            self.session.go_to(self.view.frame_at(at.x()))

    def cancel(self) -> None:
        self.session.set_range(self.before)


class _Edit(Drag):
    """A drag that edits the selected keyframes, in one gesture."""

    label = ""

    def __init__(self, track: Track, at: QPointF) -> None:
        super().__init__(track, at)
        self.gesture: Gesture | None = None
        self.refused: tuple[object, ...] = ()

    def start(self) -> None:
        self.before = self.keys.chosen  # since the press they may have been deleted
        for layer_id in {layer_id for layer_id, _ in self.before}:
            try:
                check_open(self.session.document.layer(layer_id))
            except InkbetweenError as e:
                self.session.problem.emit(str(e))
                return
        if self.before:
            self.gesture = self.session.begin(self.label if len(self.before) == 1 else f"{self.label}s")

    @property
    def alive(self) -> bool:
        """Whether the keyframes can be edited, and nothing else has ended the gesture."""
        return self.gesture is not None and self.gesture.open

    def show(self, edit, *args: object, places: dict[int, int]) -> bool:  # type: ignore[no-untyped-def]
        """Show an edit of the keyframes; while one drags on, nothing is said about one that is refused."""
        if self.gesture is None:
            return False
        keys = self.before

        def changed(document: Document) -> Document:
            return edit(document, keys, *args)

        if not self.gesture.update(changed, quiet=True):
            self.refused = (changed,)
            return False
        self.refused = ()
        self.keys.choose((layer_id, places[frame]) for layer_id, frame in keys)
        return True

    def release(self, at: QPointF) -> None:
        if self.gesture is None or not self.gesture.open:
            return
        for changed in self.refused:  # this is what was wanted: now say why it cannot be
            self.gesture.update(changed)
        chosen = self.keys.chosen
        self.gesture.commit()
        self.keys.choose(chosen)

    def cancel(self) -> None:
        if self.gesture is not None:
            self.gesture.cancel()
            self.keys.choose(self.before)


class MoveKeys(_Edit):
    """The selected keyframes follow the pointer; a click on one of several selects it alone."""

    label = "Move Keyframe"

    def __init__(self, track: Track, at: QPointF, key: KeyRef) -> None:
        super().__init__(track, at)
        self.key = key
        self.session.go_to(key[1])

    def follow(self, at: QPointF) -> None:
        if not self.alive:
            return
        delta = max(self.view.frame_at(at.x()) - self.key[1], 1 - min(f for _, f in self.before))
        places = {frame: frame + delta for _, frame in self.before}
        if self.show(move_keyframes, delta, places=places):
            self.session.go_to(self.key[1] + delta)

    def release(self, at: QPointF) -> None:
        if not self.going:
            self.keys.choose({self.key})
        super().release(at)

    def cancel(self) -> None:
        super().cancel()
        if self.going:
            self.session.go_to(self.key[1])


class StretchKeys(_Edit):
    """One end of the selected keyframes follows the pointer, the other one stays, all between in proportion."""

    label = "Retime Keyframe"

    def __init__(self, track: Track, at: QPointF, *, last: bool) -> None:
        super().__init__(track, at)
        self.last = last

    def start(self) -> None:
        self.frames = list(self.keys.frames)
        super().start()

    def follow(self, at: QPointF) -> None:
        if not self.alive or len(self.frames) < 2:
            return
        first, last, least = self.frames[0], self.frames[-1], len(self.frames) - 1
        by = round((at.x() - self.pressed.x()) / self.view.step)
        if self.last:
            last = max(last + by, first + least)
        else:
            first = min(max(first + by, 1), last - least)
        self.show(stretch_keyframes, first, last, places=stretched(self.frames, first, last))


class Band(Drag):
    """A rubber band that selects keyframes of all rows; a click goes to a frame and selects none."""

    def __init__(self, track: Track, at: QPointF, goal: int, *, adds: bool) -> None:
        super().__init__(track, at)
        self.goal, self.before = goal, self.keys.chosen
        self.kept = self.before if adds else frozenset()
        self.rect = QRectF(at, at)

    def follow(self, at: QPointF) -> None:
        self.rect = QRectF(self.pressed, at).normalized()
        self.keys.choose(self.kept | self.view.keys_in(self.rect))

    def release(self, at: QPointF) -> None:
        if not self.going:
            self.keys.choose(self.kept)
            self.session.go_to(self.goal)
            self.track.tell_problem(self.pressed)

    def cancel(self) -> None:
        self.keys.choose(self.before)

    def paint(self, painter: QPainter) -> None:
        if self.going:
            painter.setPen(QPen(self.track.theme.color("accent"), 1))
            painter.setBrush(self.track.theme.color("accent", 0.12))
            painter.drawRect(self.rect)


class MoveLayer(Drag):
    """A row is pulled to another place; a line shows where it would come to lie."""

    def __init__(self, track: Track, at: QPointF, layer_id: int) -> None:
        super().__init__(track, at)
        self.layer_id = layer_id
        self.gap = self.view.row_of(layer_id)

    def follow(self, at: QPointF) -> None:
        first = self.view.row_rect(0).top()
        self.gap = min(max(round((at.y() - first) / ROW), 0), len(self.view.rows))

    def release(self, at: QPointF) -> None:
        if self.going:
            row = self.view.row_of(self.layer_id)
            to = self.gap - 1 if self.gap > row else self.gap
            index = len(self.view.rows) - 1 - to
            self.session.apply("Reorder Layers", move_layer, self.layer_id, index)

    def paint(self, painter: QPainter) -> None:
        if self.going:
            y = self.view.row_rect(0).top() + self.gap * ROW
            painter.setPen(QPen(self.track.theme.color("accent"), 2, Qt.PenStyle.SolidLine))
            painter.drawLine(QPointF(10, y), QPointF(HEADER - 10, y))
