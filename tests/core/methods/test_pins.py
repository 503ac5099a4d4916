import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from core.errors import GeometryError
from core.geometry.outline import points_at
from core.methods.pins import Inside, OnOutline, Pin
from core.methods.plan import METHODS, AlignedPair, plan, plan_drawing
from core.repair.between import inbetween

TIMES = np.linspace(0.05, 0.95, 10)


@pytest.fixture(params=METHODS)
def method(request):
    return request.param


def rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def bar(bend, n=40, width=12.0):
    """A bar 200 px long, bent evenly by `bend` radians."""
    along = np.linspace(-0.5, 0.5, n)
    middle = np.cumsum(np.exp(1j * bend * along)) * 200 / n
    side = width * 1j * np.exp(1j * bend * along)
    z = np.concatenate([middle - side, (middle + side)[::-1]])
    return np.stack([z.real, z.imag], axis=1)


def circle(centre, radius, n=40):
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.array(centre) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def bezier(a, h, k, b, s):
    s = np.asarray(s)[:, None]
    return (1 - s) ** 3 * a + 3 * (1 - s) ** 2 * s * h + 3 * (1 - s) * s**2 * k + s**3 * b


positions = st.lists(st.floats(0, 79.99).map(lambda p: round(p, 2)), min_size=1, max_size=6, unique=True)


@settings(max_examples=15, deadline=None)
@given(positions, st.floats(-2, 2), st.floats(-3, 3))
@pytest.mark.parametrize("method", METHODS)
def test_any_number_of_pins_without_handles_go_straight(method, places, bend, turn):
    a, b = bar(0.1), bar(bend) @ rotation(turn)
    places = [p for k, p in enumerate(places) if all(abs(p - q) > 0.5 for q in places[:k])]
    pins = [Pin(OnOutline(0, p)) for p in places]
    frames = plan(a, b, method=method, pins=pins).evaluate(TIMES)
    for t, frame in zip(TIMES, frames, strict=True):
        straight = (1 - t) * points_at(a, places) + t * points_at(b, places)
        assert np.abs(points_at(frame, places) - straight).max() < 1e-9 * 200


def test_a_point_that_both_keyframes_have_at_the_same_place_is_held_still(method):
    a = bar(0.0)
    b = (a - a[7]) @ rotation(1.2) + a[7]
    frames = plan(a, b, method=method, pins=[Pin(OnOutline(0, 7.0))]).evaluate(np.linspace(-0.5, 1.5, 21))
    assert np.abs(frames[:, 7] - a[7]).max() < 1e-9 * 200


def test_a_pin_with_handles_follows_its_arc_at_even_speed(method):
    a, b = bar(0.0), bar(1.5)
    first, last = np.array([150.0, -80.0]), np.array([250.0, 60.0])
    pins = [Pin(OnOutline(0, 20.0), (tuple(first), tuple(last))), Pin(OnOutline(0, 0.0))]
    way = plan(a, b, method=method, pins=pins).evaluate(np.linspace(0, 1, 101))[:, 20]
    arc = bezier(a[20], first, last, b[20], np.linspace(0, 1, 20001))
    gap = np.linalg.norm(way[:, None] - arc[None, ::4], axis=2).min(axis=1)
    assert gap.max() < 0.1
    steps = np.linalg.norm(np.diff(way, axis=0), axis=1)
    assert np.ptp(steps) < 0.05 * steps.mean()


def test_keyframes_are_met_bit_for_bit_with_pins_and_frames_run_into_them(method):
    a, b = bar(0.0), bar(1.5) @ rotation(0.7)
    pins = [Pin(OnOutline(0, 20.0), ((0.0, 0.0), (9.0, 9.0))), Pin(OnOutline(0, 61.5)), Pin(Inside(100.0, 0.0))]
    frames = plan(a, b, method=method, pins=pins).evaluate([0.0, 1.0, 1e-9, 1 - 1e-9])
    assert np.array_equal(frames[:2], [a, b])
    np.testing.assert_allclose(frames[2:], [a, b], atol=1e-4)


def test_pins_without_anything_to_do_change_nothing():
    a, b = bar(0.0), bar(1.0)
    pins = [Pin(OnOutline(0, p)) for p in (0.0, 20.0, 50.0)]
    free = inbetween(a, b, TIMES, "linear")
    np.testing.assert_allclose(plan(a, b, method="linear", pins=pins).evaluate(TIMES), free, atol=1e-9)


def test_one_pin_shifts_the_frame_and_leaves_its_form(method):
    a, b = bar(0.0), bar(1.0) @ rotation(2.0)
    free = inbetween(a, b, TIMES, method)
    pinned = plan(a, b, method=method, pins=[Pin(OnOutline(0, 11.0))]).evaluate(TIMES)
    np.testing.assert_allclose(pinned - pinned[:, :1], free - free[:, :1], atol=1e-9)


