from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model.easing import PRESETS, Easing, Knot, preset_name, through

RATIO = st.floats(0, 1)
ANY_Y = st.floats(-4, 5)
RATIOS = np.linspace(0, 1, 101)


@given(RATIO, RATIO, RATIO, RATIO)
def test_t_rises_with_the_ratio_and_stays_between_0_and_1(x1, y1, x2, y2):
    t = Easing(x1, y1, x2, y2).t_at(RATIOS)
    # where the curve stands upright, the last bit of the ratio decides about the sixth digit of t
    assert (np.diff(t) >= -1e-4).all()
    assert (t >= 0).all()
    assert (t <= 1).all()


@given(RATIO, ANY_Y, RATIO, ANY_Y)
def test_the_ends_are_exact_for_every_curve(x1, y1, x2, y2):
    assert Easing(x1, y1, x2, y2).t_at([0.0, 1.0]).tolist() == [0.0, 1.0]


@given(RATIO, ANY_Y, RATIO, ANY_Y, st.floats(0.01, 0.99))
def test_every_t_lies_on_the_bezier_curve(x1, y1, x2, y2, u):
    x, y = (3 * (1 - u) ** 2 * u * a + 3 * (1 - u) * u * u * b + u**3 for a, b in ((x1, x2), (y1, y2)))
    slope = 3 * (1 - u) ** 2 * x1 + 6 * (1 - u) * u * (x2 - x1) + 3 * u * u * (1 - x2)
    if slope > 0.01:
        assert float(Easing(x1, y1, x2, y2).t_at(x)) == pytest.approx(y, abs=1e-9)


@given(RATIO, ANY_Y, RATIO, ANY_Y)
def test_turning_the_curve_round_turns_time_round(x1, y1, x2, y2):
    there = Easing(x1, y1, x2, y2).t_at(RATIOS)
    if max(1 - y1, 1 - y2) <= 5 and min(1 - y1, 1 - y2) >= -4:
        back = Easing(1 - x2, 1 - y2, 1 - x1, 1 - y1)
        # not exact: where the curve stands upright, the last bit of the ratio decides about the sixth digit of t
        np.testing.assert_allclose(1 - back.t_at(1 - RATIOS), there, atol=2e-4)


@given(RATIO, RATIO)
def test_handles_on_the_diagonal_leave_the_ratio_bit_for_bit(a, b):
    assert (Easing(a, a, b, b).t_at(RATIOS) == RATIOS).all()


def test_one_ratio_and_many_give_the_same_t():
    easing = PRESETS["slow in and out"]
    assert [float(easing.t_at(r)) for r in RATIOS] == easing.t_at(RATIOS).tolist()
    assert easing.t_at(RATIOS.reshape(1, -1)).shape == (1, 101)


def test_the_presets_do_what_their_names_say():
    t = {name: easing.t_at(RATIOS) for name, easing in PRESETS.items()}
    assert (t["linear"] == RATIOS).all()
    assert t["slow out"][10] < 0.05
    assert t["slow in"][90] > 0.95
    assert t["slow in and out"][10] < 0.05
    assert t["slow in and out"][90] > 0.95
    np.testing.assert_allclose(t["slow in and out"] + t["slow in and out"][::-1], 1, atol=1e-12)
    np.testing.assert_allclose(t["slow out"] + t["slow in"][::-1], 1, atol=1e-12)
    assert t["anticipation"].min() < -0.02
    assert t["overshoot"].max() > 1.02


@pytest.mark.parametrize("name", PRESETS)
def test_a_preset_knows_its_name(name):
    assert preset_name(PRESETS[name]) == name
    assert preset_name(Easing(0.1, 0.2, 0.3, 0.4)) is None


@pytest.mark.parametrize("handles", [(-0.1, 0, 1, 1), (0, 0, 1.1, 1), (0, -4.1, 1, 1), (0, 0, 1, 5.1)])
def test_a_handle_out_of_range_is_refused(handles):
    with pytest.raises(DocumentError, match="the easing's handles are at"):
        Easing(*handles)


# knots


POINTS = st.lists(
    st.tuples(st.integers(1, 99).map(lambda x: x / 100), st.floats(-4, 5)), max_size=6, unique_by=lambda p: p[0]
).map(sorted)


