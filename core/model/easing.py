"""Easing: from the linear ratio in a span to the t of its in-betweens."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.errors import DocumentError
from core.geometry.outline import FloatArray


@dataclass(frozen=True, slots=True)
class Easing:
    """A cubic Bezier curve from (0, 0) to (1, 1) over the ratio, with two handles, as in CSS and most editors.

    Attributes
    ----------
    x1, y1, x2, y2 : float
        The handles; x in [0, 1] so that every ratio has one t, y in [-4, 5] so that t may overshoot.
    """

    x1: float = 0.0
    y1: float = 0.0
    x2: float = 1.0
    y2: float = 1.0

    def __post_init__(self) -> None:
        if not (0 <= self.x1 <= 1 and 0 <= self.x2 <= 1):
            raise DocumentError(f"the easing's handles are at ratios {self.x1} and {self.x2}; they must be 0 to 1")
        if not (-4 <= self.y1 <= 5 and -4 <= self.y2 <= 5):
            raise DocumentError(f"the easing's handles are at t {self.y1} and {self.y2}; they must be -4 to 5")

    @property
    def is_linear(self) -> bool:
        """Whether t is the ratio itself."""
        return self.x1 == self.y1 and self.x2 == self.y2

    def t_at(self, ratio: npt.ArrayLike) -> FloatArray:
        """Return t for every ratio in [0, 1]; exactly 0 at 0 and 1 at 1.

        Bisection on the curve's x, which rises: 52 halvings reach the last bit, and no handle makes it diverge.
        """
        r = np.asarray(ratio, dtype=np.float64)
        if self.is_linear:
            return r.copy()
        low, high = np.zeros_like(r), np.ones_like(r)
        for _ in range(52):
            middle = (low + high) / 2
            below = _bezier(self.x1, self.x2, middle) < r
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        t = _bezier(self.y1, self.y2, (low + high) / 2)
        return np.where(r <= 0, 0.0, np.where(r >= 1, 1.0, t))


def _bezier(first: float, second: float, u: FloatArray) -> FloatArray:
    v = 1 - u
    return 3 * v * v * u * first + 3 * v * u * u * second + u * u * u


PRESETS: dict[str, Easing] = {
    "linear": Easing(),
    "slow in and out": Easing(0.42, 0.0, 0.58, 1.0),
    "slow out": Easing(0.42, 0.0, 1.0, 1.0),
    "slow in": Easing(0.0, 0.0, 0.58, 1.0),
    "anticipation": Easing(0.36, -0.4, 0.6, 1.0),
    "overshoot": Easing(0.4, 0.0, 0.64, 1.4),
}
"""By animators' words: slow out leaves the keyframe before slowly, slow in arrives slowly at the one after."""


def preset_name(easing: Easing) -> str | None:
    """Return the name of the preset that `easing` equals, or None for a curve of its own."""
    return next((name for name, preset in PRESETS.items() if preset == easing), None)
