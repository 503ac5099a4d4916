import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from core.repair.survey import runs
from core.repair.timing import durations

lengths = st.lists(st.floats(0, 2), min_size=1, max_size=12).map(np.array)


@given(lengths, st.floats(0.1, 2), st.floats(0.5, 50))
def test_moves_fill_the_time_and_keep_the_limit_where_it_can_be_kept(length, whole, limit):
    wished = np.full(len(length), whole / len(length))
    taken = durations(wished, length, whole, limit)
    assert abs(taken.sum() - whole) < 1e-9
    assert (taken >= 0).all()
    if length.sum() < 0.99 * whole * limit:
        assert (length <= limit * taken * (1 + 1e-6)).all()


def test_moves_slow_enough_take_the_time_wished():
    np.testing.assert_allclose(durations(np.array([1.0, 2, 1]), np.array([1.0, 1, 0]), 4.0, 2.0), [1, 2, 1])


def test_near_runs_are_one_and_far_ones_are_not():
    bad = np.array([0, 1, 1, 0, 0, 1, 0, 0, 0, 1], bool)
    assert runs(bad) == [(1, 6), (9, 10)]
    assert runs(bad, apart=1) == [(1, 3), (5, 6), (9, 10)]
    assert runs(bad & False) == []
