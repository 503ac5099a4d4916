import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.geometry.outline import edge_lengths, signed_area
from core.methods.plan import AlignedPair, plan, plan_drawing
from core.repair.between import inbetween

TIMES = np.linspace(0, 1, 9)
SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])

quick = settings(max_examples=60, deadline=None)


@st.composite
def outlines(draw, count=None):
    """Star-shaped outlines with edges and angles well away from nothing."""
    n = draw(st.integers(3, 16)) if count is None else count
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    angle = 2 * np.pi * (np.arange(n) + rng.uniform(-0.3, 0.3, n)) / n
    radius = rng.uniform(50, 150, n)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1) + rng.uniform(-200, 200, 2)


@st.composite
def pairs(draw):
    a = draw(outlines())
    return a, draw(outlines(len(a)))


@st.composite
def wild_pairs(draw):
    """Any vertices at all: crossing, opposite directions, sharp."""
    n = draw(st.integers(3, 12))
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    a, b = rng.uniform(-100, 100, (2, n, 2))
    if draw(st.booleans()):  # whole pixels: doubled vertices, fold-backs and right angles
        a, b = np.round(a / 50) * 50, np.round(b / 50) * 50
    assume(np.ptp(a, axis=0).max() > 0)
    assume(np.ptp(b, axis=0).max() > 0)
    return a, b


def rotation(angle):
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def edges(frames):
    return np.roll(frames, -1, axis=-2) - frames


def assert_same(x, y, size=100.0, tolerance=1e-9):
    np.testing.assert_allclose(x, y, rtol=0, atol=tolerance * size)


def well_told(a, b):
    """Whether no decision between two turns hangs on rounding: a half turn of the whole, or equal break places."""
    paths = plan(a, b).drawing.paths
    turn = 2 * np.diff(paths.half_headings, axis=0)[0]
    mean = turn @ (edge_lengths(a) / edge_lengths(a).sum() + edge_lengths(b) / edge_lengths(b).sum()) / 2
    return abs(abs(mean) - np.pi) > 1e-3


@quick
@given(wild_pairs())
def test_ends_are_the_keyframes_bit_for_bit(pair):
    a, b = pair
    frames = inbetween(a, b, np.array([0.0, 0.5, 1.0]))
    assert np.array_equal(frames[0], a)
    assert np.array_equal(frames[2], b)


@quick
@given(wild_pairs())
def test_frames_arrive_at_the_keyframes_without_a_jump(pair):
    a, b = pair
    near = inbetween(a, b, np.array([1e-9, 1 - 1e-9]))
    assert_same(near[0], a, tolerance=1e-6)
    assert_same(near[1], b, tolerance=1e-6)


@quick
@given(outlines(), st.floats(-3.0, 3.0), st.floats(0.2, 5.0), st.floats(-300, 300))
def test_similarity_motion_gives_turned_and_scaled_copies(a, angle, scale, shift):
    b = scale * a @ rotation(angle) + [shift, -shift / 2]
    for t, frame in zip(TIMES, inbetween(a, b, TIMES), strict=True):
        expected = (1 + (scale - 1) * t) * edges(a) @ rotation(t * angle)
        assert_same(edges(frame), expected, size=1000.0)


@quick
@given(pairs())
def test_exchanging_keyframes_and_time_gives_the_same_frames(pair):
    a, b = pair
    assume(well_told(a, b))
    assert_same(inbetween(a, b, TIMES), inbetween(b, a, 1 - TIMES))


@quick
@given(pairs(), st.sampled_from([1e-6, 1e-3, 1e4]))
def test_scale_does_not_matter(pair, scale):
    a, b = pair
    assert_same(inbetween(scale * a, scale * b, TIMES) / scale, inbetween(a, b, TIMES))


@quick
@given(pairs(), st.floats(-1e5, 1e5), st.floats(-1e5, 1e5))
def test_position_does_not_matter(pair, x, y):
    a, b = pair
    shift = np.array([x, y])
    moved = inbetween(a + shift, b + shift, TIMES) - shift
    assert_same(moved, inbetween(a, b, TIMES), tolerance=1e-7)


@quick
@given(pairs(), st.floats(-10, 10))
def test_turning_both_keyframes_turns_the_frames(pair, angle):
    a, b = pair
    assume(well_told(a, b))
    assert_same(
        inbetween(a @ rotation(angle), b @ rotation(angle), TIMES), inbetween(a, b, TIMES) @ rotation(angle)
    )


@quick
@given(pairs(), st.integers(0, 15))
def test_start_vertex_does_not_matter(pair, first):
    a, b = pair
    assume(well_told(a, b))
    rolled = inbetween(np.roll(a, first, axis=0), np.roll(b, first, axis=0), TIMES)
    assert_same(rolled, np.roll(inbetween(a, b, TIMES), first, axis=1))


