from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model import edits
from core.model.document import Document, Keyframe, Layer, Span
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS, Easing
from core.model.motion import PlanCache, picture_at, pictures_at
from core.model.pins import SpanPin
from core.model.smooth import FORWARD

BAR = np.array([(0.0, 0.0), (60.0, 0.0), (120.0, 0.0), (120.0, 30.0), (60.0, 30.0), (0.0, 30.0)])
HAT = np.array([(0.0, -20.0), (40.0, -20.0), (20.0, -60.0)])
METHODS = ("linear", "intrinsic", "rigid")
HANDLE = st.floats(0.1, 0.9)
EASINGS = st.one_of(
    st.sampled_from(sorted(set(PRESETS) - {"slow in", "slow out"})).map(PRESETS.get),
    st.builds(Easing, HANDLE, st.floats(0, 1), HANDLE, st.floats(0, 1)),
)
"""With both handles: without one a curve's higher derivatives have no bound, and differences see no velocity."""


def turned(points, degrees, shift=(0.0, 0.0)):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return points @ np.array([[c, s], [-s, c]]) + np.array(shift)


def film(*keyframes, **layer):
    return Document(length=100, layers=(Layer(1, keyframes=keyframes, **layer),))


def key(frame, *outlines, span=None, closed=True, **fields):
    drawing = Drawing(tuple(Outline(i, np.asarray(o, float), closed) for i, o in enumerate(outlines, 1)))
    return Keyframe(frame, drawing, span or Span("linear"), **fields)


def motions(document):
    """The motions of the spans of the first layer."""
    plans, layer = PlanCache(), document.layers[0]
    return [plans.motions.of(document, layer, a, b) for a, b in pairwise(layer.keyframes)]


def speed(motion, own, *, last, step=1e-4):
    """Velocities of a keyframe's own vertices at one end of a span, px a frame, by differences."""
    frames = motion.at(1 - np.arange(5) * step if last else np.arange(5) * step)[0]
    positions = motion.plan.links[0].after_positions if last else motion.plan.links[0].before_positions
    rows = [int(np.flatnonzero(positions == i)[0]) for i in range(own)]
    sign = -1 if last else 1
    return sign * np.tensordot(FORWARD, frames, axes=1)[rows] / step / motion.length


# smooth keyframes


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("closed", [True, False])
def test_velocity_is_continuous_through_a_smooth_keyframe(method, closed):
    span = Span(method)
    ends = BAR, turned(BAR, 40, (80, 10)), turned(BAR[[0, 1, 2, 4, 5]], 10, (200, 90))
    keys = (
        key(1, ends[0], span=span, closed=closed),
        key(9, ends[1], span=span, closed=closed, smooth=True),
        key(30, ends[2], closed=closed),
    )
    left, right = motions(film(*keys))
    a, b = speed(left, 6, last=True), speed(right, 6, last=False)
    assert np.abs(a - b).max() <= 1e-6 * np.abs(a).max()
    assert np.abs(a).max() > 1  # it does not just stand still
    sharp_left, sharp_right = motions(film(keys[0], replace(keys[1], smooth=False), keys[2]))
    jump = np.abs(speed(sharp_left, 6, last=True) - speed(sharp_right, 6, last=False)).max()
    assert jump > 0.5


@given(EASINGS, EASINGS, st.floats(-90, 90), st.integers(2, 40))
@settings(max_examples=25, deadline=None)
def test_velocity_is_continuous_whatever_the_easings_are(first, second, degrees, length):
    keys = (
        key(1, BAR, span=Span("intrinsic", first)),
        key(11, turned(BAR, degrees, (90, 0)), span=Span("linear", second), smooth=True),
        key(11 + length, turned(BAR, 20, (150, 60))),
    )
    left, right = motions(film(*keys))
    a, b = speed(left, 6, last=True), speed(right, 6, last=False)
    assert np.abs(a - b).max() <= 1e-6 * max(np.abs(a).max(), 1.0)


@given(st.lists(st.integers(0, 400), min_size=3, max_size=6), st.lists(st.integers(2, 12), min_size=5, max_size=5))
@settings(max_examples=40, deadline=None)
def test_smooth_motion_goes_no_farther_than_its_keyframes(places, lengths):
    frames = np.cumsum([1, *lengths])
    keys = [key(int(f), BAR + np.array([x, 0.0]), smooth=True) for f, x in zip(frames, places, strict=False)]
    document = film(*keys)
    plans = PlanCache()
    for (a, b), (x, y) in zip(pairwise(keys), pairwise(places), strict=True):
        way = [
            picture_at(document, document.layers[0], f, plans).outlines[0][0][0, 0]
            for f in np.linspace(a.frame, b.frame, 30)
        ]
        assert min(way) >= min(x, y) - 1e-9
        assert max(way) <= max(x, y) + 1e-9
        assert (np.diff(way) * np.sign(y - x) >= -1e-9).all()


