"""Exporting 48 frames of 1920 x 1080 of the walk: ms a frame by one process and by two, and every format.

The comparison with Synfig is by the same machine in the same run: Synfig took 51 ms a frame where painting with
QPainter and encoding with PyAV's PNG took 14, so what these two take here times 51 / 14 stands for Synfig. Where
`synfig` is installed, it is measured too.

Run from the root: python tests/benchmarks/export.py
"""

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).parents[2]))

FRAMES = 48
SIZE = (1920, 1080)
SYNFIG, PYAV = 51, 14


def walk():
    """Return the sample of the walk, 48 frames long: its keyframes spread over them."""
    import resources
    from core.io.project import load

    document = load(resources.folder() / "samples" / "walking leg.inkb")
    layer = document.layers[0]
    last = layer.keyframes[-1].frame
    keyframes = tuple(
        replace(k, frame=1 + round((k.frame - 1) * (FRAMES - 1) / (last - 1))) for k in layer.keyframes
    )
    return replace(document, length=FRAMES, layers=(replace(layer, keyframes=keyframes),))


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


def export_once(document, form="png", processes=0):
    """Export a whole film; return seconds a frame and the bytes of everything."""
    from app.export.export import export
    from app.export.formats import FORMATS
    from app.export.settings import ExportSettings

    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / ("a" if FORMATS[form].folder else f"a{FORMATS[form].ending}")
        settings = replace(ExportSettings.whole_film(document, out, "a", form), size=SIZE, processes=processes)
        began = time.perf_counter()
        export(document, settings)
        seconds = (time.perf_counter() - began) / document.length
        return seconds, sum(p.stat().st_size for p in Path(folder).rglob("*") if p.is_file())


def steady(document, processes):
    """Return seconds a frame of PNG by processes that are up, without planning the film; and of their start."""
    from app.export import pool
    from app.export.film import Film
    from app.export.frames import frame_files, look_of
    from app.export.render import Job
    from app.export.settings import ExportSettings

    with tempfile.TemporaryDirectory() as folder:
        made = Film(document, replace(ExportSettings.whole_film(document, Path(folder), "a"), size=SIZE))
        jobs = [Job(made.pictures(shot), path) for shot, path in frame_files(made)]
        began = time.perf_counter()
        with contextlib.closing(pool._Processes(look_of(made), processes)) as crew:
            while len(crew._ready) < processes:
                time.sleep(0.005)
            ready = time.perf_counter()
            for future in [crew.submit(job) for job in jobs]:
                future.result()
            return (time.perf_counter() - ready) / len(jobs), ready - began


def one_worker(document):
    """Return seconds a frame of one process that paints and encodes one frame after another."""
    from app.export.film import Film
    from app.export.frames import frame_files, look_of
    from app.export.render import Job, finish, paint
    from app.export.settings import ExportSettings

    with tempfile.TemporaryDirectory() as folder:
        made = Film(document, replace(ExportSettings.whole_film(document, Path(folder), "a"), size=SIZE))
        jobs = [Job(made.pictures(shot), path) for shot, path in frame_files(made)]
        look = look_of(made)
        began = time.perf_counter()
        for job in jobs:
            finish(paint(job, look), job, look)
        return (time.perf_counter() - began) / len(jobs)


def qpainter_and_pyav(document):
    """Return seconds a frame of the plain way: QPainter on 8 bits, PyAV's PNG encoder, one after another."""
    import av
    import numpy as np
    from PySide6.QtCore import QPointF, QSize
    from PySide6.QtGui import QColor, QImage, QPainter, QPen, QPolygonF

    from app.painting import stage_transform
    from core.model.motion import PlanCache, pictures_at

    plans = PlanCache()
    frames = [pictures_at(document, f, plans) for f in range(1, FRAMES + 1)]
    size = QSize(*SIZE)
    with tempfile.TemporaryDirectory() as folder:
        began = time.perf_counter()
        for number, pictures in enumerate(frames):
            image = QImage(size, QImage.Format.Format_RGBA8888_Premultiplied)
            image.fill(0)
            painter = QPainter(image)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setTransform(stage_transform(document.stage, size))
            for picture in pictures:
                painter.setBrush(QColor(picture.style.fill))
                painter.setPen(QPen(QColor(picture.style.stroke), picture.style.width))
                for points, _ in picture.outlines:
                    painter.drawPolygon(QPolygonF([QPointF(*p) for p in points.tolist()]))
            painter.end()
            straight = image.convertToFormat(QImage.Format.Format_RGBA8888)
            pixels = np.frombuffer(straight.constBits(), np.uint8).reshape(SIZE[1], SIZE[0], 4)
            codec = av.codec.CodecContext.create("png", "w")
            codec.width, codec.height, codec.pix_fmt, codec.time_base = *SIZE, "rgba", Fraction(1, 24)
            frame = av.VideoFrame.from_ndarray(pixels, format="rgba")
            packets = [*codec.encode(frame), *codec.encode(None)]
            Path(folder, f"{number}.png").write_bytes(b"".join(map(bytes, packets)))
        return (time.perf_counter() - began) / FRAMES


