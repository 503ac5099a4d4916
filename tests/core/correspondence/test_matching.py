"""The automatic correspondence: what it keeps, what does not change it, and golden shapes."""

import warnings

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import core
from core.correspondence.matching import alternatives, match, match_quick
from core.errors import CorrespondenceError, GeometryError
from core.geometry.outline import lengths_at, perimeter, points_at, positions_at_lengths, size

brief = settings(max_examples=12, deadline=None, derandomize=True, phases=(Phase.explicit, Phase.generate))
SHARES = np.arange(200) / 200


@st.composite
def blobs(draw):
    """Closed outlines whose radius is a sum of waves, from a random first vertex."""
    heights = draw(st.lists(st.floats(-0.2, 0.2), min_size=4, max_size=4))
    phases = draw(st.lists(st.floats(0, 6.28), min_size=4, max_size=4))
    return wave(heights, phases, draw(st.integers(12, 60)))


def wave(heights, phases, count):
    angle = 2 * np.pi * np.arange(count) / count
    radius = 1.2 + (np.array(heights) * np.cos(angle[:, None] * np.arange(2, 6) + np.array(phases))).sum(axis=1)
    return 100 * np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return points @ np.array([[c, s], [-s, c]])


def bent_strip(bend, *, count=40, width=16.0, length=200.0):
    """A strip of constant width whose second half is turned by `bend` about its middle (in round strokes)."""
    s = np.linspace(0, length, count)
    angle = np.where(s < length * 0.45, 0.0, np.clip((s - length * 0.45) / (length * 0.1), 0, 1) * bend)
    step = np.diff(s, prepend=0)
    middle = np.cumsum(step[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]), axis=0)
    side = width / 2 * np.column_stack([-np.sin(angle), np.cos(angle)])
    taper = np.linspace(1.3, 0.7, count)[:, None]
    return np.concatenate([middle - side * taper, (middle + side * taper)[::-1]])


def redrawn(points, count, start):
    """The same closed outline by `count` even points and the corners that it had, from another start."""
    even = positions_at_lengths(points, (np.arange(count) + 0.3) / count * perimeter(points))
    return points_at(points, np.roll(np.sort(np.concatenate([even, np.arange(len(points))])), -start))


def map_of(c, a, b):
    """Shares on `b` opposite even shares on `a`."""
    images = c.images(a, b, positions_at_lengths(a, SHARES * perimeter(a)))
    return lengths_at(b, images) / perimeter(b)


def shift(one, other):
    """Mean distance of two maps in shares of the perimeter."""
    return np.abs(np.mod(one - other + 0.5, 1) - 0.5).mean()


def rises_once_round(s, whole):
    d = np.diff(np.append(s, s[0]))
    return np.count_nonzero(d <= 0) == 1 and np.mod(d, whole).sum() == pytest.approx(whole)


@brief
@given(blobs(), blobs())
def test_alignment_keeps_every_vertex_of_both_bit_for_bit_and_in_order(a, b):
    p, q = match(a, b).aligned_positions(a, b)
    left, right = match(a, b).align(a, b)
    assert np.array_equal(left[p == np.rint(p)], a)
    assert np.array_equal(np.sort(q[q == np.rint(q)]), np.arange(len(b)))
    assert np.array_equal(right[q == np.rint(q)], np.roll(b, -int(q[q == np.rint(q)][0]), axis=0))
    assert rises_once_round(p, len(a))
    assert rises_once_round(q, len(b))


@brief
@given(blobs(), blobs(), st.data())
def test_every_anchor_is_kept_exactly(a, b, data):
    count = data.draw(st.integers(1, 5))
    places = [
        np.round(np.sort(data.draw(st.lists(st.floats(0, 0.99), min_size=count, max_size=count))), 6) * n
        for n in (len(a), len(b))
    ]
    if any((np.diff(x) < 1e-3).any() for x in places):
        return
    turn = data.draw(st.integers(0, count - 1))
    anchors = list(zip(places[0], np.roll(places[1], turn), strict=True))
    for c in (match(a, b, anchors), match_quick(a, b, anchors), match_quick(a, b, anchors, near=match(a, b))):
        kept = set(zip(c.before.tolist(), c.after.tolist(), strict=True))
        assert {(float(x), float(y)) for x, y in anchors} <= kept
        left, right = c.align(a, b)
        assert np.isfinite(left).all()
        assert np.isfinite(right).all()


@brief
@given(blobs(), blobs())
def test_exchanging_the_outlines_gives_the_inverse(a, b):
    assert shift(map_of(match(b, a).inverse, a, b), map_of(match(a, b), a, b)) < 1e-3


@brief
@given(blobs(), blobs(), st.floats(0, 11.5), st.floats(0, 11.5))
def test_exchanging_the_outlines_and_their_anchors_gives_the_inverse(a, b, x, y):
    there, back = match(a, b, [(x, y)]), match(b, a, [(y, x)])
    assert shift(map_of(back.inverse, a, b), map_of(there, a, b)) < 1e-3


