"""The card of the tour, in the upper corner of the canvas: messages come at the lower edge."""

import re
from collections.abc import Callable

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from app.panels.parts import flat_button
from app.tour import STEPS, Tour

WIDTH, MARGIN = 320, 16
WELCOME = (
    "Welcome",
    "Draw two shapes, say which point goes where, and see every drawing between them. It takes a minute, "
    "on an empty page.",
)
END = ("That is all", "Press {help.keys} for every key, {help.find} to find any command. Have fun.")


class TourCard(QFrame):
    """Shows the tour's step over `over`; `start` is asked to make an empty page, and says whether there is one."""

    def __init__(self, tour: Tour, over: QWidget, key_of: Callable[[str], str], start: Callable[[], bool]) -> None:
        super().__init__(over)
        self.setObjectName("card")
        self._tour, self._key_of, self._start = tour, key_of, start
        self.setFixedWidth(WIDTH)
        box = QVBoxLayout(self)
        box.setContentsMargins(16, 12, 12, 10)
        box.setSpacing(6)
        head = QHBoxLayout()
        self.title = QLabel()
        self.title.setProperty("role", "strong")
        self.count = QLabel()
        self.count.setProperty("role", "muted")
        head.addWidget(self.title)
        head.addStretch(1)
        head.addWidget(self.count)
        box.addLayout(head)
        self.text = QLabel()
        self.text.setWordWrap(True)
        box.addWidget(self.text)
        self.go = QPushButton("Start")
        self.go.setToolTip("Start on an empty page")
        self.go.clicked.connect(self._on_go)
        self.later = flat_button("Later", "Hide this card; it comes back at the next start")
        self.later.clicked.connect(lambda: tour.leave(for_good=False))
        self.never = flat_button("Don't show again", "Never offer the tour again; it stays in the Help menu")
        self.never.clicked.connect(lambda: tour.leave(for_good=True))
        foot = QHBoxLayout()
        foot.addWidget(self.go)
        foot.addStretch(1)
        foot.addWidget(self.later)
        foot.addWidget(self.never)
        box.addLayout(foot)
        tour.changed.connect(self.refresh)
        over.installEventFilter(self)
        self.refresh()

    def _on_go(self) -> None:
        if self._tour.index == len(STEPS):
            self._tour.leave(for_good=True)
        elif self._start():
            self._tour.start()
            self.parentWidget().setFocus()

    def refresh(self) -> None:
        """Show the step that the tour is at, with the keys as they are now."""
        index = self._tour.index
        self.setVisible(index is not None)
        if index is None:
            return
        step = self._tour.step
        title, text = (step.title, step.text) if step else (WELCOME if index < 0 else END)
        self.title.setText(title)
        self.count.setText(f"{index + 1} of {len(STEPS)}" if step else "")
        self.text.setText(re.sub(r"\{([\w.]+)\}", self._key, text))
        self.go.setVisible(step is None)
        self.go.setText("Start" if index < 0 else "Close")
        self.go.setToolTip("Start on an empty page" if index < 0 else "Close this card")
        ended = index == len(STEPS)
        self.later.setVisible(not ended)
        self.never.setVisible(not ended)
        self._place()
        self.raise_()

    def _key(self, match: re.Match[str]) -> str:
        return f"<b>{self._key_of(match[1]) or 'the menu'}</b>"

    def _place(self) -> None:
        over = self.parentWidget()
        height = max(self.layout().totalHeightForWidth(WIDTH) + 4, self.minimumSizeHint().height())
        self.setGeometry(over.width() - WIDTH - MARGIN, MARGIN, WIDTH, height)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and self.isVisible():
            self._place()
        return False
