"""Following another layer: how its drawing turns and shifts, and what is carried along."""

from dataclasses import dataclass, replace

import numpy as np

from core.geometry.outline import FloatArray
from core.model.document import Keyframe
from core.model.drawing import Drawing
from core.model.pins import SpanPin


@dataclass(frozen=True, slots=True)
class Carry:
    """A turn and a shift of the stage: z becomes turn * z + shift, for z = x + i y.

    Attributes
    ----------
    turn : complex
        Of length 1.
    shift : complex
        In px.
    """

    turn: complex = 1 + 0j
    shift: complex = 0j

    def after(self, first: "Carry") -> "Carry":
        """Return the carry that does `first` and then this one."""
        return Carry(self.turn * first.turn, self.turn * first.shift + self.shift)

    def back(self) -> "Carry":
        """Return the carry that undoes this one."""
        turn = self.turn.conjugate()
        return Carry(turn, -turn * self.shift)


STANDING = Carry()


def fit_carry(before: FloatArray, after: FloatArray) -> Carry:
    """Return the turn and the shift that best carry points onto others, by least squares.

    Parameters
    ----------
    before, after : (k, 2) float array
        The same vertices in px, weighted alike. No turn where they are a single point.

    Notes
    -----
    Closed form in the complex plane: the turn is the direction of sum conj(z) w about the centroids.
    """
    z, w = before[:, 0] + 1j * before[:, 1], after[:, 0] + 1j * after[:, 1]
    middle = complex(z.mean()), complex(w.mean())
    product = complex(np.vdot(z - middle[0], w - middle[1]))
    turn = product / abs(product) if abs(product) > 0 else 1 + 0j
    return Carry(turn, middle[1] - turn * middle[0])


def carried(points: FloatArray, carry: Carry) -> FloatArray:
    """Return points (..., 2) where a carry takes them."""
    if carry == STANDING:
        return points
    result: FloatArray = turned(points, carry) + np.array([carry.shift.real, carry.shift.imag])
    return result


def turned(vectors: FloatArray, carry: Carry) -> FloatArray:
    """Return vectors (..., 2) as a carry turns them, without its shift."""
    c, s = carry.turn.real, carry.turn.imag
    result: FloatArray = vectors @ np.array([[c, s], [-s, c]])
    return result


def led_back(before: Keyframe, after: Keyframe, carry: Carry) -> tuple[Keyframe, Keyframe]:
    """Return a span's keyframes with the one after, and its arcs' ends, as if nothing had carried them."""
    back = carry.back()
    outlines = tuple(replace(o, points=carried(o.points, back)) for o in after.drawing.outlines)
    pins = tuple(_led_pin(pin, back) for pin in before.span.pins)
    start = replace(before, span=replace(before.span, pins=pins)) if pins else before
    return start, replace(after, drawing=Drawing(outlines, after.drawing.style))


def _led_pin(pin: SpanPin, back: Carry) -> SpanPin:
    if pin.handles is None:
        return pin
    x, y = carried(np.array(pin.handles[1]), back).tolist()
    return replace(pin, handles=(pin.handles[0], (x, y)))
