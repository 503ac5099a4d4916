"""File > Export: presets, what is to be made and where, then a bar with the time that is left, and Cancel."""

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDialogButtonBox,
    QMessageBox,
    QProgressBar,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from app.dialogs.export_fields import ExportFields, row
from app.dialogs.job import Job
from app.export.estimate import estimate, told_size
from app.export.export import Exported, export, output_files
from app.export.film import check_frames, count_pictures
from app.export.formats import FORMATS
from app.export.names import frame_path
from app.export.presets import PRESETS, Preset, kept_presets, presets_text
from app.export.settings import ExportSettings
from app.export.whole import InTheWayError
from app.panels.parts import label
from app.settings import Settings
from core.errors import InkbetweenError
from core.model.document import Document

KEPT = "export/presets"
CUSTOM = "Own settings"
REST_MS = 250
"""The size is estimated when the hand rests."""
PATIENCE = 0.5


class ExportJob(Job):
    """One export; it ends with an Exported."""

    progressed = Signal(int, int)
    name, trouble = "export", "the export stopped"

    def __init__(self, document: Document, settings: ExportSettings, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._document, self._settings = document, settings

    def work(self) -> Exported:
        return export(self._document, self._settings, progress=self.progressed.emit, cancelled=self._cancel.is_set)


class ExportDialog(QDialog):
    """Modeless: drawing goes on while files are written; an export has the document of its start."""

    told = Signal(str, str)
    exported = Signal()

    def __init__(
        self,
        current: Callable[[], Document],
        name: str,
        folder: Path,
        store: Settings,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self.setWindowTitle("Export")
        self.setMinimumWidth(520)
        self._current, self._store = current, store
        self._job: ExportJob | None = None
        self._own = kept_presets(store.text(KEPT))
        self.fields = ExportFields(current(), name, folder)
        self._make()
        self._lay_out()
        self._show_presets(CUSTOM)
        self.fields.changed.connect(self._on_changed)
        self._on_changed()

    def _make(self) -> None:
        self.presets = QComboBox()
        self.presets.setEditable(True)
        self.presets.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.presets.setToolTip("Choose a preset; or write a name and keep these settings under it")
        self.presets.activated.connect(self._on_preset)
        self.keep = QPushButton("Keep")
        self.keep.setToolTip("Keep these settings as a preset with the name on the left")
        self.drop = QPushButton("Remove")
        self.drop.setToolTip("Forget this preset of yours")
        for button, run in ((self.keep, self._keep_preset), (self.drop, self._drop_preset)):
            button.setAutoDefault(False)
            button.clicked.connect(run)
        self.presets.editTextChanged.connect(self._show_preset_buttons)
        self.example = label("", "muted")
        self.example.setWordWrap(True)
        self.size = label("", "muted")
        self.bar = QProgressBar()
        self.bar.setVisible(False)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._show_size)

    def _lay_out(self) -> None:
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 16)
        column.setSpacing(12)
        self._preset_row = row(label("Preset"), self.presets, self.keep, self.drop)
        self._preset_row.layout().setStretch(1, 1)
        for widget in (self._preset_row, self.fields, self.example, self.size, self.bar):
            column.addWidget(widget)
        button = QDialogButtonBox.StandardButton
        self.buttons = QDialogButtonBox(button.Cancel)
        self.start_button = self.buttons.addButton("Export", QDialogButtonBox.ButtonRole.AcceptRole)
        self.start_button.setDefault(True)
        self.start_button.clicked.connect(self._start)
        self.buttons.rejected.connect(self._cancel_or_close)
        column.addWidget(self.buttons)

    @property
    def job(self) -> ExportJob | None:
        """The export under way."""
        return self._job

    # presets

    def _show_presets(self, name: str) -> None:
        self.presets.clear()
        self.presets.addItems([*PRESETS, *self._own])
        self.presets.setCurrentIndex(self.presets.findText(name))
        self.presets.setEditText(name)
        self._show_preset_buttons()

    def _preset(self, name: str) -> Preset | None:
        return self._own.get(name) or PRESETS.get(name)

    def _on_preset(self, *_: object) -> None:
        preset = self._preset(self.presets.currentText())
        if preset is not None:
            self.fields.show_document(self._current())
            self.fields.apply(preset)

    def _show_preset_buttons(self, *_: object) -> None:
        name = self.presets.currentText().strip()
        self.keep.setEnabled(name not in ("", CUSTOM) and name not in PRESETS)
        self.drop.setEnabled(name in self._own)

    def _keep_preset(self) -> None:
        name = self.presets.currentText().strip()
        try:
            self._own[name] = self.fields.preset()
        except InkbetweenError as e:
            self.told.emit(str(e), "error")
            return
        self._store.keep(KEPT, presets_text(self._own))
        self._show_presets(name)

    def _drop_preset(self) -> None:
        self._own.pop(self.presets.currentText().strip(), None)
        self._store.keep(KEPT, presets_text(self._own))
        self._show_presets(CUSTOM)

    # what will be made

    def settings(self) -> ExportSettings:
        """Return what the fields say; raises InkbetweenError if it makes no sense."""
        settings = self.fields.settings()
        check_frames(self._current(), settings)
        return settings

    def _on_changed(self) -> None:
        """Show the names at once, and the size when the hand rests."""
        self._rest.start(REST_MS)
        try:
            settings = self.settings()
        except InkbetweenError as e:
            self.example.setText(str(e))
            self.size.clear()
            self.start_button.setEnabled(False)
            return
        self.start_button.setEnabled(self._job is None)
        self.example.setText(self._names(settings))

    def _names(self, settings: ExportSettings) -> str:
        if not FORMATS[settings.format].frames:
            return settings.out.name
        layer = self._current().layers[-1].name
        count = count_pictures(settings, self._current().rate)
        first = frame_path(settings, settings.first, drawing=1, layer=layer).name
        last = frame_path(settings, settings.first + count - 1, drawing=count, layer=layer).name
        return first if first == last else f"{first} to {last}"

    def _show_size(self) -> None:
        try:
            settings, document = self.settings(), self._current()
            count = count_pictures(settings, document.rate)
            seconds = float(count / (settings.rate or document.rate))
            size = told_size(estimate(document, settings))
        except InkbetweenError:
            return
        self.size.setText(f"{count} picture{'' if count == 1 else 's'}, {seconds:.2f} s, about {size}")

    # making it

    def _start(self) -> None:
        document = self._current()
        try:
            settings = self.settings()
            there = [p for p in output_files(document, replace(settings, exposures=False)) if p.exists()]
        except InkbetweenError as e:
            self.told.emit(str(e), "error")
            return
        if there:
            answer = self._ask(there)
            if answer is None:
                return
            settings = replace(settings, replace=answer == "replace", proceed=answer == "proceed")
        self._show_working(True)
        self.bar.setRange(0, 0)
        self._began = time.monotonic()
        self._job = ExportJob(document, settings, self)
        self._job.progressed.connect(self._on_progressed)
        self._job.finished.connect(self._on_finished)
        self._job.start()

    def _ask(self, there: list[Path]) -> str | None:
        """Return whether to replace files or make the missing ones only, None for neither."""
        box = QMessageBox(self)
        box.setWindowTitle("Export")
        box.setIcon(QMessageBox.Icon.Question)
        box.setText(f"{InTheWayError(there)}. Replace?")
        replaced = box.addButton("Replace", QMessageBox.ButtonRole.DestructiveRole)
        missing = box.addButton("Make the Missing Ones", QMessageBox.ButtonRole.AcceptRole)
        box.addButton(QMessageBox.StandardButton.Cancel)
        box.setDefaultButton(missing)
        box.exec()
        return {replaced: "replace", missing: "proceed"}.get(box.clickedButton())

    def _show_working(self, on: bool) -> None:
        self.bar.setVisible(on)
        for widget in (self.fields, self._preset_row, self.start_button):
            widget.setEnabled(not on)

    def _on_progressed(self, done: int, total: int) -> None:
        self.bar.setMaximum(total)
        self.bar.setValue(done)
        spent = time.monotonic() - self._began
        left = f", {max(1, round(spent * (total - done) / done))} s left" if spent > PATIENCE else ""
        self.bar.setFormat(f"%v of %m{left}")

    def _on_finished(self, result: object) -> None:
        self._job = None
        if isinstance(result, Exported) and not result.cancelled:
            self.told.emit(_told(result), "info")
            self.exported.emit()
            self.accept()
            return
        if isinstance(result, Exported):
            count = len(result.files)
            stay = f"{count} file{'' if count == 1 else 's'} finished and stay" if count else "nothing was written"
            self.told.emit(f"Export cancelled; {stay}.", "info")
        else:
            self.told.emit(str(result), "error")
        self._show_working(False)
        self._on_changed()
        if not isinstance(result, Exported):
            self.example.setText(str(result))

    def _cancel_or_close(self) -> None:
        if self._job is not None:
            self._job.cancel()
        else:
            self.reject()

    def reject(self) -> None:
        """Escape cancels an export, or closes the dialog."""
        if self._job is not None:
            self._job.cancel()
        else:
            super().reject()

    def closeEvent(self, event: QCloseEvent) -> None:
        if self._job is not None:
            self._job.cancel()
            self._job.wait()
        super().closeEvent(event)


def _told(exported: Exported) -> str:
    files, kept = exported.files, f"; {exported.kept} were there already" if exported.kept else ""
    if not files:
        if exported.kept == 1:
            return "Nothing to do: the file was there already."
        return f"Nothing to do: all {exported.kept} files were there already."
    if len(files) == 1:
        return f"Exported {files[0].name} to {files[0].parent}{kept}"
    return f"{len(files)} frames are in {files[0].parent}{kept}"
