"""Documents that use everything a version of the project file can hold; the kept files are held to them."""

from dataclasses import replace
from fractions import Fraction

import numpy as np

from core.correspondence.pairing import Correspondence
from core.model.document import Anchor, Document, Keyframe, Layer, OutlinePair, Reference, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import Easing, Knot
from core.model.pins import SpanPin

WAVE = Outline(1, np.array([(0.5, 0), (100, -0.25), (90, 1e-7), (0, 1e9)]))
HOLE = Outline(2, np.array([(10, 10), (20, 10), (15, 20.125)]))
LINE = Outline(7, np.array([(0, 0), (5, 5), (0.1, 9)]), closed=False)
FLAG = Outline(2**31 - 1, np.array([(-3, -3), (3, -3), (3, 3), (0, 5), (-3, 3)]))

PLAIN = Style("#7b61e8", None, 4.0)


def first_of_version_1():
    """Return what the oldest kept file holds."""
    wave, hole, line = WAVE, HOLE, Outline(7, np.array([(0, 0), (5, 5)]), closed=False)
    kept = Correspondence(np.array([0.0, 1.5]), np.array([2.0, 0.25]), (4, 3), flipped=True)
    fixed = (OutlinePair(1, 2, (Anchor(0.0, 2.0), Anchor(1.5, 0.25)), kept), OutlinePair(7, 7))
    span = Span("linear", Easing(0.25, -0.5, 0.75, 1.5), -2, fixed)
    first = Keyframe(1, Drawing((wave, hole, line), Style("#12345678", "#abcdef", 2.5)), span)
    last = Keyframe(48, Drawing((hole, line), Style(None, None, 0.0)), Span("intrinsic"))
    front = Layer(3, "Flügel ✎", True, (first, last))
    return Document(Stage(1280, 720, "#101216"), Fraction(24000, 1001), 60, (Layer(1, "", False), front))


def everything_of_version_1():
    """Return a document with every field of version 1 set to what it is not by default, somewhere."""
    kept = Correspondence(np.array([0.0, 1.5, 3.25]), np.array([2.0, 0.25, 2.75]), (4, 3), flipped=True)
    ends = Correspondence(np.array([0.0, 0.5, 2.0]), np.array([0.0, 1.25, 2.0]), (3, 3), closed=False)
    pairs = (
        OutlinePair(
            1, 2, (Anchor(0.0, 2.0, muted=True), Anchor(1.5, 0.25), Anchor(4.0, 3.0, muted=True)), kept, True
        ),
        OutlinePair(7, 7, (Anchor(0.0, 0.0),), ends),
        OutlinePair(2, 2**31 - 1),
    )
    pins = (
        SpanPin(1, 3.5),
        SpanPin(7, 2.0, handles=((1.5, -2.5), (1e9, 0.0))),
        SpanPin(place=(12.25, 11.0)),
        SpanPin(place=(-1e9, 0.1), handles=((0.0, 0.0), (3.0, 4.0))),
    )
    style = Style("#12345678", "#abcdef", 2.5)
    first = Keyframe(
        1,
        Drawing((WAVE, HOLE, LINE), style),
        Span("linear", Easing(0.25, -0.5, 0.75, 1.5), -2, pairs, True, pins),
        Reference("sketches/Flügel 1.png", 0.25),
    )
    middle = Keyframe(2, Drawing((HOLE, LINE, FLAG), Style(None, "#00000000", 10_000.0)), Span("rigid", turns=100))
    empty = Keyframe(40, Drawing((), Style("#ffffff", None, 0.0)), Span("intrinsic", repair=True))
    last = Keyframe(100_000, Drawing((LINE,), PLAIN), Span("auto"), Reference("/pictures/last.jpg", 1.0))
    layers = (
        Layer(1, "", False),
        Layer(3, "Flügel ✎", True, (first, middle, empty, last)),
        Layer(2**31 - 1, "front", True, (Keyframe(5, Drawing((FLAG,), PLAIN), Span("auto")),)),
    )
    return Document(Stage(1280, 720, "#101216"), Fraction(24000, 1001), 60, layers)


def everything_of_version_2():
    """Return a document with every field of version 2 set to what it is not by default, somewhere."""
    old = everything_of_version_1()
    _, wing, front = old.layers
    first, middle, *rest = wing.keyframes
    knots = (Knot(0.25, 2.5, 0.0, -4.0, 0.5, 5.0), Knot(0.75, 0.5, 0.625, 0.5, 0.75, 1e-7))
    easing = Easing(0.125, 0.25, 0.875, 1.0, knots)
    span = replace(first.span, easing=easing, placement="centroid", exposures=(3, 1, 2))
    style = replace(first.drawing.style, opacity=0.5)
    first = replace(first, span=span, drawing=replace(first.drawing, style=style), smooth=True)
    middle = replace(middle, span=replace(middle.span, hold=True, step=1000))
    wing = replace(wing, keyframes=(first, middle, *rest), locked=True, opacity=0.25, color="#00ff0080")
    front = replace(front, parent=3, opacity=0.0)
    return replace(old, layers=(old.layers[0], wing, front))
