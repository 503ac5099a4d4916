"""One sentence over the canvas: what went wrong or what was done, never a box that must be clicked away."""

from collections.abc import Callable, Sequence

from PySide6.QtCore import QEvent, QObject, QSize, Qt, QTimer
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QToolButton, QWidget

from app.theme import Theme, icon, pixmap

INFO_MS, ERROR_MS = 5000, 12000

Choice = tuple[str, Callable[[], object]]
"""What a button says, and what it does."""


class MessageBar(QFrame):
    """Lies over the lower edge of `over`, and goes by itself."""

    def __init__(self, over: QWidget, theme: Theme) -> None:
        super().__init__(over)
        self.setObjectName("messagebar")
        self.theme = theme
        row = QHBoxLayout(self)
        row.setContentsMargins(12, 8, 8, 8)
        row.setSpacing(10)
        self._sign = QLabel()
        self._text = QLabel()
        self._text.setWordWrap(True)
        self._text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._close = QToolButton()
        self._close.setToolTip("Close this message")
        self._close.setIconSize(QSize(14, 14))
        self._close.clicked.connect(self.hide)
        row.addWidget(self._sign)
        row.addWidget(self._text, 1)
        self._choices = QHBoxLayout()
        self._choices.setSpacing(8)
        self.buttons: list[QPushButton] = []
        row.addLayout(self._choices)
        row.addWidget(self._close)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.hide)
        over.installEventFilter(self)
        self.set_theme(theme)
        self.hide()

    @property
    def text(self) -> str:
        """The sentence that is shown; empty while the bar is hidden."""
        return self._text.text() if self.isVisible() else ""

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self._close.setIcon(icon("close", theme))

    def show_message(self, text: str, kind: str = "error", choices: Sequence[Choice] = ()) -> None:
        """Show a sentence; `kind` is "error" or "info". One with choices stays until it is answered or closed."""
        self._offer(choices)
        self._text.setText(text[:1].upper() + text[1:])
        token = "error" if kind == "error" else "accent"
        self._sign.setPixmap(pixmap("warning" if kind == "error" else "info", self.theme.color(token), 18))
        self.setProperty("kind", kind)
        self.style().unpolish(self)
        self.style().polish(self)
        self._place()
        self.show()
        self.raise_()
        if choices:
            self._timer.stop()
        else:
            self._timer.start(ERROR_MS if kind == "error" else INFO_MS)

    def _offer(self, choices: Sequence[Choice]) -> None:
        for button in self.buttons:
            button.deleteLater()
            self._choices.removeWidget(button)
        self.buttons = [QPushButton(text) for text, _ in choices]
        for button, (_, run) in zip(self.buttons, choices, strict=True):
            button.clicked.connect(self.hide)
            button.clicked.connect(lambda _=False, run=run: run())
            self._choices.addWidget(button)

    def _place(self) -> None:
        over = self.parentWidget()
        beside = 90 + sum(button.sizeHint().width() + 8 for button in self.buttons)
        width = min(over.width() - 32, 620 + 120 * len(self.buttons))
        height = max(40, self.layout().heightForWidth(width), self._text.heightForWidth(width - beside) + 18)
        self.setGeometry((over.width() - width) // 2, over.height() - height - 16, width, height)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and self.isVisible():
            self._place()
        return False
