"""Do animated SVG and Lottie look in a browser as our PNG frames do? Frame 0, the middle and the last one.

Not part of the test run: it needs Chromium and lottie-web. From the root:

    sudo apt install chromium
    npm install --prefix build/players lottie-web
    python tests/browser/players.py --lottie PLAYER

where PLAYER is build/players/node_modules/lottie-web/build/player/lottie.min.js. For every film,
format and frame it prints the intersection over union of what is more opaque than not, and the mean difference of
the channels; it ends with 1 if an IoU is below 0.98.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")
sys.path.insert(0, str(Path(__file__).parents[2]))

import numpy as np
from PySide6.QtGui import QImage

import resources
from app.export.export import export
from app.export.film import Film
from app.export.lottie import lottie
from app.export.settings import ExportSettings
from core.io.project import load
from core.model.document import Document, Keyframe, Layer, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import Easing

GOAL = 0.98
FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--force-device-scale-factor=1",
    "--default-background-color=00000000",
    "--run-all-compositor-stages-before-draw",
    "--virtual-time-budget=4000",
]
PAGE = "<!DOCTYPE html><style>body{margin:0}svg,div{display:block}</style>"
SEEK = {
    "svg": "let s=document.querySelector('svg');s.pauseAnimations();s.setCurrentTime(TIME);",
    "svg-css": "for(let a of document.getAnimations()){a.pause();a.currentTime=1000*TIME;}",
    "lottie": "let p=lottie.loadAnimation({container:document.querySelector('div'),renderer:'svg',autoplay:false,"
    "animationData:DATA});p.goToAndStop(FRAME,true);",
}


def films():
    """Return the samples, and one film with everything that a format may get wrong."""
    return {p.stem: load(p) for p in resources.samples()} | {"everything": everything()}


def everything():
    """Return a film with a hole, strokes, an open line, changing colours, twos, a hold and a late layer."""

    def box(left, top, side):
        return np.array([[left, top], [left + side, top], [left + side, top + side], [left, top + side]], float)

    def ring(x, style):
        return Drawing((Outline(1, box(x, 60, 120)), Outline(2, box(x + 30, 90, 60))), style)

    eased = Span("linear", Easing(0.42, 0.0, 0.58, 1.0))
    over = Span("linear", Easing(0.4, 0.0, 0.64, 1.4))
    one, two = Style("#d04030", "#102040", 6.0), Style("#30a060c0", "#102040", 12.0)
    first = (Keyframe(1, ring(40, one), eased), Keyframe(13, ring(300, one), over), Keyframe(24, ring(120, two)))
    line = np.array([[60, 300], [200, 330], [420, 300]], float)
    bent = np.array([[60, 330], [240, 240], [420, 320]], float)
    late = (
        Keyframe(7, Drawing((Outline(1, line, closed=False),), Style("#8040c0", None, 10.0)), Span("intrinsic")),
        Keyframe(20, Drawing((Outline(1, bent, closed=False),), Style("#8040c0", None, 10.0))),
    )
    twos = (
        Keyframe(1, Drawing((Outline(1, box(360, 40, 80)),), two), Span("intrinsic", step=2)),
        Keyframe(12, Drawing((Outline(1, box(380, 200, 60)),), two), Span(hold=True)),
        Keyframe(20, Drawing((Outline(1, box(330, 120, 90)),), one)),
    )
    layers = (
        Layer(1, "ring", keyframes=first),
        Layer(2, "line", keyframes=late),
        Layer(3, "twos", keyframes=twos, opacity=0.7),
    )
    return Document(Stage(480, 360), Fraction(24), 24, layers)


def page(document, settings, frame, script):
    """Return an HTML page that shows one frame of an export."""
    time = float((Fraction(frame) + Fraction(1, 1000)) / document.rate)
    seek = SEEK[settings.format].replace("TIME", f"{time:.6f}").replace("FRAME", str(frame))
    if settings.format == "lottie":
        width, height = settings.size
        seek = seek.replace("DATA", json.dumps(lottie(Film(document, settings))))
        body = f'<div style="width:{width}px;height:{height}px"></div><script>{script}</script>'
    else:
        export(document, replace(settings, replace=True))
        body = settings.out.read_text(encoding="utf-8")
    return f"{PAGE}{body}<script>{seek}</script>"


def screenshot(chromium, html, size, folder):
    """Return the straight channels of what the browser shows."""
    (folder / "page.html").write_text(html, encoding="utf-8")
    shot = folder / "shot.png"
    shot.unlink(missing_ok=True)
    command = [
        chromium,
        *FLAGS,
        f"--user-data-dir={folder / 'profile'}",
        f"--window-size={size[0]},{size[1]}",
        f"--screenshot={shot}",
        (folder / "page.html").as_uri(),
    ]
    subprocess.run(command, capture_output=True, check=True, timeout=120)
    return channels(shot)


def channels(path):
    """Return the (height, width, 4) channels of a picture file."""
    image = QImage(str(path)).convertToFormat(QImage.Format.Format_RGBA8888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, : 4 * image.width()].reshape(image.height(), image.width(), 4).astype(int)


def compare(seen, ours):
    """Return the IoU of the shapes and the mean difference of the premultiplied channels."""
    a, b = seen[..., 3] > 127, ours[..., 3] > 127
    union = (a | b).sum()
    iou = (a & b).sum() / union if union else 1.0
    lit = [p[..., :3] * p[..., 3:] / 255 for p in (seen, ours)]
    return float(iou), float(np.abs(lit[0] - lit[1])[a | b].mean()) if union else 0.0


def main():
    """Print every figure; return 1 if a shape is another one in the browser."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--chromium", default="chromium")
    parser.add_argument("--lottie", type=Path, required=True)
    parsed = parser.parse_args()
    script = parsed.lottie.read_text(encoding="utf-8")
    least = 1.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for film, document in films().items():
            scale = 480 / document.stage.width
            size = (480, round(document.stage.height * scale))
            frames = (0, (document.length - 1) // 2, document.length - 1)
            png = ExportSettings(folder / film, "f", 1, document.length, size, replace=True)
            files = export(document, png).files
            for form in SEEK:
                settings = replace(png, out=folder / f"{film}.{form}", format=form)
                told = []
                for frame in frames:
                    seen = screenshot(parsed.chromium, page(document, settings, frame, script), size, folder)
                    told.append(compare(seen, channels(files[frame])))
                least = min(least, *(iou for iou, _ in told))
                figures = ", ".join(f"{iou:.4f} ({off:.2f})" for iou, off in told)
                print(f"{film:20} {form:8} frames {frames}: IoU (mean difference) {figures}", flush=True)
    print(f"least IoU {least:.4f} (goal {GOAL})")
    return int(least < GOAL)


if __name__ == "__main__":
    sys.exit(main())
