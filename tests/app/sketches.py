"""Small documents for tests that paint."""

import numpy as np

from core.correspondence.pairing import Correspondence
from core.model.document import Document, Keyframe, Layer, OutlinePair, Span, Stage
from core.model.drawing import Drawing, Outline, Style


def square(left, top, side):
    return np.array([[left, top], [left + side, top], [left + side, top + side], [left, top + side]], dtype=float)


def ring(count, *, radius=200.0, center=(320.0, 240.0), lobes=5, depth=0.3):
    """Return a closed star-like outline of many vertices."""
    turn = np.linspace(0, 2 * np.pi, count, endpoint=False)
    reach = radius * (1 + depth * np.sin(lobes * turn))
    return np.column_stack([center[0] + reach * np.cos(turn), center[1] + reach * np.sin(turn)])


def film(
    *, length=4, fill="#785ae6b4", stroke=None, width=4.0, background=None, size=(64, 48), side=20.0, shift=20.0
):
    """Return a document whose square, with a square hole in it, moves to the right."""
    style = Style(fill, stroke, width)

    def drawing(x):
        hole = Outline(2, square(x + side / 4, 10 + side / 4, side / 2))
        return Drawing((Outline(1, square(x, 10.0, side)), hole), style)

    keyframes = (Keyframe(1, drawing(10.0)), Keyframe(max(length, 2), drawing(10.0 + shift)))
    return Document(Stage(*size, background), length=length, layers=(Layer(1, keyframes=keyframes),))


def strip(bend, count=10):
    """Return a bent strip of 400 x 30 px."""
    heading = bend * np.linspace(-0.5, 1, count)
    on = (heading[1:] + heading[:-1]) / 2
    steps = np.column_stack([np.cos(on), np.sin(on)]) * 400 / (count - 1)
    spine = np.vstack([np.zeros(2), *np.cumsum(steps, axis=0)])
    side = np.column_stack([-np.sin(heading), np.cos(heading)]) * 15
    return np.add(np.vstack([spine - side, (spine + side)[::-1]]), (800, 500))


def swing(bend, *, method="linear", repair=False, frames=(3, 13), length=20):
    """Return a document in which a strip bends over, vertex to vertex; bent by 2, straight ways cross."""
    ends = strip(-bend), strip(bend)
    places = np.arange(len(ends[0]), dtype=float)
    answer = Correspondence(places, places, (len(ends[0]), len(ends[1])))
    span = Span(method, pairs=(OutlinePair(1, 1, (), answer, chosen=True),), repair=repair)
    before = Keyframe(frames[0], Drawing((Outline(1, ends[0]),)), span)
    after = Keyframe(frames[1], Drawing((Outline(1, ends[1]),)))
    return Document(length=length, layers=(Layer(1, "arm", keyframes=(before, after)),))
