"""Sketched films and their crossings, against the plain definition."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LinearRing

from core.correspondence.film import crossing, film_factor, sketches

SQUARE = np.array([0, 1, 1 + 1j, 1j])
BOW_TIE = np.array([0, 1 + 1j, 1, 1j])


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.integers(0, 10**6), st.integers(4, 40), st.booleans())
def test_crossings_are_those_that_geometry_finds(seed, count, star):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(count)) if star else rng.random(count)
    z = (0.5 + rng.random(count)) * np.exp(2j * np.pi * angle)
    assert bool(crossing(z[None])[0]) == (not LinearRing(np.column_stack([z.real, z.imag])).is_simple)


def test_a_film_begins_and_ends_with_its_keyframes_but_for_the_place():
    ends = sketches(SQUARE, np.roll(SQUARE, -1) * 2j, np.array([0.0, 1.0]))
    for got, want in zip(ends, (SQUARE, np.roll(SQUARE, -1) * 2j), strict=True):
        np.testing.assert_allclose(got - got[0], want - want[0], atol=1e-12)


def test_a_rigid_motion_costs_nothing():
    assert film_factor(SQUARE, SQUARE * np.exp(0.8j) + 3) == pytest.approx(1.0)


def test_keyframes_that_cross_are_not_blamed_on_the_film():
    assert film_factor(BOW_TIE, BOW_TIE + 1) == pytest.approx(1.0)


def test_edges_without_length_make_no_trouble():
    doubled = np.repeat(SQUARE, 2)
    assert np.isfinite(sketches(doubled, np.roll(doubled, 1), np.array([0.5]))).all()
