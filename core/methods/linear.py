"""Straight vertex paths: fast and honest, but a shape that turns shrinks on the way."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray


@dataclass(frozen=True, eq=False)
class LinearPaths:
    """Every vertex runs straight from `left` to `right`, both (n, 2) in px."""

    left: FloatArray
    right: FloatArray

    @classmethod
    def of(cls, outlines: Sequence[tuple[FloatArray, FloatArray]]) -> "LinearPaths":
        """Put the (left, right) vertices of several outlines into one row."""
        nothing = np.zeros((0, 2))
        return cls(
            np.concatenate([nothing, *(left for left, _ in outlines)]),
            np.concatenate([nothing, *(right for _, right in outlines)]),
        )

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2)."""
        s = t[:, None, None]
        frames: FloatArray = (1 - s) * self.left + s * self.right
        return frames
