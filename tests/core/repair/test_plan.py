from functools import cache

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

import core
from core.certificate import certify_drawing
from core.errors import CancelledError
from core.geometry.crossings import is_simple
from core.geometry.outline import signed_area
from core.methods.pins import Inside, OnOutline, Pin
from core.methods.plan import AlignedPair, plan, plan_drawing
from core.repair.plan import plan_repair, repair_drawing
from tests.core.repair.shapes import any_shape, circle, comb, spiral, untangled

TIMES = np.linspace(0, 1, 241)

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])
DIAMOND = np.array([[50.0, -20.0], [120.0, 50.0], [50.0, 120.0], [-20.0, 50.0]])


def tangled(method="linear"):
    """A pair that needs a repair which takes little time."""
    rng = np.random.default_rng(3)
    return plan(untangled(14, rng), untangled(14, rng), method=method)


@cache
def repaired_once():
    told = []
    return plan_repair(tangled(), progress=told.append), told


def steps(frames):
    return np.hypot(*np.moveaxis(np.diff(frames, axis=0), 2, 0)).max(axis=1)


def count_crossed(frames):
    return sum(not Polygon(p).is_valid for p in frames)


kinds = st.sampled_from(["star", "untangled", "spiral", "comb"])


@given(kinds, kinds, st.integers(2, 12), st.integers(0, 2**32 - 1), st.sampled_from(["linear", "intrinsic"]))
@settings(max_examples=12)
def test_no_in_between_of_simple_keyframes_crosses_itself(kind, other, count, seed, method):
    rng = np.random.default_rng(seed)
    count = 2 * count if "spiral" not in (kind, other) else 2 * count + 20
    a, b = any_shape(kind, count, rng), any_shape(other, count, rng)
    assume(is_simple(a) and is_simple(b))
    repaired = plan_repair(plan(a, b, method=method))
    frames = repaired.evaluate(np.concatenate([TIMES, rng.random(60)]))
    assert repaired.notes == ()
    assert count_crossed(frames) == 0
    assert (signed_area(frames) > 0).all()
    assert np.array_equal(frames[0], a)
    assert np.array_equal(frames[240], b)
    moved = steps(frames[:241])
    assert moved.max() <= 3 * np.median(moved)


@pytest.mark.parametrize("method", ["linear", "intrinsic"])
def test_what_crosses_nowhere_comes_back_byte_for_byte(method):
    found = plan(SQUARE, DIAMOND, method=method)
    repaired = plan_repair(found)
    assert not repaired.changed
    assert np.array_equal(repaired.evaluate(TIMES), found.evaluate(TIMES))


def test_frames_far_from_the_trouble_are_the_methods_own():
    a, b = spiral(60, 1.5), circle(60)
    found = plan(a, b, method="intrinsic")
    wished, frames = found.evaluate(TIMES), plan_repair(found).evaluate(TIMES)
    assert count_crossed(wished) > 20
    assert count_crossed(frames) == 0
    assert (wished == frames).all(axis=(1, 2)).mean() > 0.2


def test_the_deviation_tells_how_far_the_paths_are_bent():
    assert plan_repair(plan(SQUARE, DIAMOND)).deviation == 0
    repaired, _ = repaired_once()
    wished = tangled().evaluate(np.linspace(0, 1, 65))
    away = repaired.evaluate(np.linspace(0, 1, 65)) - wished
    size = np.ptp(wished[[0, -1]].reshape(-1, 2), axis=0).max()
    assert repaired.deviation == pytest.approx(np.sqrt((away**2).sum(axis=2).mean(axis=1)).mean() / size)


def test_repaired_paths_are_continuous():
    repaired, _ = repaired_once()
    coarse, fine = (steps(repaired.evaluate(np.linspace(0, 1, k))).max() for k in (241, 240 * 64 + 1))
    assert fine < coarse / 32


def test_the_same_plan_gives_the_same_bytes():
    assert np.array_equal(plan_repair(tangled()).evaluate(TIMES), repaired_once()[0].evaluate(TIMES))


def test_the_size_of_the_drawing_is_no_matter():
    a, b = tangled().evaluate([0.0, 1.0])
    frames = repaired_once()[0].evaluate(TIMES)
    larger = plan_repair(plan(64 * a, 64 * b, method="linear")).evaluate(TIMES)
    assert np.array_equal(larger, 64 * frames)


