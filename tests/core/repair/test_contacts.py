import itertools

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from core.repair.chains import Chains
from core.repair.contacts import clear_moves, distances, free_share, near_pairs
from tests.core.repair.shapes import circle, star, untangled


def row(points):
    return points[:, 0] / 100 + 1j * points[:, 1] / 100


def clear(a, b, bend=None):
    chains = Chains.of([len(a)], [True])
    return bool(clear_moves(chains, row(a)[None], row(b)[None], None if bend is None else row(bend)[None])[0])


@given(st.integers(4, 30), st.integers(0, 2**32 - 1), st.floats(0, 0.2))
@settings(max_examples=150)
def test_a_clear_move_keeps_simple_outlines_simple(count, seed, reach):
    rng = np.random.default_rng(seed)
    a, b = untangled(count, rng), rng.uniform(0, 100, (count, 2))
    b = (1 - reach) * a + reach * b
    frames = [(1 - s) * a + s * b for s in np.linspace(0, 1, 41)]
    if clear(a, b):
        assert all(Polygon(p).is_valid for p in frames)
    else:  # and what is refused comes at least near to a crossing, be it between two of those frames
        near = max(0.3 * near_distance(a), 0.05)
        finer = ((1 - s) * a + s * b for s in np.linspace(0, 1, 1001))
        assert any(near_distance(p) < near for p in itertools.chain(frames, finer))


def near_distance(p):
    z, chains = row(p), Chains.of([len(p)], [True])
    pairs = near_pairs(chains, z[None], np.zeros((1, len(z))), 9.0)
    return 100 * distances(*pairs.of(z))[0].min()


def test_parts_that_pass_through_each_other_between_the_frames_are_seen():
    thin = np.array([[0.0, 0], [100, 0], [100, 10], [2, 10], [2, 12], [100, 12], [100, 30], [0, 30]])
    swapped = thin[[0, 5, 4, 3, 2, 1, 6, 7]]
    jumped = thin.copy()
    jumped[1:3, 1] += 15
    assert clear(thin, thin + 500.0)
    assert not clear(thin, swapped)
    assert not clear(thin, jumped)


def test_turning_with_a_tiny_edge_beside_a_long_one_is_clear():
    p = np.array([[0.0, 0], [1e-6, 1e-6], [100, 0], [100, 50], [0, 50]])
    turn = np.exp(0.1j)
    z = p @ [1, 1j] * turn
    assert clear(p, np.stack([z.real, z.imag], axis=1))


def test_a_path_that_may_bend_further_than_the_gap_is_not_clear():
    p = np.array([[0.0, 0], [100, 0], [100, 10], [2, 10], [2, 12], [100, 12], [100, 30], [0, 30]])
    bend = np.zeros_like(p)
    bend[2, 1] = 1.0
    assert clear(p, p, bend)
    assert not clear(p, p, 3 * bend)


def test_many_moves_at_once_are_judged_as_one_by_one():
    rng = np.random.default_rng(1)
    a = np.stack([row(star(20, rng)) for _ in range(30)])
    b = a + rng.normal(0, 0.1, a.shape) * np.exp(2j * np.pi * rng.random(a.shape))
    chains = Chains.of([20], [True])
    together = clear_moves(chains, a, b)
    assert np.array_equal(together, [clear_moves(chains, x[None], y[None])[0] for x, y in zip(a, b, strict=True)])
    assert 0 < together.sum() < 30


def test_a_step_ends_before_the_first_meeting():
    z = row(circle(40))
    chains = Chains.of([40], [True])
    move = np.zeros(40, complex)
    move[0] = -3.0
    pairs = near_pairs(chains, z[None], move[None], 0.0)
    share = free_share(z, move, pairs)
    assert 0.5 < share < 2 / 3
    assert chains.simple((z + share * move)[None])[0]
    assert not chains.simple((z + 0.7 * move)[None])[0]


def test_open_ends_may_meet_edges_too():
    z = np.array([0, 1, 1 + 1j, 1j, 0.5j])
    chains = Chains.of([5], [False])
    last = np.array([0, 0, 0, 0, 1])
    assert clear_moves(chains, z[None], (z - 0.4j * last)[None])[0]
    assert not clear_moves(chains, z[None], (z + (0.3 - 0.7j) * last)[None])[0]