@brief
@given(blobs(), blobs(), st.integers(1, 11), st.floats(0.01, 50), st.floats(-3, 3))
def test_start_scale_place_and_a_common_turn_do_not_matter(a, b, start, scale, angle):
    a2 = turned(np.roll(a, -start, axis=0), angle) * scale + [300, -20]
    b2 = turned(b, angle) + np.array([1e4, 5])
    along = np.mod(positions_at_lengths(a, SHARES * perimeter(a)) - start, len(a))
    images = match(a2, b2).images(a2, b2, along)
    assert shift(lengths_at(b, images) / perimeter(b), map_of(match(a, b), a, b)) < 1e-3


@brief
@given(blobs(), blobs())
def test_the_direction_of_drawing_does_not_matter(a, b):
    c = match(a, b[::-1])
    images = len(b) - 1 - c.images(a, b[::-1], positions_at_lengths(a, SHARES * perimeter(a)))
    assert c.flipped
    assert shift(lengths_at(b, np.mod(images, len(b))) / perimeter(b), map_of(match(a, b), a, b)) < 1e-3


@brief
@given(blobs(), st.integers(10, 90), st.integers(0, 20))
def test_a_shape_drawn_again_does_not_move(a, count, start):
    left, right = (lambda b: match(a, b).align(a, b))(redrawn(a, count, start))
    assert np.abs(left - right).max() <= 1e-8 * size(a)


def test_a_shape_turned_and_scaled_moves_rigidly():
    a = wave([0.2, 0.1, -0.15, 0.05], [0, 1, 2, 3], 50)
    b = redrawn(turned(a, 1.0) * 2 + 7, 30, 11)
    left, right = match(a, b).align(a, b)
    np.testing.assert_allclose(turned(left, 1.0) * 2 + 7, right, atol=1e-6)


@pytest.mark.parametrize("bend", [-2.0, -1.0, 1.0, 2.2])
def test_a_limb_that_bends_keeps_its_parts_together(bend):
    a, b = bent_strip(0.0), bent_strip(bend)
    b2 = np.roll(b, 23, axis=0)
    images = np.mod(match(a, b2).images(a, b2, np.arange(80.0)) - 23, 80)
    along = [lengths_at(b, x) / perimeter(b) for x in (images, np.arange(80.0))]
    assert shift(*along) < 0.025


LETTERS = {
    "I": [(-1, -5), (1, -5), (1, 5), (-1, 5)],
    "L": [(0, 0), (6, 0), (6, 1), (1, 1), (1, 9), (0, 9)],
    "T": [(-0.5, 0), (0.5, 0), (0.5, 8), (4, 8), (4, 9), (-4, 9), (-4, 8), (-0.5, 8)],
    "X": [(1, 0), (4, 4), (7, 0), (8, 0), (4.5, 5), (8, 10), (7, 10), (4, 6), (1, 10), (0, 10), (3.5, 5), (0, 0)],
    "Z": [(0, 0), (6, 0), (6, 1), (1, 1), (6, 8), (6, 9), (0, 9), (0, 8), (5, 8), (0, 1)],
}


@pytest.mark.parametrize("letter", LETTERS)
@pytest.mark.parametrize("stretch", [(1.6, 1.0), (1.0, 0.6), (1.3, 1.3)])
def test_a_letter_keeps_its_corners_and_is_not_turned_over(letter, stretch):
    a = np.array(LETTERS[letter], float) * 20
    a = a[::-1] if core.geometry.outline.signed_area(a) < 0 else a
    b = np.roll(a * stretch, 3, axis=0)
    images = match(a, b).images(a, b, np.arange(len(a), dtype=float))
    assert np.array_equal(np.rint(images), np.mod(np.arange(len(a)) + 3, len(a)))
    np.testing.assert_allclose(images, np.rint(images), atol=1e-9)


def test_a_corner_lands_on_the_corner_near_it():
    square = np.array([[0, 0], [100, 0], [100, 100], [0, 100.0]])
    kite = np.array([[-5, 3], [110, -8], [92, 95], [8, 120.0]])
    images = match(square, redrawn(kite, 57, 0)).images(square, redrawn(kite, 57, 0), np.arange(4.0))
    np.testing.assert_allclose(points_at(redrawn(kite, 57, 0), images), kite, atol=1e-6)


def test_open_outlines_go_ends_to_ends_in_the_nearer_direction():
    x = np.linspace(0, 100, 15)
    a, b = np.column_stack([x, np.sin(x / 20) * 20]), np.column_stack([x, np.sin(x / 25) * 30 + 5])
    c, d = match(a, b, closed=False), match(a, b[::-1], closed=False)
    assert (c.flipped, d.flipped) == (False, True)
    assert (c.after[0], c.after[-1], d.after[0], d.after[-1]) == (0, 14, 14, 0)
    there = [c.images(a, b, np.arange(15.0)), 14 - d.images(a, b[::-1], np.arange(15.0))]
    np.testing.assert_allclose(*there, atol=1e-3)