def test_keyframes_are_exact_whether_smooth_or_not():
    keys = [key(1 + 8 * i, turned(BAR, 30 * i, (40 * i, 0)), span=Span("rigid"), smooth=True) for i in range(4)]
    document, plans = film(*keys), PlanCache()
    for k in keys:
        assert (
            picture_at(document, document.layers[0], k.frame, plans).outlines[0][0] == k.drawing.outlines[0].points
        ).all()


@pytest.mark.parametrize("stiff", [Span("rigid", repair=True), Span("linear", pins=(SpanPin(1, 2.0),))])
def test_a_pinned_or_repaired_span_is_not_bent_and_its_neighbour_gives_way(stiff):
    keys = key(1, BAR, span=stiff), key(9, BAR + 80, smooth=True), key(30, BAR + np.array([90, 300]))
    left, right = motions(film(*keys))
    plain = motions(film(keys[0], replace(keys[1], smooth=False), keys[2]))[0]
    times = np.linspace(0, 1, 9)
    assert (left.at(times)[0] == plain.at(times)[0]).all()
    a, b = speed(left, 6, last=True), speed(right, 6, last=False)
    assert np.abs(a - b).max() <= 1e-6 * np.abs(a).max()


@pytest.mark.parametrize(
    "edit",
    [
        lambda d: edits.set_span(d, 1, 1, easing=PRESETS["slow out"]),
        lambda d: edits.move_keyframe(d, 1, 1, 4),
        lambda d: edits.move_keyframe(d, 1, 30, 50),
        lambda d: edits.move_vertices(d, 1, 1, {1: BAR - 70}),
    ],
)
def test_a_smooth_keyframe_notices_what_changes_in_either_span(edit):
    document = film(key(1, BAR), key(9, BAR + 80, smooth=True), key(30, BAR + np.array([90, 300])))
    plans = PlanCache()

    def shown(film):
        return [pictures_at(film, f, plans)[0].outlines[0][0].tolist() for f in (6, 12)]

    shown(document)
    changed = edit(document)
    fresh = [pictures_at(changed, f, PlanCache())[0].outlines[0][0].tolist() for f in (6, 12)]
    assert shown(changed) == fresh


def test_velocity_is_continuous_beside_a_repaired_span_with_a_steep_easing():
    stiff = Span("linear", Easing(0.05, 0.5, 0.95, 0.5), repair=True)
    for keys in (
        (key(1, BAR, span=stiff), key(9, BAR + 80, smooth=True), key(30, BAR + np.array([90, 300]))),
        (key(1, BAR), key(9, BAR + 80, span=stiff, smooth=True), key(30, BAR + np.array([90, 300]))),
    ):
        left, right = motions(film(*keys))
        # the easing bends so much near its ends that differences need smaller steps to see its velocity
        a, b = speed(left, 6, last=True, step=1e-5), speed(right, 6, last=False, step=1e-5)
        assert np.abs(a - b).max() <= 1e-6 * np.abs(a).max()
        assert np.abs(a).max() > 1


def test_a_hold_beside_a_smooth_keyframe_changes_nothing():
    keys = key(1, BAR, span=Span(hold=True)), key(9, BAR + 80, smooth=True), key(30, BAR + 200)
    document = film(*keys)
    shown = picture_at(document, document.layers[0], 16, PlanCache()).outlines[0][0]
    np.testing.assert_allclose(shown, BAR + 80 + 120 / 3, atol=1e-9)


def test_moving_one_keyframe_solves_only_the_two_spans_beside_it():
    keys = [key(1 + 8 * i, BAR + 40 * i, span=Span("intrinsic"), smooth=True) for i in range(6)]
    document, plans = film(*keys), PlanCache()
    for frame in range(1, 42):
        pictures_at(document, frame, plans)
    assert plans.solved == 5
    moved = edits.move_vertices(document, 1, 17, {1: BAR + 90})
    for frame in range(1, 42):
        pictures_at(moved, frame, plans)
    assert plans.solved == 7


# following another layer


def following(child, *parent_keys, **fields):
    layers = Layer(1, "body", keyframes=parent_keys), Layer(2, "hat", keyframes=child, parent=1, **fields)
    return Document(length=100, layers=layers)


def shown(document, layer_id, frame):
    return picture_at(document, document.layer(layer_id), frame, PlanCache()).outlines[0][0]


def test_a_single_drawing_is_carried_by_its_parent():
    document = following((key(1, HAT),), key(1, BAR), key(11, turned(BAR, 90, (300, 50))))
    np.testing.assert_allclose(shown(document, 2, 11), turned(HAT, 90, (300, 50)), atol=1e-9)
    np.testing.assert_allclose(shown(document, 2, 60), turned(HAT, 90, (300, 50)), atol=1e-9)
    assert (shown(document, 2, 1) == HAT).all()


