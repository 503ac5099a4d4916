"""What a panel says while there is nothing to show in it."""

from PySide6.QtWidgets import QLabel, QWidget

from app.session import Session


class WithoutSpan(QLabel):
    """A sentence that is there as long as the playhead stands in no span."""

    def __init__(self, session: Session, text: str, parent: QWidget | None = None) -> None:
        super().__init__(text, parent)
        self._session = session
        self.setWordWrap(True)
        self.setProperty("role", "muted")
        for signal in (session.documentChanged, session.frameChanged, session.layerChanged):
            signal.connect(self._refresh)
        self._refresh()

    def _refresh(self, *_: object) -> None:
        self.setVisible(None in self._session.span_keyframes())
