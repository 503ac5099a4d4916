"""What the help menu shows."""

from collections.abc import Iterable
from importlib.metadata import version

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QMessageBox, QWidget

from app.actions import ACTIONS, ActionSpec
from app.canvas.tool import Tool

KEY_NAMES = {",": ", (comma)", ".": ". (point)", "Ctrl+,": "Ctrl + comma", "Ctrl+.": "Ctrl + point"}


def show_keys(parent: QWidget, tools: Iterable[Tool]) -> None:
    """List every tool's hint and every key."""
    hints = "".join(f"<p><b>{t.name} ({t.shortcut})</b><br>{t.hint.split(': ', 1)[1]}</p>" for t in tools)
    rows = [_row(spec) for spec in ACTIONS if spec.keys]
    half = (len(rows) + 1) // 2
    columns = "".join(f"<td><table>{''.join(part)}</table></td>" for part in (rows[:half], rows[half:]))
    canvas = "<p>Canvas: Space + drag or the middle button pans, the wheel zooms at the pointer.</p>"
    _show(parent, "Keys and Mouse", f"{hints}{canvas}<table cellspacing='16'><tr>{columns}</tr></table>")


def show_about(parent: QWidget) -> None:
    """Say what this is."""
    _show(
        parent,
        "About Inkbetween",
        f"<p><b>Inkbetween {version('inkbetween')}</b></p>"
        "<p>Draw keyframes, say which point goes where, see every in-between at once.</p>"
        "<p>MIT licence. Made with Qt for Python, NumPy, SciPy and pyqtgraph.</p>",
    )


def _row(spec: ActionSpec) -> str:
    keys = " or ".join(KEY_NAMES.get(k, k) for k in spec.keys)
    return f"<tr><td><b>{keys}</b>&nbsp;&nbsp;</td><td>{spec.text.rstrip('…')}</td></tr>"


def _show(parent: QWidget, title: str, text: str) -> None:
    box = QMessageBox(parent)
    box.setWindowTitle(title)
    box.setTextFormat(Qt.TextFormat.RichText)
    box.setText(text)
    box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    box.open()
