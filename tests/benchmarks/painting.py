"""Painting one outline at 1280 x 720: ours against plain QPainter, as ratios within one run.

Run from the root: python tests/benchmarks/painting.py
"""

import os
import statistics
import sys
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
sys.path.insert(0, str(Path(__file__).parents[2]))

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPainterPath, QPen, QPolygonF, QTransform

from app.painting import outlines_path, paint_outlines

FILL, STROKE = QColor("#7b61e8"), QColor("#101020")
ROUNDS = 25


def star(count, *, noise=0.0):
    """Return an outline of `count` vertices that fills the picture."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    reach = 240 * (1 + 0.3 * np.sin(7 * turn))
    points = np.column_stack([640 + reach * np.cos(turn), 360 + reach * np.sin(turn)])
    return points + np.random.default_rng(1).normal(0, noise, points.shape)


def path_of(points):
    """Return the path of all vertices, made once and not counted."""
    path = QPainterPath()
    path.addPolygon(QPolygonF([QPointF(x, y) for x, y in (*points.tolist(), points[0].tolist())]))
    return path


def paint_plainly(painter, path, width):
    """Paint a ready path as QPainter does it."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.fillPath(path, FILL)
    painter.strokePath(path, QPen(STROKE, width, Qt.SolidLine, Qt.RoundCap, Qt.RoundJoin))


def medians(works):
    """Return the median milliseconds of each, taken in turns so that a busy machine is unfair to none."""
    image = QImage(1280, 720, QImage.Format.Format_ARGB32_Premultiplied)
    times = [[] for _ in works]
    for _ in range(ROUNDS):
        for work, taken in zip(works, times, strict=True):
            image.fill(Qt.GlobalColor.white)
            painter = QPainter(image)
            began = time.perf_counter()
            work(painter)
            taken.append(1000 * (time.perf_counter() - began))
            painter.end()
    return [statistics.median(t) for t in times]


def compare(count, width, noise=0.0):
    """Print the figures of one outline."""
    points = star(count, noise=noise)
    outlines = [(points, True)]
    every, thinned = path_of(points), outlines_path(outlines, QTransform())
    ours, full, least, path = medians(
        [
            lambda p: paint_outlines(p, outlines, fill=FILL, stroke=STROKE, width=width, transform=QTransform()),
            lambda p: paint_plainly(p, every, width),
            lambda p: paint_plainly(p, thinned, width),
            lambda p: outlines_path(outlines, QTransform()),
        ]
    )
    print(
        f"{count:6,} vertices, pen {width:3.1f}, noise {noise:3.1f} px: ours {ours:5.2f} ms (path {path:4.2f}, "
        f"{thinned.elementCount():5,} kept), {ours / full:4.2f} of plain QPainter's {full:6.2f}, "
        f"{ours / least:4.2f} of QPainter's own for the thinned path"
    )


def main():
    """Print every figure."""
    for width in (1.0, 1.8, 2.2, 5.0):
        for count in (1_000, 10_000):
            compare(count, width)
    compare(10_000, 2.2, noise=0.1)
    compare(10_000, 2.2, noise=0.3)


if __name__ == "__main__":
    main()
