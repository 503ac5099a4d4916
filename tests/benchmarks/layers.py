"""A film of 20 layers x 12 keyframes x 200 vertices in the real window: scrubbing, opening, moving one keyframe.

Scrubbing is timed from the change of the playhead to the painted canvas, of 1280 x 720 px. Beside it, in the same
run: QPainter alone for the same picture, the outlines on an image with the same pens, their paths made beforehand.

Run from the root: python tests/benchmarks/layers.py
"""

import os
import statistics
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parents[2]))

import numpy as np
from PySide6.QtCore import QPointF, QSettings, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen, QPolygonF
from PySide6.QtWidgets import QApplication

from app.bootstrap import Editor, make_application
from app.painting import to_qcolor
from app.settings import Settings
from core.io.project import save
from core.model import edits
from core.model.document import Document
from core.model.drawing import Drawing, Outline, Style

LAYERS, KEYS, VERTICES, EVERY = 20, 12, 200, 6


def shape(layer, key):
    """Return an outline that grows lobes and wanders."""
    rng = np.random.default_rng(100 * layer + key)
    u = np.linspace(0, 2 * np.pi, VERTICES, endpoint=False)
    reach = 150 * (1 + 0.25 * np.sin(3 * u + rng.uniform(0, 6)) + 0.1 * np.sin(7 * u + rng.uniform(0, 6)))
    x, y = 200 + 380 * (layer % 5) + rng.uniform(-60, 60), 170 + 245 * (layer // 5) + rng.uniform(-40, 40)
    return np.column_stack([x + reach * np.cos(u), y + reach * np.sin(u)])


def big_film():
    """Return the document."""
    film = edits.set_length(Document(), EVERY * (KEYS - 1) + 1)
    for layer in range(1, LAYERS + 1):
        if layer > 1:
            film = edits.add_layer(film)
        style = Style(QColor.fromHsvF(layer / LAYERS, 0.5, 0.9).name(), "#303040", 3.0)
        for key in range(KEYS):
            drawing = Drawing((Outline(1, shape(layer, key)),), style)
            film = edits.put_drawing(film, layer, 1 + EVERY * key, drawing)
    return film


def settle(editor):
    """Wait until every plan that was asked for is the final one."""
    while not editor.preview.settled:
        QApplication.processEvents()
        time.sleep(0.005)


def scrub(editor, frames):
    """Return the milliseconds of each step of the playhead, painted at once."""
    pad, times = editor.window.canvas.viewport(), []
    for frame in frames:
        began = time.perf_counter()
        editor.session.go_to(frame)
        pad.repaint()
        times.append(1000 * (time.perf_counter() - began))
    return times


def canvas_only(editor, frames):
    """Return the milliseconds of working the content out and painting the canvas alone, without panels."""
    canvas, times = editor.window.canvas, []
    for frame in frames:
        editor.session.go_to(frame)
        canvas._content = None
        began = time.perf_counter()
        _ = canvas.content
        canvas.viewport().repaint()
        times.append(1000 * (time.perf_counter() - began))
    return times


def plainly(editor, frames):
    """Return the milliseconds of QPainter alone for the same pictures, paths made beforehand."""
    canvas = editor.window.canvas
    image = QImage(canvas.viewport().size(), QImage.Format.Format_RGB32)
    times = []
    for frame in frames:
        editor.session.go_to(frame)
        content, transform, theme = canvas.content, canvas.camera.transform(), canvas.theme
        parts = []
        for picture, _ in content.others:
            style = picture.style
            pen = QPen(to_qcolor(style.stroke), style.width * canvas.camera.scale)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
            parts.append((path_of(picture.outlines, transform), pen, to_qcolor(style.fill), 0.45))
        shown = path_of(content.picture.outlines, transform)
        parts.append((shown, QPen(theme.color("inbetween"), 2.2), theme.color("accent", 0.16), 1.0))
        for key in (content.before, content.after):
            path = path_of([(o.points, o.closed) for o in key.drawing.outlines], transform)
            parts.append((path, QPen(theme.color("before"), 1.8), None, 1.0))
        began = time.perf_counter()
        painter = QPainter(image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        image.fill(0)
        for path, pen, fill, opacity in parts:
            painter.setOpacity(opacity)
            if fill is not None:
                painter.fillPath(path, fill)
            painter.strokePath(path, pen)
        painter.end()
        times.append(1000 * (time.perf_counter() - began))
    return times


def path_of(outlines, transform):
    """Return one path of all vertices in view px."""
    path = QPainterPath()
    for points, closed in outlines:
        polygon = transform.map(QPolygonF([QPointF(x, y) for x, y in points.tolist()]))
        path.addPolygon(polygon)
        if closed:
            path.closeSubpath()
    return path


def new_editor():
    """Return an editor with a canvas of 1280 x 720."""
    store = QSettings(str(Path(tempfile.mkdtemp()) / "settings.ini"), QSettings.Format.IniFormat)
    editor = Editor(Settings(store))
    window = editor.window
    window.show()
    window.resize(1280 + window.width() - window.canvas.width(), 720 + window.height() - window.canvas.height())
    QApplication.processEvents()
    return editor


def main():
    """Print the figures."""
    app = make_application()
    path = Path(tempfile.mkdtemp()) / "big.inkb"
    save(big_film(), path)
    editor = new_editor()
    began = time.perf_counter()
    assert editor.files.open_path(path)
    editor.window.repaint()
    print(f"opening {path.stat().st_size / 1e6:.1f} MB until it is painted: {time.perf_counter() - began:.2f} s")
    last = editor.session.document.length
    began = time.perf_counter()
    settle(editor)
    first = scrub(editor, range(1, last + 1))
    print(
        f"scrubbing while it is being solved: median {statistics.median(first):.1f} ms, worst {max(first):.1f} ms"
    )
    for _ in range(2):
        settle(editor)
        scrub(editor, range(1, last + 1))
    settle(editor)
    print(f"every span solved after {time.perf_counter() - began:.1f} s")
    frames = [f for f in range(2, last) if (f - 1) % EVERY]
    for name, onion in (("without onion skin", False), ("with onion skin", True)):
        editor.view_state.set(onion=onion)
        scrub(editor, frames)
        ours, bare, plain = scrub(editor, frames), canvas_only(editor, frames), plainly(editor, frames)
        ratio = statistics.median(bare) / statistics.median(plain)
        print(
            f"{name}: step of the playhead, panels and all {statistics.median(ours):.1f} ms "
            f"(worst {max(ours):.1f}), canvas {statistics.median(bare):.1f} ms, "
            f"plain QPainter {statistics.median(plain):.1f} ms: {ratio:.2f}"
        )
    plans = set(editor.preview._plans)
    key = editor.session.document.layers[7].keyframes[5]
    editor.session.apply("Move", edits.move_keyframe, 8, key.frame, key.frame + 1)
    scrub(editor, range(1, last + 1))
    settle(editor)
    print(f"moving one keyframe in time: {len(set(editor.preview._plans) - plans)} new plans")
    moved = edits.move_vertices(editor.session.document, 8, 7, {1: shape(8, 1) + 5})
    plans = set(editor.preview._plans)
    editor.session.apply("Move", lambda _: moved)
    scrub(editor, range(1, last + 1))
    settle(editor)
    scrub(editor, range(1, last + 1))
    spans = {k[:2] for k in set(editor.preview._plans) - plans}
    print(f"moving one drawing: {len(spans)} spans solved again")
    editor.window.close()
    app.quit()


if __name__ == "__main__":
    main()
