"""What a person waits for while a vertex is dragged: solve, paths and paint of one frame of the real canvas.

Every step is a real mouse move on the canvas at 1280 x 720, painted at once. Beside it, in the same run, QPainter
alone: the outlines of that frame with the same pens on an image, their paths made beforehand; every vertex of the
1,000, and at most one in 1.5 px of the 10,000.

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
from PySide6.QtCore import QEvent, QPointF, QSettings, Qt
from PySide6.QtGui import QImage, QMouseEvent, QPainter, QPainterPath, QPen, QPolygonF
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
    while window.canvas.content is None or not editor.preview.settled:
        QApplication.processEvents()  # until the worker has matched the outlines
        time.sleep(0.01)
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


def anchor_times(editor):
    """Return the milliseconds of every step of an anchor's end that is dragged along its outline."""
    editor.window.choose_tool("tool.correspond")
    canvas = editor.window.canvas
    pad, transform = canvas.viewport(), canvas.camera.transform()
    before, after = (editor.session.layer.keyframe_at(f).drawing.outlines[0].points for f in (1, 24))
    send(pad, QEvent.Type.MouseButtonPress, transform.map(QPointF(*before[250])), Qt.MouseButton.LeftButton)
    times = []
    for i in range(240, 240 + STEPS):
        began = time.perf_counter()
        send(pad, QEvent.Type.MouseMove, transform.map(QPointF(*after[i])), Qt.MouseButton.NoButton)
        pad.repaint()
        times.append(1000 * (time.perf_counter() - began))
    send(pad, QEvent.Type.MouseButtonRelease, transform.map(QPointF(*after[i])), Qt.MouseButton.LeftButton)
    assert editor.session.layer.keyframe_at(1).span.pairs, "no anchor was made"
    return times[5:]


def plain_time(editor, *, decimated):
    """Return the milliseconds that QPainter alone needs for the picture on the canvas, paths made beforehand.

    Every vertex is drawn, or, `decimated`, at most one in 1.5 px. Pens and colours are those of the canvas.
    """
    canvas = editor.window.canvas
    content, transform, theme = canvas.content, canvas.camera.transform(), canvas.theme
    lines = [(s.outlines, QPen(theme.color("onion_before", s.strength), 1.0), None) for s in content.onion]
    shape = content.picture.outlines
    lines.append((shape, QPen(theme.color("inbetween"), 2.2), theme.color("accent", 0.16)))
    for side in ("before", "after"):
        outlines = [(o.points, True) for o in content.editable(side).drawing.outlines]
        lines.append((outlines, QPen(theme.color(side), 1.8), None))
    parts = [(plain_path(outlines, transform, decimated), pen, fill) for outlines, pen, fill in lines]
    image = QImage(canvas.viewport().size(), QImage.Format.Format_RGB32)
    times = []
    for _ in range(40):
        began = time.perf_counter()
        painter = QPainter(image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        image.fill(0)
        for path, pen, fill in parts:
            if fill is not None:
                painter.fillPath(path, fill)
            painter.strokePath(path, pen)
        painter.end()
        times.append(1000 * (time.perf_counter() - began))
    return statistics.median(times)


def plain_path(outlines, transform, decimated):
    """Return a closed path through all vertices, or through one in 1.5 px."""
    path = QPainterPath()
    for points, _ in outlines:
        p = transform.m11() * points + (transform.dx(), transform.dy())
        if decimated:
            along = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(p, axis=0).T))])
            p = p[np.diff(np.floor(along / 1.5), prepend=-1) > 0]
        path.addPolygon(QPolygonF([QPointF(x, y) for x, y in p]))
        path.closeSubpath()
    return path


def main():
    """Print every figure."""
    app = make_application()
    for count, most, limit in ((1000, 1.5, 16), (10_000, 2.0, 33)):
        editor = open_editor(count)
        times = drag_times(editor)
        alone = plain_time(editor, decimated=count > 1000)
        median, worst = statistics.median(times), max(times)
        size = editor.window.canvas.viewport().size()
        print(
            f"{count} vertices at {size.width()} x {size.height()}: a step {median:.1f} ms (worst {worst:.1f}), "
            f"QPainter alone {alone:.1f} ms, {median / alone:.2f} times (goal {most}, under {limit} ms)"
        )
        if count == 1000:
            end = editor.window.canvas.viewport()
            send(end, QEvent.Type.MouseButtonRelease, QPointF(0, 0), Qt.MouseButton.LeftButton)
            print(
                f"an anchor of {count} vertices: a step {statistics.median(anchor_times(editor)):.1f} ms (goal 33)"
            )
        editor.preview.stop()
        editor.ranked.stop()
        editor.files.may_leave = lambda: True
        editor.window.close()
    app.quit()


if __name__ == "__main__":
    main()
