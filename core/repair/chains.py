"""The outlines of a drawing as one row of vertices and edges between them, and what their form weighs.

Inside this package points are complex numbers, x + iy, in units of the drawing's size.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse as sp

from core.geometry.boxes import IndexArray
from core.geometry.crossings import frame_crossings_between, simple_frames
from core.geometry.outline import FloatArray, signed_area

ComplexArray = npt.NDArray[np.complex128]
BoolArray = npt.NDArray[np.bool_]

FINEST = 1e-3
"""Share of the mean edge below which an edge counts as that long: mass and stiffness stay bounded."""


@dataclass(frozen=True, eq=False)
class Chains:
    """Which vertices are joined.

    Attributes
    ----------
    rows : tuple of slice
        Vertices of every outline.
    closed : tuple of bool
    keyframes : (2, n) complex array, optional
        What is narrow there may be narrow everywhere; nothing else may.
    """

    rows: tuple[slice, ...]
    closed: tuple[bool, ...]
    keyframes: ComplexArray | None = None

    @classmethod
    def of(cls, counts: Sequence[int], closed: Sequence[bool], keyframes: ComplexArray | None = None) -> "Chains":
        """Make chains of outlines with so many vertices each."""
        last = np.cumsum([0, *counts]).tolist()
        return cls(tuple(slice(i, j) for i, j in pairwise(last)), tuple(closed), keyframes)

    @property
    def count(self) -> int:
        """Number of vertices."""
        return int(self.rows[-1].stop)

    @cached_property
    def edges(self) -> IndexArray:
        """Vertices (m, 2) at the start and the end of every edge."""
        found = []
        for row, closed in zip(self.rows, self.closed, strict=True):
            k = np.arange(row.start, row.stop)
            pairs = np.stack([k, np.roll(k, -1)], axis=1)
            found.append(pairs if closed else pairs[:-1])
        return np.concatenate(found)

    @property
    def ring(self) -> bool:
        """Whether this is one closed outline and nothing else."""
        return self.closed == (True,)

    def lengths(self, z: ComplexArray) -> FloatArray:
        """Lengths (m,) of all edges."""
        start, end = self.edges.T
        return np.asarray(np.abs(z[end] - z[start]), np.float64)

    def signs(self, frames: ComplexArray) -> FloatArray:
        """Signs (T, outlines) of the areas; 1 for open outlines."""
        points = as_points(frames)
        signs = [
            np.sign(signed_area(points[:, row])) if closed else np.ones(len(frames))
            for row, closed in zip(self.rows, self.closed, strict=True)
        ]
        return np.stack(signs, axis=1)

    def simple(self, frames: ComplexArray) -> BoolArray:
        """Whether (T,) frames (T, n) have no crossing, neither of an outline with itself nor with another."""
        points = as_points(frames)
        fine = np.ones(len(frames), np.bool_)
        for k, (row, closed) in enumerate(zip(self.rows, self.closed, strict=True)):
            fine &= simple_frames(points[:, row], closed=closed)
            for other, other_closed in zip(self.rows[:k], self.closed[:k], strict=True):
                met = frame_crossings_between(
                    points[:, row], points[:, other], closed=closed, others_closed=other_closed
                )
                fine[met[:, 0]] = False
        return fine

    def stiffness(self, a: ComplexArray, b: ComplexArray) -> tuple[FloatArray, Any]:
        """Masses (n,) of the vertices, 1 in all, and the sparse matrix (n, n) of the springs between them.

        A spring is as stiff as the perimeter over its length, so that x'Kx is the integral of |dx/ds|^2 over the
        perimeter, taken as 1: refining the outline changes neither.
        """
        lengths = self.lengths(a) / self.lengths(a).sum() + self.lengths(b) / self.lengths(b).sum()
        lengths = np.maximum(lengths, FINEST * lengths.mean())
        lengths = lengths / lengths.sum()
        start, end = self.edges.T
        mass = np.zeros(self.count)
        np.add.at(mass, start, lengths / 2)
        np.add.at(mass, end, lengths / 2)
        off = -1.0 / lengths
        rows, columns = np.concatenate([start, end]), np.concatenate([end, start])
        springs = sp.csc_matrix((np.concatenate([off, off]), (rows, columns)), shape=(self.count, self.count))
        return mass, (springs - sp.diags(np.asarray(springs.sum(axis=1)).ravel())).tocsc()


def as_points(z: ComplexArray) -> FloatArray:
    """Return complex numbers (..., n) as points (..., n, 2)."""
    return np.stack([z.real, z.imag], axis=-1)
