import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.methods.plan import inbetween

TIMES = np.linspace(0, 1, 17)


def rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def leg(knee, foot=80):
    """A shoe on the ground, a shin and a thigh that leans with the knee; the first vertices are the sole."""
    shin = np.array([[15.0, 40.0], [15.0, 120.0]])
    hip = np.array([0.0, 120.0]) + np.array([[15.0, 100.0], [-15.0, 100.0]]) @ rotation(knee)
    back = np.array([[-15.0, 120.0], [-15.0, 40.0]])
    sole = np.stack([np.linspace(-30, foot, 12), np.zeros(12)], axis=1)
    toe = np.array([[foot, 25.0]])
    even = [sole, toe, shin, hip, back, [[-30.0, 25.0]]]
    return np.concatenate(even)


@pytest.mark.parametrize("knee", [-1.5, -0.5, 0.5, 1.5])
def test_a_planted_foot_does_not_slide_while_the_knee_bends(knee):
    a, b = leg(0.0), leg(knee)
    frames = inbetween(a, b, TIMES)
    slide = np.linalg.norm(frames[:, :12] - a[:12], axis=2).max()
    assert slide < 0.01 * 220


@settings(max_examples=50, deadline=None)
@given(st.floats(-3, 3), st.floats(0.3, 3), st.floats(-200, 200), st.floats(-20, 20))
def test_a_drawing_that_turns_about_a_point_in_it_keeps_that_point(angle, scale, x, y):
    a = leg(0.7)
    centre = np.array([x / 20, 100 + y])
    b = scale * (a - centre) @ rotation(angle) + centre
    for t, frame in zip(TIMES, inbetween(a, b, TIMES), strict=True):
        expected = (1 + (scale - 1) * t) * (a - centre) @ rotation(t * angle) + centre
        np.testing.assert_allclose(frame, expected, atol=1e-6)


def test_a_limb_turns_about_the_joint_it_hangs_from():
    a = leg(0.0)
    hip = np.array([0.0, 220.0])
    b = (a - hip) @ rotation(1.2) + hip
    for t, frame in zip(TIMES, inbetween(a, b, TIMES), strict=True):
        np.testing.assert_allclose(frame, (a - hip) @ rotation(1.2 * t) + hip, atol=1e-6)


def test_a_shift_without_a_turn_is_straight():
    a = leg(0.7)
    frames = inbetween(a, a + np.array([300.0, -100.0]), TIMES)
    np.testing.assert_allclose(frames, a + TIMES[:, None, None] * [300.0, -100.0], atol=1e-9)


def test_a_far_throw_with_a_small_turn_is_all_but_straight():
    a = leg(0.7)
    middle = a.mean(axis=0)
    b = (a - middle) @ rotation(0.3) + middle + [5000.0, 0.0]
    centres = inbetween(a, b, TIMES).mean(axis=1)
    np.testing.assert_allclose(centres[:, 1], middle[1], atol=0.03 * 220)


def test_extra_turns_spin_in_place():
    a = leg(0.7)
    frames = inbetween(a, a, TIMES, turns=1)
    quarter = frames[4] - frames[4].mean(axis=0)
    np.testing.assert_allclose(quarter, (a - a.mean(axis=0)) @ rotation(np.pi / 2), atol=1e-9)
    assert np.linalg.norm(frames - a.mean(axis=0), axis=2).max() < 300


def test_placement_changes_continuously_where_nothing_stands_still():
    """Two equal shifts, then one of them a hair longer: no other vertex may suddenly hold the drawing."""
    a = leg(0.7)
    b = a + np.array([200.0, 50.0])
    nudged = b.copy()
    nudged[3] += [1e-6, 0.0]
    np.testing.assert_allclose(inbetween(a, nudged, TIMES), inbetween(a, b, TIMES), atol=1e-5)


@pytest.mark.parametrize("turns", [0, 1])
def test_placement_is_continuous_where_a_turn_passes_through_nothing(turns):
    a = leg(0.7)
    middle = a.mean(axis=0)
    shift = np.array([3.0, 2.0])
    frames = [
        inbetween(a, (a - middle) @ rotation(e) + middle + shift, TIMES, turns=turns) for e in (-1e-6, 0.0, 1e-6)
    ]
    np.testing.assert_allclose(frames[0], frames[1], atol=0.01)
    np.testing.assert_allclose(frames[2], frames[1], atol=0.01)
