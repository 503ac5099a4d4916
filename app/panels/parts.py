"""Small widgets that several panels are made of."""

from collections.abc import Callable, Sequence

from PySide6.QtCore import QEvent, QObject, QSignalBlocker, QSize, Qt, Signal
from PySide6.QtGui import QColor, QIcon, QPainter, QPixmap
from PySide6.QtWidgets import (
    QButtonGroup,
    QDoubleSpinBox,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSizePolicy,
    QSlider,
    QSpinBox,
    QToolButton,
    QVBoxLayout,
    QWidget,
)


class Segments(QWidget):
    """A few choices beside each other, one of them on; `chosen` only when a person chooses.

    `pointed` tells the choice under the pointer, "" when it has left.
    """

    chosen = Signal(str)
    pointed = Signal(str)

    def __init__(self, choices: Sequence[tuple[str, str, str]], parent: QWidget | None = None) -> None:
        """`choices` are (value, text, tooltip)."""
        super().__init__(parent)
        self.setObjectName("segments")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        row = QHBoxLayout(self)
        row.setContentsMargins(1, 1, 1, 1)
        row.setSpacing(1)
        self._group = QButtonGroup(self)
        self._buttons: dict[str, QToolButton] = {}
        for value, text, tip in choices:
            button = QToolButton()
            button.setText(text)
            button.setToolTip(tip)
            button.setAccessibleName(text)
            button.setCheckable(True)
            button.setProperty("segment", True)
            button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            button.clicked.connect(lambda _=False, v=value: self.chosen.emit(v))
            button.installEventFilter(self)
            self._group.addButton(button)
            self._buttons[value] = button
            row.addWidget(button)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Enter and self.isEnabled():
            self.pointed.emit(next(v for v, button in self._buttons.items() if button is watched))
        elif event.type() == QEvent.Type.Leave:
            self.pointed.emit("")
        return super().eventFilter(watched, event)

    def set_value(self, value: str) -> None:
        """Show a choice, without telling anyone; one that is not among them shows none."""
        if value in self._buttons:
            self._buttons[value].setChecked(True)
            return
        self._group.setExclusive(False)
        for button in self._buttons.values():
            button.setChecked(False)
        self._group.setExclusive(True)

    def button(self, value: str) -> QToolButton:
        return self._buttons[value]


class Section(QWidget):
    """A titled part of the side panel; a click on the title folds it away."""

    folded = Signal(bool)

    def __init__(self, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.name = title.lower()
        outer = QVBoxLayout(self)
        outer.setContentsMargins(2, 12, 16, 4)
        outer.setSpacing(8)
        outer.addWidget(self._head(title))
        self.body = QWidget()
        self.box = QVBoxLayout(self.body)
        self.box.setContentsMargins(14, 0, 0, 0)
        self.box.setSpacing(8)
        outer.addWidget(self.body)

    def _head(self, title: str) -> QWidget:
        head = QWidget()
        head.setCursor(Qt.CursorShape.PointingHandCursor)
        head.installEventFilter(self)
        row = QHBoxLayout(head)
        row.setContentsMargins(0, 0, 0, 0)
        row.setSpacing(0)
        self.arrow = QToolButton()
        self.arrow.setProperty("arrow", True)
        self.arrow.setFixedWidth(14)
        self.arrow.setText("▾")
        self.arrow.setToolTip(f"Fold {title} away")
        self.arrow.setAccessibleName(f"Fold {title} away")
        self.arrow.clicked.connect(lambda: self.set_folded(not self.is_folded))
        self.title = label(title.upper(), "title")
        self.note = label("", "muted")
        row.addWidget(self.arrow)
        row.addWidget(self.title)
        row.addStretch(1)
        row.addWidget(self.note)
        return head

    @property
    def is_folded(self) -> bool:
        return self.body.isHidden()

    def set_folded(self, folded: bool) -> None:
        """Show the title only, or all."""
        if folded != self.is_folded:
            self.body.setVisible(not folded)
            self.arrow.setText("▸" if folded else "▾")
            self.arrow.setToolTip(f"Show {self.name.capitalize()}" if folded else f"Fold {self.name} away")
            self.folded.emit(folded)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.MouseButtonPress and watched is self.title.parentWidget():
            self.set_folded(not self.is_folded)
            return True
        return super().eventFilter(watched, event)

    def add_row(self, name: str, *widgets: QWidget) -> QLabel:
        """Add a labelled row and return its label."""
        row = QHBoxLayout()
        row.setSpacing(8)
        text = label(name, "muted")
        text.setMinimumWidth(64)
        row.addWidget(text)
        for widget in widgets:
            row.addWidget(widget)
        row.addStretch(1)
        self.box.addLayout(row)
        return text


def label(text: str, role: str = "") -> QLabel:
    made = QLabel(text)
    if role:
        made.setProperty("role", role)
    return made


def separator(*, vertical: bool = False) -> QFrame:
    line = QFrame()
    line.setObjectName("separator")
    if vertical:
        line.setFixedWidth(1)
    else:
        line.setFixedHeight(1)
    return line


def number_field(low: int, high: int, tip: str, changed: Callable[[int], None], width: int = 56) -> QSpinBox:
    """Return a field for a whole number that tells every step, but typed digits only at the end."""
    field = QSpinBox()
    field.setRange(low, high)
    field.setKeyboardTracking(False)
    field.setToolTip(tip)
    field.setFixedWidth(width)
    field.setAlignment(Qt.AlignmentFlag.AlignRight)
    field.valueChanged.connect(changed)
    return field


def show_value(field: QSpinBox | QDoubleSpinBox | QSlider, value: float) -> None:
    """Show a value that is not a person's change, so that nothing acts on it.

    An edit here would end the gesture that changed the value, and rounding for the field would change it.
    """
    with QSignalBlocker(field):
        field.setValue(value)


def percent_fields(tip: str, changed: Callable[[int], None]) -> tuple[QSlider, QSpinBox]:
    """Return a slider and a field that both tell a share in percent."""
    slider = QSlider(Qt.Orientation.Horizontal)
    slider.setRange(0, 100)
    slider.setFixedWidth(104)
    slider.setToolTip(tip)
    slider.setAccessibleName(tip)
    slider.valueChanged.connect(changed)
    field = number_field(0, 100, tip, changed, 64)
    field.setSuffix(" %")
    field.setAccessibleName(tip)
    return slider, field


def swatch_icon(color: QColor | None, line: QColor, size: int = 18) -> QIcon:
    """Return a small square of a colour, or a crossed one for none."""
    picture = QPixmap(QSize(size * 2, size * 2))
    picture.fill(Qt.GlobalColor.transparent)
    painter = QPainter(picture)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.scale(2, 2)
    painter.setPen(line)
    painter.setBrush(color if color is not None else Qt.BrushStyle.NoBrush)
    painter.drawRoundedRect(1, 1, size - 2, size - 2, 4, 4)
    if color is None:
        painter.drawLine(4, size - 4, size - 4, 4)
    painter.end()
    picture.setDevicePixelRatio(2)
    return QIcon(picture)


def flat_button(text: str, tip: str) -> QPushButton:
    """Return a button that is only its words, for what is done seldom."""
    button = QPushButton(text)
    button.setProperty("flat", True)
    button.setFlat(True)
    button.setToolTip(tip)
    button.setCursor(Qt.CursorShape.PointingHandCursor)
    return button
