import numpy as np
import pytest

from core.repair.barrier import REACH, WEIGHT, Barrier
from core.repair.chains import Chains
from core.repair.contacts import near_pairs
from core.repair.descent import Field, Metric, descend
from core.repair.join import star_centre
from tests.core.repair.shapes import circle, spiral, star


def field_of(z):
    chains = Chains.of([len(z)], [True])
    mass, springs = chains.stiffness(z, z)
    return Field(chains, Barrier(z, z), mass, springs, lambda: None)


def contact():
    """A field of a wide open fork and a place where its two points almost touch."""
    z = np.array([0, 1, 1 + 0.4j, 0.3 + 0.45j, 0.3 + 0.55j, 1 + 0.6j, 1 + 1j, 1j], complex)
    near = z.copy()
    near[2] += 0.0995j
    near[5] -= 0.0995j
    return field_of(z), near


def test_the_barrier_is_silent_at_both_keyframes():
    rng = np.random.default_rng(2)
    a, b = (star(30, rng) @ [0.005, 0.005j] for _ in range(2))
    barrier, chains = Barrier(a, b), Chains.of([30], [True])
    for z in (a, b):
        pairs = near_pairs(chains, z[None], np.zeros((1, 30)), REACH)
        assert not barrier.touches(z, pairs)
        assert barrier.value(z, pairs) == 0


def test_slopes_are_those_of_the_value():
    field, z = contact()
    pairs = field.pairs_near(z)
    terms = field.barrier.terms(z, pairs)
    assert len(terms.slope) >= 2
    gradient = np.zeros(len(z), complex)
    np.add.at(gradient, terms.vertices, terms.shares * (terms.slope * terms.normal)[:, None])
    for k in range(len(z)):
        for axis in (1, 1j):
            ahead, behind = z.copy(), z.copy()
            ahead[k] += 1e-8 * axis
            behind[k] -= 1e-8 * axis
            slope = (field.barrier.value(ahead, pairs) - field.barrier.value(behind, pairs)) / 2e-8
            assert slope == pytest.approx((gradient[k] * np.conj(axis)).real, rel=1e-4, abs=1e-6)


def test_both_ways_to_solve_for_a_step_agree():
    field, z = contact()
    terms = field.barrier.terms(z, field.pairs_near(z))
    away = z - field.barrier.before + 0.01
    one, other = (solve(away, terms, WEIGHT) for solve in (field.metric._added_step, field.metric._factored_step))
    assert np.abs(one - other).max() < 1e-9
    assert np.abs(one).max() > 1e-3


def test_without_contact_a_descent_goes_straight_to_its_target():
    z = circle(30) @ [0.005, 0.005j]
    places = descend(field_of(z), z, z + 0.02j, metric=field_of(z).metric)
    assert len(places) == 1
    assert np.abs(places[0] - z - 0.02j).max() < 1e-12


def test_a_descent_towards_a_crossing_stops_before_it():
    field, _ = contact()
    z = field.barrier.before
    target = z.copy()
    target[[2, 5]] = target[[5, 2]]
    places = descend(field, z, target, metric=field.metric, steps=40)
    assert field.chains.simple(np.array(places)).all()
    assert np.abs(places[-1] - target).max() < np.abs(z - target).max()
    assert abs(places[-1][2] - places[-1][5]) < 0.05


def test_columns_asked_for_twice_are_the_same():
    field, _ = contact()
    metric = Metric(field.metric.matrix)
    first = metric.replies(np.array([3, 1, 3]))
    again = metric.replies(np.array([1, 5]))
    inverse = np.linalg.inv(field.metric.matrix.toarray())
    np.testing.assert_allclose(first, inverse[[3, 1, 3]])
    np.testing.assert_allclose(again, inverse[[1, 5]])


def test_the_centre_of_a_star_shape_sees_all_of_it():
    p = 500.0 + star(40, np.random.default_rng(4))
    centre = star_centre(p @ [1, 1j])
    angles = np.unwrap(np.angle(p @ [1, 1j] - centre))
    assert (np.diff(angles) > 0).all()
    assert star_centre(spiral(80, 1.5) @ [1, 1j]) is None
