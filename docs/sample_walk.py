"""The sample of a walk: six layers on twos, in place, so that it loops; lengths in units of a leg, then scaled."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from sample_parts import Curve, Joint, Knot, Vertices, bent, smooth, with_vertices

from core.geometry.outline import FloatArray
from core.model import edits
from core.model.document import Anchor, Document
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS, Easing

SCALE = 0.56
HIP_X, GROUND = 960.0, 985.0
SOLE = 100.0
"""How far the sole lies under the ankle."""

BALL, HEEL = np.array([95.0, -120.0]), np.array([100.0, 40.0])
"""Where the foot rolls, from the ankle: along the leg, and across it towards the back."""

PHASE = 4
"""Frames from one keyframe to the next: with drawings on twos there is one in-between."""

STRIDE = 120.0
"""How far a standing foot goes back in a phase."""

HIPS = (652.0, 632.0, 678.0, 684.0)
"""Height of the hip over a standing ankle: contact, down, passing, up."""

KNEE, ANKLE = Joint(350, 190), Joint(700, 70)
LEG = (
    Knot(-104, 0, "hip"), Knot(-74, -80), Knot(10, -116), Knot(150, -104), Knot(280, -80),
    Knot(350, -70, "knee"), Knot(440, -58), Knot(560, -48), Knot(660, -46, "instep"),
    Knot(718, -92), Knot(748, -160),
    Knot(772, -184, "toe"), Knot(798, -160, "sole"), Knot(800, -60), Knot(800, 30, "heel"), Knot(780, 58),
    Knot(740, 60), Knot(690, 46, "ankle"), Knot(600, 54), Knot(480, 80), Knot(350, 62, "hollow"),
    Knot(270, 78), Knot(150, 106), Knot(10, 116), Knot(-74, 80),
)  # fmt: skip
LEG_ANCHORS = ("hip", "knee", "instep", "toe", "sole", "heel", "ankle", "hollow")
ARM = (
    Knot(-84, 0, "shoulder"), Knot(-58, -62), Knot(20, -84), Knot(150, -74), Knot(280, -56, "elbow"),
    Knot(420, -46), Knot(500, -50), Knot(560, -58), Knot(612, -30), Knot(618, 14, "hand"), Knot(584, 52),
    Knot(520, 56), Knot(420, 48), Knot(280, 60, "crook"), Knot(150, 80), Knot(20, 86), Knot(-58, 62),
)  # fmt: skip
ARM_ANCHORS = ("shoulder", "elbow", "hand", "crook")
TORSO = (
    Knot(0, 130, "seat"), Knot(-120, 84), Knot(-150, -60), Knot(-160, -240), Knot(-140, -420), Knot(-70, -520),
    Knot(20, -545, "neck"), Knot(110, -505), Knot(160, -390), Knot(170, -230), Knot(150, -60), Knot(120, 84),
)  # fmt: skip
HEAD = (
    Knot(10, -520, "neck"), Knot(-110, -560), Knot(-160, -680), Knot(-110, -810), Knot(20, -860),
    Knot(130, -825), Knot(182, -735), Knot(192, -700), Knot(232, -655, "nose"), Knot(188, -634), Knot(168, -560),
    Knot(100, -520),
)  # fmt: skip
SHOULDER = (-6.0, -440.0)

STYLES = {
    "far arm": Style("#b57a17", "#7a4f08", 5.0),
    "far leg": Style("#35508a", "#22355f", 5.0),
    "near leg": Style("#5578c9", "#2c4583", 5.0),
    "body": Style("#e8a938", "#8f5f0d", 5.0),
    "head": Style("#efbd9c", "#9c6142", 5.0),
    "near arm": Style("#f0b64d", "#8f5f0d", 5.0),
}


def walk() -> Document:
    """Return two steps in place: contact, down, passing, up, and the same with the other leg in front."""
    frames = [1 + PHASE * k for k in range(9)]
    film = edits.set_length(Document(), frames[-1])
    film = edits.set_layer(film, 1, name="far arm")
    for name in list(STYLES)[1:]:
        film = edits.add_layer(film, name)
    ids = {layer.name: layer.id for layer in film.layers}
    for name, first in (("near leg", 0), ("far leg", 4)):
        drawings = {f: _leg(first + k) for k, f in enumerate(frames)}
        film = _with_keyframes(film, ids[name], drawings, STYLES[name], "intrinsic", LEG_ANCHORS)
    for name, knots in (("body", TORSO), ("head", HEAD)):
        drawings = {f: _upper(knots, k) for k, f in enumerate(frames)}
        marks = ("seat", "neck") if name == "body" else ("neck", "nose")
        film = _with_keyframes(film, ids[name], drawings, STYLES[name], "linear", marks)
    for name, side in (("near arm", 1), ("far arm", -1)):
        drawings = {f: _arm(k, side * swing) for f, k, swing in ((1, 0, -1), (17, 4, 1), (33, 8, -1))}
        film = edits.set_parent(film, ids[name], ids["body"])
        film = _with_keyframes(film, ids[name], drawings, STYLES[name], "intrinsic", ARM_ANCHORS, eased=True)
    return film


def _with_keyframes(
    film: Document,
    layer: int,
    drawings: dict[int, Vertices],
    style: Style,
    method: str,
    marks: Sequence[str],
    *,
    eased: bool = False,
) -> Document:
    """Put drawings into a layer, tied at the marks, on twos; even ones pass smoothly through their keyframes."""
    for frame, drawing in drawings.items():
        film = edits.put_drawing(film, layer, frame, Drawing((Outline(1, drawing.points),), style))
    frames = list(drawings)
    for before, after in pairwise(frames):
        easing = PRESETS["slow in and out"] if eased else Easing()
        film = edits.set_span(film, layer, before, method=method, easing=easing)
        film = edits.set_step(film, layer, before, 2)
        a, b = drawings[before].marks, drawings[after].marks
        for mark in marks:
            film = edits.add_anchor(film, layer, before, 1, 1, Anchor(a[mark], b[mark]))
    return film if eased else edits.set_smooth(film, layer, frames[1:-1], True)


def _hip(phase: int) -> FloatArray:
    """Return where the hip is, in units from the point of the ground under it."""
    return np.array([0.0, -HIPS[phase % 4] - SOLE])


def _placed(curve: Curve, spacing: float) -> Vertices:
    moved = curve.mapped(lambda p: p * SCALE + (HIP_X, GROUND))
    return with_vertices(moved, spacing)


def _leg(phase: int) -> Vertices:
    """Return a leg at a phase: at 0 the heel strikes, to 3 it stands, at 4 the toe leaves, to 7 it swings."""
    phase %= 8
    standing = np.array([2 * STRIDE - 10 - STRIDE * phase, -SOLE])
    turn, ankle = {
        0: (-22.0, _rolled(standing, HEEL, -22)),
        1: (0.0, standing),
        2: (0.0, standing),
        3: (8.0, _rolled(standing, BALL, 8)),
        4: (36.0, _rolled(standing, BALL, 36)),
        5: (62.0, np.array([-255.0, -SOLE - 170])),
        6: (34.0, np.array([-40.0, -SOLE - 150])),
        7: (-6.0, np.array([165.0, -SOLE - 62])),
    }[phase]
    hip = _hip(phase)
    way = ankle - hip
    knee = _knee_for(float(np.hypot(*way)))
    reach = bent(Curve(np.array([[700.0, 0.0]]), {}), (0, 0), 0, [KNEE], [knee]).points[0]
    heading = float(np.degrees(np.arctan2(way[1], way[0]) - np.arctan2(reach[1], reach[0])))
    turns, (x, y) = (knee, 90 + turn - heading - knee), hip.tolist()
    return _placed(bent(smooth(LEG), (x, y), heading, (KNEE, ANKLE), turns), 34)


def _rolled(ankle: FloatArray, pivot: FloatArray, turn: float) -> FloatArray:
    """Return where the ankle of a flat foot goes when the foot turns about a point of its sole."""

    def at(angle: float) -> FloatArray:
        a = np.radians(90 + angle)
        along, across = np.array([np.cos(a), np.sin(a)]), np.array([-np.sin(a), np.cos(a)])
        return pivot[0] * along + pivot[1] * across

    moved: FloatArray = ankle + at(0) - at(turn)
    return moved


def _knee_for(distance: float) -> float:
    """Return the bend of the knee, in degrees, that brings the ankle to a distance from the hip."""
    low, high = 0.0, 150.0
    ankle = Curve(np.array([[700.0, 0.0]]), {})
    for _ in range(50):
        middle = (low + high) / 2
        far = float(np.hypot(*bent(ankle, (0, 0), 0, [KNEE], [middle]).points[0])) > distance
        low, high = (middle, high) if far else (low, middle)
    return low


def _upper(knots: Sequence[Knot], phase: int) -> Vertices:
    """Return body or head, which lean a little into the step."""
    lean = np.radians((3.0, 4.5, 3.0, 1.5)[phase % 4])
    turn = np.array([[np.cos(lean), np.sin(lean)], [-np.sin(lean), np.cos(lean)]])
    return _placed(smooth(knots).mapped(lambda p: p @ turn + _hip(phase)), 40)


def _arm(phase: int, swing: int) -> Vertices:
    """Return an arm in front (1) or behind (-1); the elbow bends forward only."""
    x, y = np.array(SHOULDER) + _hip(phase) + (0.05 * 440, 0)
    heading, elbow = (62.0, -34.0) if swing > 0 else (124.0, -22.0)
    return _placed(bent(smooth(ARM), (float(x), float(y)), heading, [Joint(280, 180)], [elbow]), 34)
