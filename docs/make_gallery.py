"""Draw contact sheets: every span with its in-betweens, matching places in the same colour.

    python docs/make_gallery.py                      the project's own samples, into docs/gallery.png
    python docs/make_gallery.py --pairs FILE... --out FOLDER     one sheet a file of keyframe pairs

A file of pairs is JSON: {"cases": [{"name", "a": [[x, y], ...], "b": [[x, y], ...], "indexed": bool}, ...]}.
"""

import argparse
import json
import os
from itertools import pairwise
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QFont, QFontDatabase, QGuiApplication, QImage, QPainter, QTransform

import resources
from app.canvas.items import hue
from app.canvas.lines import HUE_PIECES
from app.painting import paint_outlines
from core import load
from core.errors import InkbetweenError
from core.geometry.outline import arc_lengths
from core.model.document import Span
from core.model.drawing import Drawing, Outline
from core.model.inbetweens import plan_span

TIMES = np.array([0.0, 0.2, 0.4, 0.5, 0.6, 0.8, 1.0])
CELL, CAPTION = 150, 22
MARKS = 14
MOST_SPANS = 4
LEFT_OUT = ("turning letter",)
"""That an a turns over to become an e is the artist's idea: without anchors it stands."""
ROOT = Path(__file__).resolve().parent


def sample_spans():
    """Yield (caption, plan) of spans of every sample, matched without the artist's help.

    Of each layer the first few; where everything goes straight there is nothing to be seen.
    """
    for path in (p for p in resources.samples() if p.stem not in LEFT_OUT):
        for layer in load(path).layers:
            for before, after in list(pairwise(layer.keyframes))[:MOST_SPANS]:
                if before.span.method == "linear":
                    continue
                caption = f"{path.stem}, {layer.name}, frames {before.frame} to {after.frame}"
                yield caption, plan_span(before.drawing, after.drawing, Span("intrinsic"))


def pair_spans(path, method):
    """Yield (caption, plan) of every pair in a file, matched whether the file knows the answer or not."""
    for case in json.loads(path.read_text())["cases"]:
        try:
            drawings = [Drawing((Outline(1, np.array(case[side], float)),)) for side in "ab"]
            yield case["name"], plan_span(*drawings, Span(method))
        except (InkbetweenError, ValueError) as e:
            yield f"{case['name']}: {e}", None


def draw_sheet(spans):
    """Return one picture with a row a span."""
    spans = list(spans)
    image = QImage(CELL * len(TIMES), (CELL + CAPTION) * len(spans), QImage.Format.Format_RGB32)
    image.fill(QColor("#ffffff"))
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    font = QFont("DejaVu Sans")
    font.setPixelSize(12)
    painter.setFont(font)
    for row, (caption, plan) in enumerate(spans):
        top = row * (CELL + CAPTION)
        painter.setPen(QColor("#5f6979"))
        painter.drawText(QRectF(8, top, image.width() - 16, CAPTION), Qt.AlignmentFlag.AlignVCenter, caption)
        if plan is not None:
            draw_row(painter, plan, top + CAPTION)
    painter.end()
    return image


def draw_row(painter, plan, top):
    """Draw the in-betweens of a span beside each other, all to one scale."""
    frames = plan.frames(TIMES)
    every = np.concatenate([f.reshape(len(TIMES), -1, 2) for f in frames], axis=1)
    low, high = every.min(axis=1), every.max(axis=1)
    scale = (CELL - 16) / max(float((high - low).max()), 1e-9)
    for i in range(len(TIMES)):
        centre = (low[i] + high[i]) / 2
        dx, dy = CELL * (i + 0.5) - scale * centre[0], top + CELL / 2 - scale * centre[1]
        transform = QTransform(scale, 0, 0, scale, dx, dy)
        outlines = [(f[i], link.aligned.closed) for f, link in zip(frames, plan.links, strict=True)]
        key = i in (0, len(TIMES) - 1)
        paint_outlines(
            painter,
            outlines,
            fill=QColor("#e6e0fb" if key else "#f4f5f8"),
            stroke=QColor("#2a2f3a"),
            width=1.4 if key else 1.0,
            transform=transform,
        )
        for link, frame in zip(plan.links, frames, strict=True):
            draw_marks(painter, link, frame[i], transform)


def draw_marks(painter, link, points, transform):
    """Mark places that correspond, each in its colour."""
    lengths = [arc_lengths(side, closed=True) for side in (link.aligned.left, link.aligned.right)]
    along = sum(s / max(float(s[-1]), 1e-12) for s in lengths) / 2
    painter.setPen(Qt.PenStyle.NoPen)
    for k in range(MARKS):
        row = int(np.searchsorted(along, k / MARKS)) % len(points)
        painter.setBrush(hue(k * HUE_PIECES // MARKS))
        painter.drawEllipse(transform.map(QPointF(*points[row])), 3.2, 3.2)


def main():
    """Draw what the arguments ask for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=Path, nargs="+", default=[])
    parser.add_argument("--out", type=Path, default=ROOT)
    parser.add_argument("--method", default="intrinsic")
    args = parser.parse_args()
    app = QGuiApplication([])
    QFontDatabase.addApplicationFont(str(resources.folder() / "fonts" / "DejaVuSans.ttf"))
    for path in args.pairs:
        draw_sheet(pair_spans(path, args.method)).save(str(args.out / f"{path.stem}.png"))
    if not args.pairs:
        sheet = draw_sheet(sample_spans())
        flat = Qt.ImageConversionFlag.ThresholdDither | Qt.ImageConversionFlag.AvoidDither
        sheet.convertToFormat(QImage.Format.Format_Indexed8, flat).save(str(args.out / "gallery.png"))
    app.quit()


if __name__ == "__main__":
    main()
