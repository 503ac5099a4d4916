"""Size and colour of the paper."""

from PySide6.QtCore import QSize
from PySide6.QtGui import QColor
from PySide6.QtWidgets import (
    QCheckBox,
    QColorDialog,
    QDialog,
    QDialogButtonBox,
    QFormLayout,
    QHBoxLayout,
    QToolButton,
    QWidget,
)

from app.painting import to_qcolor
from app.panels.drawing import color_text
from app.panels.parts import number_field, swatch_icon
from app.theme import Theme
from core.model.document import LARGEST_STAGE, Stage


class StageDialog(QDialog):
    """`stage` is what was chosen, once the dialog was accepted."""

    def __init__(self, stage: Stage, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Stage")
        self._theme = theme
        self._color = stage.background
        self.wide = number_field(1, LARGEST_STAGE, "Width in px", lambda _: None, 90)
        self.high = number_field(1, LARGEST_STAGE, "Height in px", lambda _: None, 90)
        self.wide.setValue(stage.width)
        self.high.setValue(stage.height)
        form = QFormLayout(self)
        form.setContentsMargins(20, 20, 20, 16)
        form.setSpacing(12)
        form.addRow("Width", self.wide)
        form.addRow("Height", self.high)
        form.addRow("Background", self._background_row())
        button = QDialogButtonBox.StandardButton
        buttons = QDialogButtonBox(button.Ok | button.Cancel)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        form.addRow(buttons)

    @property
    def stage(self) -> Stage:
        return Stage(self.wide.value(), self.high.value(), self._color if self.painted.isChecked() else None)

    def _background_row(self) -> QWidget:
        row = QWidget()
        box = QHBoxLayout(row)
        box.setContentsMargins(0, 0, 0, 0)
        self.painted = QCheckBox("painted")
        self.painted.setToolTip("Off: exported frames are transparent")
        self.painted.setChecked(self._color is not None)
        self.swatch = QToolButton()
        self.swatch.setProperty("swatch", True)
        self.swatch.setIconSize(QSize(18, 18))
        self.swatch.setToolTip("Choose the colour of the background")
        self.swatch.clicked.connect(self._choose)
        self._color = self._color or "#ffffff"
        self._show_color()
        box.addWidget(self.painted)
        box.addWidget(self.swatch)
        box.addStretch(1)
        return row

    def _show_color(self) -> None:
        self.swatch.setIcon(swatch_icon(to_qcolor(self._color), self._theme.color("muted")))

    def _choose(self) -> None:
        color = QColorDialog.getColor(QColor(to_qcolor(self._color)), self, "Colour of the background")
        if color.isValid():
            self._color = color_text(color)
            self.painted.setChecked(True)
            self._show_color()
