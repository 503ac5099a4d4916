"""Editing an easing's curve."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model.curve_edits import add_knot, delete_knot, is_smooth, move_handle, move_knot
from core.model.easing import PRESETS, Easing

RATIOS = np.linspace(0, 1, 101)
SHARE = st.floats(0, 1)
HEIGHT = st.floats(-2, 3)
CURVES = st.builds(Easing, SHARE, HEIGHT, SHARE, HEIGHT)
LEANING = st.builds(Easing, st.floats(0, 0.5), HEIGHT, st.floats(0.5, 1), HEIGHT)
INSIDE = st.floats(0.05, 0.95)
ANYWHERE = st.floats(-10, 10)


@given(LEANING, INSIDE)
def test_a_new_knot_leaves_the_curve_as_it_is(easing, ratio) -> None:
    knotted = add_knot(easing, ratio)
    assert len(knotted.knots) == 1
    assert knotted.knots[0].x == pytest.approx(ratio, abs=1e-9)
    assert knotted.t_at(RATIOS) == pytest.approx(easing.t_at(RATIOS), abs=1e-6)


@pytest.mark.parametrize("name", PRESETS)
def test_deleting_the_knot_that_was_added_gives_the_curve_back(name) -> None:
    easing = PRESETS[name]
    ratio = 0.37
    knotted = add_knot(easing, ratio)
    index = next(i for i, k in enumerate(knotted.knots) if abs(k.x - ratio) < 1e-9)
    assert delete_knot(knotted, index).t_at(RATIOS) == pytest.approx(easing.t_at(RATIOS), abs=1e-9)


@given(CURVES, INSIDE, INSIDE, ANYWHERE, ANYWHERE, st.integers(0, 5), st.booleans())
def test_wherever_the_hand_goes_the_curve_stays_one(easing, first, second, x, y, grip, alone) -> None:
    knotted = add_knot(easing, first)
    if abs(first - second) > 0.01:
        knotted = add_knot(knotted, second)
    moved = (
        move_knot(knotted, len(knotted.knots) - 1, x, y),
        move_handle(knotted, 0, "in", x, y, alone=alone),
        move_handle(knotted, 0, "out", x, y, alone=alone),
        move_handle(knotted, None, "in", x, y),
        move_handle(knotted, None, "out", x, y),
        delete_knot(knotted, 0),
    )[grip]
    assert np.isfinite(moved.t_at(RATIOS)).all()  # Easing itself refuses what is not one curve
    assert (moved.t_at(0.0), moved.t_at(1.0)) == (0, 1)


def test_a_moved_knot_lies_where_it_was_put_and_the_curve_goes_through_it() -> None:
    moved = move_knot(add_knot(Easing(), 0.5), 0, 0.4, 0.8)
    assert moved.knots[0][:2] == (0.4, 0.8)
    assert moved.t_at(0.4) == 0.8
    assert is_smooth(moved.knots[0])


def test_the_other_handle_turns_along_unless_one_is_moved_alone() -> None:
    knotted = add_knot(Easing(), 0.5)
    together = move_handle(knotted, 0, "out", 0.6, 0.9)
    assert is_smooth(together.knots[0])
    assert together.knots[0].in_x == knotted.knots[0].in_x
    alone = move_handle(knotted, 0, "out", 0.6, 0.9, alone=True)
    assert not is_smooth(alone.knots[0])
    assert alone.knots[0][:4] == knotted.knots[0][:4]
    corner = move_handle(alone, 0, "in", 0.4, 0.5)
    assert corner.knots[0][4:] == alone.knots[0][4:]  # two handles that were not in line do not turn together


def test_a_linear_easing_has_handles_to_take_hold_of() -> None:
    moved = move_handle(Easing(), None, "out", 0.5, 0.0)
    assert moved == Easing(0.5, 0.0, 2 / 3, 2 / 3)


def test_what_is_not_there_is_refused_with_a_sentence() -> None:
    with pytest.raises(DocumentError, match="1 knots; there is no number 1"):
        delete_knot(add_knot(Easing(), 0.5), 1)
    with pytest.raises(DocumentError, match="already"):
        add_knot(add_knot(Easing(), 0.5), 0.5)
    with pytest.raises(DocumentError, match="already"):
        add_knot(Easing(), 1.0)
