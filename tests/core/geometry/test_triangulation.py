import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import GeometryError
from core.geometry.triangulation import Mesh, split_chords, triangle_areas, triangulate


def star(radii):
    angle = np.linspace(0, 2 * np.pi, len(radii), endpoint=False)
    return np.asarray(radii) * np.exp(1j * angle)


def ring(*outlines):
    """Vertices of closed outlines in a row, and the vertex after each."""
    stops = np.cumsum([len(p) for p in outlines])
    starts = stops - [len(p) for p in outlines]
    pairs = zip(starts, stops, strict=True)
    after = np.concatenate([first + np.roll(np.arange(last - first), -1) for first, last in pairs])
    return np.concatenate(outlines), after


def area(p):
    return float((p.conj() * np.roll(p, -1)).imag.sum() / 2)


def mesh_of(*outlines, size=0.2):
    boundary, after = ring(*outlines)
    return triangulate(boundary, after, np.full(len(boundary), size)), after


stars = st.lists(st.floats(0.3, 1.0), min_size=5, max_size=40).map(star)


@settings(max_examples=60, deadline=None)
@given(stars, st.floats(0.05, 1.0))
def test_the_triangles_fill_the_outline_exactly_and_none_is_turned_over(p, size):
    mesh, _ = mesh_of(p, size=size)
    assert (mesh.areas > 0).all()
    assert mesh.areas.sum() == pytest.approx(area(p), rel=1e-9)


@settings(max_examples=60, deadline=None)
@given(stars)
def test_the_boundary_comes_first_and_every_edge_of_it_is_in_the_mesh_once(p):
    mesh, after = mesh_of(p)
    assert mesh.rim == len(p)
    assert np.array_equal(mesh.points[: mesh.rim], p)
    sides = np.sort(np.stack([mesh.triangles, np.roll(mesh.triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    for i, j in enumerate(after):
        assert (sides == sorted((i, j))).all(axis=1).sum() == 1


@settings(max_examples=60, deadline=None)
@given(stars)
def test_every_inner_edge_has_an_end_inside_so_that_every_triangle_can_be_unfolded(p):
    mesh, _ = mesh_of(p)
    _, ends = mesh.neighbours
    assert (ends >= mesh.rim).any(axis=1).all()


@settings(max_examples=40, deadline=None)
@given(stars)
def test_every_edge_belongs_to_one_triangle_on_the_boundary_and_to_two_inside(p):
    mesh, _ = mesh_of(p)
    pairs, _ = mesh.neighbours
    assert 3 * len(mesh.triangles) == 2 * len(pairs) + mesh.rim
    assert len(np.unique(np.sort(pairs, axis=1), axis=0)) == len(pairs)


@pytest.mark.parametrize("turn", [1, -1])
def test_a_hole_stays_empty_whichever_way_it_is_drawn(turn):
    outer, hole = star(np.ones(30)), star(np.full(12, 0.4))[::turn]
    mesh, _ = mesh_of(outer, hole)
    assert mesh.areas.sum() == pytest.approx(area(outer) - abs(area(hole)), rel=1e-9)
    assert np.abs(mesh.points[mesh.triangles].mean(axis=1)).min() > 0.4 * np.cos(np.pi / 12)


def test_an_island_in_a_hole_is_filled_again():
    outlines = [star(np.full(24, r)) for r in (1.0, 0.7, 0.3)]
    mesh, _ = mesh_of(*outlines)
    assert mesh.areas.sum() == pytest.approx(area(outlines[0]) - area(outlines[1]) + area(outlines[2]), rel=1e-9)


def test_a_smaller_size_gives_a_finer_mesh():
    p = star(np.ones(60))
    counts = [len(mesh_of(p, size=size)[0].triangles) for size in (0.4, 0.2, 0.1)]
    assert counts[0] < counts[1] < counts[2]


def test_a_triangle_needs_no_other():
    mesh, _ = mesh_of(star([1.0, 1.0, 1.0]), size=10.0)
    assert np.array_equal(np.sort(mesh.triangles), [[0, 1, 2]])


@pytest.mark.parametrize(
    "p",
    [
        np.array([0, 2 + 2j, 2, 2j]),  # crosses
        np.array([0, 2, 2, 2j]),  # doubled
        np.array([0, 2, 2 + 2j, 1, 2j]),  # touches
        np.array([0, 1, 2, 3], np.complex128),  # encloses nothing
    ],
)
def test_outlines_that_cross_touch_or_enclose_nothing_are_refused(p):
    with pytest.raises(GeometryError):
        mesh_of(p.astype(np.complex128))


@pytest.mark.parametrize(("rim", "count"), [(4, 4), (3, 4), (2, 2)])
def test_splitting_chords_keeps_the_area_and_the_direction(rim, count):
    points = np.array([0, 1, 1 + 1j, 1j])
    mesh = split_chords(Mesh(points, np.array([[0, 1, 2], [0, 2, 3]]), rim))
    assert len(mesh.triangles) == count
    assert (triangle_areas(mesh.points, mesh.triangles) > 0).all()
    assert mesh.areas.sum() == pytest.approx(1)
