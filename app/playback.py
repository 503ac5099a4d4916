"""Playing the film at its rate; late frames are dropped, never stretched."""

from PySide6.QtCore import QElapsedTimer, QObject, Qt, QTimer, Signal

from app.session import Session


class Playback(QObject):
    """Moves the playhead by the clock."""

    changed = Signal()

    def __init__(self, session: Session, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.session = session
        self.loop = True
        self._clock = QElapsedTimer()
        self._from = 1
        self._timer = QTimer(self)
        self._timer.setTimerType(Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._on_tick)
        session.fileChanged.connect(self._on_file_changed)
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
        """Play from the playhead, or from the start if it stands on the last frame."""
        self._from = 1 if self.session.frame >= self.session.document.length else self.session.frame
        self.session.go_to(self._from)
        self._clock.start()
        self._timer.start(max(2, int(500 / float(self.session.document.rate))))
        self.changed.emit()

    def stop(self) -> None:
        if self.playing:
            self._timer.stop()
            self.changed.emit()

    def set_loop(self, loop: bool) -> None:
        if loop != self.loop:
            self.loop = loop
            self.changed.emit()

    def _on_tick(self) -> None:
        document = self.session.document
        passed = int(self._clock.nsecsElapsed() * 1e-9 * float(document.rate))
        frame = self._from + passed
        if frame > document.length:
            if not self.loop:
                self.session.go_to(document.length)
                self.stop()
                return
            frame = (frame - 1) % document.length + 1
        self.session.go_to(frame)

    def _on_file_changed(self) -> None:
        if self.session.path != self._shown_path:
            self._shown_path = self.session.path
            self.stop()
