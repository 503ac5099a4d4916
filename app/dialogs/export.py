"""File > Export Frames: where to, how large, which frames; then a progress bar that can be cancelled."""

from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import (
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QFileDialog,
    QFormLayout,
    QHBoxLayout,
    QLineEdit,
    QMessageBox,
    QProgressBar,
    QPushButton,
    QWidget,
)

from app.dialogs.job import Job
from app.export.frames import Exported, ExportSettings, export_frames, frame_path
from app.panels.parts import label, number_field
from core.errors import InkbetweenError
from core.model.document import LARGEST_STAGE, Document


class ExportJob(Job):
    """One export; it ends with an Exported."""

    progressed = Signal(int, int)
    name, trouble = "export", "the export stopped"

    def __init__(self, document: Document, settings: ExportSettings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document, self._settings = document, settings

    def work(self) -> Exported:
        return export_frames(
            self._document, self._settings, progress=self.progressed.emit, cancelled=self._cancel.is_set
        )


class ExportDialog(QDialog):
    """Modeless: drawing can go on while frames are written; the export has the document of its start."""

    told = Signal(str, str)

    def __init__(self, document: Document, name: str, folder: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Export Frames")
        self.setMinimumWidth(460)
        self._document = document
        self._job: ExportJob | None = None
        self._make_fields(name, folder)
        self._lay_out()
        self._fill()

    def _make_fields(self, name: str, folder: Path) -> None:
        last = self._document.length
        self.folder = QLineEdit(str(folder))
        self.name = QLineEdit(name)
        self.wide = number_field(1, LARGEST_STAGE, "Width of the pictures in px", self._show_example, 80)
        self.high = number_field(1, LARGEST_STAGE, "Height of the pictures in px", self._show_example, 80)
        self.first = number_field(1, last, "First frame", self._show_example, 80)
        self.last = number_field(1, last, "Last frame", self._show_example, 80)
        self.transparent = QCheckBox("transparent background")
        self.example = label("", "muted")
        self.example.setWordWrap(True)
        self.bar = QProgressBar()
        self.bar.setVisible(False)

    def _fill(self) -> None:
        """Begin with every frame, as large as the stage."""
        stage = self._document.stage
        self.wide.setValue(stage.width)
        self.high.setValue(stage.height)
        self.last.setValue(self._document.length)
        self.transparent.setChecked(stage.background is None)
        self.name.textChanged.connect(self._show_example)
        self.folder.textChanged.connect(self._show_example)
        self._show_example()

    def _lay_out(self) -> None:
        form = QFormLayout(self)
        form.setContentsMargins(20, 20, 20, 16)
        form.setSpacing(12)
        browse = QPushButton("Choose…")
        browse.setAutoDefault(False)
        browse.clicked.connect(self._browse)
        form.addRow("Folder", _row(self.folder, browse))
        form.addRow("Name", self.name)
        form.addRow("Size", _row(self.wide, label("x", "muted"), self.high, label("px", "muted"), stretch=True))
        form.addRow("Frames", _row(self.first, label("to", "muted"), self.last, stretch=True))
        form.addRow("", self.transparent)
        form.addRow("", self.example)
        form.addRow(self.bar)
        button = QDialogButtonBox.StandardButton
        self.buttons = QDialogButtonBox(button.Cancel)
        self.start_button = self.buttons.addButton("Export", QDialogButtonBox.ButtonRole.AcceptRole)
        self.start_button.setDefault(True)
        self.start_button.clicked.connect(self._start)
        self.buttons.rejected.connect(self._cancel_or_close)
        form.addRow(self.buttons)
        self._fields = (
            self.folder,
            browse,
            self.name,
            self.wide,
            self.high,
            self.first,
            self.last,
            self.transparent,
        )

    @property
    def job(self) -> ExportJob | None:
        """The export under way."""
        return self._job

    def settings(self) -> ExportSettings:
        """Return what the fields say; raises InkbetweenError if it makes no sense."""
        stage_color = self._document.stage.background
        return ExportSettings(
            folder=Path(self.folder.text()).expanduser(),
            name=self.name.text(),
            first=self.first.value(),
            last=self.last.value(),
            size=(self.wide.value(), self.high.value()),
            background=None if self.transparent.isChecked() else (stage_color or "#ffffff"),
        )

    def _show_example(self, *_: object) -> None:
        try:
            settings = self.settings()
        except InkbetweenError as e:
            self.example.setText(str(e))
            self.start_button.setEnabled(False)
            return
        self.start_button.setEnabled(True)
        first, last = (frame_path(settings, f).name for f in (settings.first, settings.last))
        self.example.setText(f"{first} to {last}" if first != last else first)

    def _browse(self) -> None:
        name = QFileDialog.getExistingDirectory(self, "Folder for the frames", self.folder.text())
        if name:
            self.folder.setText(name)

    def _start(self) -> None:
        settings = self.settings()
        frames = range(settings.first, settings.last + 1)
        there = [p for p in (frame_path(settings, f) for f in frames) if p.exists()]
        if there and not self._may_overwrite(len(there), settings.folder):
            return
        for field in self._fields:
            field.setEnabled(False)
        self.start_button.setEnabled(False)
        self.bar.setRange(0, len(frames))
        self.bar.setFormat("%v of %m frames")
        self.bar.setVisible(True)
        self._job = ExportJob(self._document, settings, self)
        self._job.progressed.connect(self._on_progressed)
        self._job.finished.connect(self._on_finished)
        self._job.start()

    def _may_overwrite(self, count: int, folder: Path) -> bool:
        what = "One frame" if count == 1 else f"{count} frames"
        answer = QMessageBox.question(
            self, "Export Frames", f"{what} of these names are in {folder} already. Replace them?"
        )
        return answer == QMessageBox.StandardButton.Yes

    def _on_progressed(self, done: int, total: int) -> None:
        self.bar.setMaximum(total)
        self.bar.setValue(done)

    def _on_finished(self, result: object) -> None:
        self._job = None
        if isinstance(result, Exported) and not result.cancelled:
            self.told.emit(f"{len(result.files)} frames are in {result.files[0].parent}", "info")
            self.accept()
            return
        if isinstance(result, Exported):
            self.told.emit(f"Export cancelled; {len(result.files)} frames were finished and stay.", "info")
        else:
            self.told.emit(str(result), "error")
            self.example.setText(str(result))
        self.bar.setVisible(False)
        for field in self._fields:
            field.setEnabled(True)
        self.start_button.setEnabled(True)

    def _cancel_or_close(self) -> None:
        if self._job is not None:
            self._job.cancel()
        else:
            self.reject()

    def closeEvent(self, event: QCloseEvent) -> None:
        if self._job is not None:
            self._job.cancel()
            self._job.wait()
        super().closeEvent(event)


def _row(*widgets: QWidget, stretch: bool = False) -> QWidget:
    row = QWidget()
    box = QHBoxLayout(row)
    box.setContentsMargins(0, 0, 0, 0)
    for widget in widgets:
        box.addWidget(widget)
    if stretch:
        box.addStretch(1)
    return row
