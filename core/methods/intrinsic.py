"""Intrinsic vertex paths: lengths and headings of the edges are interpolated, so that a turn keeps its size."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.geometry.outline import FloatArray

TURN = 2 * np.pi


@dataclass(frozen=True, eq=False)
class IntrinsicPaths:
    """First version: one outline after the other, simple closure, simple placement."""

    outlines: tuple[tuple[Any, Any, bool], ...]
    turns: int

    @classmethod
    def of(cls, outlines: Sequence[tuple[FloatArray, FloatArray, bool]], *, turns: int = 0) -> "IntrinsicPaths":
        """Plan the paths of the outlines (left, right, closed)."""
        return cls(tuple((_complex(a), _complex(b), closed) for a, b, closed in outlines), turns)

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices of all outlines at the times `t` (T,), as (T, n, 2)."""
        s = t[:, None]
        parts = []
        for a, b, closed in self.outlines:
            za, zb = (np.append(p[1:], p[0]) - p if closed else p[1:] - p[:-1] for p in (a, b))
            firm = (abs(za) > 1e-9 * abs(za).mean()) & (abs(zb) > 1e-9 * abs(zb).mean())
            d = np.zeros(len(za))
            if firm.any():
                ta, tb = _turnings(za[firm]), _turnings(zb[firm])
                d[firm] = np.cumsum(tb - ta) + np.angle(zb[firm][0] / za[firm][0]) - (tb - ta)[0]
                d[~firm] = np.interp(np.flatnonzero(~firm), np.flatnonzero(firm), d[firm])
            w = abs(za) + abs(zb)
            d -= TURN * np.ceil((d @ w / w.sum() - np.pi) / TURN - 1e-12)
            d += TURN * self.turns
            z = np.exp(1j * s * d) * ((1 - s) * za + s * np.exp(-1j * d) * zb)
            if closed:
                lengths = abs(z)
                z -= lengths * (z.sum(1) / lengths.sum(1))[:, None]
                z = z[:, :-1]
            p = np.concatenate([np.zeros((len(t), 1)), np.cumsum(z, axis=1)], axis=1)
            travel = abs(b - a)
            weight = 1 / (travel**2 + (0.05 * w.sum() / len(w)) ** 2)
            weight /= weight.sum()
            p += ((1 - s) * (a @ weight) + s * (b @ weight)) - (p @ weight)[:, None]
            parts.append(p)
        frames = np.concatenate(parts, axis=1)
        return np.stack([frames.real, frames.imag], axis=-1)


def _complex(points: FloatArray) -> Any:
    return points[:, 0] + 1j * points[:, 1]


def _turnings(z: Any) -> Any:
    turn: Any = np.angle(z * np.conj(np.roll(z, 1)))
    return turn
