"""Playing the film at its rate, and flipping between drawings; late frames are dropped, never stretched."""

from PySide6.QtCore import QCoreApplication, QElapsedTimer, QEvent, QObject, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent

from app.session import Session
from core.model.timing import exposures_of


class Playback(QObject):
    """Moves the playhead by the clock, through the session's range."""

    changed = Signal()
    dropping = Signal(int)  # frames dropped since playing began

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.loop, self.ping_pong = True, False
        self.dropped = 0
        self._clock = QElapsedTimer()
        self._from = 1
        self._seen = 0
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_tick)
        session.fileChanged.connect(self._on_file_changed)
        session.rangeChanged.connect(self._restart)
        self._shown_path = session.path

    @property
    def playing(self) -> bool:
        return self._timer.isActive()

    def toggle(self) -> None:
        if self.playing:
            self.stop()
        else:
            self.start()

    def start(self) -> None:
        """Play from the playhead, or from the start of the range if it stands behind it or on its last frame."""
        first, last = self.session.range
        self._from = self.session.frame if first <= self.session.frame < last else first
        self.session.go_to(self._from)
        self._seen = 0
        self._count_dropped(-self.dropped)
        self._clock.start()
        self._timer.start(max(2, int(500 / float(self.session.document.rate))))
        self.changed.emit()

    def stop(self) -> None:
        if self.playing:
            self._timer.stop()
            self.changed.emit()

    def _restart(self) -> None:
        if self.playing:
            self.start()

    def set_loop(self, loop: bool) -> None:
        if loop != self.loop:
            self.loop = loop
            self.changed.emit()

    def set_ping_pong(self, ping_pong: bool) -> None:
        """Play forth and back."""
        if ping_pong != self.ping_pong:
            self.ping_pong = ping_pong
            self._restart()
            self.changed.emit()

    def _on_tick(self) -> None:
        passed = int(self._clock.nsecsElapsed() * 1e-9 * float(self.session.document.rate))
        self._count_dropped(max(passed - self._seen - 1, 0))
        self._seen = passed
        first, last = self.session.range
        frame = frame_after(self._from, passed, first, last, loop=self.loop, ping_pong=self.ping_pong)
        self.session.go_to(first if self.ping_pong and frame is None else last if frame is None else frame)
        if frame is None:
            self.stop()

    def _count_dropped(self, more: int) -> None:
        if more:
            self.dropped += more
            self.dropping.emit(self.dropped)

    def _on_file_changed(self) -> None:
        if self.session.path != self._shown_path:
            self._shown_path = self.session.path
            self.stop()


def frame_after(start: int, passed: int, first: int, last: int, *, loop: bool, ping_pong: bool) -> int | None:
    """Return the frame to show when so many have passed since `start`; None when the end is reached.

    Forth and back shows each end once; without a loop it ends where it began.
    """
    length = last - first
    period = 2 * length if ping_pong else length + 1
    position = start - first + passed
    if period == 0:
        return first if loop else None
    if not loop and position >= period:
        return None
    position %= period
    return first + (position if position <= length else period - position)


class Flip(QObject):
    """Shows the previous or the next drawing while a key is held, as one flips paper; back when it is let go."""

    def __init__(self, session: Session, playback: Playback, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._session, self._playback = session, playback
        self._home: int | None = None

    @property
    def flipping(self) -> bool:
        return self._home is not None

    def show(self, step: int) -> None:
        """Show the drawing before (-1) or after (1) the one at the playhead until a key is released."""
        if self._home is None:
            self._playback.stop()
            self._home = self._session.frame
            application = QCoreApplication.instance()
            if application is not None:
                application.installEventFilter(self)
        self._session.go_to(neighbour_drawing(self._session, self._home, step))

    def end(self) -> None:
        """Go back to where the flipping began."""
        home, self._home = self._home, None
        application = QCoreApplication.instance()
        if application is not None:
            application.removeEventFilter(self)
        if home is not None:
            self._session.go_to(home)

    def eventFilter(self, _: QObject, event: QEvent) -> bool:
        kind = event.type()
        released = kind == QEvent.Type.KeyRelease and isinstance(event, QKeyEvent) and not event.isAutoRepeat()
        if self.flipping and (released or kind == QEvent.Type.ApplicationDeactivate):
            self.end()
        return False


def neighbour_drawing(session: Session, frame: int, step: int) -> int:
    """Return the frame where the drawing before (-1) or after (1) the one shown at `frame` begins.

    Of the active layer; where there is none, the frame that the one shown begins at.
    """
    starts = [e.frame for e in exposures_of(session.layer, 1, session.document.length)]
    here = max((i for i, f in enumerate(starts) if f <= frame), default=-1)
    wanted = here + step
    if 0 <= wanted < len(starts):
        return starts[wanted]
    return starts[here] if here >= 0 else frame
