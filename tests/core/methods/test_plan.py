import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import core
from core.errors import GeometryError
from core.methods.plan import METHODS, AlignedPair, plan, plan_drawing
from core.repair.between import inbetween

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])
DIAMOND = np.array([[50.0, -20.0], [120.0, 50.0], [50.0, 120.0], [-20.0, 50.0]])


@pytest.fixture(params=METHODS)
def method(request):
    return request.param


def test_the_public_face_is_this_one():
    assert (core.plan, core.METHODS) == (plan, METHODS)


def test_a_number_gives_one_frame_and_a_row_gives_a_row(method):
    assert inbetween(SQUARE, DIAMOND, 0.3, method).shape == (4, 2)
    assert inbetween(SQUARE, DIAMOND, [0.3], method).shape == (1, 4, 2)
    assert inbetween(SQUARE, DIAMOND, np.linspace(0, 1, 7), method).shape == (7, 4, 2)
    assert inbetween(SQUARE, DIAMOND, [], method).shape == (0, 4, 2)


def test_a_number_and_a_row_agree_bit_for_bit(method):
    assert np.array_equal(inbetween(SQUARE, DIAMOND, 0.3, method), inbetween(SQUARE, DIAMOND, [0.3], method)[0])


def test_ends_are_exact_for_numbers_that_have_no_short_binary_form(method):
    rng = np.random.default_rng(3)
    a, b = rng.uniform(-1e6, 1e6, (2, 50, 2))
    assert np.array_equal(inbetween(a, b, 0.0, method), a)
    assert np.array_equal(inbetween(a, b, 1.0, method), b)
    assert np.array_equal(inbetween(a, b, [1, 0], method), [b, a])


def test_linear_is_the_straight_path():
    assert np.array_equal(inbetween(SQUARE, DIAMOND, 0.5, "linear"), (SQUARE + DIAMOND) / 2)
    np.testing.assert_allclose(inbetween(SQUARE, DIAMOND, 1.5, "linear"), 1.5 * DIAMOND - 0.5 * SQUARE)


def test_keyframes_are_neither_changed_nor_kept_as_frames(method):
    a, b = SQUARE.copy(), DIAMOND.copy()
    paths = plan(a, b, method=method)
    frames = paths.evaluate([0.0, 0.5, 1.0])
    frames += 7
    assert np.array_equal(a, SQUARE)
    assert np.array_equal(b, DIAMOND)
    assert np.array_equal(paths.evaluate([0.0])[0], SQUARE)


def test_evaluating_twice_gives_the_same_bytes_and_separate_arrays(method):
    paths = plan(SQUARE, DIAMOND, method=method)
    first = paths.evaluate([0.2, 0.4])
    kept = first.copy()
    paths.evaluate([0.7, 0.9])
    assert np.array_equal(first, kept)
    assert np.array_equal(paths.evaluate([0.2, 0.4]), first)


def test_different_vertex_counts_are_named(method):
    with pytest.raises(GeometryError, match="before has 4 vertices, after has 3"):
        inbetween(SQUARE, DIAMOND[:3], 0.5, method)


def test_an_unknown_method_is_named_with_the_known_ones():
    with pytest.raises(GeometryError, match=r'"rubber".*linear, intrinsic'):
        inbetween(SQUARE, DIAMOND, 0.5, "rubber")


@pytest.mark.parametrize("t", [np.nan, np.inf, [0.0, -np.inf], [0.5, np.nan], 1e9])
def test_a_time_that_is_no_number_is_refused(t, method):
    with pytest.raises(GeometryError, match="t is"):
        inbetween(SQUARE, DIAMOND, t, method)


@pytest.mark.parametrize("t", ["soon", None, [[0.1, 0.2]], [[0.1], 0.2]])
def test_a_time_that_is_no_row_of_numbers_is_refused(t, method):
    with pytest.raises(GeometryError, match=r"^t "):
        inbetween(SQUARE, DIAMOND, t, method)


@pytest.mark.parametrize(
    ("outline", "message"),
    [
        (SQUARE[:2], "before has 2 vertices"),
        (np.full((4, 2), 5.0), "all 4 vertices of before are the same point"),
        (np.where(SQUARE == 100, np.nan, SQUARE), "vertex 1 of before is not a finite number"),
        (SQUARE * 1e9, "px away"),
    ],
)
def test_an_outline_that_is_none_is_refused(outline, message, method):
    with pytest.raises(GeometryError, match=message):
        inbetween(outline, DIAMOND[: len(outline)], 0.5, method)


def test_turns_must_be_whole():
    with pytest.raises(GeometryError, match=r"turns is 0\.5"):
        inbetween(SQUARE, DIAMOND, 0.5, turns=0.5)


HOSTILE = {
    "one line": np.stack([np.array([0.0, 5, 10, 3]), np.zeros(4)], axis=1),
    "there and back": np.array([[0.0, 0], [10, 0], [0, 0], [10, 0]]),
    "two places": np.array([[0.0, 0], [0, 0], [1, 0], [0, 0]]),
    "bow tie": np.array([[0.0, 0], [10, 10], [10, 0], [0, 10]]),
    "far": SQUARE + 9e8,
    "tiny": SQUARE * 1e-12,
    "tinier": SQUARE * 1e-200,
    "huge": SQUARE * 9e6,
    "backwards": SQUARE[::-1].copy(),
    "half a turn": 100 - SQUARE,
    "integers": SQUARE.astype(int),
}


@pytest.mark.parametrize("first", HOSTILE)
@pytest.mark.parametrize("second", HOSTILE)
@pytest.mark.parametrize("closed", [True, False])
def test_hostile_keyframes_give_finite_frames_without_a_warning(first, second, closed, method):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        frames = inbetween(HOSTILE[first], HOSTILE[second], np.linspace(-0.5, 1.5, 9), method, closed=closed)
    assert np.isfinite(frames).all()


def test_an_open_outline_of_two_vertices_is_a_line_that_turns():
    frames = inbetween([[0, 0], [10, 0]], [[0, 0], [0, 10]], 0.5, closed=False)
    np.testing.assert_allclose(np.hypot(*(frames[1] - frames[0])), 10, rtol=1e-12)


def test_a_drawing_without_outlines_has_frames_without_outlines(method):
    assert plan_drawing([], method=method).evaluate([0.0, 0.5]) == ()


def test_a_drawing_names_the_outline_whose_vertices_do_not_match(method):
    with pytest.raises(GeometryError, match="outline 1: before has 4 vertices, after has 3"):
        plan_drawing([AlignedPair(SQUARE, DIAMOND), AlignedPair(SQUARE, DIAMOND[:3])], method=method)


def test_threads_do_not_share_work_memory():
    rng = np.random.default_rng(8)
    paths = [plan(*rng.uniform(0, 100, (2, 400, 2))) for _ in range(8)]
    t = np.linspace(0, 1, 60)
    expected = [p.evaluate(t) for p in paths]
    with ThreadPoolExecutor(4) as threads:
        for _ in range(5):
            for got, want in zip(threads.map(lambda p: p.evaluate(t), paths), expected, strict=True):
                assert np.array_equal(got, want)
