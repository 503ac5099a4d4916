"""Small documents for tests that paint."""

import numpy as np

from core.model.document import Document, Keyframe, Layer, Stage
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