@pytest.mark.parametrize("method", METHODS)
def test_what_stands_still_on_its_parent_moves_with_it(method):
    span = Span(method)
    ends = turned(BAR, 80, (300, 50)), turned(HAT, 80, (300, 50))
    parent = key(1, BAR, span=Span("rigid")), key(11, ends[0])
    document = following((key(1, HAT, span=span), key(11, ends[1])), *parent)
    body = shown(document, 1, 6)
    hat = shown(document, 2, 6)
    turn = np.degrees(np.arctan2(*(body[2] - body[0])[::-1]))
    np.testing.assert_allclose(hat, turned(HAT, turn) + body[0], atol=1e-6)
    assert (shown(document, 2, 11) == ends[1]).all()


def test_a_chain_of_layers_is_carried_from_link_to_link():
    layers = (
        Layer(1, keyframes=(key(1, BAR), key(11, BAR + np.array([100, 0])))),
        Layer(2, keyframes=(key(1, HAT),), parent=1),
        Layer(3, keyframes=(key(1, HAT * 2),), parent=2),
    )
    np.testing.assert_allclose(shown(Document(layers=layers), 3, 6), HAT * 2 + (50, 0), atol=1e-9)


def test_the_parent_s_motion_through_several_keyframes_adds_up():
    parent = [key(1 + 10 * i, turned(BAR, 50 * i, (60 * i, 0)), span=Span("rigid")) for i in range(4)]
    document = following((key(5, HAT),), *parent)
    before, after = shown(document, 1, 5), shown(document, 1, 27)
    angle = np.degrees(np.arctan2(*(after[2] - after[0])[::-1]) - np.arctan2(*(before[2] - before[0])[::-1]))
    hat = shown(document, 2, 27)
    np.testing.assert_allclose(hat - after[0], turned(HAT - before[0], angle), atol=1e-6)


def test_a_plan_is_not_solved_again_as_long_as_the_parent_stays():
    document = following((key(1, HAT), key(11, HAT + 50)), key(1, BAR), key(11, turned(BAR, 20)))
    plans = PlanCache()
    for frame in range(1, 12):
        pictures_at(document, frame, plans)
    assert plans.solved == 2
    for frame in range(1, 12):
        pictures_at(edits.set_layer(document, 1, name="torso"), frame, plans)
    assert plans.solved == 2


def test_circles_of_parents_are_refused():
    document = Document(layers=(Layer(1, "a"), Layer(2, "b", parent=1)))
    with pytest.raises(DocumentError, match="'a' cannot follow a layer that follows it"):
        edits.set_parent(document, 1, 2)
    with pytest.raises(DocumentError, match="cannot follow"):
        edits.set_parent(document, 1, 1)
    assert edits.set_parent(document, 2, None).layer(2).parent is None


# layers


def test_opacity_is_the_layer_s_times_the_drawing_s():
    drawing = Drawing((Outline(1, BAR),), Style(opacity=0.5))
    document = film(Keyframe(1, drawing), Keyframe(11, replace(drawing, style=Style(opacity=1.0))), opacity=0.5)
    layer = document.layers[0]
    assert [picture_at(document, layer, f, PlanCache()).opacity for f in (1, 6, 11, 50)] == [0.25, 0.375, 0.5, 0.5]


def test_a_locked_layer_refuses_every_change_but_that_of_the_layer():
    document = edits.set_layer(film(key(1, BAR), key(11, BAR + 9)), 1, locked=True)
    for edit in (
        lambda d: edits.move_vertices(d, 1, 1, {1: BAR + 1}),
        lambda d: edits.delete_keyframe(d, 1, 11),
        lambda d: edits.set_span(d, 1, 1, method="rigid"),
        lambda d: edits.add_outline(d, 1, 5, BAR),
        lambda d: edits.set_smooth(d, 1, [1], True),
    ):
        with pytest.raises(DocumentError, match="'Layer 1' is locked; unlock it"):
            edit(document)
    assert edits.set_layer(document, 1, locked=False, name="x").layer(1).name == "x"


def test_layers_are_added_moved_copied_and_deleted():
    document = edits.add_layer(edits.add_layer(Document(), "b"), above=1)
    assert [x.id for x in document.layers] == [1, 3, 2]
    assert document.layer(3).name == "Layer 3"
    document = edits.move_layer(document, 1, 99)
    assert [x.id for x in document.layers] == [3, 2, 1]
    assert edits.move_layer(document, 3, 0) is document
    document = edits.set_parent(document, 3, 2)
    copied = edits.duplicate_layer(document, 2)
    assert [x.name for x in copied.layers] == ["Layer 3", "b", "b copy", "Layer 1"]
    rest = edits.delete_layer(document, 2)
    assert [(x.id, x.parent) for x in rest.layers] == [(3, None), (1, None)]
    with pytest.raises(DocumentError, match="only layer"):
        edits.delete_layer(Document(), 1)
