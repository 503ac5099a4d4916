import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from core.methods.plan import AlignedPair, plan, plan_drawing
from core.methods.rigid import FELL_BACK
from core.repair.between import inbetween

TIMES = np.linspace(0, 1, 9)
BEYOND = np.array([-1.5, -0.3, 0.0, 0.4, 1.0, 1.3, 2.5])


def rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def blob(waves, n=60):
    """A star-shaped outline about 100 px in size: a circle with waves (amplitude, phase) of growing number."""
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    radius = 50 * (1 + sum(a * np.sin((k + 2) * angle + phase) for k, (a, phase) in enumerate(waves)))
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


def bar(bend, n=40, width=12.0):
    """A bar 200 px long, bent evenly by `bend` radians."""
    along = np.linspace(-0.5, 0.5, n)
    middle = np.cumsum(np.exp(1j * bend * along)) * 200 / n
    side = width * 1j * np.exp(1j * bend * along)
    z = np.concatenate([middle - side, (middle + side)[::-1]])
    return np.stack([z.real, z.imag], axis=1)


def circle(centre, radius, n=40, flat=1.0):
    angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return np.array(centre) + radius * np.stack([np.cos(angle), flat * np.sin(angle)], axis=1)


def aligned(p, q):
    """`p` turned and shifted to lie best on `q`."""
    a, b = p - p.mean(axis=0), q - q.mean(axis=0)
    u, _, v = np.linalg.svd(a.T @ b)
    return a @ u @ np.diag([1, np.linalg.det(u @ v)]) @ v + q.mean(axis=0)


def area(p):
    return abs(Polygon(p).area)


blobs = st.lists(st.tuples(st.floats(-0.15, 0.15), st.floats(0, 6)), min_size=1, max_size=4).map(blob)
similarities = st.tuples(st.floats(-2.8, 2.8), st.floats(0.1, 10), st.floats(-300, 300))