@given(POINTS)
def test_a_curve_through_points_has_them_exactly_and_goes_no_farther(points):
    easing = through(points)
    ends = np.array([(0.0, 0.0), *points, (1.0, 1.0)])
    assert easing.t_at(ends[:, 0]).tolist() == ends[:, 1].tolist()
    for (x0, y0), (x1, y1) in pairwise(ends):
        t = easing.t_at(np.linspace(x0, x1, 20))
        assert t.min() >= min(y0, y1) - 1e-9
        assert t.max() <= max(y0, y1) + 1e-9
        assert (np.diff(t) * np.sign(y1 - y0) >= -1e-6).all()


@given(POINTS.filter(bool))
def test_a_curve_through_points_has_no_kink_at_them(points):
    for (_, _, a, b), (_, c, _, _) in pairwise(through(points).pieces()):
        left, right = (b - a), c - b
        assert left[0] * right[1] == pytest.approx(left[1] * right[0], abs=1e-9)


@given(st.floats(0.05, 0.95), RATIO, st.floats(0.05, 0.95), RATIO, st.floats(0.05, 0.95))
@example(0.9375, 0.0, 0.25, 0.0, 0.5)  # a handle would lie behind the cut
def test_a_cut_easing_runs_as_before_in_both_parts(x1, y1, x2, y2, ratio):
    easing = Easing(x1, y1, x2, y2)
    parts, middle = easing.cut(ratio), float(easing.t_at(ratio))
    if parts is None:
        assert not 1e-5 < middle < 1 - 1e-5
        return
    inside = np.linspace(0.05, 0.95, 10)
    fine = np.linspace(0, 1, 20001)
    slope = np.abs(np.gradient(easing.t_at(fine), fine)).max()
    if slope < 20:  # where the curve stands upright the last bits of the ratio decide
        first = middle * parts[0].t_at(inside)
        second = middle + (1 - middle) * parts[1].t_at(inside)
        np.testing.assert_allclose(first, easing.t_at(inside * ratio), atol=1e-6)
        np.testing.assert_allclose(second, easing.t_at(ratio + inside * (1 - ratio)), atol=1e-6)


def test_bounce_lands_three_times_and_falls_like_a_ball():
    t = PRESETS["bounce"].t_at(np.linspace(0, 1, 4001))
    assert np.count_nonzero((t[1:-1] > t[:-2]) & (t[1:-1] >= t[2:]) & (t[1:-1] > 0.99)) == 2
    assert t.max() <= 1
    fall = t[: int(np.argmax(t)) - 1]
    assert np.ptp(np.diff(fall, 2)) < 1e-9  # constant acceleration


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("end", [0, 1])
def test_slopes_are_those_of_the_curve(name, end):
    easing, h = PRESETS[name], 1e-7
    rise = (1 - easing.t_at(1 - h)) / h if end else easing.t_at(h) / h
    assert easing.slopes()[end] == pytest.approx(float(rise), abs=1e-3)


@settings(max_examples=300)
@given(RATIO, ANY_Y, RATIO, ANY_Y)
@example(0.0, 0.0, 1.0, -2.0)  # leaning the one handle leaves the other end upright
@example(0.0, 3.0, 1.0, 1.0)
def test_a_gentle_easing_is_no_steeper_than_asked_and_a_flat_one_stays(x1, y1, x2, y2):
    easing = Easing(x1, y1, x2, y2)
    gentle = easing.gentle(3.0, first=True, last=True)
    if abs(y1) <= 3 and abs(1 - y2) <= 3:
        assert max(map(abs, gentle.slopes())) <= 3.0 + 1e-6
    assert easing.gentle(3.0, first=False, last=False) is easing
    assert PRESETS["slow in and out"].gentle(3.0, first=True, last=True) is PRESETS["slow in and out"]


@pytest.mark.parametrize(
    "knots",
    [(Knot(0.5, 0.5, 0.6, 0.5, 0.6, 0.5),), (Knot(0.5, 0.5, 0.4, 0.5, 0.4, 0.5),), (Knot(0, 0, 0, 0, 0, 0),)],
)
def test_handles_that_reach_beyond_their_piece_are_refused(knots):
    with pytest.raises(DocumentError, match="reach beyond"):
        Easing(0.1, 0.1, 0.9, 0.9, knots)
