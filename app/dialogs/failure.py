"""The one dialog that says that the program made a mistake, with a report to copy."""

from PySide6.QtGui import QFontDatabase, QGuiApplication
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QPlainTextEdit, QPushButton, QVBoxLayout, QWidget

from app.panels.parts import label


class FailureDialog(QDialog):
    """Stays open beside later failures: they are added to its report."""

    def __init__(self, report: str, kept: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Inkbetween Made a Mistake")
        self.setMinimumSize(620, 400)
        column = QVBoxLayout(self)
        column.setContentsMargins(20, 20, 20, 16)
        column.setSpacing(12)
        self.text = label(_sentence(kept))
        self.text.setWordWrap(True)
        column.addWidget(self.text)
        self.report = QPlainTextEdit(report)
        self.report.setReadOnly(True)
        self.report.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.report.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        column.addWidget(self.report, 1)
        buttons = QDialogButtonBox()
        self.copy_button = QPushButton("Copy Report")
        self.copy_button.clicked.connect(self._copy)
        self.go_on_button = QPushButton("Go On")
        self.go_on_button.setDefault(True)
        buttons.addButton(self.copy_button, QDialogButtonBox.ButtonRole.ActionRole)
        buttons.addButton(self.go_on_button, QDialogButtonBox.ButtonRole.AcceptRole)
        buttons.accepted.connect(self.accept)
        column.addWidget(buttons)

    def add(self, report: str) -> None:
        """Add another failure to the report."""
        self.report.appendPlainText(f"\n\n{report}")

    def _copy(self) -> None:
        QGuiApplication.clipboard().setText(self.report.toPlainText())
        self.copy_button.setText("Copied")


def _sentence(kept: str) -> str:
    safe = (
        f"Your drawing as it is now was copied to {kept}."
        if kept
        else "A copy of your drawing could not be written: save it now, under another name."
    )
    return (
        f"Something in the program went wrong. {safe} You can go on, but save soon, and start Inkbetween again if "
        "it behaves strangely. The report says what happened; it holds nothing of your drawing."
    )
