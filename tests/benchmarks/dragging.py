"""What a person waits for while a vertex is dragged: solve, paths and paint of one frame of the real canvas.

Every step is a real mouse move on the canvas at 1280 x 720, painted at once. Beside it, in the same run, QPainter
alone: the very picture of that frame, recorded once and played back on an image.

Run from the root: python tests/benchmarks/dragging.py
"""

import os
import statistics
import tempfile
import time
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np
from PySide6.QtCore import QEvent, QPoint, QPointF, QSettings, Qt
from PySide6.QtGui import QImage, QMouseEvent, QPainter, QPicture
from PySide6.QtWidgets import QApplication

from app.bootstrap import Editor, make_application
from app.settings import Settings
from core.model.document import Document
from core.model.edits import add_outline

STEPS = 60


def wavy_limb(count, bend):
    """Return a smooth limb of `count` vertices, bent by an angle."""
    u = np.linspace(0, 2 * np.pi, count, endpoint=False)
    x, y = 560 * np.cos(u), (120 + 24 * np.cos(9 * u)) * np.sin(u)
    turn = bend * np.clip(x / 560, 0, 1)
    return np.column_stack([960 + x * np.cos(turn) - y * np.sin(turn), 540 + x * np.sin(turn) + y * np.cos(turn)])


def open_editor(count):
    """Return an editor that shows two keyframes of `count` vertices on a canvas of 1280 x 720."""
    folder = Path(tempfile.mkdtemp())
    editor = Editor(Settings(QSettings(str(folder / "settings.ini"), QSettings.Format.IniFormat)))
    document = Document()
    for frame, bend in ((1, 0.0), (24, -1.2)):
        document = add_outline(document, 1, frame, wavy_limb(count, bend))
    editor.session.new(document)
    editor.session.go_to(12)
    window = editor.window
    window.show()
    window.resize(1280 + window.width() - window.canvas.width(), 720 + window.height() - window.canvas.height())
    QApplication.processEvents()
    return editor


def send(widget, kind, at, button):
    """Send one mouse event."""
    held = Qt.MouseButton.NoButton if kind == QEvent.Type.MouseButtonRelease else Qt.MouseButton.LeftButton
    where = QPointF(widget.mapToGlobal(at.toPoint()))
    QApplication.sendEvent(widget, QMouseEvent(kind, at, where, button, held, Qt.KeyboardModifier.NoModifier))


def drag_times(editor):
    """Return the milliseconds of every step of one drag, from the mouse move to the painted canvas."""
    canvas = editor.window.canvas
    pad = canvas.viewport()
    vertex = editor.session.layer.keyframe_at(1).drawing.outlines[0].points[0]
    start = canvas.camera.transform().map(QPointF(*vertex))
    send(pad, QEvent.Type.MouseButtonPress, start, Qt.MouseButton.LeftButton)
    times = []
    for i in range(1, STEPS + 1):
        began = time.perf_counter()
        send(pad, QEvent.Type.MouseMove, start + QPointF(0.7 * i, 0.4 * i), Qt.MouseButton.NoButton)
        pad.repaint()
        times.append(1000 * (time.perf_counter() - began))
    return times[5:]


def playback_time(editor):
    """Return the milliseconds that QPainter alone needs for the picture that is on the canvas."""
    canvas = editor.window.canvas
    record = QPicture()
    painter = QPainter(record)
    canvas.viewport().render(painter, QPoint())
    painter.end()
    image = QImage(canvas.viewport().size(), QImage.Format.Format_RGB32)
    times = []
    for _ in range(40):
        began = time.perf_counter()
        painter = QPainter(image)
        painter.drawPicture(0, 0, record)
        painter.end()
        times.append(1000 * (time.perf_counter() - began))
    return statistics.median(times)


def main():
    """Print every figure."""
    app = make_application()
    for count, most, limit in ((1000, 1.5, 16), (10_000, 2.0, 33)):
        editor = open_editor(count)
        times = drag_times(editor)
        alone = playback_time(editor)
        median, worst = statistics.median(times), max(times)
        size = editor.window.canvas.viewport().size()
        print(
            f"{count} vertices at {size.width()} x {size.height()}: a step {median:.1f} ms (worst {worst:.1f}), "
            f"QPainter alone {alone:.1f} ms, {median / alone:.2f} times (goal {most}, under {limit} ms)"
        )
        editor.preview.stop()
        editor.files.may_leave = lambda: True
        editor.window.close()
    app.quit()


if __name__ == "__main__":
    main()