@settings(max_examples=30, deadline=None)
@given(blobs, blobs)
def test_ends_are_the_keyframes_bit_for_bit_and_frames_run_into_them(a, b):
    paths = plan(a, b, method="rigid")
    frames = paths.evaluate([0.0, 1.0, 1e-9, 1 - 1e-9])
    assert np.array_equal(frames[:2], [a, b])
    np.testing.assert_allclose(frames[2:], [a, b], atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(blobs, similarities)
def test_a_similarity_turns_and_grows_evenly(a, similarity):
    angle, scale, shift = similarity
    b = scale * a @ rotation(angle) + shift
    for t, frame in zip(TIMES, inbetween(a, b, TIMES, "rigid"), strict=True):
        expected = (1 + (scale - 1) * t) * a @ rotation(t * angle)
        np.testing.assert_allclose(
            frame - frame.mean(axis=0), expected - expected.mean(axis=0), atol=1e-7 * (1 + scale)
        )


@settings(max_examples=30, deadline=None)
@given(blobs, blobs)
def test_exchanging_the_keyframes_and_the_times_changes_nothing(a, b):
    b = b * [1.3, 1.0]  # where both are equally thin, the choice of the one to be meshed is not defined
    there, back = inbetween(a, b, BEYOND, "rigid"), inbetween(b, a, 1 - BEYOND, "rigid")
    np.testing.assert_allclose(there, back, atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(blobs, blobs, similarities, st.integers(0, 59), st.booleans())
def test_place_turn_scale_start_vertex_and_direction_change_less_than_a_thousandth(
    a, b, similarity, start, backwards
):
    angle, scale, shift = similarity
    frames = inbetween(a, b, TIMES, "rigid")
    order = np.roll(np.arange(60), start)[:: -1 if backwards else 1]
    moved = [scale * p[order] @ rotation(angle) + shift for p in (a, b)]
    expected = scale * frames[:, order] @ rotation(angle) + shift
    np.testing.assert_allclose(inbetween(*moved, TIMES, "rigid"), expected, atol=0.1 * scale)


@settings(max_examples=30, deadline=None)
@given(blobs, blobs)
def test_frames_are_finite_however_far_easing_overshoots(a, b):
    assert np.isfinite(inbetween(a, b, [-1e6, -3, -0.1, 1.1, 4, 1e6], "rigid")).all()


@settings(max_examples=20, deadline=None)
@given(blobs, blobs)
def test_blobs_keep_simple_and_their_area_between_the_keyframes(a, b):
    paths = plan(a, b, method="rigid")
    assert paths.note == ""
    for frame in paths.evaluate(TIMES):
        assert Polygon(frame).is_valid
        assert 0.9 * min(area(a), area(b)) < area(frame) < 1.1 * max(area(a), area(b))


@pytest.mark.parametrize("bend", [-2.5, -1.0, 0.5, 2.0])
def test_a_bar_that_bends_passes_through_the_bars_bent_less(bend):
    frames = inbetween(bar(0.0), bar(bend), TIMES, "rigid")
    for t, frame in zip(TIMES, frames, strict=True):
        true = bar(t * bend)
        assert np.abs(aligned(frame, true) - true).max() < 0.01 * 200
        assert area(frame) == pytest.approx(area(true), rel=0.03)


def test_a_bar_that_curls_up_by_more_than_a_turn_uncurls_the_same_way():
    frames = inbetween(bar(0.0, 120, 4.0), bar(1.9 * np.pi, 120, 4.0), TIMES, "rigid")
    for t, frame in zip(TIMES, frames, strict=True):
        true = bar(t * 1.9 * np.pi, 120, 4.0)
        assert np.abs(aligned(frame, true) - true).max() < 0.02 * 200


def test_turns_are_added():
    a = blob([(0.1, 0.0), (0.1, 1.0)])
    a = a - a.mean(axis=0)
    for turns, quarters in ((1, 1), (-2, -2)):
        frame = inbetween(a, a, 0.25, "rigid", turns=turns)
        np.testing.assert_allclose(frame - frame.mean(axis=0), a @ rotation(quarters * np.pi / 2), atol=1e-6)


def test_a_shape_that_stays_does_not_move():
    a = blob([(0.1, 0.0), (0.1, 1.0)])
    np.testing.assert_allclose(inbetween(a, a, BEYOND, "rigid"), np.broadcast_to(a, (7, 60, 2)), atol=1e-9)


def test_neighbouring_frames_never_jump():
    a, b = bar(0.3), blob([(0.3, 1.0), (0.1, 2.0)], 80)
    frames = inbetween(a, b, np.linspace(0, 1, 241), "rigid")
    steps = np.linalg.norm(np.diff(frames, axis=0), axis=2).max(axis=1)
    assert steps.max() < 3 * np.median(steps)


def test_a_fat_drawing_becomes_thin_and_back_without_folds():
    fat, thin = blob([(0.05, 0.0)], 80), bar(2.0, 40, 3.0)
    for a, b in ((fat, thin), (thin, fat)):
        paths = plan(a, b, method="rigid")
        assert not paths.note.startswith(FELL_BACK)
        assert all(Polygon(frame).is_valid for frame in paths.evaluate(TIMES))


MIRRORED = [
    (blob([(0.1, 0.0)]), blob([(0.1, 0.0)])[::-1]),
    (np.array([[0.0, 0], [10, 10], [10, 0], [0, 10]]), np.array([[0.0, 0], [10, 0], [10, 10], [0, 10]])),
    (np.array([[0.0, 0], [10, 0], [20, 0], [5, 0]]), np.array([[0.0, 0], [10, 0], [10, 10], [0, 10]])),
]


@pytest.mark.parametrize(("a", "b"), MIRRORED)
def test_where_interiors_cannot_be_matched_it_is_intrinsic_and_says_so(a, b):
    paths = plan(a, b, method="rigid")
    assert paths.note == FELL_BACK
    assert np.array_equal(paths.evaluate(BEYOND), inbetween(a, b, BEYOND, "intrinsic"))


@settings(max_examples=30, deadline=None)
@given(st.lists(st.tuples(st.floats(-100, 100), st.floats(-100, 100)), min_size=6, max_size=16))
def test_random_polygons_give_finite_frames_and_never_an_error(points):
    n = len(points) // 2
    if n < 3:
        return
    a, b = np.array(points[:n]), np.array(points[n : 2 * n])
    if np.ptp(a, axis=0).max() < 1e-3 or np.ptp(b, axis=0).max() < 1e-3:
        return
    paths = plan(a, b, method="rigid")
    assert np.isfinite(paths.evaluate(BEYOND)).all()
    assert np.array_equal(paths.evaluate([0.0, 1.0]), [a, b])


def test_vertices_doubled_in_both_keyframes_stay_together():
    a, b = (np.repeat(p, 2, axis=0) for p in (blob([(0.1, 0.0)]), blob([(0.1, 2.0)]) @ rotation(0.5)))
    paths = plan(a, b, method="rigid")
    frames = paths.evaluate(TIMES)
    assert paths.note == ""
    np.testing.assert_array_equal(frames[:, ::2], frames[:, 1::2])


def test_two_thousand_vertices_keep_their_detail():
    ripple = 0.2 * np.sin(np.arange(2000))[:, None]
    a, b = (blob([(0.1, 0.0), (0.05, 1.0)], 2000) * (1 + ripple / 50) @ rotation(r) for r in (0.0, 1.0))
    frame = inbetween(a, b, 0.5, "rigid")
    true = a @ rotation(0.5)
    np.testing.assert_allclose(frame - frame.mean(axis=0), true - true.mean(axis=0), atol=1e-6)


def drawing(before, after, **options):
    return plan_drawing([AlignedPair(a, b) for a, b in zip(before, after, strict=True)], method="rigid", **options)


def test_a_drawing_with_holes_that_turns_is_rigid():
    before = [circle((0, 0), 100), circle((-30, 0), 30)[::-1], circle((40, 10), 20)]
    turn = rotation(2.0)
    paths = drawing(before, [p @ turn for p in before])
    assert paths.note == ""
    for outline, frames in zip(before, paths.evaluate(TIMES), strict=True):
        for t, frame in zip(TIMES, frames, strict=True):
            np.testing.assert_allclose(frame, outline @ rotation(2.0 * t), atol=1e-5)


def test_a_hole_that_grows_to_the_rim_never_touches_it():
    paths = drawing([circle((0, 0), 100), circle((0, 0), 30)], [circle((0, 0), 100), circle((0, 0), 92)])
    outer, hole = paths.evaluate(TIMES)
    assert paths.note == ""
    for rim, gap in zip(outer, hole, strict=True):
        assert Polygon(rim, [gap]).is_valid
        assert Polygon(rim).contains(Polygon(gap))


def test_the_direction_in_which_a_hole_is_drawn_does_not_matter():
    before, after = [circle((0, 0), 100), circle((20, 0), 30)], [circle((0, 0), 90, flat=0.7), circle((0, 5), 20)]
    plain = drawing(before, after).evaluate(TIMES)
    turned = drawing([before[0], before[1][::-1]], [after[0], after[1][::-1]]).evaluate(TIMES)
    np.testing.assert_allclose(plain[0], turned[0], atol=1e-2)
    np.testing.assert_allclose(plain[1], turned[1][:, ::-1], atol=1e-2)


def test_apart_outlines_turn_together_as_one_drawing():
    stem, dot = bar(0.0), circle((250, 0), 12)
    turn = rotation(1.0)
    stems, dots = drawing([stem, dot], [stem @ turn, dot @ turn]).evaluate(TIMES)
    distances = np.linalg.norm(stems.mean(axis=1) - dots.mean(axis=1), axis=1)
    np.testing.assert_allclose(distances, distances[0], atol=1e-3)


def test_an_open_outline_beside_a_rigid_one_is_carried_along():
    body = circle((0, 0), 100)
    line = np.array([[100.0, 0.0], [200.0, 0.0], [250.0, 30.0]])
    turn = rotation(1.5)
    paths = plan_drawing(
        [AlignedPair(body, body @ turn), AlignedPair(line, line @ turn, closed=False)], method="rigid"
    )
    assert paths.note == ""
    for outline, frames in zip((body, line), paths.evaluate(TIMES), strict=True):
        for t, frame in zip(TIMES, frames, strict=True):
            np.testing.assert_allclose(frame, outline @ rotation(1.5 * t), atol=1e-4)


def test_an_outline_that_grows_from_a_point_does_not_keep_the_others_from_being_rigid():
    body = circle((0, 0), 100)
    paths = drawing([body, np.zeros((5, 2))], [body @ rotation(1.0), circle((0, 0), 20, 5)])
    frames = paths.evaluate(BEYOND)
    assert all(np.isfinite(f).all() for f in frames)
    assert paths.note == f"1 of 2 parts {FELL_BACK}"
    np.testing.assert_allclose(area(frames[0][3]), area(body), rtol=1e-3)
