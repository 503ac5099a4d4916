"""How long the correspondence takes: figures and ratios, nothing is asserted.

    python tests/benchmarks/correspondence.py

Run it with OMP_NUM_THREADS=1: the matrices are small, and threads only wait for each other.
The references are what other programs do: the best rotation of a ring (as flubber), and the table of Sederberg
and Greenwood for one start in plain loops.
"""

import time
from collections.abc import Callable

import numpy as np

from core.correspondence.matching import alternatives, match, match_quick
from core.geometry.outline import resample

SIZES = ((100, 100), (1000, 800), (5000, 4000))


def blob(count: int, seed: int) -> np.ndarray:
    """A round outline with limbs, `count` vertices at uneven distances."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(count)) * 2 * np.pi
    waves = [rng.normal() * 0.25 / k * np.cos(k * angle + rng.random() * 6) for k in range(2, 12)]
    radius = 300 * np.maximum(1 + sum(waves), 0.2)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def milliseconds(work: Callable[[], object], repeats: int = 7) -> float:
    """Median of a few runs after one to warm up."""
    work()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return 1000 * float(np.median(times))


def best_rotation(a: np.ndarray, b: np.ndarray) -> int:
    """The start at which even samples of `b` lie nearest to those of `a`: every start is tried."""
    count = max(len(a), len(b))
    p, q = resample(a, count), resample(b, count)
    return int(np.argmin([((p - np.roll(q, -k, axis=0)) ** 2).sum() for k in range(count)]))


def table_in_loops(a: np.ndarray, b: np.ndarray) -> float:
    """Sederberg and Greenwood's table for one start, squared distances for the work, in Python loops."""
    p, q = a.tolist(), b.tolist()
    last = [0.0] + [float("inf")] * len(q)
    for x, y in p:
        row = [float("inf")]
        for j, (u, v) in enumerate(q):
            row.append(min(last[j], last[j + 1], row[j]) + (x - u) ** 2 + (y - v) ** 2)
        last = row
    return last[-1]


def main() -> None:
    """Print a line a figure."""
    for n, m in SIZES:
        a, b = blob(n, 1), blob(m, 2)
        print(f"match {n} x {m}: {milliseconds(lambda a=a, b=b: match(a, b)):.1f} ms")
    a, b = blob(100, 1), blob(100, 2)
    solved, loops = milliseconds(lambda: match(a, b)), milliseconds(lambda: table_in_loops(a, b), 3)
    print(f"match 100 x 100 over one start in Python loops: {solved / loops:.1f}")
    print(f"alternatives 100 x 100: {milliseconds(lambda: alternatives(a, b), 3):.1f} ms")
    a, b = blob(1000, 1), blob(800, 2)
    solved, rotated = milliseconds(lambda: match(a, b)), milliseconds(lambda: best_rotation(a, b), 3)
    print(f"match 1000 x 800 over the search of the best rotation: {solved / rotated:.1f}")
    a, b = blob(1000, 1), blob(1000, 2)
    near = match(a, b)
    image = float(near.images(a, b, np.array([100.5]))[0])
    for anchors in ([(100.5, image + 4)], [(100.5, image + 4), (500.0, (image + 400) % 1000)]):
        dragged = milliseconds(lambda anchors=anchors: match_quick(a, b, anchors, near=near))
        print(f"anchor dragged, {len(anchors)} in all, 1000 x 1000, near the last answer: {dragged:.1f} ms")
    print(f"anchored, no last answer: {milliseconds(lambda: match_quick(a, b, anchors)):.1f} ms")
    print(f"anchored, all candidates: {milliseconds(lambda: match(a, b, anchors)):.1f} ms")


if __name__ == "__main__":
    main()
