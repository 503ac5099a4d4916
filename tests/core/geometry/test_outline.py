import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon

from core.errors import GeometryError
from core.geometry.outline import (
    arc_lengths,
    as_points,
    contains,
    edge_lengths,
    edge_vectors,
    lengths_at,
    locate,
    perimeter,
    points_at,
    positions_at_lengths,
    resample,
    signed_area,
    size,
)

SQUARE = np.array([(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)])
CLOSED = st.booleans()
SHARES = np.linspace(0, 1, 41)


@st.composite
def polygons(draw, least=3):
    count = draw(st.integers(least, 12))
    coordinate = st.integers(-50, 50)
    points = draw(st.lists(st.tuples(coordinate, coordinate), min_size=count, max_size=count, unique=True))
    return np.array(points, dtype=np.float64)


def top(points, closed):
    return len(points) if closed else len(points) - 1


@given(polygons(), CLOSED)
def test_the_edges_run_from_vertex_to_vertex_and_home_if_closed(points, closed):
    d = edge_vectors(points, closed=closed)
    assert len(d) == top(points, closed)
    np.testing.assert_allclose(points[0] + d.sum(axis=0), points[0] if closed else points[-1], atol=1e-9)
    assert edge_lengths(points, closed=closed).sum() == pytest.approx(perimeter(points, closed=closed))
    assert arc_lengths(points, closed=closed)[-1] == pytest.approx(perimeter(points, closed=closed))


@given(polygons(), CLOSED)
def test_a_whole_position_is_the_vertex_itself(points, closed):
    assert (points_at(points, np.arange(len(points)), closed=closed) == points).all()


@given(polygons(), st.floats(-40, 40))
def test_positions_of_a_closed_outline_wrap_round(points, position):
    there = points_at(points, [position, position + len(points)])
    np.testing.assert_allclose(there[0], there[1], atol=1e-9)


@given(polygons(), st.floats(-40, 40))
def test_positions_of_an_open_outline_end_at_its_ends(points, position):
    (there,) = points_at(points, [position], closed=False)
    if position <= 0:
        assert (there == points[0]).all()
    elif position >= len(points) - 1:
        assert (there == points[-1]).all()


def test_a_position_a_hair_below_zero_is_no_trap():
    assert (points_at(SQUARE, [-1e-300]) == SQUARE[0]).all()


@given(polygons(), CLOSED)
def test_positions_and_lengths_are_inverse_of_each_other(points, closed):
    positions = SHARES[:-1] * top(points, closed)
    lengths = lengths_at(points, positions, closed=closed)
    assert (np.diff(lengths) > 0).all()
    np.testing.assert_allclose(positions_at_lengths(points, lengths, closed=closed), positions, atol=1e-9)


@given(polygons(), CLOSED, st.integers(2, 30), st.floats(0, 1))
def test_resampled_points_lie_evenly_along_the_outline(points, closed, count, start):
    start = start if closed else 0.0
    sampled = resample(points, count, closed=closed, start=start)
    assert len(sampled) == count
    _, distance = locate(points, sampled, closed=closed)
    np.testing.assert_allclose(distance, 0, atol=1e-9)
    if not closed:
        np.testing.assert_allclose(sampled[[0, -1]], points[[0, -1]], atol=1e-9)
    steps = count if closed else count - 1
    assert edge_lengths(sampled, closed=closed).max() <= perimeter(points, closed=closed) / steps * (1 + 1e-9)


@given(polygons(), CLOSED, st.floats(0, 1))
def test_a_point_of_the_outline_is_found_on_it(points, closed, share):
    (point,) = points_at(points, [share * top(points, closed)], closed=closed)
    position, distance = locate(points, point, closed=closed)
    assert distance[0] == pytest.approx(0, abs=1e-9)
    np.testing.assert_allclose(points_at(points, position, closed=closed)[0], point, atol=1e-9)


@given(polygons(), CLOSED, st.tuples(st.floats(-99, 99), st.floats(-99, 99)))
def test_no_point_of_the_outline_is_nearer_than_the_located_one(points, closed, target):
    position, distance = locate(points, target, closed=closed)
    assert 0 <= position[0] <= top(points, closed)
    (nearest,) = points_at(points, position, closed=closed)
    assert np.hypot(*(nearest - target)) == pytest.approx(distance[0], abs=1e-9)
    others = points_at(points, SHARES * top(points, closed), closed=closed)
    assert (np.hypot(*(others - target).T) >= distance[0] - 1e-9).all()


def test_a_doubled_vertex_does_not_hide_the_edge_beside_it():
    doubled = np.insert(SQUARE, 1, SQUARE[1], axis=0)
    position, distance = locate(doubled, (5.0, 2.0))
    assert position.tolist() == [2.5]
    assert distance.tolist() == [1.0]


@given(polygons(), st.integers(0, 11), st.floats(-3, 3), st.floats(0.1, 9))
def test_area_turns_with_nothing_but_direction(points, roll, angle, scale):
    area = signed_area(points)
    assume(abs(area) > 1)
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert signed_area(np.roll(points, roll, axis=0)) == pytest.approx(area)
    assert signed_area(points[::-1]) == pytest.approx(-area)
    assert signed_area(points @ turn.T * scale + 1e5) == pytest.approx(area * scale**2, rel=1e-6)


def test_the_square_has_the_measures_of_a_square():
    assert signed_area(SQUARE) == 16
    assert perimeter(SQUARE) == 16
    assert perimeter(SQUARE, closed=False) == 12
    assert size(SQUARE * (1, 2)) == 8
    assert signed_area(np.stack([SQUARE, SQUARE[::-1]])).tolist() == [16, -16]


def test_checked_points_are_the_very_array():
    assert as_points(SQUARE) is SQUARE
    assert as_points([(0, 0), (1, 0), (0, 1)]).dtype == np.float64


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ("abc", "before is not a list"),
        ([(0, 0), (1,), (1, 1)], "before is not a list"),
        ([1, 2, 3], r"the shape \(3,\)"),
        ([], r"the shape \(0,\)"),
        ([(0, 0), (1, 1)], "has 2 vertices; a closed outline needs at least 3"),
        ([(0, 0), (1, 1), (np.inf, 0)], "vertex 2 of before is not a finite number"),
        ([(0, 0), (1, 1), (0, -2e9)], "vertex 2 of before lies 2e[+]09 px away"),
        ([(7, 7), (7, 7), (7, 7)], "all 3 vertices of before are the same point"),
        ([(1e8, 1e8), (1e8, 1e8 + 1e-8), (1e8, 1e8)], "same point"),
        ([(0, 0), (None, 1), (1, 1)], "not a finite number|is not a list"),
        ([(0, 0), (1j, 1), (1, 1)], "before is not a list"),
    ],
)
def test_what_cannot_be_drawn_is_named(points, message):
    with pytest.raises(GeometryError, match=message):
        as_points(points, name="before")


@given(st.integers(3, 12), st.integers(0, 2**32 - 1))
def test_what_an_outline_contains_is_what_an_independent_judge_says(count, seed):
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, count))
    points = rng.uniform(1, 9, count)[:, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    shape = Polygon(points)
    assume(shape.is_valid)
    targets = rng.uniform(-10, 10, (40, 2))
    assert contains(points, targets).tolist() == [shape.contains(Point(t)) for t in targets]
