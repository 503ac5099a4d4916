import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString, Polygon

from core.geometry.boxes import box_pairs, box_pairs_between
from core.geometry.crossings import (
    crossing_places,
    crossings,
    frame_crossings,
    frame_crossings_between,
    is_simple,
    orientations,
    simple_frames,
)

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])
BOW_TIE = np.array([[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]])

# of 32 bits: products of smaller numbers than these vanish, and no drawing is 1e-100 px large
coordinates = st.integers(0, 6).map(float) | st.floats(0, 6, allow_subnormal=False, width=32)
outlines = st.lists(st.tuples(coordinates, coordinates), min_size=3, max_size=12).map(np.array)


def test_a_bow_tie_crosses_at_its_knot():
    pairs = crossings(BOW_TIE)
    assert pairs.tolist() == [[0, 2]]
    assert crossing_places(BOW_TIE, pairs).tolist() == [[1.0, 1.0]]


@given(outlines)
@settings(max_examples=400)
def test_a_closed_outline_is_simple_where_an_independent_judge_says_so(p):
    assert is_simple(p) == Polygon(p).is_valid


@given(outlines)
@settings(max_examples=400)
def test_an_open_outline_is_simple_where_an_independent_judge_says_so(p):
    # a ring of its own is simple for the judge although its ends meet
    expected = LineString(p).is_simple and not LineString(p).is_ring and len(np.unique(p, axis=0)) > 1
    assert is_simple(p, closed=False) == expected


@given(outlines, outlines)
def test_outlines_cross_each_other_where_an_independent_judge_says_so(p, q):
    assume(len(np.unique(p, axis=0)) > 1 and len(np.unique(q, axis=0)) > 1)
    rows = frame_crossings_between(p[None], q[None])
    expected = LineString([*p, p[0]]).intersects(LineString([*q, q[0]]))
    assert bool(len(rows)) == expected


@given(outlines)
def test_start_direction_and_place_do_not_change_how_many_edges_cross(p):
    count = len(crossings(p))
    assert len(crossings(np.roll(p, 2, axis=0))) == count
    assert len(crossings(p[::-1])) == count


@given(outlines)
def test_every_crossing_lies_on_both_edges(p):
    pairs = crossings(p)
    for (i, j), place in zip(pairs, crossing_places(p, pairs), strict=True):
        for k in (i, j):
            a, b = p[k], p[(k + 1) % len(p)]
            u = np.clip((place - a) @ (b - a) / max((b - a) @ (b - a), 1e-300), 0, 1)
            assert np.abs(a + u * (b - a) - place).max() < 1e-9


def test_frames_are_told_apart_and_chunks_do_not_matter():
    frames = np.stack([SQUARE, BOW_TIE] * 20_000) * np.linspace(1, 9, 40_000)[:, None, None]
    rows = frame_crossings(frames)
    assert np.array_equal(rows[:, 0], np.arange(1, 40_000, 2))
    assert (rows[:, 1:] == [0, 2]).all()
    assert np.array_equal(simple_frames(frames), np.tile([True, False], 20_000))


@pytest.mark.parametrize(
    ("scale", "shift"), [(1e-200, 0.0), (1e-12, 0.0), (1.0, 0.0), (1e8, 0.0), (1.0, 5e8), (1e8, 5e8)]
)
def test_scale_and_place_are_no_matter(scale, shift):
    assert is_simple(SQUARE * scale + shift)
    assert not is_simple(BOW_TIE * scale + shift)


def test_touching_is_crossing_and_repeating_a_vertex_is_not():
    pinched = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]])
    assert len(crossings(pinched))
    assert is_simple(np.repeat(SQUARE, 3, axis=0))


def test_an_edge_that_doubles_back_crosses_its_neighbour():
    spike = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 5.0], [3.0, 3.0], [0.0, 3.0]])
    assert crossings(spike).tolist() == [[1, 2], [1, 3]]  # and the edge on which the spike ends


def test_no_area_and_no_number_are_not_simple():
    assert not is_simple(np.zeros((4, 2)))
    assert not is_simple(np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]))
    assert not is_simple(np.where(SQUARE == 2, np.nan, SQUARE))


def test_orientation_is_exact_where_doubles_are_not():
    p, q = np.array([[0.5, 0.5]]), np.array([[12.0, 12.0]])
    for k in range(1, 50):
        r = np.array([[24.0, 24.0 + k * 2.0**-48]])
        assert orientations(p, q, r) == 1
        assert orientations(q, p, r) == -1
    assert orientations(p, q, np.array([[24.0, 24.0]])) == 0


boxes = st.lists(st.tuples(coordinates, coordinates, st.floats(0, 2), st.floats(0, 2)), min_size=1, max_size=12)


@given(boxes, boxes)
def test_pairs_of_boxes_are_those_of_the_plain_double_loop(mine, others):
    a, b = np.array(mine), np.array(others)
    corners = [x for r in (a, b) for x in (r[None, :, :2], r[None, :, :2] + r[None, :, 2:])]
    meets = ((corners[0][0][:, None] <= corners[3][0]) & (corners[2][0] <= corners[1][0][:, None])).all(axis=2)
    _, i, j = box_pairs_between(*corners)
    assert sorted(zip(i, j, strict=True)) == list(zip(*np.nonzero(meets), strict=True))
    own = ((corners[0][0][:, None] <= corners[1][0]) & (corners[0][0] <= corners[1][0][:, None])).all(axis=2)
    _, i, j = box_pairs(corners[0], corners[1])
    assert sorted(zip(i, j, strict=True)) == list(zip(*np.nonzero(np.triu(own, 1)), strict=True))
