"""The fields of the export dialog: from a person's choices to the settings of an export, and presets."""

from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import (
    QCheckBox,
    QComboBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QWidget,
)

from app.export.formats import FORMATS
from app.export.presets import BACKGROUNDS, Preset, rate_of
from app.export.settings import PATTERN, ExportSettings, fitting_size
from app.panels.parts import label, number_field
from core.model.document import LARGEST_STAGE, LONGEST, Document

ALL, EACH = "all", "each"
SHORT = 80


class ExportFields(QWidget):
    """Where to, in which format, how it looks, what the files are called; `changed` whenever one is touched."""

    changed = Signal()

    def __init__(self, document: Document, name: str, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._document, self._own_name = document, name
        self._form = QFormLayout(self)
        self._form.setContentsMargins(0, 0, 0, 0)
        self._form.setSpacing(10)
        self._make(folder)
        self._lay_out()
        self.show_document(document)
        self.first.setValue(1)
        self.last.setValue(document.length)
        self.apply(Preset())
        self._connect()

    # making them

    def _make(self, folder: Path) -> None:
        told = self._on_changed
        self.format = QComboBox()
        for form in FORMATS.values():
            self.format.addItem(form.label, form.id)
        self.place = QLineEdit(str(folder / f"{self._own_name} frames"))
        self.choose = QPushButton("Choose…")
        self.choose.setAutoDefault(False)
        self.name = QLineEdit(self._own_name)
        self.wide = number_field(1, LARGEST_STAGE, "Width of the pictures in px", told, SHORT)
        self.high = number_field(1, LARGEST_STAGE, "Height of the pictures in px", told, SHORT)
        self.first = number_field(1, LONGEST, "First frame", told, SHORT)
        self.last = number_field(1, LONGEST, "Last frame", told, SHORT)
        self.rate = QLineEdit()
        self.rate.setFixedWidth(SHORT)
        self.rate.setToolTip("Pictures a second; the film lasts as long as before")
        self.background = QComboBox()
        for value, text in BACKGROUNDS.items():
            self.background.addItem(text, value)
        self.layers = QComboBox()
        self.layers.setToolTip("Every layer on its own becomes a file or sequence with its name")
        self._make_frame_fields()

    def _make_frame_fields(self) -> None:
        self.depth = QComboBox()
        for bits in (8, 16):
            self.depth.addItem(f"{bits} bits", bits)
        self.depth.setToolTip("Bits a channel of PNG")
        self.pattern = QLineEdit()
        self.pattern.setPlaceholderText(PATTERN)
        self.pattern.setToolTip("Of {name} {layer} {frame} {drawing} {separator}; empty: the usual one")
        self.separator = QLineEdit(".")
        self.separator.setFixedWidth(40)
        self.padding = number_field(1, 9, "Least number of digits", self._on_changed, 56)
        self.padding.setValue(4)
        self.number = number_field(-1, 10**8, "Number of the first file", self._on_changed, 90)
        self.number.setSpecialValueText("frame")
        self.number.setValue(-1)
        self.exposures = QCheckBox("each drawing once")
        self.exposures.setToolTip("A drawing that is held is written where it begins, and not again")
        self.chart = QCheckBox("timing chart")
        self.chart.setToolTip("Print the timing chart of the span beside the drawing")

    def _lay_out(self) -> None:
        form = self._form
        form.addRow("Format", row(self.format, self.depth, stretch=True))
        form.addRow("Folder", row(self.place, self.choose))
        form.addRow("Name", self.name)
        form.addRow("Size", row(self.wide, label("x", "muted"), self.high, label("px", "muted"), stretch=True))
        form.addRow("Frames", row(self.first, label("to", "muted"), self.last, stretch=True))
        form.addRow("Frame rate", row(self.rate, label("a second", "muted"), stretch=True))
        form.addRow("Background", row(self.background, stretch=True))
        form.addRow("Layers", row(self.layers, stretch=True))
        names = row(
            label("separator", "muted"),
            self.separator,
            label("digits", "muted"),
            self.padding,
            label("from", "muted"),
            self.number,
            stretch=True,
        )
        form.addRow("Numbers", names)
        form.addRow("Pattern", self.pattern)
        form.addRow("", row(self.exposures, self.chart, stretch=True))
        self._of_frames = (names, self.pattern, self.exposures.parentWidget())

    def _connect(self) -> None:
        for text in (self.place, self.name, self.rate, self.pattern, self.separator):
            text.textChanged.connect(self._on_changed)
        for box in (self.background, self.layers, self.depth):
            box.currentIndexChanged.connect(self._on_changed)
        for check in (self.exposures, self.chart):
            check.toggled.connect(self._on_changed)
        self.format.currentIndexChanged.connect(self._on_format)
        self.choose.clicked.connect(self._browse)

    def _on_changed(self, *_: object) -> None:
        self.changed.emit()

    # what is chosen

    def show_document(self, document: Document) -> None:
        """Offer the layers of the document as it is now."""
        self._document = document
        self.rate.setPlaceholderText(str(document.rate))
        kept = self.layers.currentData()
        self.layers.blockSignals(True)
        self.layers.clear()
        self.layers.addItem("All together", ALL)
        self.layers.addItem("Each on its own", EACH)
        for layer in document.layers:
            self.layers.addItem(f"Only {layer.name}"[:60], layer.id)
        self.layers.setCurrentIndex(max(0, self.layers.findData(kept)))
        self.layers.blockSignals(False)

    def settings(self) -> ExportSettings:
        """Return what the fields say; raises InkbetweenError if it makes no sense."""
        form = FORMATS[self.format.currentData()]
        layers, background = self.layers.currentData(), self.background.currentData()
        made = ExportSettings(
            Path(self.place.text()).expanduser(),
            self.name.text(),
            self.first.value(),
            self.last.value(),
            (self.wide.value(), self.high.value()),
            form.id,
            background=None if background == "none" else background,
            rate=rate_of(self.rate.text()),
            layers=None if layers in (ALL, EACH) else (layers,),
            each_layer=layers == EACH,
        )
        return self._with_names(made) if form.frames else made

    def _with_names(self, settings: ExportSettings) -> ExportSettings:
        return replace(
            settings,
            padding=self.padding.value(),
            separator=self.separator.text(),
            pattern=self.pattern.text(),
            number=None if self.number.value() < 0 else self.number.value(),
            depth=self.depth.currentData() if settings.format == "png" else 8,
            exposures=self.exposures.isChecked(),
            chart=self.chart.isChecked(),
        )

    def preset(self) -> Preset:
        """Return what of the fields a preset keeps."""
        return Preset(
            self.format.currentData(),
            round(self.wide.value() / self._document.stage.width, 4),
            self.rate.text(),
            self.background.currentData(),
            self.depth.currentData(),
            self.exposures.isChecked(),
            self.chart.isChecked(),
            self.layers.currentData() == EACH,
        )

    def apply(self, preset: Preset) -> None:
        """Show a preset; the place, the names and the frames stay."""
        self.format.setCurrentIndex(self.format.findData(preset.format))
        width, height = fitting_size(self._document, preset.format, preset.scale)
        self.wide.setValue(width)
        self.high.setValue(height)
        self.rate.setText(preset.rate)
        self.background.setCurrentIndex(self.background.findData(preset.background))
        self.depth.setCurrentIndex(self.depth.findData(preset.depth))
        self.exposures.setChecked(preset.exposures)
        self.chart.setChecked(preset.chart)
        if preset.each_layer or self.layers.currentData() == EACH:
            self.layers.setCurrentIndex(self.layers.findData(EACH if preset.each_layer else ALL))
        self._on_format()

    def _on_format(self, *_: object) -> None:
        """Show the fields that the format has, and give the place its ending."""
        form = FORMATS[self.format.currentData()]
        for widget in self._of_frames:
            self._form.setRowVisible(widget, form.frames)
        self._form.setRowVisible(self.name, not form.moving)
        self.depth.setVisible(form.deep)
        self.rate.setEnabled(form.frames or form.moving or form.id == "sprites")
        if not self.rate.isEnabled():
            self.rate.clear()
        at = self._form.labelForField(self.place.parentWidget())
        at.setText("Folder" if form.folder else "File")
        self.place.setText(str(self._place_for(form.id)))
        if form.even:
            for side in (self.wide, self.high):
                side.setValue(side.value() + side.value() % 2)
        self.changed.emit()

    def _place_for(self, form: str) -> Path:
        folder = Path(self.place.text()).parent
        if FORMATS[form].frames:
            return folder / f"{self._own_name} frames"
        return folder / f"{self._own_name}{FORMATS[form].ending or '.oca'}"

    def _browse(self) -> None:
        form = FORMATS[self.format.currentData()]
        if form.frames:
            found = QFileDialog.getExistingDirectory(self, "Folder for the frames", self.place.text())
        else:
            kinds = f"{form.label} (*{form.ending or '.oca'})"
            options = QFileDialog.Option.DontConfirmOverwrite  # it is asked for when the export begins
            found, _ = QFileDialog.getSaveFileName(self, "Export", self.place.text(), kinds, options=options)
        if found:
            self.place.setText(found)


def row(*widgets: QWidget, stretch: bool = False) -> QWidget:
    """Return widgets beside each other."""
    made = QWidget()
    box = QHBoxLayout(made)
    box.setContentsMargins(0, 0, 0, 0)
    for widget in widgets:
        box.addWidget(widget)
    if stretch:
        box.addStretch(1)
    return made
