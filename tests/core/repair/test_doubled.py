import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from core.certificate import certify_drawing
from core.geometry.crossings import is_simple
from core.methods.plan import AlignedPair, plan, plan_drawing
from core.repair.chains import Chains
from core.repair.doubled import spread
from core.repair.plan import plan_repair, repair_drawing
from tests.core.repair.shapes import circle, star, untangled

counts = st.lists(st.integers(1, 3), min_size=5, max_size=9)


@given(counts, st.integers(0, 2**32 - 1), st.booleans())
def test_doubled_vertices_part_along_the_outline(times, seed, closed):
    z = untangled(len(times), np.random.default_rng(seed)) @ [0.01, 0.01j]
    doubled = np.roll(np.repeat(z, times), 1 if closed else 0)
    chains = Chains.of([len(doubled)], [closed])
    moves = spread(chains, doubled)
    parted = doubled + moves
    assert (np.abs(moves) < 1.1e-4).all()
    edges = np.diff(parted, append=parted[:1]) if closed else np.diff(parted)
    assert (edges != 0).all()
    assert (moves != 0).sum() == sum(times) - len(times)
    assert chains.simple(parted[None])[0]


def test_where_nothing_is_doubled_nothing_moves():
    z = circle(20) @ [0.005, 0.005j]
    assert not spread(Chains.of([20], [True]), z).any()


@given(counts, counts, st.integers(0, 2**32 - 1), st.sampled_from(["linear", "intrinsic"]))
@settings(max_examples=12)
def test_keyframes_with_doubled_vertices_are_repaired_too(times, other, seed, method):
    rng = np.random.default_rng(seed)
    a, b = np.repeat(star(len(times), rng), times, axis=0), np.repeat(star(len(other), rng), other, axis=0)
    count = max(len(a), len(b))
    a, b = (np.concatenate([p, np.repeat(p[-1:], count - len(p), axis=0)]) for p in (a, b))
    assume(is_simple(a) and is_simple(b))
    repaired = plan_repair(plan(a, b, method=method))
    when = np.concatenate([[0, 1e-6, 1e-4, 3e-4], np.linspace(0, 1, 121), [1 - 1e-5, 1]])
    frames = repaired.evaluate(when)
    assert repaired.notes == ()
    assert all(Polygon(p).is_valid for p in frames)
    assert np.array_equal(frames[0], a)
    assert np.array_equal(frames[-1], b)
    near = repaired.evaluate(np.array([0, 1e-9, 1 - 1e-9, 1]))
    assert np.abs(near[1] - a).max() < 1e-3
    assert np.abs(near[2] - b).max() < 1e-3


@pytest.mark.parametrize("method", ["linear", "intrinsic"])
def test_outlines_that_grow_out_of_a_point_do_not_keep_the_others_from_repair(method):
    rng = np.random.default_rng(3)
    a, b = untangled(14, rng), untangled(14, rng)
    far = np.full((6, 2), 500.0)
    found = plan_drawing([AlignedPair(a, b), AlignedPair(far, far + circle(6))], method=method)
    repaired = repair_drawing(found)
    times = np.linspace(0, 1, 61)
    assert repaired.notes == ()
    assert certify_drawing(repaired.evaluate(times[1:]), (True, True)).ok
    assert np.array_equal(repaired.evaluate(times)[1], found.evaluate(times)[1])


def test_a_growing_outline_that_crosses_another_is_told():
    square = circle(4)
    there = circle(6, 20.0) + 300
    found = plan_drawing([AlignedPair(square, square), AlignedPair(np.zeros((6, 2)), there)], method="linear")
    assert "grows out of a point" in repair_drawing(found).notes[0]
