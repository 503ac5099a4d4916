"""Closed outlines as rows of complex numbers: who follows whom, and where they cross."""

from collections.abc import Sequence
from itertools import combinations

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.crossings import frame_crossings, frame_crossings_between
from core.geometry.outline import FloatArray
from core.methods.headings import ComplexArray


def next_in_loops(loops: Sequence[slice]) -> IndexArray:
    """Return the number of the vertex after each vertex of closed outlines, (n,)."""
    after = np.arange(1, sum(loop.stop - loop.start for loop in loops) + 1)
    for loop in loops:
        after[loop.stop - 1] = loop.start
    return after


def previous_in_loops(loops: Sequence[slice]) -> IndexArray:
    """Return the number of the vertex before each vertex of closed outlines, (n,)."""
    after = next_in_loops(loops)
    before = np.zeros_like(after)
    before[after] = np.arange(len(after))
    return before


def crossing_edges(frames: ComplexArray, loops: Sequence[slice]) -> IndexArray:
    """Return where closed outlines cross themselves and each other, as rows (frame, edge, edge), (k, 3).

    Parameters
    ----------
    frames : (T, n) complex array
        Vertices of all outlines.
    loops : sequence of slice
        The outlines. Edge i begins at vertex i.
    """
    p = as_pairs(frames)
    found = [frame_crossings(p[:, loop]) + np.array([0, loop.start, loop.start]) for loop in loops]
    found += [
        frame_crossings_between(p[:, one], p[:, other]) + np.array([0, one.start, other.start])
        for one, other in combinations(loops, 2)
    ]
    return np.concatenate(found)


def as_pairs(p: ComplexArray) -> FloatArray:
    """Return complex numbers (...) as points (..., 2)."""
    return np.stack([p.real, p.imag], axis=-1)
