"""What the onion skin costs on the real canvas at 1280 x 720: a repaint, and a step among frames seen before.

The item alone is timed, painted on a picture of the view's size. A repaint should stay under 2 ms. Beside
it, in the same run: painting the same skins without keeping any picture.

Run from the root: python tests/benchmarks/onion.py
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
from PySide6.QtCore import QSettings
from PySide6.QtGui import QImage, QPainter
from PySide6.QtWidgets import QApplication

from app.bootstrap import Editor, make_application
from app.canvas.onion import OnionItem
from app.settings import Settings
from core.model.document import Document
from core.model.edits import add_outline

ROUNDS = 40


def limb(count, bend):
    """Return a smooth limb of `count` vertices that fills most of the stage, bent by an angle."""
    u = np.linspace(0, 2 * np.pi, count, endpoint=False)
    x, y = 700 * np.cos(u), (260 + 24 * np.cos(9 * u)) * np.sin(u)
    turn = bend * np.clip(x / 700, 0, 1)
    return np.column_stack([960 + x * np.cos(turn) - y * np.sin(turn), 540 + x * np.sin(turn) + y * np.cos(turn)])


def open_editor(count):
    """Return an editor on two keyframes of `count` vertices, its canvas 1280 x 720."""
    store = QSettings(str(Path(tempfile.mkdtemp()) / "settings.ini"), QSettings.Format.IniFormat)
    editor = Editor(Settings(store))
    document = Document()
    for frame, bend in ((1, 0.0), (24, -1.2)):
        document = add_outline(document, 1, frame, limb(count, bend))
    editor.session.new(document)
    editor.session.go_to(12)
    window = editor.window
    window.show()
    window.resize(1280 + window.width() - window.canvas.width(), 720 + window.height() - window.canvas.height())
    while window.canvas.content is None or not editor.preview.settled:
        QApplication.processEvents()  # until the worker has matched the outlines
        time.sleep(0.01)
    return editor


def paint(editor, image, *, kept=True):
    """Return the milliseconds of painting the item."""
    canvas = editor.window.canvas
    item, content = next(x for x in canvas.scene().items() if isinstance(x, OnionItem)), canvas.content
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    began = time.perf_counter()
    if kept:
        item.draw(painter, content)
    else:
        item.paint_plainly(painter, content, canvas.camera.transform())
    taken = 1000 * (time.perf_counter() - began)
    painter.end()
    return taken


def measure(editor):
    """Return the medians in ms: a repaint, a step forward, and the same without pictures."""
    image = QImage(editor.window.canvas.viewport().size(), QImage.Format.Format_RGB32)
    paint(editor, image)
    repaint = statistics.median(paint(editor, image) for _ in range(ROUNDS))
    plain = statistics.median(paint(editor, image, kept=False) for _ in range(ROUNDS))
    steps = []
    for _ in range(3):
        for frame in range(10, 16):
            editor.session.go_to(frame)
            _ = editor.window.canvas.content
            steps.append(paint(editor, image))
    return repaint, statistics.median(steps[6:]), plain


def main():
    """Print one line a case."""
    app = make_application()
    print("vertices  skins    look      repaint    a step   without pictures   (ms)")
    for count in (200, 1000, 10_000):
        editor = open_editor(count)
        for each in (2, 6, 12):
            for filled in (False, True):
                editor.view_state.set(onion=True, onion_before=each, onion_after=each, onion_filled=filled)
                figures = measure(editor)
                look = "filled" if filled else "outlines"
                print(f"{count:8d}  {2 * each:5d}  {look:8s}" + "".join(f"  {x:9.2f}" for x in figures))
        editor.window.close()
    app.quit()


if __name__ == "__main__":
    main()
