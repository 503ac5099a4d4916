"""What the help menu shows."""

from importlib.metadata import version

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMessageBox, QWidget


def show_about(parent: QWidget) -> None:
    """Say what this is."""
    _show(
        parent,
        "About Inkbetween",
        f"<p><b>Inkbetween {version('inkbetween')}</b></p>"
        "<p>Draw keyframes, say which point goes where, see every in-between at once.</p>"
        "<p>MIT licence. Made with Qt for Python, NumPy, SciPy and pyqtgraph.</p>",
    )


def _show(parent: QWidget, title: str, text: str) -> None:
    box = QMessageBox(parent)
    box.setWindowTitle(title)
    box.setTextFormat(Qt.TextFormat.RichText)
    box.setText(text)
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.open()
