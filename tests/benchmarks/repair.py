"""Time the repair of in-betweens and measure what it changes: `python -m tests.benchmarks.repair`.

A pair of outlines with nothing wrong shows what the check alone costs; the ratio is to evaluating 128 frames.
"""

import os
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402  (threads are counted when numpy is imported)

from core import plan  # noqa: E402
from core.geometry.crossings import simple_frames  # noqa: E402
from core.geometry.outline import resample  # noqa: E402
from core.repair.plan import plan_repair  # noqa: E402
from tests.core.repair.shapes import circle, comb, oriented, ribbon, spiral  # noqa: E402

TIMES = np.linspace(0, 1, 241)


def waves(count, side):
    """A ribbon that swings to one side and the other."""
    s = np.linspace(0, 1, count // 2)
    return ribbon(np.stack([side * 50 * np.sin(2 * np.pi * s), 200 * s], axis=1), 12.0)


def bay(count, turn):
    """A coast with fine teeth, turned."""
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    radius = 100 * (1 + 0.2 * np.sin(3 * angle) + 0.03 * np.sin(40 * angle))
    p = radius[:, None] * np.stack([np.cos(angle + turn), np.sin(angle + turn)], axis=1)
    return oriented(resample(p, count))


def seconds(work):
    """Processor time of one call, and what it returned."""
    start = time.process_time()
    found = work()
    return time.process_time() - start, found


def main():
    """Print a line for every pair and method."""
    pairs = {
        "S to Z": (waves, 1, waves, -1),
        "spiral to circle": (spiral, 2.0, circle, 100.0),
        "coast, half a turn": (bay, 0.0, bay, 3.0),
    }
    print("pair                 method    vertices  crossed  seconds  / 128 frames  still crossed  change  jump")
    for name, (first, x, second, y) in pairs.items():
        for count in (100, 400, 1000):
            for method in ("linear", "intrinsic"):
                show(name, method, first(count, x), second(count, y))
    show("comb down", "linear", comb(200, 6, 80.0), comb(200, 6, -80.0))


def show(name, method, a, b):
    """Repair one pair and print what came of it."""
    paths = plan(a, b, method=method)
    frame_time, _ = seconds(lambda: paths.evaluate(np.linspace(0, 1, 129)))
    taken, repaired = seconds(lambda: plan_repair(paths))
    wished, frames = paths.evaluate(TIMES), repaired.evaluate(TIMES)
    crossed, still = (int((~simple_frames(f)).sum()) for f in (wished, frames))
    change = np.sqrt(((frames - wished) ** 2).sum(axis=2).mean()) / np.ptp(np.concatenate([a, b]), axis=0).max()
    steps = np.hypot(*np.moveaxis(np.diff(frames, axis=0), 2, 0)).max(axis=1)
    print(
        f"{name:20} {method:10} {len(a):7} {crossed:8} {taken:8.2f} {taken / frame_time:13.0f} {still:14}"
        f" {100 * change:6.2f}% {steps.max() / np.median(steps):5.2f}",
        *repaired.notes,
    )


if __name__ == "__main__":
    main()
