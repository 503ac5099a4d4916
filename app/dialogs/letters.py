"""Insert > Letters: what to write and how, with the outlines as they will be."""

import numpy as np
from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QFont, QPainter, QPaintEvent, QTransform
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFontComboBox,
    QFormLayout,
    QHBoxLayout,
    QPlainTextEdit,
    QWidget,
)

from app.letters import letter_outlines
from app.painting import paint_outlines
from app.panels.parts import label, number_field
from app.settings import Settings
from app.theme import Theme
from core.geometry.outline import FloatArray

LARGEST_LETTERS = 10_000
MOST_CHARACTERS = 500
MARGIN = 16


class LettersDialog(QDialog):
    """`outlines` are the letters, once the dialog was accepted."""

    def __init__(
        self, settings: Settings, theme: Theme, middle: tuple[float, float], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Letters")
        self.setMinimumWidth(460)
        self._settings, self._middle = settings, middle
        self.outlines: list[FloatArray] = []
        self.text = QPlainTextEdit("A")
        self.text.setFixedHeight(54)
        self.text.setTabChangesFocus(True)
        self.text.setAccessibleName("Text")
        self.font_field = QFontComboBox()
        self.font_field.setFontFilters(QFontComboBox.FontFilter.ScalableFonts)
        self.bold, self.italic = QCheckBox("bold"), QCheckBox("italic")
        self.height_field = number_field(
            4, LARGEST_LETTERS, "Size of the letters in px of the stage", self._show, 80
        )
        self.preview = _Preview(theme)
        self.count = label("", "muted")
        self._lay_out()
        self._fill()
        self.text.selectAll()
        self.text.setFocus()

    def _lay_out(self) -> None:
        form = QFormLayout(self)
        form.setContentsMargins(20, 20, 20, 16)
        form.setSpacing(12)
        form.addRow("Text", self.text)
        form.addRow("Font", self.font_field)
        row = QHBoxLayout()
        row.setSpacing(14)
        row.addWidget(self.height_field)
        row.addWidget(label("px", "muted"))
        row.addWidget(self.bold)
        row.addWidget(self.italic)
        row.addStretch(1)
        form.addRow("Size", row)
        form.addRow(self.preview)
        form.addRow(self.count)
        button = QDialogButtonBox.StandardButton
        self.buttons = QDialogButtonBox(button.Ok | button.Cancel)
        self.buttons.button(button.Ok).setText("Insert")
        self.buttons.accepted.connect(self.accept)
        self.buttons.rejected.connect(self.reject)
        form.addRow(self.buttons)

    def _fill(self) -> None:
        """Begin with what was chosen last time."""
        family = self._settings.text("letters/font")
        if family:
            self.font_field.setCurrentFont(QFont(family))
        self.bold.setChecked(self._settings.flag("letters/bold", False))
        self.italic.setChecked(self._settings.flag("letters/italic", False))
        self.height_field.setValue(int(self._settings.number("letters/size", 400, 4, LARGEST_LETTERS)))
        self.text.textChanged.connect(self._show)
        self.font_field.currentFontChanged.connect(self._show)
        self.bold.toggled.connect(self._show)
        self.italic.toggled.connect(self._show)
        self._show()

    def chosen_font(self) -> QFont:
        font = QFont(self.font_field.currentFont())
        font.setBold(self.bold.isChecked())
        font.setItalic(self.italic.isChecked())
        return font

    def accept(self) -> None:
        self._settings.keep("letters/font", self.font_field.currentFont().family())
        self._settings.keep("letters/bold", self.bold.isChecked())
        self._settings.keep("letters/italic", self.italic.isChecked())
        self._settings.keep("letters/size", self.height_field.value())
        super().accept()

    def _show(self, *_: object) -> None:
        text = self.text.toPlainText()[:MOST_CHARACTERS]
        self.outlines = letter_outlines(text, self.chosen_font(), self.height_field.value(), self._middle)
        self.preview.show_outlines(self.outlines)
        vertices = sum(map(len, self.outlines))
        self.count.setText(f"outlines {len(self.outlines)}, vertices {vertices}")
        self.buttons.button(QDialogButtonBox.StandardButton.Ok).setEnabled(bool(self.outlines))


class _Preview(QWidget):
    """The letters, as large as there is room."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self._outlines: list[FloatArray] = []
        self.setMinimumHeight(170)

    def sizeHint(self) -> QSize:
        return QSize(420, 190)

    def show_outlines(self, outlines: list[FloatArray]) -> None:
        self._outlines = outlines
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(self._theme.color("line"))
        painter.setBrush(self._theme.color("stage"))
        painter.drawRoundedRect(self.rect().adjusted(0, 0, -1, -1), 6, 6)
        if not self._outlines:
            painter.setPen(self._theme.color("muted"))
            painter.drawText(self.rect(), int(Qt.AlignmentFlag.AlignCenter), "Nothing to draw in this text")
            return
        every = np.concatenate(self._outlines)
        low, high = every.min(axis=0), every.max(axis=0)
        room = np.array([self.width(), self.height()]) - 2 * MARGIN
        scale = float((room / np.maximum(high - low, 1e-9)).min())
        middle = (low + high) / 2
        transform = QTransform(
            scale, 0, 0, scale, self.width() / 2 - scale * middle[0], self.height() / 2 - scale * middle[1]
        )
        paint_outlines(
            painter,
            [(o, True) for o in self._outlines],
            fill=self._theme.color("accent", 0.25),
            stroke=self._theme.color("accent"),
            width=1.5 * self.devicePixelRatioF(),
            transform=transform,
        )
