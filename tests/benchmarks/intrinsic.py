"""Time the intrinsic method against the same formulas written plainly: `python -m tests.benchmarks.intrinsic`.

All figures of one run are taken side by side, so that their ratios hold on any machine. The references are
checked to give the same vertices.
"""

import cmath
import math
import os
import timeit

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402  (threads are counted when numpy is imported)

from core import plan  # noqa: E402
from core.methods.intrinsic import FIRM  # noqa: E402
from core.methods.placement import place  # noqa: E402

FRAMES = 24


def keyframes(n):
    """Two waves round a circle: the second one turned, wider, and another wave."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    wave = 300 * (1 + 0.3 * np.sin(5 * angle))
    a = np.stack([wave * np.cos(angle), wave * np.sin(angle)], axis=1)
    return a, 1.3 * a @ np.array([[0, 1], [-1, 0]]) + 20 * np.sin(3 * angle)[:, None]


def prepared(a, b):
    """Everything that does not depend on t, in plain numpy (no doubled vertices, no opposite directions)."""
    p, q = a @ [1, 1j], b @ [1, 1j]
    za, zb = np.roll(p, -1) - p, np.roll(q, -1) - q
    la, lb = abs(za), abs(zb)
    bend = np.angle(zb / np.roll(zb, 1)) - np.angle(za / np.roll(za, 1))
    turn = np.angle(zb[0] / za[0]) + np.cumsum(bend) - bend[0]
    edge = (la / la.sum() + lb / lb.sum()) / 2
    turn -= 2 * np.pi * np.ceil((turn @ edge - np.pi) / (2 * np.pi))
    x, y = la / la.sum(), lb / lb.sum()
    soft = FIRM + (2 * (x - y) / (x + y)) ** 2 + ((abs(bend) + abs(np.roll(bend, -1))) / 2) ** 2
    return np.angle(za), turn, la, lb, soft, place(p, q, (edge + np.roll(edge, 1)) / 2, float(turn @ edge))


def frame(values, t):
    """One in-between in plain numpy."""
    heading, turn, la, lb, soft, placement = values
    lengths = (1 - t) * la + t * lb
    angle = heading + t * turn
    z = lengths * (np.cos(angle) + 1j * np.sin(angle))
    gap = z.sum()
    even, own = lengths / lengths.sum(), lengths * soft / (lengths * soft).sum()
    least, most = abs(gap) / lengths.sum(), abs(gap) * soft.max() / (lengths * soft).sum()
    trust = (1 - least) ** 2 / ((1 - least) ** 2 + (most - least) ** 2)
    z = z - gap * ((1 - trust) * even + trust * own)
    p = np.concatenate([[0], np.cumsum(z[:-1])])
    p = p + (placement.path(np.array([t]))[0] - p @ placement.weights)
    return np.stack([p.real, p.imag], axis=1)


def scalar_frame(values, t):
    """One in-between, vertex after vertex."""
    heading, turn, la, lb, soft, placement = values
    lengths = [(1 - t) * x + t * y for x, y in zip(la, lb, strict=True)]
    angles = [h + t * d for h, d in zip(heading, turn, strict=True)]
    z = [x * complex(math.cos(h), math.sin(h)) for x, h in zip(lengths, angles, strict=True)]
    gap, whole, pliable = sum(z), sum(lengths), sum(x * g for x, g in zip(lengths, soft, strict=True))
    least, most = abs(gap) / whole, abs(gap) * max(soft) / pliable
    trust = (1 - least) ** 2 / ((1 - least) ** 2 + (most - least) ** 2)
    p = [0j]
    for edge, x, g in zip(z, lengths, soft, strict=True):
        p.append(p[-1] + edge - gap * x * ((1 - trust) / whole + trust * g / pliable))
    at = placement
    end = cmath.exp(1j * at.turn) * at.scale
    now = cmath.exp(1j * t * at.turn) * (1 + (at.scale - 1) * t)
    shift = at.before + t * (at.after - at.before) + at.arm * (1 - t - now + t * end)
    shift -= sum(v * w for v, w in zip(p[:-1], at.weights, strict=True))
    return np.array([[(v + shift).real, (v + shift).imag] for v in p[:-1]])


def per_frame(a, b, times):
    """Every frame from the keyframes, as a function `inbetween(a, b, t)` without a plan does it."""
    return np.array([frame(prepared(a, b), float(t)) for t in times])


def per_frame_prepared(values, times):
    """Frame after frame, from what was prepared once."""
    return np.array([frame(values, float(t)) for t in times])


def per_vertex(values, times):
    """Vertex after vertex, from what was prepared once, in Python's own numbers."""
    own = tuple(v.tolist() if isinstance(v, np.ndarray) else v for v in values)
    return np.array([scalar_frame(own, float(t)) for t in times])


def best(run, number):
    """Shortest time of one call, in seconds."""
    run()
    return min(timeit.repeat(run, number=number, repeat=7)) / number


def main():
    """Print all figures."""
    times = np.linspace(0, 1, FRAMES + 2)[1:-1]
    a, b = keyframes(1000)
    paths, values = plan(a, b), prepared(a, b)
    ours = best(lambda: paths.evaluate(times), 20)
    print(f"1,000 vertices x {FRAMES} frames   ms     ns a vertex and frame   times as long")
    print(f"  planned once, all at once  {ours * 1e3:6.2f} {ours / FRAMES * 1e6:12.1f}")
    whole = best(lambda: plan(a, b).evaluate(times), 10)
    print(f"  plan and frames            {whole * 1e3:6.2f} {whole / FRAMES * 1e6:12.1f} {whole / ours:20.1f}")
    for label, run, number in (
        ("numpy, each from keyframes", lambda: per_frame(a, b, times), 5),
        ("numpy, each from a plan", lambda: per_frame_prepared(values, times), 5),
        ("Python, vertex by vertex", lambda: per_vertex(values, times), 1),
    ):
        assert np.allclose(run(), paths.evaluate(times), rtol=0, atol=1e-9)
        took = best(run, number)
        print(f"  {label:26} {took * 1e3:6.2f} {took / FRAMES * 1e6:12.1f} {took / ours:20.1f}")
    for n in (1_000, 10_000):
        a, b = keyframes(n)
        paths, middle = plan(a, b), np.array([0.5])
        made, one = best(lambda: plan(a, b), 5), best(lambda: paths.evaluate(middle), 20)  # noqa: B023
        print(f"{n:6,} vertices: plan {made * 1e3:.2f} ms, one frame {one * 1e3:.3f} ms")


if __name__ == "__main__":
    main()
