"""Which outline of a drawing becomes which of another."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.correspondence.drawings import OutlinePairs, pair_outlines
from core.errors import CorrespondenceError, GeometryError


def circle(x, y, r, n=24):
    angle = 2 * np.pi * np.arange(n) / n
    return np.column_stack([x + r * np.cos(angle), y + r * np.sin(angle)])


FACE = [
    (circle(0, 0, 100), True),
    (circle(-35, -30, 12), True),
    (circle(35, -30, 12), True),
    (np.column_stack([np.linspace(-40, 40, 9), 40 + np.linspace(-1, 1, 9) ** 2 * 8]), False),
]


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.permutations(range(4)), st.floats(0.1, 5), st.floats(-500, 500))
def test_the_order_of_drawing_the_scale_and_the_place_do_not_matter(order, scale, move):
    after = [(FACE[k][0] * scale + move, FACE[k][1]) for k in order]
    assert pair_outlines(FACE, after).pairs == tuple((i, order.index(i)) for i in range(4))


@settings(max_examples=25, deadline=None, derandomize=True)
@given(st.permutations(range(4)))
def test_exchanging_the_drawings_gives_the_inverse(order):
    after = [(FACE[k][0] * [1.2, 0.9], FACE[k][1]) for k in order]
    there, back = pair_outlines(FACE, after), pair_outlines(after, FACE)
    assert set(there.pairs) == {(i, j) for j, i in back.pairs}


def test_a_hole_goes_with_the_hole_and_not_with_a_nearer_solid():
    before = [(circle(0, 0, 50), True), (circle(10, 0, 20), True)]
    after = [(circle(0, 0, 50), True), (circle(70, 0, 20), True), (circle(-20, 0, 20), True)]
    assert pair_outlines(before, after) == OutlinePairs(((0, 0), (1, 2)), (), (1,))


def test_what_has_no_partner_is_named():
    assert pair_outlines(FACE, FACE[:2]) == OutlinePairs(((0, 0), (1, 1)), (2, 3), ())
    assert pair_outlines([], FACE) == OutlinePairs((), (), (0, 1, 2, 3))


def test_pairs_made_by_hand_are_kept():
    assert set(pair_outlines(FACE, FACE, fixed=[(1, 2)]).pairs) == {(0, 0), (1, 2), (2, 1), (3, 3)}


@pytest.mark.parametrize(
    ("fixed", "sentence"),
    [([(9, 0)], "no outline 9 before"), ([(0, 1), (0, 2)], "paired twice"), ([(0, 3)], "one is closed")],
)
def test_impossible_pairs_are_refused_with_a_sentence(fixed, sentence):
    with pytest.raises(CorrespondenceError, match=sentence):
        pair_outlines(FACE, FACE, fixed)


def test_a_bad_outline_is_named():
    with pytest.raises(GeometryError, match="outline 1 after has 1 vertices"):
        pair_outlines(FACE, [FACE[0], ([(0, 0)], True)])