def test_a_point_inside_goes_straight(method):
    a = circle((0, 0), 100)
    b = circle((300, 50), 80) @ rotation(0.4)
    frames = plan(a, b, method=method, pins=[Pin(Inside(20.0, 30.0))]).evaluate(TIMES)

    # the affine map from keyframe to frame tells where a point of the inside is
    def inside(frame):
        return np.linalg.lstsq(np.column_stack([a, np.ones(40)]), frame, rcond=None)[0].T @ [20.0, 30.0, 1.0]

    for t, frame in zip(TIMES, frames, strict=True):
        np.testing.assert_allclose(inside(frame), (1 - t) * np.array([20.0, 30.0]) + t * inside(b), atol=1e-6)


def test_neighbouring_frames_never_jump_and_no_kink_shows_at_a_pin(method):
    a, b = bar(0.0, 100), bar(1.5, 100)
    pins = [
        Pin(OnOutline(0, 0.0)),
        Pin(OnOutline(0, 99.0)),
        Pin(OnOutline(0, 50.0), ((140.0, 60.0), (160.0, 80.0))),
    ]
    frames = plan(a, b, method=method, pins=pins).evaluate(np.linspace(0, 1, 241))
    steps = np.linalg.norm(np.diff(frames, axis=0), axis=2).max(axis=1)
    assert steps.max() < 3 * np.median(steps)
    side = frames[:, 10:90] @ np.array([1, 1j])  # the side of the bar with a pin in it, without its corners
    bends = np.abs(np.angle(np.diff(side, axis=1)[:, 1:] / np.diff(side, axis=1)[:, :-1]))
    assert bends.max() < 0.25


def test_a_rigid_bar_led_along_an_arc_keeps_its_area_better_than_a_straight_one():
    a, b = bar(0.0), bar(1.5)
    pins = [
        Pin(OnOutline(0, 0.0)),
        Pin(OnOutline(0, 39.0)),
        Pin(OnOutline(0, 20.0), ((120.0, -80.0), (120.0, -80.0))),
    ]
    worst = {
        m: max(abs(Polygon(f).area / Polygon(a).area - 1) for f in plan(a, b, method=m, pins=pins).evaluate(TIMES))
        for m in ("linear", "rigid")
    }
    assert worst["rigid"] < worst["linear"]


def test_pins_on_a_drawing_with_a_hole_and_an_apart_outline_are_exact(method):
    before = [circle((0, 0), 100), circle((20, 0), 30), circle((250, 0), 40, 9)]
    after = [p @ rotation(1.0) * [1.2, 0.9] for p in before]
    pairs = [AlignedPair(a, b) for a, b in zip(before, after, strict=True)]
    places = [(0, 3.5), (0, 21.0), (1, 7.0), (2, 4.25)]
    paths = plan_drawing(pairs, method=method, pins=[Pin(OnOutline(*p)) for p in places])
    frames = paths.evaluate(TIMES)
    for number, position in places:
        ends = [points_at(x[number], [position])[0] for x in (before, after)]
        for t, frame in zip(TIMES, frames[number], strict=True):
            got = points_at(frame, [position])[0]
            assert np.abs(got - (1 - t) * ends[0] - t * ends[1]).max() < 1e-9 * 300


def test_everything_moves_with_a_drawing_that_moves():
    a, b = bar(0.0), bar(1.5)
    turn, shift = rotation(0.8), np.array([500.0, -300.0])
    handles = ((120.0, -80.0), (140.0, -60.0))
    moved = tuple(tuple(np.array(h) @ turn + shift) for h in handles)
    for method in METHODS:
        plain = plan(a, b, method=method, pins=[Pin(OnOutline(0, 20.0), handles), Pin(OnOutline(0, 0.0))])
        other = plan(
            a @ turn + shift,
            b @ turn + shift,
            method=method,
            pins=[Pin(OnOutline(0, 20.0), moved), Pin(OnOutline(0, 0.0))],
        )
        np.testing.assert_allclose(other.evaluate(TIMES), plain.evaluate(TIMES) @ turn + shift, atol=0.02)


@pytest.mark.parametrize(
    ("pin", "message"),
    [
        (Pin(OnOutline(1, 0.0)), "pin 0 is on outline 1; the drawing has 1"),
        (Pin(OnOutline(0, np.nan)), "the position of pin 0"),
        (Pin(Inside(np.inf, 0.0)), "the place of pin 0"),
        (Pin(OnOutline(0, 1.0), ((0.0, np.nan), (1.0, 1.0))), "a handle of pin 0"),
    ],
)
def test_pins_that_are_none_are_refused(pin, message):
    with pytest.raises(GeometryError, match=message):
        plan(bar(0.0), bar(1.0), pins=[pin])


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.floats(-50, 250), st.floats(-50, 50)), min_size=1, max_size=4))
def test_pins_anywhere_and_on_one_another_give_finite_frames(places):
    pins = [Pin(Inside(*p)) for p in [*places, places[0]]]
    for method in METHODS:
        assert np.isfinite(plan(bar(0.0), bar(1.0), method=method, pins=pins).evaluate([-1, 0.5, 2])).all()