def test_the_public_face_repairs_on_demand():
    a, b = comb(40, 2, 60.0), circle(40)
    crossed = core.inbetween(a, b, TIMES, "linear")
    assert count_crossed(crossed) > 0
    assert count_crossed(core.inbetween(a, b, TIMES, "linear", repair=True)) == 0
    assert core.inbetween(a, b, 0.1, "linear", repair=True).shape == (40, 2)


def test_opposite_directions_are_left_alone_and_told():
    found = plan(SQUARE, DIAMOND[::-1])
    repaired = plan_repair(found)
    assert "opposite ways round" in repaired.notes[0]
    assert np.array_equal(repaired.evaluate(TIMES), found.evaluate(TIMES))


def test_a_keyframe_that_crosses_itself_is_left_alone_and_told():
    found = plan(SQUARE, DIAMOND[[0, 2, 1, 3]])
    repaired = plan_repair(found)
    assert "keyframe after crosses itself" in repaired.notes[0]
    assert np.array_equal(repaired.evaluate(TIMES), found.evaluate(TIMES))


def test_work_nobody_waits_for_stops():
    calls = []

    def cancelled():
        calls.append(0)
        return len(calls) > 10

    with pytest.raises(CancelledError):
        plan_repair(tangled(), cancelled=cancelled)
    assert len(calls) == 11


def test_progress_grows_from_nothing_to_all():
    _, told = repaired_once()
    assert told[0] == 0
    assert told[-1] == 1
    assert (np.diff(told) >= 0).all()
    assert len(told) > 20


@pytest.mark.parametrize("method", ["linear", "intrinsic"])
def test_discs_that_change_places_pass_each_other(method):
    places = np.array([[-80.0, 0.0], [80.0, 0.0], [80.0, 30.0], [-80.0, -10.0]])[:, None]
    here, there, back, forth = circle(24, 40.0) + places
    pairs = [AlignedPair(here, there), AlignedPair(back, forth)]
    found = plan_drawing(pairs, method=method)
    times = np.linspace(0, 1, 49)
    assert not certify_drawing(found.evaluate(times), (True, True)).ok
    assert certify_drawing(repair_drawing(found).evaluate(times), (True, True)).ok


def test_a_repaired_open_outline_does_not_cross_itself():
    s = np.linspace(0, 4, 40)
    before = np.stack([40 * s, 20 * np.sin(3 * s)], axis=1)
    found = plan(before, before[::-1] * [1, -1], method="linear", closed=False)
    times = np.linspace(0, 1, 49)
    repaired = plan_repair(found)
    assert repaired.notes == ()
    assert certify_drawing((repaired.evaluate(times),), (False,)).counts["crossing"].sum() == 0


def random_pins(count, vertices, rng):
    """Pins on vertices, on edges and one inside, some of them on arcs."""
    places = [OnOutline(0, float(p)) for p in rng.choice(vertices * 4, count, replace=False) / 4]
    if count > 1:
        places[-1] = Inside(*rng.uniform(-20, 20, 2))
    arcs = [tuple(map(tuple, rng.uniform(-100, 100, (2, 2)))) if rng.random() < 0.4 else None for _ in places]
    return [Pin(place, arc) for place, arc in zip(places, arcs, strict=True)]


def off_pins(found, frames, times):
    """How far the pinned points are from where they must be, in sizes."""
    held = found.drawing.paths.held
    return np.abs(held.at(frames[..., 0] + 1j * frames[..., 1]) - held.wanted(times)).max() / np.ptp(frames[0])


@given(
    kinds,
    kinds,
    st.integers(4, 8),
    st.integers(0, 2**32 - 1),
    st.integers(1, 3),
    st.sampled_from(["linear", "intrinsic", "rigid"]),
)
@settings(max_examples=2)
def test_a_repair_leaves_every_pin_where_it_must_be_and_says_where_it_can_do_nothing(
    kind, other, count, seed, pins, method
):
    rng = np.random.default_rng(seed)
    a, b = any_shape(kind, 2 * count + 8, rng), any_shape(other, 2 * count + 8, rng)
    assume(is_simple(a) and is_simple(b))
    found = plan(a, b, method=method, pins=random_pins(pins, len(a), rng))
    repaired = plan_repair(found)
    times = np.concatenate([TIMES, rng.random(60)])
    frames = repaired.evaluate(times)
    assert off_pins(found, frames, times) < 1e-9
    assert np.array_equal(frames[[0, 240]], [a, b])
    if repaired.notes:
        assert "pins" in repaired.notes[0]
        assert not repaired.changed
    else:
        assert count_crossed(frames) == 0
        wished = steps(found.evaluate(TIMES))
        most = max(8.0, 2.1 * wished.max() / np.median(wished))
        assert pins == 1 or steps(frames[:241]).max() <= most * np.median(steps(frames[:241]))


