"""The correspondence itself: what it refuses, its inverse, the outlines aligned by it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.correspondence.pairing import Correspondence
from core.errors import CorrespondenceError
from core.geometry.outline import perimeter, points_at

SQUARE = np.array([[0, 0], [100, 0], [100, 100], [0, 100.0]])
PENTAGON = 80 * np.column_stack([np.cos(np.arange(5) * 2 * np.pi / 5), np.sin(np.arange(5) * 2 * np.pi / 5)])


@st.composite
def correspondences(draw):
    """Of SQUARE and PENTAGON, with one to five pairs, in either direction."""
    k = draw(st.integers(1, 5))
    before, after = (
        np.sort(draw(st.lists(st.integers(0, 100 * n - 1), min_size=k, max_size=k, unique=True))) / 100
        for n in (4, 5)
    )
    flipped = draw(st.booleans())
    after = np.roll(after[::-1] if flipped else after, draw(st.integers(0, k - 1)))
    return Correspondence(before, after, (4, 5), flipped=flipped)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(correspondences())
def test_aligned_outlines_are_the_outlines_with_points_added_on_their_edges(c):
    left, right = c.align(SQUARE, PENTAGON)
    p, q = c.aligned_positions(SQUARE, PENTAGON)
    assert np.array_equal(left[p == np.rint(p)], SQUARE)
    assert sorted(q[q == np.rint(q)]) == [0, 1, 2, 3, 4]
    assert np.array_equal(right, points_at(PENTAGON, q))
    assert perimeter(left) == pytest.approx(perimeter(SQUARE))
    assert perimeter(right) == pytest.approx(perimeter(PENTAGON))
    assert len(left) <= 4 + 5 + len(c.before)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(correspondences())
def test_every_pair_is_a_row_of_the_aligned_outlines(c):
    rows = set(zip(*(x.tolist() for x in c.aligned_positions(SQUARE, PENTAGON)), strict=True))
    assert set(zip(c.before.tolist(), c.after.tolist(), strict=True)) <= rows


@settings(max_examples=100, deadline=None, derandomize=True)
@given(correspondences(), st.lists(st.floats(0, 3.99), min_size=1, max_size=9))
def test_the_inverse_leads_back(c, positions):
    there = c.images(SQUARE, PENTAGON, np.array(positions))
    back = c.inverse.images(PENTAGON, SQUARE, there)
    assert c.inverse.inverse == c
    np.testing.assert_allclose(points_at(SQUARE, back), points_at(SQUARE, np.array(positions)), atol=1e-6)


@pytest.mark.parametrize(
    ("before", "after", "closed"),
    [([0, 1, 2, 3], [0, 2, 1, 3], True), ([0, 0], [1, 2], True), ([0, 2], [0, 4], False), ([0], [np.nan], True)],
)
def test_pairs_that_cannot_be_are_refused(before, after, closed):
    with pytest.raises(CorrespondenceError):
        Correspondence(np.array(before, float), np.array(after, float), (4, 4), closed)


def test_outlines_with_other_vertex_counts_are_refused_by_numbers():
    with pytest.raises(CorrespondenceError, match=r"4 and 5 vertices.*before has 5, after has 4"):
        Correspondence(np.zeros(1), np.zeros(1), (4, 5)).align(PENTAGON, SQUARE)