@quick
@given(pairs())
def test_drawing_direction_does_not_matter(pair):
    a, b = pair
    assume(well_told(a, b))
    assert_same(inbetween(a[::-1], b[::-1], TIMES)[:, ::-1], inbetween(a, b, TIMES))


@quick
@given(pairs())
def test_mirroring_both_keyframes_mirrors_the_frames(pair):
    a, b = pair
    assume(well_told(a, b))
    assert_same(inbetween(a * [1, -1], b * [1, -1], TIMES), inbetween(a, b, TIMES) * [1, -1])


@quick
@given(pairs(), st.integers(0, 15))
def test_opposite_directions_depend_on_neither_start_nor_exchange(pair, first):
    a, b = pair
    assume(not np.allclose(a, b))  # an outline and its own reverse tie everywhere
    b = b[::-1].copy()
    assume(well_told(a, b))
    frames = inbetween(a, b, TIMES)
    assert np.isfinite(frames).all()
    rolled = inbetween(np.roll(a, first, axis=0), np.roll(b, first, axis=0), TIMES)
    assert_same(rolled, np.roll(frames, first, axis=1))
    assert_same(inbetween(b, a, 1 - TIMES), frames)


@quick
@given(wild_pairs())
def test_no_edge_ever_turns_over(pair):
    a, b = pair
    paths = plan(a, b).drawing.paths
    t = np.linspace(0, 1, 21)[1:-1]
    frames = paths.evaluate(t)
    heading = 2 * ((1 - t)[:, None] * paths.half_headings[0] + t[:, None] * paths.half_headings[1])
    along = edges(frames)[..., 0] * np.cos(heading) + edges(frames)[..., 1] * np.sin(heading)
    assert along.min() >= -1e-9 * 100


@quick
@given(wild_pairs())
def test_frames_change_smoothly_with_time(pair):
    a, b = pair
    t = np.linspace(0, 1, 2001)
    steps = np.linalg.norm(np.diff(inbetween(a, b, t), axis=0), axis=2).max(axis=1)
    assert np.isfinite(steps).all()
    # a jump stays a jump however fine the steps; the same path in half steps must halve them
    halves = np.linalg.norm(np.diff(inbetween(a, b, np.linspace(0, 1, 4001)), axis=0), axis=2).max(axis=1)
    assert halves.max() <= 0.6 * steps.max() + 1e-9


@quick
@given(wild_pairs(), st.integers(-3, 3))
def test_frames_are_finite_beyond_the_ends(pair, turns):
    a, b = pair
    frames = inbetween(a, b, np.array([-10.0, -0.3, 1.2, 5.0]), turns=turns)
    assert np.isfinite(frames).all()


def test_overshoot_goes_on_turning_and_growing():
    b = 1.5 * SQUARE @ rotation(1.0)
    frame = inbetween(SQUARE, b, 1.2)
    assert_same(edges(frame), 1.6 * edges(SQUARE) @ rotation(1.2))


def test_a_shrinking_edge_does_not_turn_over_in_overshoot():
    b = SQUARE * [0.1, 1.0]
    frame = inbetween(SQUARE, b, 1.3)
    assert edge_lengths(frame)[0] == pytest.approx(0, abs=1e-9)
    assert signed_area(frame) == pytest.approx(0, abs=1e-6)


def test_a_square_stays_a_square_its_last_edge_included():
    frames = inbetween(SQUARE, SQUARE @ rotation(np.pi / 2), TIMES)
    np.testing.assert_allclose(edge_lengths(frames), 100.0, rtol=1e-12)
    np.testing.assert_allclose(signed_area(frames), 1e4, rtol=1e-12)


def test_a_square_becomes_a_rectangle_with_closed_right_angles():
    frames = inbetween(SQUARE, SQUARE * [1.0, 1.5], TIMES)
    np.testing.assert_allclose(edge_lengths(frames)[:, 3], 100 * (1 + TIMES / 2), rtol=1e-12)
    np.testing.assert_allclose(signed_area(frames), 1e4 * (1 + TIMES / 2), rtol=1e-12)


def pentagon(left, right):
    """Five edges of 80 px; the two beside the base stand at the given angles."""
    feet = np.array([[0.0, 0.0], [1.0, 0.0]])
    hips = feet + np.stack([np.cos([left, right]), np.sin([left, right])], axis=1)
    across = hips[0] - hips[1]
    height = np.sqrt(1 - across @ across / 4)
    top = hips.mean(axis=0) + height * np.array([across[1], -across[0]]) / np.hypot(*across)
    return 80 * np.array([feet[0], feet[1], hips[1], top, hips[0]])


