"""Time the rigid method beside the intrinsic one: `python -m tests.benchmarks.rigid`.

All figures of one run are taken side by side, so that their ratios hold on any machine.
"""

import os
import timeit

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402  (threads are counted when numpy is imported)

from core import plan  # noqa: E402

FRAMES = 24


def limb(n, bend):
    """A limb of n vertices, thicker in the middle, bent by `bend` radians round its middle."""
    half = n // 2
    along = np.linspace(-1, 1, half)
    direction = np.pi / 2 + bend / 2 * np.tanh(3 * along)
    middle = np.cumsum(np.exp(1j * direction)) * 400 / half
    width = (30 + 6 * np.cos(9 * along)) * np.sqrt(1.02 - along**2) * 1j * np.exp(1j * direction)
    z = np.concatenate([middle - width, (middle + width)[::-1]])
    return np.stack([z.real, z.imag], axis=1)


def fat_and_thin(n):
    """A star with deep bays, and a rounder one turned: its interior folds and must be opened."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    waves = (300 * (1 + depth * np.sin(7 * angle + shift)) for depth, shift in ((0.75, 0.0), (0.5, 1.2)))
    return tuple(np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1) for r in waves)


def best(run, number):
    """Shortest time of one call, in milliseconds."""
    run()
    return 1e3 * min(timeit.repeat(run, number=number, repeat=7)) / number


def row(label, a, b):
    """Print the times of one pair of keyframes."""
    rigid, plain = plan(a, b, method="rigid"), plan(a, b)
    many, middle = np.linspace(0, 1, FRAMES + 2)[1:-1], np.array([0.5])
    made = best(lambda: plan(a, b, method="rigid"), 3)
    one, all_ = best(lambda: rigid.evaluate(middle), 50), best(lambda: rigid.evaluate(many), 10)
    times = all_ / best(lambda: plain.evaluate(many), 10)
    print(f"{label:28} {made:8.1f} {one:10.3f} {all_:10.2f} {times:14.1f}   {rigid.note}")


def main():
    """Print all figures."""
    print(f"{'ms':28} {'plan':>8} {'one frame':>10} {f'{FRAMES} frames':>10} {'of intrinsic':>14}")
    for n in (200, 1000, 2000):
        row(f"limb, {n:,} vertices", limb(n, 0.2), limb(n, 1.9))
    row("star, 400 vertices", *fat_and_thin(400))


if __name__ == "__main__":
    main()
