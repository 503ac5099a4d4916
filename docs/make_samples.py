"""Draw the sample documents: `python docs/make_samples.py [FOLDER]`, by default into resources/samples.

All geometry is made here, by numbers. Coordinates are rounded to a hundredth of a pixel, so that the same files
come out on every machine. A limb is drawn once, stretched out along its bone (x along it, y across), and bent
into every keyframe; its vertices are then set anew, as an artist would draw each keyframe anew.
"""

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))

from sample_ball import bouncing_ball
from sample_letters import turning_letter
from sample_parts import Curve, Joint, Knot, Vertices, bent, document, smooth, with_vertices
from sample_walk import walk

from core.io.project import SUFFIX, save
from core.model.document import Document
from core.model.drawing import Style
from core.model.easing import Easing


def bending_arm() -> Document:
    """Return the demo: a strong arm that bends and stretches again."""
    joints = (Joint(420, 260), Joint(735, 120))

    def arm(spacing: float, heading: float, turns: tuple[float, float], muscle: float) -> Vertices:
        knots = (
            Knot(-96, 0, "shoulder"), Knot(-66, 66), Knot(20, 96), Knot(150, 88 + muscle), Knot(270, 82 + muscle),
            Knot(410, 58, "crook"), Knot(500, 68), Knot(600, 58), Knot(710, 40, "wrist"), Knot(770, 66),
            Knot(806, 104), Knot(842, 146), Knot(874, 156), Knot(894, 132, "thumb"), Knot(878, 96),
            Knot(866, 66, "cleft", True), Knot(930, 74), Knot(1010, 68), Knot(1062, 36), Knot(1070, -14, "tip"),
            Knot(1034, -56), Knot(940, -78), Knot(830, -76), Knot(766, -56), Knot(710, -42), Knot(600, -60),
            Knot(500, -70), Knot(410, -72, "elbow"), Knot(280, -72), Knot(140, -86), Knot(20, -96), Knot(-66, -66),
        )  # fmt: skip
        drawn = bent(smooth(knots), (1440, 600), heading, joints, turns)
        return with_vertices(drawn.mapped(lambda p: (p - (960, 540)) * 1.1 + (960, 556)), spacing)

    stretched, curled = arm(60, 176, (22, -6), 0), arm(52, 156, (112, 18), 26)
    anchors = ("shoulder", "crook", "wrist", "thumb", "cleft", "tip", "elbow")
    style = Style("#7d6be0", "#4a3bab", 6.0)
    return document("arm", {1: [stretched], 19: [curled], 36: [stretched]}, style, anchors=[anchors])


def square_to_diamond() -> Document:
    """Return the textbook's example: one turns into the other, and the straight way shrinks it."""

    def corners(*points: tuple[float, float]) -> Vertices:
        return Vertices(np.array(points), {"top": 0})

    square = corners((700, 280), (1220, 280), (1220, 800), (700, 800))
    diamond = corners((960, 160), (1240, 540), (960, 920), (680, 540))
    style = Style("#e0a030", "#946410", 6.0)
    return document("shape", {1: [square], 24: [diamond]}, style, anchors=[["top"]])


def bird_wing() -> Document:
    """Return a wing that beats: up, down and up again, so that it loops."""
    joints = (Joint(330, 420), Joint(760, 480))

    def wing(spacing: float, heading: float, turns: tuple[float, float], width: float) -> Vertices:
        knots = [Knot(-40, 30, "root"), Knot(-20, -46), Knot(90, -84), Knot(240, -82), Knot(370, -64, "wrist")]
        knots += [Knot(560, -66), Knot(760, -58), Knot(940, -30), Knot(1050, 8)]
        knots += [*_feathers(), Knot(60, 150), Knot(-4, 96)]
        knots = [Knot(x, y * (width if y > 0 else 1), *rest) for x, y, *rest in knots]
        drawn = bent(smooth(knots), (0, 0), heading, joints, turns)
        return with_vertices(drawn.mapped(lambda p: p * 0.84 + (570, 590)), spacing)

    up, down = wing(80, -58, (16, 30), 1.0), wing(70, 26, (-8, -34), 0.88)
    anchors = ("root", "wrist", "tip", *(f"notch {i}" for i in range(10)))
    style = Style("#36a497", "#1d6e65", 5.0)
    return document("wing", {1: [up], 13: [down], 24: [up]}, style, anchors=[anchors])


def _feathers() -> list[Knot]:
    """Return the trailing edge of the wing: round tips that fan out, with notches between them."""
    tips = [(1150, 70), (1096, 146), (1022, 206), (930, 244), (824, 264), (710, 270), (594, 266), (476, 256)]
    tips += [(358, 240), (244, 214), (130, 186)]
    knots = []
    for i, way in enumerate(np.radians(np.linspace(22, 96, len(tips) - 1))):
        tip, following = np.array(tips[i]), np.array(tips[i + 1])
        out, across = np.array([np.cos(way), np.sin(way)]), np.array([np.sin(way), -np.cos(way)])
        knots += [Knot(*(tip + 17 * across - 12 * out)), Knot(*tip, "" if i else "tip")]
        knots += [Knot(*(tip - 19 * across - 14 * out))]
        knots.append(Knot(*((tip + following) / 2 - (62 - 4 * i) * out), f"notch {i}", corner=True))
    return knots


class Step(NamedTuple):
    """A keyframe of the walk: where the hip is, where the ankle is, and how far the heel is up (degrees)."""

    hip: tuple[float, float]
    ankle: tuple[float, float]
    heel: float