def test_equal_lengths_do_not_let_rounding_choose_where_to_close():
    """|LA - LB| is rounding everywhere: the weights of the closure must not be made of it."""
    a, b = pentagon(1.9, 1.3), pentagon(2.0, 2.1)
    np.testing.assert_allclose([edge_lengths(a), edge_lengths(b)], 80.0, rtol=1e-12)
    frames = inbetween(a, b, TIMES)
    rng = np.random.default_rng(5)
    for _ in range(5):
        noise = rng.uniform(-1e-11, 1e-11, a.shape)
        assert_same(inbetween(a + noise, b - noise, TIMES), frames, tolerance=1e-11)
    np.testing.assert_allclose(edge_lengths(frames), 80.0, rtol=0.05)


def test_a_bending_rhombus_of_equal_lengths_keeps_them():
    def rhombus(angle):
        u, v = np.array([[1.0, 0.0], [np.cos(angle), np.sin(angle)]]) * 80
        return np.array([0 * u, u, u + v, v])

    frames = inbetween(rhombus(0.4), rhombus(2.4), TIMES)
    np.testing.assert_allclose(edge_lengths(frames), 80.0, rtol=1e-12)


def test_a_heading_from_170_to_190_degrees_does_not_run_through_0():
    b = SQUARE @ rotation(np.radians(190))
    frames = inbetween(SQUARE @ rotation(np.radians(170)), b, TIMES)
    first = np.degrees(np.arctan2(edges(frames)[:, 0, 1], edges(frames)[:, 0, 0])) % 360
    np.testing.assert_allclose(first, 170 + 20 * TIMES, rtol=1e-9)


def test_a_headings_wrap_does_not_matter_at_any_vertex():
    a = SQUARE @ rotation(np.radians(-100))
    frames = inbetween(a, a @ rotation(np.radians(170)), TIMES)
    assert_same(edges(frames[4]), edges(a @ rotation(np.radians(85))))


def test_opposite_direction_stays_finite_and_closed():
    frames = inbetween(SQUARE, SQUARE[::-1], TIMES)
    assert np.isfinite(frames).all()
    assert np.linalg.norm(frames - frames.mean(axis=1, keepdims=True), axis=2).max() < 150


def test_a_corner_that_opens_into_an_edge_turns_with_its_neighbours():
    a = np.array([[0, 0], [100, 0], [100, 100], [100, 100], [0, 100]], dtype=float)
    b = np.array([[0, 0], [100, 0], [100, 70], [70, 100], [0, 100]], dtype=float)
    grown = edges(inbetween(a, b, TIMES[1:]))[:, 2]
    heading = np.degrees(np.arctan2(grown[:, 1], grown[:, 0]))
    np.testing.assert_allclose(heading, 135, atol=6)
    turned = edges(inbetween(a, b @ rotation(1.0), TIMES[1:]))[:, 2]
    heading = np.degrees(np.arctan2(turned[:, 1], turned[:, 0]))
    np.testing.assert_allclose(heading % 360, 135 + np.degrees(TIMES[1:]), atol=6)


@quick
@given(pairs(), st.integers(0, 15))
def test_a_doubled_vertex_changes_nothing(pair, k):
    a, b = pair
    k %= len(a)
    doubled = [np.insert(p, k, p[k], axis=0) for p in (a, b)]
    frames = inbetween(*doubled, TIMES)
    assert_same(frames[:, k], frames[:, k + 1])
    assert_same(np.delete(frames, k, axis=1), inbetween(a, b, TIMES), tolerance=0.1)


def test_a_doubled_vertex_among_similar_shapes_is_exact():
    a = np.insert(SQUARE, 2, SQUARE[2], axis=0)
    frames = inbetween(a, a @ rotation(2.0), TIMES)
    np.testing.assert_allclose(edge_lengths(frames), [[100, 100, 0, 100, 100]] * len(TIMES), atol=1e-9)


def test_a_fold_back_on_both_sides_is_no_break():
    """Turning angles of exactly half a turn: rounding may say +pi before and -pi after."""
    a = np.array([[0, 0], [100, 0], [100, 50], [200, 50], [100, 50], [100, 100], [0, 100]], dtype=float)
    for angle in np.linspace(-3, 3, 13):
        frames = inbetween(a, a @ rotation(angle), TIMES)
        assert_same(edges(frames[4]), edges(a @ rotation(angle / 2)))