def test_an_anchor_overrules_the_direction_of_open_outlines():
    a = np.column_stack([np.linspace(0, 100, 9), np.zeros(9)])
    assert match(a, a + 3, [(0.0, 8.0)], closed=False).flipped


def test_three_anchors_overrule_the_direction_of_closed_outlines():
    a = wave([0.1, 0.1, 0, 0], [0, 1, 0, 0], 30)
    assert match(a, a, [(0, 0), (10, 20), (20, 10)]).flipped


@pytest.mark.parametrize(
    ("anchors", "sentence"),
    [
        ([(0, 0), (3, 9), (6, 3), (9, 6)], "cross"),
        ([(1, 2), (1, 5)], "share a point"),
        ([(1, 2), (50, 5)], "ends at"),
        ([(float("nan"), 2)], "positions"),
    ],
)
@pytest.mark.parametrize("solve", [match, match_quick, alternatives])
def test_impossible_anchors_are_refused_with_a_sentence(solve, anchors, sentence):
    a = wave([0.1, 0, 0, 0], [0, 0, 0, 0], 12)
    with pytest.raises(CorrespondenceError, match=sentence):
        solve(a, a, anchors)


def test_a_bad_outline_is_named():
    with pytest.raises(GeometryError, match="after has 2 vertices"):
        match([(0, 0), (1, 0), (0, 1)], [(0, 0), (1, 1)])


COMB = [p for i in range(60) for p in ((i, 0), (i + 0.2, 30), (i + 0.4, 30), (i + 0.6, 0))] + [(60, -3), (0, -3)]
HARD = {
    "triangle": [(0, 0), (1, 0), (0, 1)],
    "circle": wave([0, 0, 0, 0], [0, 0, 0, 0], 2000),
    "comb": COMB,
    "collinear": [(0, 0), (1, 0), (3, 0), (2, 0)],
    "doubled": np.repeat(wave([0.2, 0, 0, 0], [0, 0, 0, 0], 8), 3, axis=0),
    "figure of eight": [(0, 0), (1, 1), (1, 0), (0, 1)],
    "needle": [(0, 0), (1000, 1e-9), (0, 1e-3)],
    "far": wave([0, 0, 0, 0], [0, 0, 0, 0], 9) * 1e-5 + 9e8,
    "two places": [(0, 0), (0, 0), (1, 1), (1, 1)],
}


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("one", HARD)
def test_hard_outlines_match_without_warning(one, closed):
    a = np.asarray(HARD[one], float)
    for other in ("triangle", "comb", "collinear", "doubled"):
        b = np.asarray(HARD[other], float)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            c = match(a, b, closed=closed)
            anchored = match_quick(a, b, [(0.5, 1.25)], closed=closed, near=c)
            left, right = c.align(a, b)
        assert np.isfinite(left).all()
        assert np.isfinite(right).all()
        assert (0.5, 1.25) in set(zip(anchored.before.tolist(), anchored.after.tolist(), strict=True))


@brief
@given(blobs(), blobs())
def test_alternatives_begin_with_the_answer_rise_in_cost_and_differ(a, b):
    found = alternatives(a, b, count=5)
    costs = [x.cost for x in found]
    assert found[0].correspondence == match(a, b)
    assert (np.diff(costs) > -1e-8).all()
    assert [x.stretch + x.bend + x.turn for x in found] == pytest.approx(costs)
    maps = [map_of(x.correspondence, a, b) for x in found]
    assert all(shift(maps[i], maps[j]) > 0.01 for i in range(len(maps)) for j in range(i))


def test_the_answer_is_the_same_every_time():
    a, b = wave([0.2, 0.1, 0, 0], [0, 1, 0, 0], 40), wave([0.1, -0.2, 0, 0.1], [2, 1, 0, 0], 33)
    assert match(a, b) == match(a, b)


def test_dragging_one_anchor_moves_little_beyond_the_next():
    a, b = wave([0.2, 0.1, 0.1, 0], [0, 1, 2, 0], 100), wave([0.1, 0.1, 0.15, 0], [0, 1, 2, 0], 90)
    c = match(a, b)
    held = [(x, float(c.images(a, b, np.array([x]))[0])) for x in (10.0, 40.0, 80.0)]
    there = float(c.images(a, b, np.array([60.0]))[0])
    steps = [match_quick(a, b, [*held, (60.0, there + d)], near=c) for d in (0, 3)]
    far = np.linspace(81, 109, 40) % 100
    moved = [lengths_at(b, s.images(a, b, far)) / perimeter(b) for s in steps]
    assert shift(*moved) < 0.002


@pytest.mark.parametrize("closed", [True, False])
def test_several_anchors_on_an_edge_without_length_are_kept(closed):
    a = np.repeat(wave([0.2, 0, 0, 0], [0, 0, 0, 0], 8), 2, axis=0)
    b = wave([0.1, 0.1, 0, 0], [0, 1, 0, 0], 11)
    anchors = [(4.25, 2.5), (4.5, 4.0), (4.75, 6.125)]
    c = match(a, b, anchors, closed=closed)
    assert set(anchors) <= set(zip(c.before.tolist(), c.after.tolist(), strict=True))