def walking_leg() -> Document:
    """Return one stride: the foot stands while the body passes over it, then swings to the next place."""
    joints = (Joint(350, 190), Joint(700, 70))
    knots = (
        Knot(-104, 0, "hip"), Knot(-74, -74), Knot(10, -112), Knot(150, -104), Knot(280, -76),
        Knot(350, -66, "knee"), Knot(440, -54), Knot(560, -42), Knot(668, -36, "instep"),
        Knot(722, -84), Knot(752, -150),
        Knot(778, -172, "toe"), Knot(798, -150, "sole"), Knot(800, -60), Knot(800, 30, "heel"), Knot(780, 56),
        Knot(740, 58), Knot(690, 40, "ankle"), Knot(600, 50), Knot(480, 78), Knot(350, 58, "hollow"),
        Knot(270, 74), Knot(150, 104), Knot(10, 112), Knot(-74, 74),
    )  # fmt: skip
    rest = smooth(knots)
    ball = np.array([795.0, -120.0])

    def leg(spacing: float, step: Step) -> Vertices:
        knee = _knee_for(joints[0], float(np.hypot(*np.subtract(step.ankle, step.hip))))
        reach = bent(Curve(np.array([[700.0, 0.0]]), {}), (0, 0), 0, joints[:1], [knee]).points[0]
        way = np.subtract(step.ankle, step.hip)
        heading = np.degrees(np.arctan2(way[1], way[0]) - np.arctan2(reach[1], reach[0]))
        return with_vertices(
            bent(rest, step.hip, heading, joints, (knee, 90 + step.heel - heading - knee)), spacing
        )

    def rolled(at: float, heel: float) -> tuple[float, float]:
        """Ankle of a foot that stands at `at` and rolls over its ball."""
        a = np.radians(90 + heel)
        offset = np.array([700.0, 0.0]) - ball
        x = offset[0] * np.cos(a) - offset[1] * np.sin(a)
        y = offset[0] * np.sin(a) + offset[1] * np.cos(a)
        return at + 120 + float(x), 925 + float(y)

    first, stride = 640.0, 760.0
    steps = {
        1: Step((420, 190), rolled(first, 0), 0),
        9: Step((640, 144), rolled(first, 0), 0),
        17: Step((850, 196), rolled(first, 34), 34),
        25: Step((1010, 184), (first + 330, 700), 46),
        33: Step((420 + stride, 190), rolled(first + stride, 0), 0),
    }
    keyframes = {frame: [leg(50 + 3 * i, step)] for i, (frame, step) in enumerate(steps.items())}
    anchors = ("hip", "knee", "instep", "toe", "sole", "heel", "ankle", "hollow")
    style = Style("#d9695f", "#93392f", 5.0)
    return document("leg", keyframes, style, easing=Easing(), anchors=[anchors])


def _knee_for(joint: Joint, distance: float) -> float:
    """Return the bend of the knee, in degrees, that brings the ankle to `distance` from the hip."""
    low, high = 0.0, 150.0
    ankle = Curve(np.array([[700.0, 0.0]]), {})
    for _ in range(50):
        middle = (low + high) / 2
        far = float(np.hypot(*bent(ankle, (0, 0), 0, [joint], [middle]).points[0])) > distance
        low, high = (middle, high) if far else (low, middle)
    return low


def letter() -> Document:
    """Return an A that becomes an R: an outline and a hole, filled even-odd."""
    a = [
        ("foot", 0, 700), ("top left", 235, 0), ("top right", 385, 0), ("right foot", 620, 700),
        ("right heel", 484, 700), ("crotch", 434, 544), ("bar", 186, 544), ("heel", 136, 700),
    ]  # fmt: skip
    r = [
        ("foot", 60, 700), ("top left", 60, 0), ("top right", 330, 0), ("right foot", 590, 700),
        ("right heel", 436, 700), ("crotch", 292, 436), ("bar", 192, 436), ("heel", 192, 700),
    ]  # fmt: skip
    bowl = [Knot(470, 60), Knot(528, 212), Knot(470, 356), Knot(412, 400, "", True)]
    a_hole = [Knot(310, 156, "top", True), Knot(397, 430, "right", True), Knot(223, 430, "left", True)]
    r_hole = [
        Knot(192, 118, "top", True), Knot(310, 118, "", True), Knot(372, 142), Knot(396, 216), Knot(372, 290),
        Knot(310, 318, "right", True), Knot(192, 318, "left", True),
    ]  # fmt: skip

    def cut(knots: Sequence[Knot], spacing: float) -> Vertices:
        return with_vertices(smooth(knots).mapped(lambda p: p * 1.18 + (592, 128)), spacing)

    def cornered(corners: Sequence[tuple[str, float, float]]) -> list[Knot]:
        return [Knot(x, y, mark, True) for mark, x, y in corners]

    outer_r = [*cornered(r[:3]), *bowl, *cornered(r[3:])]
    before = [cut(cornered(a), 90), cut(a_hole, 80)]
    after = [cut(outer_r, 80), cut(r_hole, 60)]
    style = Style("#c25fa6", "#85366f", 5.0)
    anchors = ([mark for mark, _, _ in a], ["top", "right", "left"])
    return document("letter", {1: before, 24: after}, style, anchors=anchors)


SAMPLES: dict[str, Callable[[], Document]] = {
    "bending arm": bending_arm,
    "bird wing": bird_wing,
    "bouncing ball": bouncing_ball,
    "letter": letter,
    "square to diamond": square_to_diamond,
    "turning letter": turning_letter,
    "walk": walk,
    "walking leg": walking_leg,
}


def main(folder: Path) -> None:
    """Write every sample into `folder`."""
    for name, draw in SAMPLES.items():
        save(draw(), folder / f"{name}{SUFFIX}")


if __name__ == "__main__":
    here = Path(__file__).resolve().parent.parent
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else here / "resources" / "samples")
