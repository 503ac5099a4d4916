"""Simple polygons of many kinds, all turning from x towards y."""

import numpy as np

from core.geometry.crossings import crossings
from core.geometry.outline import resample, signed_area


def oriented(points):
    return points if signed_area(points) > 0 else points[::-1].copy()


def circle(count, radius=100.0):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def star(count, rng):
    angle = (np.arange(count) + rng.uniform(0, 0.9, count)) * 2 * np.pi / count
    radius = rng.uniform(20, 120, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def untangled(count, rng):
    """Random points joined at random, crossings undone one by one (2-opt)."""
    p = rng.uniform(0, 100, (count, 2))
    while len(found := crossings(p)):
        i, j = found[0]
        p[i + 1 : j + 1] = p[i + 1 : j + 1][::-1].copy()
    return oriented(p)


def ribbon(middle, width):
    d = np.gradient(middle, axis=0)
    d /= np.hypot(*d.T)[:, None]
    side = np.stack([-d[:, 1], d[:, 0]], axis=1) * width
    return oriented(np.concatenate([middle + side, (middle - side)[::-1]]))


def spiral(count, turns):
    s = np.linspace(0, 1, count // 2)
    angle, radius = 2 * np.pi * turns * s, 20 + 100 * s
    return ribbon(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1), 3.0)


def comb(count, teeth, height):
    """A bar with teeth on one side, up or down."""
    corners = [(0.0, 0.0)]
    for x in range(0, 20 * teeth, 20):
        corners += [(x, height), (x + 10, height), (x + 10, height / 8), (x + 20, height / 8)]
    return oriented(resample(np.array([*corners, (20.0 * teeth, 0.0)]), count))


def any_shape(kind, count, rng):
    if kind == "star":
        return star(count, rng)
    if kind == "untangled":
        return untangled(count, rng)
    if kind == "spiral":
        turns = rng.uniform(0.6, 1.8) * rng.choice([-1, 1])
        return spiral(count, turns)
    return comb(count, int(rng.integers(2, 4)), rng.uniform(40, 90) * rng.choice([-1, 1]))
