"""The steps of the rigid method on their own: cage, carrying, opening of folds, angles."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from core.geometry.triangulation import triangulate
from core.methods import untangle as untangling
from core.methods.cage import cage
from core.methods.carry import Carried, carry
from core.methods.elements import Elements, Factor, Maps
from core.methods.headings import headings
from core.methods.interior import even_turns, travel
from core.methods.loops import crossing_edges, next_in_loops

numbers = st.complex_numbers(max_magnitude=10, allow_nan=False, allow_infinity=False)


def star(radii):
    angle = np.linspace(0, 2 * np.pi, len(radii), endpoint=False)
    p = np.asarray(radii) * np.exp(1j * angle)
    area = (p.conj() * np.roll(p, -1)).imag.sum() / 2
    return (p - p.mean()) / np.sqrt(area)


stars = st.lists(st.floats(0.4, 1.0), min_size=30, max_size=30).map(star)


def carried(a, b, tolerance=0.003):
    rows = [slice(0, len(a))]
    boundary = cage(a, b, rows, tolerance, 200)
    return carry(boundary, [headings(a, b, closed=True).mean_turn()])


@settings(max_examples=40, deadline=None)
@given(stars, stars, st.floats(0.005, 0.2))
def test_the_cage_is_simple_and_within_its_tolerance_of_both_keyframes(a, b, tolerance):
    found = cage(a, b, [slice(0, 30)], tolerance, 200)
    for p, boundary in ((a, found.before), (b, found.after)):
        assert not len(crossing_edges(boundary[None], found.loops))
        outline = Polygon(np.stack([boundary.real, boundary.imag], axis=1))
        assert Polygon(np.stack([p.real, p.imag], axis=1)).hausdorff_distance(outline) <= tolerance + 1e-9
        assert np.array_equal(boundary[found.places], p[found.vertices])


@settings(max_examples=40, deadline=None)
@given(stars, stars, st.integers(0, 29), st.booleans())
def test_the_cage_does_not_depend_on_the_order_of_keyframes_nor_on_the_start(a, b, start, exchanged):
    plain = cage(a, b, [slice(0, 30)], 0.05, 200)
    p, q = np.roll(a, start), np.roll(b, start)
    other = cage(q, p, [slice(0, 30)], 0.05, 200) if exchanged else cage(p, q, [slice(0, 30)], 0.05, 200)
    assert set(((other.vertices - start) % 30).tolist()) == set(plain.vertices.tolist())


def test_outlines_that_cross_have_no_cage():
    bow = np.array([0, 1 + 1j, 1, 1j])
    assert cage(bow, bow, [slice(0, 4)], 0.01, 100) is None


@given(numbers, numbers, numbers, numbers, numbers)
def test_maps_follow_each_other_and_go_backwards_like_functions(p, q, r, s, x):
    def at(maps, z):
        return maps.p[0] * z + maps.q[0] * np.conj(z)

    one, two = (Maps(np.array([u]), np.array([v])) for u, v in ((p, q), (r, s)))
    assert at(one.after(two), x) == pytest.approx(at(one, at(two, x)), abs=1e-9)
    if abs(abs(p) - abs(q)) > 1e-2:
        assert at(one.inverse(), at(one, x)) == pytest.approx(x, abs=1e-6)


@settings(max_examples=30, deadline=None)
@given(stars, numbers, numbers)
def test_a_linear_map_of_the_vertices_is_found_in_every_triangle_and_again_from_all(p, u, v):
    mesh = triangulate(p, next_in_loops([slice(0, 30)]), np.full(30, 0.3))
    elements = Elements.of(mesh)
    image = u * mesh.points + v * mesh.points.conj()
    maps = elements.maps(image)
    np.testing.assert_allclose(maps.p, np.full(len(maps.p), u), atol=1e-8)
    np.testing.assert_allclose(maps.q, np.full(len(maps.q), v), atol=1e-8)
    found = Factor(elements.stiffness[1:, 1:]).solve(elements.pull(maps)[1:])
    np.testing.assert_allclose(found, image[1:] - image[0], atol=1e-6)


@settings(max_examples=30, deadline=None)
@given(stars, st.floats(-3, 3))
def test_carrying_a_turned_outline_turns_the_mesh(p, angle):
    found = carried(p, p * np.exp(1j * angle))
    np.testing.assert_allclose(found.image, found.mesh.points * np.exp(1j * angle), atol=1e-9)
    assert np.ptp(found.turn) < 1e-9
    np.testing.assert_allclose(np.exp(1j * found.turn), np.exp(1j * angle), atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(stars, st.integers(0, 10**6))
def test_folds_made_by_shaking_the_inner_vertices_are_opened_and_the_boundary_stays(p, seed):
    plain = carried(p, p)
    rng = np.random.default_rng(seed)
    image = plain.image.copy()
    inner = len(image) - plain.mesh.rim
    image[plain.mesh.rim :] += 0.05 * (rng.normal(size=inner) + 1j * rng.normal(size=inner))
    shaken = replace(plain, image=image)
    opened = untangling.untangle(shaken, 60)
    assert opened is not None
    assert (shaken.elements.maps(opened).determinant > 0).all()
    assert np.array_equal(opened[: plain.mesh.rim], image[: plain.mesh.rim])


def test_folds_that_the_boundary_enforces_are_reported():
    p = star(np.ones(30))
    plain = carried(p, p)
    image = plain.image.copy()
    image[: plain.mesh.rim] = image[: plain.mesh.rim].conj()
    assert untangling.untangle(replace(plain, image=image), 20) is None


@settings(max_examples=60)
@given(numbers, numbers, st.sampled_from([1.0, 0.1, 1e-3]))
def test_derivatives_of_the_energy_agree_with_differences(p, q, softness):
    step = 1e-5
    at = np.array([p.real, p.imag, q.real, q.imag])

    def gradient(x):
        maps = Maps(np.array([x[0] + 1j * x[1]]), np.array([x[2] + 1j * x[3]]))
        energy = untangling._energy(maps, softness)
        both = np.concatenate([energy.by_p * maps.p, energy.by_q * maps.q])
        return both.view(np.float64), energy, maps

    if abs(abs(p) ** 2 - abs(q) ** 2) < 0.2:
        return
    own, energy, maps = gradient(at)
    value = [untangling._energy(gradient(at + s * step * np.eye(4)[0])[2], softness).value[0] for s in (1, -1)]
    assert own[0] == pytest.approx((value[0] - value[1]) / (2 * step), rel=1e-3, abs=1e-3 * (1 + abs(own).max()))
    exact = np.stack([(gradient(at + step * e)[0] - gradient(at - step * e)[0]) / (2 * step) for e in np.eye(4)])
    projected = energy.hessian(maps)[0]
    size = np.abs(exact).max()
    assert np.linalg.eigvalsh(projected).min() > 0
    if np.linalg.eigvalsh(exact).min() > 1e-3 * size:  # where nothing is clamped it is the Hessian itself
        np.testing.assert_allclose(projected, exact, atol=1e-3 * size)


@settings(max_examples=30, deadline=None)
@given(stars, st.floats(-2, 2), st.floats(0.7, 1.4))
def test_angles_are_those_of_the_boundary_where_all_turns_alike(p, angle, flat):
    q = (p.real * flat + 1j * p.imag / flat) * np.exp(1j * angle)
    found = carried(p, q)
    turns = even_turns(found, found.maps())
    turns -= 2 * np.pi * np.rint((turns.mean() - angle) / (2 * np.pi))
    assert np.abs(turns - angle).max() < 1.0
    assert abs(np.average(turns, weights=found.mesh.areas) - angle) < 0.2


@settings(max_examples=30, deadline=None)
@given(stars, stars)
def test_the_interior_travels_from_the_mesh_to_its_image(a, b):
    found = carried(a, b)
    image = untangling.untangle(found, 60)
    if image is None:
        return
    ready = Carried(found.mesh, found.elements, image, found.turn, found.rim_turn, found.width)
    first, last = travel(ready, 2.0, 3.0).vertices(np.array([0.0, 1.0])).T
    np.testing.assert_allclose(first, 2 * (ready.mesh.points - ready.mesh.points[0]), atol=1e-7)
    np.testing.assert_allclose(last, 3 * (image - image[0]), atol=1e-6)
