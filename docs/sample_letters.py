"""The sample of an a that turns into an e: it is half a turn, and the hole goes with it."""

import numpy as np
from sample_parts import Curve, Knot, Vertices, document, smooth, with_vertices

from core.geometry.outline import FloatArray
from core.model import edits
from core.model.document import Document
from core.model.drawing import Style

CENTRE, SIZE = (960.0, 540.0), 1.15
MARKS = ("bar", "back", "end out", "end in", "inside", "corner")
HOLE_MARKS = ("first", "last")


def turning_letter() -> Document:
    """Return the two letters as keyframes, each an outline and a hole."""
    e, a = [_placed(_e(), 60), _placed(_e_hole(), 50)], [_placed(_a(), 60), _placed(_a_hole(), 50)]
    style = Style("#3f7fbf", "#234e7a", 5.0)
    film = document("letter", {1: a, 30: e}, style, anchors=(MARKS, HOLE_MARKS))
    return edits.set_span(film, 1, 1, placement="centroid")


def _arc(radius: tuple[float, float], start: float, end: float, count: int) -> list[tuple[float, float]]:
    """Return points of an ellipse about the middle from one angle to another, degrees clockwise from the right."""
    return [(radius[0] * np.cos(t), radius[1] * np.sin(t)) for t in np.radians(np.linspace(start, end, count))]


def _e() -> Curve:
    """The outline of an e: along the bar, over the top and round to its open end, and back inside."""
    outer = _arc((330, 350), -12, -322, 15)
    inner = _arc((215, 240), -318, -196, 7)
    knots = [Knot(325, 48, "bar", True), Knot(*outer[0])]
    knots += [Knot(*p, "back" if i == 6 else "") for i, p in enumerate(outer[1:-1], 1)]
    knots += [Knot(*outer[-1], "end out", True), Knot(*inner[0], "end in", True)]
    knots += [Knot(*p, "inside" if i == 3 else "") for i, p in enumerate(inner[1:-1], 1)]
    knots += [Knot(-213, 48, "corner", True)]
    return smooth(knots)


def _e_hole() -> Curve:
    arc = _arc((212, 240), -12, -168, 9)
    knots = [Knot(*arc[0], "first", True), *(Knot(*p) for p in arc[1:-1]), Knot(*arc[-1], "last", True)]
    return smooth(knots)


def _a() -> Curve:
    """The outline of an a, begun where the e's is after half a turn: round the bowl, up the stem, over the top."""
    knots = (
        Knot(-110, -48, "bar", True), Knot(-262, 8), Knot(-322, 142), Knot(-258, 296), Knot(-108, 352),
        Knot(70, 330), Knot(206, 250, "", True), Knot(214, 344, "", True), Knot(330, 344, "back", True),
        Knot(330, 60), Knot(328, -130), Knot(262, -284), Knot(110, -346), Knot(-80, -346),
        Knot(-272, -268, "end out", True), Knot(-214, -170, "end in", True), Knot(-120, -226),
        Knot(10, -244, "inside"), Knot(136, -222), Knot(198, -140), Knot(206, -48, "corner", True),
    )  # fmt: skip
    return smooth(knots)


def _a_hole() -> Curve:
    knots = (
        Knot(-96, 42, "first", True), Knot(-182, 76), Knot(-212, 146), Knot(-166, 226), Knot(-70, 250),
        Knot(70, 232), Knot(172, 168), Knot(206, 42, "last", True),
    )  # fmt: skip
    return smooth(knots)


def _placed(curve: Curve, spacing: float) -> Vertices:
    def place(p: FloatArray) -> FloatArray:
        return p * SIZE + CENTRE

    return with_vertices(curve.mapped(place), spacing)
