import numpy as np
import pytest

from core.repair.barrier import Barrier
from core.repair.chains import Chains
from core.repair.contacts import clear_moves
from core.repair.descent import Field
from core.repair.join import Simplification, join, star_centre, star_link
from core.repair.tighten import tighten
from tests.core.repair.shapes import circle, comb, spiral, star, untangled


def row(points):
    return (points - points.mean(axis=0)) @ [1, 1j] / np.ptp(points)


def field_of(x, y):
    chains = Chains.of([len(x)], [True])
    mass, springs = chains.stiffness(x, y)
    return Field(chains, Barrier(x, y), mass, springs, lambda: None)


def pairs():
    rng = np.random.default_rng(8)
    return {
        "spiral to comb": (spiral(50, 1.3), comb(50, 3, 70.0)),
        "spirals of both senses": (spiral(50, 1.0), spiral(50, -1.0)),
        "comb upside down": (comb(40, 2, 70.0), comb(40, 2, -70.0)),
        "untangled": (untangled(16, rng), untangled(16, rng)),
    }


@pytest.mark.parametrize("name", pairs())
def test_smoothing_alone_joins_any_two_simple_outlines(name):
    x, y = (row(p) for p in pairs()[name])
    field = field_of(x, y)
    places = np.array(join(field, x, y, ()))
    assert np.array_equal(places[0], x)
    assert np.array_equal(places[-1], y)
    assert clear_moves(field.chains, places[:-1], places[1:]).all()
    assert field.chains.simple(places).all()


def test_smoothing_opens_a_spiral_and_keeps_its_area():
    x = row(spiral(50, 1.2))
    field = field_of(x, x)
    side = Simplification(field, x)
    assert side.centre() is None
    before = field.chains.lengths(x).sum()
    side.flow(40)
    assert field.chains.lengths(side.place).sum() < 0.8 * before
    area = [0.5 * np.abs((z.conj() * np.roll(z, -1)).imag.sum()) for z in (x, side.place)]
    assert area[0] == pytest.approx(area[1])
    places = np.array(side.places)
    assert clear_moves(field.chains, places[:-1], places[1:]).all()


def test_star_shapes_are_linked_through_star_shapes():
    rng = np.random.default_rng(6)
    x, y = row(star(30, rng)), row(star(30, rng)) * 1j + 3
    field = field_of(x, y)
    between = star_link(field, x, y, star_centre(x), star_centre(y))
    places = np.array([x, *between, y])
    assert clear_moves(field.chains, places[:-1], places[1:]).all()
    assert all(star_centre(z) is not None for z in between)


def test_tightening_brings_a_needless_detour_back():
    x = row(circle(24))
    times = np.linspace(0, 1, 17)
    wished = x + times[:, None]
    detour = wished + 0.3j * np.sin(np.pi * times)[:, None]
    field = field_of(x, x + 1)
    tight = detour
    for _ in range(6):
        tight = tighten(field, times, tight, wished)
    assert np.array_equal(tight[[0, -1]], detour[[0, -1]])
    assert np.abs(tight - wished).max() < 0.25 * np.abs(detour - wished).max()
    assert clear_moves(field.chains, tight[:-1], tight[1:]).all()