def standing(left, right):
    """A table with two feet and two spikes on it, their tips there."""
    feet = [[80.0, 10], [80, 100], [70, 100], [70, 20], [10, 20], [10, 100], [0, 100]]
    return np.array([[0.0, 10], [10, 10], left, [20, 10], [60, 10], right, [70, 10], *feet])


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=4)
def test_one_pin_never_stands_in_the_way_of_a_repair(seed):
    rng = np.random.default_rng(seed)
    a, b = standing([90, -120], [65, -20]), standing([15, -20], [-10, -120])
    found = plan(a, b, method="linear", pins=random_pins(1, len(a), rng))
    assert count_crossed(found.evaluate(TIMES)) > 20
    repaired = plan_repair(found)
    frames = repaired.evaluate(TIMES)
    assert (repaired.notes, count_crossed(frames)) == ((), 0)
    assert off_pins(found, frames, TIMES) < 1e-9


def test_planted_feet_stay_planted_while_crossings_are_bent_away():
    a, b = standing([90, -120], [65, -20]), standing([15, -20], [-10, -120])
    found = plan(a, b, method="linear", pins=[Pin(OnOutline(0, 8.0)), Pin(OnOutline(0, 12.0))])
    assert count_crossed(found.evaluate(TIMES)) > 20
    repaired = plan_repair(found)
    frames = repaired.evaluate(TIMES)
    assert (repaired.notes, count_crossed(frames)) == ((), 0)
    np.testing.assert_allclose(frames[:, [8, 12]], np.broadcast_to(a[[8, 12]], (241, 2, 2)), atol=1e-9 * 200)


def test_nothing_needs_no_repair():
    assert repair_drawing(plan_drawing([])).evaluate([0.5]) == ()


HOSTILE = {
    "one line": np.stack([np.array([0.0, 5, 10, 3]), np.zeros(4)], axis=1),
    "there and back": np.array([[0.0, 0], [10, 0], [0, 0], [10, 0]]),
    "two places": np.array([[0.0, 0], [0, 0], [1, 0], [0, 0]]),
    "three places": np.array([[0.0, 0], [0, 0], [100, 0], [0, 100]]),
    "bow tie": np.array([[0.0, 0], [10, 10], [10, 0], [0, 10]]),
    "sliver": np.array([[0.0, 0], [100, 1e-9], [200, 0], [100, 2e-9]]),
    "far": SQUARE + 9e8,
    "tiny": SQUARE * 1e-12,
    "tinier": SQUARE * 1e-200,
    "huge": SQUARE * 9e6,
    "backwards": SQUARE[::-1].copy(),
    "half a turn": 100 - SQUARE,
}


@pytest.mark.parametrize("other", HOSTILE)
@pytest.mark.parametrize("method", ["linear", "intrinsic"])
def test_hostile_outlines_give_frames_that_are_simple_or_a_note(other, method):
    for a, b in ((SQUARE, HOSTILE[other]), (HOSTILE[other], SQUARE)):
        repaired = plan_repair(plan(a, b, method=method))
        frames = repaired.evaluate(TIMES)
        assert np.isfinite(frames).all()
        assert np.array_equal(frames[[0, -1]], [a, b])
        assert repaired.notes or count_crossed(frames) == 0


@pytest.mark.parametrize("count", [3, 4, 5, 24])
def test_an_outline_turned_upside_down_does_not_pass_through_a_point(count):
    a = circle(count)
    wished = plan(a, -a, method="linear").evaluate(TIMES)
    frames = plan_repair(plan(a, -a, method="linear")).evaluate(TIMES)
    assert np.ptp(wished[120]) < 1e-9
    assert count_crossed(frames) == 0
    assert np.ptp(frames, axis=1).min() > 0.01
