"""How long projects take to open and to save: 200,000 vertices in few, many and very many outlines.

    python tests/benchmarks/files.py

Opening is reading, checking and making the document; saving is making the bytes, writing them to the disk (fsync)
and keeping the version before. The best of five.
"""

import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "endurance"))

from films import many_vertices

from core.io.project import load, save

VERTICES = 200_000
SHAPES = ((1, 2), (50, 2), (500, 4), (2_000, 10))


def best(run):
    """Return the seconds of the fastest of five runs."""
    times = []
    for _ in range(5):
        start = time.perf_counter()
        run()
        times.append(time.perf_counter() - start)
    return min(times)


def main():
    print(f"{VERTICES:,} vertices     MB   open s   save s")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "film.inkb"
        for outlines, keyframes in SHAPES:
            document = many_vertices(VERTICES, outlines, keyframes)
            saving = best(lambda d=document: save(d, path, backup=True))
            opening = best(lambda: load(path))
            size = path.stat().st_size / 2**20
            print(f"{keyframes:3} x {outlines:5,} outlines {size:5.1f} {opening:8.3f} {saving:8.3f}")


if __name__ == "__main__":
    main()
