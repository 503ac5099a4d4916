import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.correspondence.by_hand import directions, mean_shift, reversed_direction, shifted_start
from core.correspondence.matching import match
from core.correspondence.pairing import Correspondence
from core.errors import CorrespondenceError

SQUARE = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])
HOUSE = np.array([(0.0, 40.0), (50.0, 0.0), (100.0, 40.0), (90.0, 100.0), (10.0, 100.0)])


def even(a, b, flipped=False):
    return Correspondence(np.zeros(1), np.zeros(1), (len(a), len(b)), flipped=flipped)


def test_turning_round_twice_gives_the_pairs_of_the_start_again():
    c = match(SQUARE, HOUSE)
    there = reversed_direction(c)
    assert there.flipped != c.flipped
    assert reversed_direction(there).before[0] == c.before[0]
    assert reversed_direction(there).after[0] == c.after[0]


def test_open_outlines_exchange_their_ends():
    line = SQUARE[:3]
    c = match(line, line, closed=False)
    assert (c.after[0], c.after[-1]) == (0.0, 2.0)
    other = reversed_direction(c)
    assert (other.after[0], other.after[-1]) == (2.0, 0.0)
    assert tuple(reversed_direction(other).after) == (0.0, 2.0)


@given(st.integers(1, 9), st.booleans())
def test_each_step_puts_the_start_on_the_next_vertex(steps, flipped):
    c = even(SQUARE, HOUSE, flipped)
    moved = shifted_start(c, SQUARE, HOUSE, steps)
    start = moved.images(SQUARE, HOUSE, np.zeros(1))[0]
    expected = -steps % 5 if flipped else steps % 5
    assert min(abs(start - expected), 5 - abs(start - expected)) < 1e-9


@given(st.integers(-6, 6))
def test_steps_there_and_back_end_where_they_began(steps):
    c = even(SQUARE, HOUSE)
    back = shifted_start(shifted_start(c, SQUARE, HOUSE, steps), SQUARE, HOUSE, -steps)
    assert mean_shift(c, back, SQUARE, HOUSE) < 1e-9


def test_a_shift_of_a_quarter_of_a_square_is_a_quarter():
    c = even(SQUARE, SQUARE)
    assert mean_shift(c, shifted_start(c, SQUARE, SQUARE, 1), SQUARE, SQUARE) == pytest.approx(0.25)
    assert mean_shift(c, c, SQUARE, SQUARE) == 0


def test_open_outlines_have_no_start_to_shift():
    line = SQUARE[:3]
    with pytest.raises(CorrespondenceError, match="ends"):
        shifted_start(match(line, line, closed=False), line, line, 1)


def test_directions_follow_the_edges():
    d = directions(SQUARE, np.array([0.0, 1.5, 3.0]), closed=True)
    assert d.tolist() == [[1, 0], [0, 1], [0, -1]]