def synfig(document):
    """Return seconds a frame of Synfig for the same polygons, None where it is not installed."""
    if shutil.which("synfig") is None:
        return None
    from core.model.motion import PlanCache, pictures_at

    with tempfile.TemporaryDirectory() as folder:
        sif = Path(folder) / "walk.sif"
        plans = PlanCache()
        frames = [pictures_at(document, f, plans)[0].outlines[0][0] for f in range(1, FRAMES + 1)]
        sif.write_text(_sif(frames, document.stage))
        command = ["synfig", str(sif), "-w", str(SIZE[0]), "-h", str(SIZE[1]), "-t", "png", "-o"]
        command.append(str(Path(folder) / "a.png"))
        began = time.perf_counter()
        ended = subprocess.run(command, capture_output=True, text=True, check=False)
        seconds = time.perf_counter() - began
        count = len(list(Path(folder).glob("*.png")))
        if ended.returncode or not count:
            print("  synfig:", ended.stderr.strip()[-200:])
            return None
        return seconds / count


def _sif(frames, stage):
    """Return a Synfig film that shows a polygon a frame."""
    unit = 60.0
    layers = []
    for i, points in enumerate(frames):
        vertices = "".join(
            f"<entry><vector><x>{(x - stage.width / 2) / unit:.5f}</x><y>{(stage.height / 2 - y) / unit:.5f}</y>"
            "</vector></entry>"
            for x, y in points.tolist()
        )
        seen = (
            f'<animated type="real"><waypoint time="{max(i - 1, 0)}f" before="constant" after="constant">'
            f'<real value="{float(i == 0)}"/></waypoint><waypoint time="{i}f" before="constant" after="constant">'
            f'<real value="1"/></waypoint><waypoint time="{i + 1}f" before="constant" after="constant">'
            '<real value="0"/></waypoint></animated>'
        )
        layers.append(
            f'<layer type="polygon" active="true" version="0.1"><param name="amount">{seen}</param>'
            '<param name="color"><color><r>0.7</r><g>0.2</g><b>0.15</b><a>1</a></color></param>'
            f'<param name="vector_list"><dynamic_list type="vector">{vertices}</dynamic_list></param></layer>'
        )
    half = (stage.width / 2 / unit, stage.height / 2 / unit)
    return (
        f'<?xml version="1.0"?><canvas version="1.0" width="{SIZE[0]}" height="{SIZE[1]}" fps="24" '
        f'begin-time="0f" end-time="{len(frames) - 1}f" antialias="1" '
        f'view-box="{-half[0]} {half[1]} {half[0]} {-half[1]}">{"".join(layers)}</canvas>'
    )


def milliseconds(work, repeats=5):
    """Return the least of calls that return seconds, in ms: what the machine can do when nothing else runs."""
    return 1000 * min(work() for _ in range(repeats))


def main():
    """Print every figure."""
    peaks()
    document = walk()
    export_once(document, processes=1)
    print(f"PNG, {FRAMES} frames of the walk at 1920 x 1080, ms a frame, best of 5:")
    base = milliseconds(lambda: qpainter_and_pyav(document))
    alone = milliseconds(lambda: one_worker(document))
    print(f"  QPainter and PyAV's PNG, one after another: {base:.1f}; ours, one after another: {alone:.1f}")
    single, pair = (milliseconds(lambda n=n: steady(document, n)[0]) for n in (1, 2))
    start = milliseconds(lambda: steady(document, 2)[1])
    told = f"{single / pair:.2f} times; start {start:.0f} ms"
    print(f"  1 process that is up {single:.1f}, 2 processes {pair:.1f}: {told}")
    one, two, auto = (milliseconds(lambda n=n: export_once(document, processes=n)[0]) for n in (1, 2, 0))
    print(f"  the whole export: by threads {one:.1f}, by 2 processes {two:.1f}, as it chooses {auto:.1f}")
    stands, best = base * SYNFIG / PYAV, min(one, two, auto)
    print(f"  for Synfig stands {stands:.0f}: {best / stands:.2f} of it (goal 0.35)")
    other = synfig(document)
    if other is not None:
        print(f"  Synfig here {1000 * other:.0f}: {best / (1000 * other):.2f} of it")
    for vertices in (40, 1000):
        shape = film(FRAMES, vertices)
        seconds, size = min(export_once(shape) for _ in range(3))
        print(f"2 outlines of {vertices} vertices: {1000 * seconds:.1f} ms, {size / FRAMES / 1024:.0f} KB a frame")
    every_format(document)


def every_format(document):
    """Print what each format takes."""
    from app.export.formats import FORMATS

    print("every format, the walk at 1920 x 1080:")
    for form in FORMATS:
        seconds, size = export_once(document, form)
        print(f"  {form:10} {1000 * seconds:7.1f} ms a frame, {size / 1e6:8.2f} MB in all")


def peaks():
    """Print how much memory an export takes, short and long, in processes of their own."""
    for length in (48, 192):
        script = (
            "import resource, sys; sys.path.insert(0, 'tests/benchmarks'); import export; "
            f"export.export_once(export.film({length})); "
            "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024)"
        )
        root = Path(__file__).parents[2]
        ended = subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, cwd=root, check=True
        )
        print(f"peak memory of an export of {length} frames: {ended.stdout.strip()} MB")


if __name__ == "__main__":
    main()
