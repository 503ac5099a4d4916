"""Reading a file or folder beside the window, with a bar and Cancel when it takes a while."""

from pathlib import Path

from PySide6.QtCore import QObject, Qt, QTimer, Signal
from PySide6.QtGui import QCloseEvent
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QProgressBar, QVBoxLayout, QWidget

from app.dialogs.job import Job
from app.panels.parts import label

BIG_FILE = 1_000_000
PATIENCE_MS = 400
"""A smaller file shows the bar only if it takes longer than this."""

STEPS = 1000


class ImportJob(Job):
    """One file or folder read; it ends with an Imported, or with an ImportedFilm where there are keyframes."""

    progressed = Signal(float)
    name = "import"

    def __init__(self, path: Path, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.path = path
        self.trouble = f"cannot import {path.name}"

    def work(self) -> object:
        from core.io.lottie import read_lottie
        from core.io.svg import read_svg
        from core.io.svg_folder import read_svg_folder

        told, asked = self.progressed.emit, self._cancel.is_set
        if self.path.is_dir():
            return read_svg_folder(self.path, progress=told, cancelled=asked)
        if self.path.suffix.lower() == ".json":
            return read_lottie(self.path)
        return read_svg(self.path, tolerance=None, progress=told, cancelled=asked)


class ImportDialog(QDialog):
    """`told` once, after which it is gone; the window waits behind it, yet paints and can cancel."""

    told = Signal(object)

    def __init__(self, path: Path, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Import")
        self.setWindowModality(Qt.WindowModality.WindowModal)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setMinimumWidth(380)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 16)
        column.setSpacing(12)
        column.addWidget(label(f"Reading {path.name}"))
        self.bar = QProgressBar()
        self.bar.setRange(0, STEPS)
        column.addWidget(self.bar)
        self.buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
        self.buttons.rejected.connect(self.cancel)
        column.addWidget(self.buttons)
        self.job = ImportJob(path, self)
        self.job.progressed.connect(lambda share: self.bar.setValue(round(share * STEPS)))
        self.job.finished.connect(self._on_finished)
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.timeout.connect(self.show)

    def start(self) -> None:
        """Begin to read; the dialog shows itself when there is something to wait for."""
        self.job.start()
        try:
            big = self.job.path.stat().st_size > BIG_FILE
        except OSError:
            big = False
        if big:
            self.show()
        else:
            self._patience.start(PATIENCE_MS)

    def cancel(self) -> None:
        """Ask the job to stop; it ends within a moment."""
        self.job.cancel()

    def stop(self) -> None:
        """Stop now and tell nobody: the window is closing."""
        self.job.finished.disconnect(self._on_finished)
        self.job.cancel()
        self.job.wait()
        self._finish()

    def reject(self) -> None:
        self.cancel()

    def closeEvent(self, event: QCloseEvent) -> None:
        self.cancel()
        event.ignore()

    def _on_finished(self, result: object) -> None:
        self.job.wait()
        self._finish()
        self.told.emit(result)

    def _finish(self) -> None:
        self._patience.stop()
        self.hide()
        self.deleteLater()
