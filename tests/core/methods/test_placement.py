import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from core.errors import GeometryError
from core.methods.pins import OnOutline, Pin
from core.methods.plan import AlignedPair, other_way, plan, plan_drawing, turn_of
from core.repair.between import inbetween

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


def star(radii, turn=0.0):
    angle = np.linspace(0, 2 * np.pi, len(radii), endpoint=False) + turn
    return np.asarray(radii)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def centroid(points):
    return np.array(Polygon(points).centroid.coords[0])


radii = st.lists(st.floats(40, 90), min_size=8, max_size=8)
methods = pytest.mark.parametrize("method", ["intrinsic", "rigid"])


@methods
@settings(max_examples=15, deadline=None)
@given(radii, radii, st.floats(-3, 3), st.floats(-500, 500), st.integers(-1, 1))
def test_the_centroid_goes_straight_at_even_speed(method, one, other, turn, x, turns):
    a, b = star(one), star(other, turn) + np.array([x, 70.0])
    frames = inbetween(a, b, TIMES, method, turns=turns, placement="centroid")
    for t, frame in zip(TIMES, frames, strict=True):
        assert Polygon(frame).area > 0.25 * min(Polygon(a).area, Polygon(b).area)
        np.testing.assert_allclose(centroid(frame), (1 - t) * centroid(a) + t * centroid(b), atol=1e-9 * 600)
    assert np.array_equal(frames[[0, -1]], [a, b])


@methods
@settings(max_examples=10, deadline=None)
@given(radii, radii, st.floats(-3, 3))
def test_a_straight_centroid_changes_only_where_frames_lie(method, one, other, turn):
    a, b = star(one), star(other, turn) + np.array([200.0, 70.0])
    still, straight = (inbetween(a, b, TIMES, method, placement=p) for p in ("still", "centroid"))
    np.testing.assert_allclose(still - still[:, :1], straight - straight[:, :1], atol=1e-9 * 600)


@settings(max_examples=15, deadline=None)
@given(radii, radii, st.floats(-3, 3), st.floats(-3, 3), st.floats(0.01, 100), st.integers(0, 7))
def test_a_straight_centroid_depends_on_no_units_no_start_no_direction_and_no_order(
    one, other, turn, angle, scale, k
):
    a, b = star(one), star(other, turn) + np.array([200.0, 70.0])
    frames = inbetween(a, b, TIMES, placement="centroid")

    def similar(p):
        return scale * p @ rotation(angle) + [30.0, 40.0]

    def close(found, expected, size=600.0):
        np.testing.assert_allclose(found, expected, atol=1e-9 * size)

    close(inbetween(similar(a), similar(b), TIMES, placement="centroid"), similar(frames), 600 * scale + 100)
    close(inbetween(np.roll(a, k, 0), np.roll(b, k, 0), TIMES, placement="centroid"), np.roll(frames, k, 1))
    close(inbetween(a[::-1], b[::-1], TIMES, placement="centroid"), frames[:, ::-1])
    close(inbetween(b, a, 1 - TIMES, placement="centroid"), frames)


def test_the_hole_of_a_ring_counts_as_nothing():
    outer, hole = star([100.0] * 24), star([30.0] * 24) + np.array([40.0, 0.0])

    def ring(turn, place):
        return [p @ rotation(turn) + place for p in (outer, hole)]

    def middle(parts):
        return np.array(Polygon(parts[0], [parts[1]]).centroid.coords[0])

    a, b = ring(0.0, [0.0, 0.0]), ring(2.0, [300.0, 50.0])
    for flip in (1, -1):  # whichever way round the hole is drawn
        pairs = [AlignedPair(a[0], b[0]), AlignedPair(a[1][::flip], b[1][::flip])]
        frames = plan_drawing(pairs, placement="centroid").evaluate(TIMES)
        for t, outlines in zip(TIMES, zip(*frames, strict=True), strict=True):
            np.testing.assert_allclose(middle(outlines), (1 - t) * middle(a) + t * middle(b), atol=1e-6)


def test_an_open_line_and_a_shape_without_area_go_by_their_outline():
    line = np.stack([np.linspace(0, 100, 11), np.zeros(11)], axis=1)
    frames = inbetween(line, line @ rotation(2.0) + [50.0, 0.0], TIMES, closed=False, placement="centroid")
    middles = frames[:, 5]
    np.testing.assert_allclose(middles, middles[0] + TIMES[:, None] * (middles[-1] - middles[0]), atol=1e-9)
    a = leg(0.7)
    pairs = [AlignedPair(a, np.broadcast_to(a.mean(axis=0) + np.array([9.0, 0.0]), a.shape).copy())]
    for pair in (pairs, [AlignedPair(a, a[::-1].copy())]):
        assert np.isfinite(plan_drawing(pair, placement="centroid").evaluate(TIMES)[0]).all()


@methods
def test_the_centroid_takes_small_steps_even_where_the_shape_turns_inside_out(method):
    a = leg(0.7)
    b = a * [-1.0, 1.0]
    frames = inbetween(a, b, np.linspace(0, 1, 241), method, placement="centroid")
    steps = np.linalg.norm(np.diff(frames, axis=0), axis=2).max(axis=1)
    assert steps.max() < 0.1 * 220


def test_pins_decide_and_not_the_placement():
    a, b = leg(0.0), leg(1.2)
    pins = [Pin(OnOutline(0, 0.0)), Pin(OnOutline(0, 15.0))]
    still, straight = (plan(a, b, pins=pins, placement=p).evaluate(TIMES) for p in ("still", "centroid"))
    np.testing.assert_allclose(still, straight, atol=1e-9 * 220)


def test_an_unknown_placement_is_named():
    with pytest.raises(GeometryError, match='unknown placement "middle"; known are still, centroid'):
        inbetween(leg(0.0), leg(1.0), 0.5, placement="middle")


@methods
@settings(max_examples=15, deadline=None)
@given(st.floats(0.1, 3.0), st.sampled_from([-1, 1]), st.integers(-2, 2))
def test_the_other_way_round_goes_round_the_other_side(method, angle, side, turns):
    a = leg(0.7)
    b = a @ rotation(side * angle)
    natural = turn_of([AlignedPair(a, b)])
    assert natural == pytest.approx(side * angle)
    other = other_way(turns, natural)
    assert other_way(other, natural) == turns
    way, back = natural + 2 * np.pi * turns, natural + 2 * np.pi * other
    assert way * back < 0
    assert abs(abs(way) - abs(back)) < 2 * np.pi
    before = a - a.mean(axis=0)
    for t, frame in zip(TIMES, inbetween(a, b, TIMES, method, turns=other), strict=True):
        np.testing.assert_allclose(frame - frame.mean(axis=0), before @ rotation(t * back), atol=1e-5)


def test_an_exact_half_turn_goes_from_x_towards_y_and_the_other_way_back():
    a = leg(0.7)
    assert turn_of([AlignedPair(a, -a)]) == pytest.approx(np.pi)
    assert other_way(0, np.pi) == -1
    assert turn_of([]) == 0
