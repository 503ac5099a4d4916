import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model.color import hex_color, mix_colors, rgba
from core.model.drawing import COLOR_PATTERN, as_color

COLORS = st.from_regex(r"#[0-9a-f]{6}([0-9a-f]{2})?", fullmatch=True)
T = st.floats(-1, 2)


@given(COLORS)
def test_a_colour_survives_its_channels(color):
    assert rgba(hex_color(rgba(color))).tolist() == rgba(color).tolist()
    assert hex_color(rgba(color)) == (color[:7] if color.endswith("ff") and len(color) == 9 else color)


@given(COLORS | st.none(), COLORS | st.none())
def test_the_ends_of_a_mix_are_the_colours_themselves(a, b):
    assert mix_colors(a, b, 0.0) == a
    assert mix_colors(a, b, 1.0) == b
    assert mix_colors(a, b, -0.5) == a
    assert mix_colors(a, b, 1.5) == b


@given(COLORS, T)
def test_a_colour_mixed_with_itself_stays(color, t):
    assert mix_colors(color, color, t) == color


@given(COLORS, COLORS, T)
def test_a_mix_is_a_colour_and_the_same_from_the_other_side(a, b, t):
    mixed = mix_colors(a, b, t)
    assert COLOR_PATTERN.fullmatch(mixed)
    np.testing.assert_allclose(rgba(mix_colors(b, a, 1 - t)), rgba(mixed), atol=1.01 / 255)


@given(st.integers(0, 255), st.integers(0, 255), st.floats(0, 1))
def test_greys_mix_to_a_grey_between_them(a, b, t):
    channels = rgba(mix_colors(f"#{a:02x}{a:02x}{a:02x}", f"#{b:02x}{b:02x}{b:02x}", t))[:3] * 255
    assert np.ptp(channels) <= 1
    assert min(a, b) - 1 <= channels[0] <= max(a, b) + 1


@given(COLORS, COLORS, st.floats(0.01, 0.99))
def test_transparency_mixes_in_step_with_t(a, b, t):
    expected = (1 - t) * rgba(a)[3] + t * rgba(b)[3]
    assert rgba(mix_colors(a, b, t))[3] == pytest.approx(expected, abs=0.6 / 255)


def test_no_colour_fades_without_a_change_of_hue():
    assert mix_colors(None, None, 0.5) is None
    assert mix_colors("#3366cc", None, 0.5) == "#3366cc80"
    assert mix_colors(None, "#3366cc", 0.25) == "#3366cc40"


def test_blue_to_yellow_does_not_pass_through_a_dark_grey():
    middle = rgba(mix_colors("#0000ff", "#ffff00", 0.5))[:3]
    assert middle @ [0.2126, 0.7152, 0.0722] > 0.4


@pytest.mark.parametrize("color", ["", "#12", "123456", "#12345g", "#1234567", "#123456\n", "red", "#１23456"])
def test_what_is_no_colour_is_refused(color):
    with pytest.raises(DocumentError, match="expected #rrggbb or #rrggbbaa"):
        as_color(color)


def test_colours_are_kept_in_lower_case():
    assert as_color("#ABCDEF") == "#abcdef"
