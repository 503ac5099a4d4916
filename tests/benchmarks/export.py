"""Exporting 1920 x 1080 frames: milliseconds a frame, where they go, and whether memory grows with the film.

Run from the root: python tests/benchmarks/export.py
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parents[2]))


def film(length, vertices=40):
    """Return a document of a large shape with a hole that turns into another one."""
    import numpy as np

    from core.model.document import Document, Keyframe, Layer
    from core.model.drawing import Drawing, Outline, Style

    turn = np.linspace(0, 2 * np.pi, vertices, endpoint=False)

    def drawing(lobes, radius, fill):
        reach = radius * (1 + 0.3 * np.sin(lobes * turn))
        star = np.column_stack([960 + reach * np.cos(turn), 540 + reach * np.sin(turn)])
        hole = star * 0.3 + (672, 378)
        return Drawing((Outline(1, star), Outline(2, hole)), Style(fill, "#101020", 5.0))

    keyframes = (
        Keyframe(1, drawing(5, 350, "#7b61e8b0")),
        Keyframe(length, drawing(7, 380, "#20c080")),
    )
    return Document(length=length, layers=(Layer(1, keyframes=keyframes),))


def export(length, vertices=40):
    """Export a film; return seconds a frame and the bytes of all frames."""
    from app.export.frames import ExportSettings, export_frames

    document = film(length, vertices)
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        files = export_frames(document, ExportSettings.whole_film(document, Path(folder), "a")).files
        seconds = (time.perf_counter() - began) / length
        return seconds, sum(f.stat().st_size for f in files)


def milliseconds(work, repeats=12):
    """Return the median of calls."""
    times = []
    for i in range(repeats):
        began = time.perf_counter()
        work(i)
        times.append(1000 * (time.perf_counter() - began))
    return statistics.median(times)


def main():
    """Print every figure."""
    from PySide6.QtCore import QSize
    from PySide6.QtGui import QImage

    from app.export.png import encode_png
    from app.painting import render_frame
    from core.model.motion import PlanCache

    export(8)
    for vertices in (40, 1000):
        seconds, size = min(export(48, vertices) for _ in range(3))
        print(
            f"48 frames of 1920 x 1080, 2 outlines of {vertices} vertices: {1000 * seconds:.1f} ms a frame "
            f"(goal 30), {size / 48 / 1024:.0f} KB each"
        )

    document, plans = film(48), PlanCache()
    deep = QImage.Format.Format_RGBA64_Premultiplied
    picture = render_frame(document, 20, QSize(1920, 1080), plans, format=deep)
    render = milliseconds(lambda i: render_frame(document, 2 + i, QSize(1920, 1080), plans, format=deep))
    print(
        f"  render {render:.1f} ms, encode {milliseconds(lambda i: encode_png(picture)):.1f} ms, one after another"
    )
    with tempfile.TemporaryDirectory() as folder:
        saving = milliseconds(lambda i: picture.save(f"{folder}/a.png"), 3)
    print(f"  QImage.save instead of our encoder: {saving:.1f} ms")

    peaks = {length: peak_of(length) for length in (48, 192)}
    growth = peaks[192] - peaks[48]
    print(f"peak memory: {peaks[48]} MB for 48 frames, {peaks[192]} MB for 192 ({growth:+d} MB)")


def peak_of(length):
    """Return the peak of the resident memory of a fresh process that exports so many frames, in MB."""
    command = [sys.executable, __file__, "--peak", str(length)]
    return int(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--peak"]:
        import resource

        export(int(sys.argv[2]))
        print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)
    else:
        main()
