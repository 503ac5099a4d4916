"""Time the certificate against what it cannot do without: `python -m tests.benchmarks.certificate`."""

import os
import timeit

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402  (threads are counted when numpy is imported)
from shapely.geometry import Polygon  # noqa: E402

from core import certify, plan  # noqa: E402
from core.geometry.crossings import frame_crossings  # noqa: E402

FRAMES = 24


def flower(n, petals, turn):
    """A wave round a circle."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    radius = 300 * (1 + 0.3 * np.sin(petals * angle))
    return radius[:, None] * np.stack([np.cos(angle + turn), np.sin(angle + turn)], axis=1)


def milliseconds(work):
    """Best of five."""
    return 1e3 * min(timeit.repeat(work, number=1, repeat=5))


def main():
    """Print a line for every size."""
    print(f"{FRAMES} frames      vertices  paths  crossings  shapely  certificate  (ms)  problems")
    for n in (100, 1000, 3000):
        for kind, a, b in (
            ("sound", flower(n, 5, 0.0), flower(n, 5, 2.0)),
            ("crossed", flower(n, 9, 0.0), flower(n, 2, 1.5)),
        ):
            times = np.linspace(0, 1, FRAMES)
            paths = plan(a, b)
            frames = paths.evaluate(times)
            shown = [
                milliseconds(lambda paths=paths, times=times: paths.evaluate(times)),
                milliseconds(lambda frames=frames: frame_crossings(frames)),
                milliseconds(lambda frames=frames: [Polygon(p).is_valid for p in frames]),
                milliseconds(lambda frames=frames, a=a, b=b: certify(frames, a, b)),
            ]
            counts = sum(int(c.sum()) for c in certify(frames, a, b).counts.values())
            print(f"{kind:12} {n:10} " + "".join(f"{ms:9.2f}" for ms in shown) + f"  {counts:14}")


if __name__ == "__main__":
    main()
