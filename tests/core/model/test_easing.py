import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model.easing import PRESETS, Easing, preset_name

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
