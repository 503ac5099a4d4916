import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.geometry.outline import signed_area
from core.methods.plan import AlignedPair, plan_drawing
from core.repair.between import inbetween

TIMES = np.linspace(0, 1, 9)


def rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def circle(centre, radius, n=24, start=0.0):
    angle = start + 2 * np.pi * np.arange(n) / n
    return np.asarray(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def letter():
    """A round letter: outer outline, a hole drawn the other way, and a stroke beside it."""
    stroke = np.array([[90.0, -100.0], [110.0, -100.0], [110.0, 100.0], [90.0, 100.0]])
    return [circle((0, 0), 100), circle((10, 20), 60)[::-1], stroke]


def drawing(before, after, **options):
    return plan_drawing([AlignedPair(a, b) for a, b in zip(before, after, strict=True)], **options)


@settings(max_examples=40, deadline=None)
@given(st.floats(-3, 3), st.floats(0.3, 3), st.floats(-500, 500), st.integers(-2, 2), st.permutations([0, 1, 2]))
def test_a_drawing_with_a_hole_turns_and_grows_as_one(angle, scale, shift, turns, order):
    before = [letter()[k] for k in order]
    after = [scale * p @ rotation(angle) + [shift, 2 * shift] for p in before]
    frames = drawing(before, after, turns=turns).evaluate(TIMES)
    base = np.concatenate(before)
    for k, t in enumerate(TIMES):
        now = np.concatenate([f[k] for f in frames])
        expected = (1 + (scale - 1) * t) * base @ rotation(t * (angle + 2 * np.pi * turns))
        np.testing.assert_allclose(now - now.mean(axis=0), expected - expected.mean(axis=0), atol=1e-9)


def test_the_hole_of_a_bending_strip_stays_between_its_walls():
    def strip(bend):
        s = np.linspace(0, 400, 81)
        angle = bend * s / 400
        middle = np.concatenate([[[0, 0]], np.cumsum(np.stack([np.cos(angle), np.sin(angle)], 1)[1:] * 5, axis=0)])
        side = np.stack([-np.sin(angle), np.cos(angle)], axis=1)
        near = np.abs(s - 340) <= 30
        outer = np.concatenate([middle + 30 * side, (middle - 30 * side)[::-1]])
        hole = np.concatenate([(middle + 10 * side)[near], (middle - 10 * side)[near][::-1]])
        return [outer, hole], middle[68], np.flatnonzero(near)

    (before, _, _), (after, _, _) = strip(0.0), strip(3.0)
    outer, hole = drawing(before, after).evaluate(TIMES)
    for k in range(len(TIMES)):
        walls = (outer[k, 62:75].mean(axis=0) + outer[k, ::-1][62:75].mean(axis=0)) / 2
        np.testing.assert_allclose(hole[k].mean(axis=0), walls, atol=1.5)


def test_parts_take_the_same_way_round_as_their_drawing():
    """A part that turns by 170 degrees more than a body turning 100 goes on to 270 and not back to -90."""
    body = np.array([[0.0, 0.0], [300.0, 0.0], [300.0, 80.0], [0.0, 80.0]])
    part = np.array([[310.0, 0.0], [350.0, 0.0], [350.0, 30.0], [310.0, 30.0]])
    centre = part.mean(axis=0)
    turned = ((part - centre) @ rotation(np.radians(170)) + centre) @ rotation(np.radians(100))
    frames = drawing([body, part], [body @ rotation(np.radians(100)), turned]).evaluate(TIMES)[1]
    edge = frames[:, 1] - frames[:, 0]
    heading = np.degrees(np.unwrap(np.arctan2(edge[:, 1], edge[:, 0])))
    np.testing.assert_allclose(heading - heading[0], 270 * TIMES, atol=1e-6)


def test_an_outline_alone_in_a_drawing_moves_as_without_one():
    a, b = circle((0, 0), 50), circle((30, 0), 80, start=1.0)
    assert np.array_equal(drawing([a], [b]).evaluate(TIMES)[0], inbetween(a, b, TIMES))


def test_the_order_of_outlines_does_not_matter():
    rng = np.random.default_rng(4)
    before = letter()
    after = [p @ rotation(1.2) + rng.uniform(-8, 8, p.shape) for p in before]
    frames = drawing(before, after).evaluate(TIMES)
    turned_round = drawing(before[::-1], after[::-1]).evaluate(TIMES)
    for x, y in zip(frames, turned_round[::-1], strict=True):
        np.testing.assert_allclose(x, y, atol=1e-9)


def test_exchanging_keyframes_and_time_gives_the_same_drawing():
    rng = np.random.default_rng(4)
    before = letter()
    after = [p @ rotation(1.2) + rng.uniform(-8, 8, p.shape) for p in before]
    there, back = drawing(before, after).evaluate(TIMES), drawing(after, before).evaluate(1 - TIMES)
    for x, y in zip(there, back, strict=True):
        np.testing.assert_allclose(x, y, atol=1e-9)


@pytest.mark.parametrize("side", ["before", "after"])
def test_an_outline_that_is_a_point_on_one_side_grows_in_shape_and_turns_with_the_rest(side):
    outer = circle((0, 0), 100)
    dot = np.array([[20.0, 0.0], [40.0, 0.0], [40.0, 30.0]])
    point = np.full((3, 2), [[30.0, 10.0]])
    small, large = [outer, point], [p @ rotation(1.0) for p in (outer, dot)]
    if side == "before":
        frames, grown = drawing(small, large).evaluate(TIMES)[1], TIMES
    else:
        frames, grown = drawing(large, small).evaluate(TIMES)[1], 1 - TIMES
    for frame, s in zip(frames, grown, strict=True):
        expected = s * dot @ rotation(s * 1.0)
        np.testing.assert_allclose(frame - frame[0], expected - expected[0], atol=1e-9)


def test_collapsed_sides_of_all_kinds_are_finite_without_a_warning():
    dot = np.array([[20.0, 0.0], [40.0, 0.0], [40.0, 30.0]])
    point = np.full((3, 2), 30.0)
    cases = [([point], [point]), ([point], [dot]), ([dot], [point]), ([point, point], [point + 5, dot])]
    cases += [([dot, point], [point, dot]), ([dot, point, point], [dot, point + 1, point - 1])]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for before, after in cases:
            for closed in (True, False):
                pairs = [AlignedPair(a, b, closed) for a, b in zip(before, after, strict=True)]
                for method in ("linear", "intrinsic"):
                    frames = plan_drawing(pairs, method=method).evaluate(np.linspace(-0.5, 1.5, 9))
                    for frame, a, b in zip(frames, before, after, strict=True):
                        assert np.isfinite(frame).all()
                        assert np.array_equal(frame[2], a)
                        assert np.array_equal(frame[6], b)


def test_closed_and_open_outlines_share_a_drawing():
    line = np.array([[-50.0, 0.0], [0.0, 10.0], [50.0, 0.0]])
    before = [AlignedPair(circle((0, 0), 100), circle((0, 0), 100) @ rotation(2.0), True)]
    frames = plan_drawing([*before, AlignedPair(line, line @ rotation(2.0), False)]).evaluate(TIMES)
    np.testing.assert_allclose(frames[1][4] - frames[1][4, 1], (line - line[1]) @ rotation(1.0), atol=1e-9)
    np.testing.assert_allclose(frames[1][4], line @ rotation(1.0), atol=1e-9)


def test_a_hole_keeps_its_share_of_the_area_while_the_letter_turns():
    before = letter()[:2]
    after = [p @ rotation(2.5) for p in before]
    outer, hole = drawing(before, after).evaluate(TIMES)
    np.testing.assert_allclose(signed_area(hole) / signed_area(outer), -0.36, rtol=1e-9)