def test_a_line_drawn_there_and_back_bends_the_same_at_every_turn():
    there = np.stack([np.linspace(0, 300, 7), np.zeros(7)], axis=1)
    s = np.linspace(0, 1.5, 7)
    bent = 200 * np.stack([np.sin(s), 1 - np.cos(s)], axis=1)
    a, b = (np.concatenate([p, p[-2:0:-1]]) for p in (there, bent))
    frames = inbetween(a, b, TIMES)
    assert_same(frames[:, 1:6], frames[:, :6:-1], tolerance=1e-6)
    for angle in np.linspace(-3, 3, 25):
        assert_same(inbetween(a @ rotation(angle), b @ rotation(angle), TIMES), frames @ rotation(angle))
        assert_same(
            inbetween(a[::-1] @ rotation(angle), b[::-1] @ rotation(angle), TIMES)[:, ::-1],
            frames @ rotation(angle),
        )


def spiral(winds, n=120):
    s = np.linspace(0, 1, n)
    angle = 2 * np.pi * winds * s
    step = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.concatenate([[[0.0, 0.0]], np.cumsum(step, axis=0)]) * 5


def test_a_spiral_of_several_turns_uncurls_evenly():
    frames = inbetween(spiral(3.0), spiral(0.0), TIMES, closed=False)
    for t, frame in zip(TIMES, frames, strict=True):
        d = np.diff(frame, axis=0)
        bend = d[:-1, 0] * d[1:, 1] - d[:-1, 1] * d[1:, 0]
        np.testing.assert_allclose(np.arcsin(bend / 25), (1 - t) * 6 * np.pi / 119, atol=1e-9)


def test_an_open_outline_keeps_its_lengths_and_is_not_closed():
    frames = inbetween(spiral(0.3), spiral(-1.2), TIMES, closed=False)
    np.testing.assert_allclose(edge_lengths(frames, closed=False), 5.0, rtol=1e-12)


def test_extra_turns_are_whole_turns_on_top():
    b = SQUARE @ rotation(0.5)
    for turns in (-2, 1, 3):
        frames = inbetween(SQUARE, b, TIMES, turns=turns)
        for t, frame in zip(TIMES, frames, strict=True):
            assert_same(edges(frame), edges(SQUARE) @ rotation(t * (0.5 + 2 * np.pi * turns)))


def test_the_shortest_way_round_is_taken():
    quarter = inbetween(SQUARE, SQUARE @ rotation(np.radians(240)), 0.5)
    assert_same(edges(quarter), edges(SQUARE) @ rotation(np.radians(-60)))


def test_a_limb_that_bends_keeps_its_area():
    def bone(bend):
        s = np.linspace(-200, 200, 81)
        angle = bend * np.clip((s + 30) / 60, 0, 1)
        middle = np.cumsum(np.stack([np.cos(angle), np.sin(angle)], axis=1) * 5, axis=0)
        side = np.stack([-np.sin(angle), np.cos(angle)], axis=1) * 20
        return np.concatenate([middle + side, (middle - side)[::-1]])

    a, b = bone(0.0), bone(2.0)
    areas = np.abs(signed_area(inbetween(a, b, TIMES)))
    np.testing.assert_allclose(areas, abs(signed_area(a)), rtol=0.01)
    straight = np.abs(signed_area(inbetween(a, b, TIMES, method="linear")))
    assert straight[4] < 0.95 * areas[4]


@quick
@given(wild_pairs())
def test_the_last_edge_takes_no_more_than_its_share_of_the_closure(pair):
    a, b = pair
    paths = plan(a, b).drawing.paths
    t = np.linspace(0.05, 0.95, 7)
    last = edges(paths.evaluate(t))[:, -1]
    heading = (1 - t) * 2 * paths.half_headings[0, -1] + t * 2 * paths.half_headings[1, -1]
    length = (1 - t) * paths.lengths[0, -1] + t * paths.lengths[1, -1]
    open_edge = length[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    assert (np.linalg.norm(last - open_edge, axis=1) <= length + 1e-9).all()


def test_many_frames_are_the_same_as_one_at_a_time():
    rng = np.random.default_rng(1)
    a = rng.uniform(0, 100, (700, 2))
    b = rng.uniform(0, 100, (700, 2))
    paths = plan(a, b)
    t = np.linspace(-0.2, 1.2, 50)
    whole = paths.evaluate(t)
    for k in range(0, 50, 7):
        assert_same(paths.evaluate(t[k : k + 1])[0], whole[k], tolerance=1e-10)


def test_a_plan_of_one_closed_pair_is_the_drawing_of_it():
    b = SQUARE @ rotation(1.0)
    drawing = plan_drawing([AlignedPair(SQUARE, b, True)])
    assert np.array_equal(drawing.evaluate(TIMES)[0], plan(SQUARE, b).evaluate(TIMES))
