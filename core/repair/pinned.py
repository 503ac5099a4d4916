"""A repair that leaves every pin where it must be."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.pins import Held, spread
from core.repair.chains import ComplexArray

APART = 0.01
"""Sizes of the drawing: pins nearer to each other, or to a line, cannot turn and stretch the drawing safely."""

LOOKS = np.linspace(0.0, 1.0, 65)


@dataclass(frozen=True, eq=False)
class Grip:
    """The pins of the outlines that are repaired, and how frames are brought onto them.

    Attributes
    ----------
    held : Held
        In sizes of the drawing.
    freedom : int
        Pins that a map of the whole plane can meet: 1 by a shift, 2 by a similarity, 3 by an affine map. None of
        these makes a simple outline cross itself. Further pins are met by a smooth field, which might.
    """

    held: Held
    freedom: int

    @classmethod
    def of(cls, held: Held, rows: Sequence[slice], origin: complex, scale: float) -> "Grip | None":
        """Return the pins on the outlines in `rows` of a drawing; None where there are none."""
        columns = np.concatenate([np.arange(row.start, row.stop) for row in rows])
        weights = held.weights[:, columns]
        own = np.isclose(weights.sum(axis=1), 1.0)
        if not own.any():
            return None
        own_held = Held(weights[own], (held.corners[own] - origin) / scale, held.lengths[own])
        return cls(own_held, _freedom(own_held.wanted(LOOKS)))

    @property
    def attempts(self) -> tuple[FloatArray | None, ...]:
        """Weights to hold while a way is looked for; None, if that fails: bringing the way onto them is enough."""
        safe = self.freedom == len(self.held.weights) < 3
        return (self.held.weights, None) if safe else (self.held.weights,)

    def onto(self, places: ComplexArray, times: FloatArray) -> ComplexArray:
        """Return the places (T, n), which should all but meet the pins, with all pins where they are wanted."""
        wanted = self.held.wanted(times)
        at = self.held.at(places)
        middle, target = at.mean(axis=1, keepdims=True), wanted.mean(axis=1, keepdims=True)
        p, q, z = at - middle, wanted - target, places - middle
        if self.freedom == 2:
            z = z * ((p.conj() * q).sum(axis=1) / _least((np.abs(p) ** 2).sum(axis=1)))[:, None]
        elif self.freedom == 3:
            turned, mirrored = _affine(p, q)
            z = z * turned + z.conj() * mirrored
        return spread(z + target, self.held, wanted)

    def between(self, frames: ComplexArray) -> ComplexArray:
        """Return frames (T, n) with every pin on the straight line from where it is in the first to the last."""
        at = self.held.at(frames[[0, -1]])
        s = np.linspace(0.0, 1.0, len(frames))[:, None]
        return spread(frames, self.held, (1 - s) * at[0] + s * at[1])


def _freedom(wanted: ComplexArray) -> int:
    """How many pins a map of the plane meets safely at all times, from where they are wanted (T, k)."""
    p = wanted - wanted.mean(axis=1, keepdims=True)
    values = np.linalg.svd(np.stack([p.real, p.imag], axis=1), compute_uv=False)
    long, wide = values.min(axis=0)[0], values.min(axis=0)[-1]
    if wanted.shape[1] >= 3 and wide > APART:
        return 3
    return 2 if wanted.shape[1] >= 2 and long > APART else 1


def _affine(p: ComplexArray, q: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Numbers a, b (T, 1) for which a p + b conj(p) is nearest to q (T, k)."""
    pp, p2 = (np.abs(p) ** 2).sum(axis=1), (p * p).sum(axis=1)
    pq, cq = (p.conj() * q).sum(axis=1), (p * q).sum(axis=1)
    whole = _least(pp**2 - np.abs(p2) ** 2)
    turned, mirrored = (pp * pq - p2.conj() * cq) / whole, (pp * cq - p2 * pq) / whole
    return turned[:, None], mirrored[:, None]


def _least(x: FloatArray) -> FloatArray:
    return np.maximum(x, 1e-300)
