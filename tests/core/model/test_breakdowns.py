from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.io.project import decode, encode
from core.model.breakdowns import add_breakdown
from core.model.document import Anchor, Document, Keyframe, Layer, OutlinePair, Span
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS
from core.model.motion import PlanCache, picture_at

SQUARE = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])
HOUSE = np.array([(300.0, 0.0), (350.0, -40.0), (400.0, 0.0), (400.0, 100.0), (300.0, 100.0)])


def film(span, after=HOUSE, closed=True):
    ends = (
        Keyframe(1, Drawing((Outline(1, SQUARE, closed),), Style("#ff0000")), span),
        Keyframe(25, Drawing((Outline(1, after, closed),), Style("#0000ff"))),
    )
    return Document(layers=(Layer(1, keyframes=ends),), length=40)


def broken(document, frame, **fields):
    layer = document.layers[0]
    motion = PLANS.motions.of(document, layer, *layer.keyframes)
    return add_breakdown(document, 1, frame, motion)


PLANS = PlanCache()


def shape(document, frame):
    return picture_at(document, document.layers[0], frame, PLANS).outlines[0][0]


def same_shape(points, others):
    """Whether every vertex of either lies on the other's outline."""
    from core.geometry.outline import locate

    return max(locate(others, points)[1].max(), locate(points, others)[1].max()) < 1e-6


@pytest.mark.parametrize("method", ["linear", "intrinsic", "rigid", "auto"])
@pytest.mark.parametrize("after", [HOUSE, HOUSE[::-1]])
def test_a_breakdown_lands_exactly_on_what_was_shown(method, after):
    document = film(Span(method, PRESETS["slow in and out"]), after)
    shown = shape(document, 9)
    result = broken(document, 9)
    assert (shape(result, 9) == shown).all()
    assert result.layers[0].frames() == (1, 9, 25)
    assert [k.span.method for k in result.layers[0].keyframes[:2]] == [method, method]
    assert decode(encode(result)) == result


@given(
    st.sampled_from(["linear", "slow in and out", "slow in", "slow out"]),
    st.integers(2, 24),
    st.sampled_from([{}, {"step": 2}, {"exposures": (3, 10, 11)}]),
)
@settings(max_examples=12)
def test_a_breakdown_of_straight_ways_leaves_the_film_as_it_was(easing, frame, timing):
    document = film(Span("linear", PRESETS[easing], **timing))
    result = broken(document, frame)
    for f in range(1, 26):
        assert same_shape(shape(result, f), shape(document, f)), f


@pytest.mark.parametrize("flipped", [False, True])
def test_points_keep_going_where_the_artist_sent_them(flipped):
    after = HOUSE[::-1] if flipped else HOUSE
    target = 4.0 if flipped else 0.0
    pair = OutlinePair(1, 1, (Anchor(2.0, target),))
    result = broken(film(Span("linear", pairs=(pair,)), after), 13)
    motions = [
        PlanCache().motions.of(result, result.layers[0], *result.layers[0].keyframes[i : i + 2]) for i in (0, 1)
    ]
    link = motions[0].plan.links[0]
    row = int(np.flatnonzero(link.before_positions == 2.0)[0])
    vertex = link.after_positions[row]
    link = motions[1].plan.links[0]
    row = int(np.flatnonzero(link.before_positions == vertex)[0])
    assert link.after_positions[row] == target


def test_a_breakdown_between_smooth_keyframes_is_smooth():
    document = film(Span("linear"))
    layer = document.layers[0]
    smooth = document.with_layer(
        replace(layer, keyframes=(layer.keyframes[0], replace(layer.keyframes[1], smooth=True)))
    )
    assert broken(smooth, 9).layers[0].keyframe_at(9).smooth
    assert not broken(document, 9).layers[0].keyframe_at(9).smooth


def test_strokes_break_into_strokes():
    result = broken(film(Span("intrinsic"), closed=False), 9)
    assert [o.closed for k in result.layers[0].keyframes for o in k.drawing.outlines] == [False] * 3
