from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model import edits
from core.model.document import Document, Keyframe, Layer, Span
from core.model.drawing import Drawing, Outline
from core.model.easing import PRESETS
from core.model.motion import PlanCache, picture_at
from core.model.timing import drawn_offsets, drawn_ratio, exposures_in, exposures_of, fitted_exposures
from core.model.timing_edits import ticks_of

SQUARE = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])
SPANS = st.builds(
    Span,
    hold=st.booleans(),
    step=st.integers(1, 5),
    exposures=st.lists(st.integers(1, 6), max_size=6).map(tuple),
)
EASINGS = st.sampled_from([PRESETS["linear"], PRESETS["slow in and out"], PRESETS["slow out"]])


def film(span, length=24, **layer):
    ends = (
        Keyframe(1, Drawing((Outline(1, SQUARE),)), span),
        Keyframe(1 + length, Drawing((Outline(1, SQUARE + 240),))),
    )
    return Document(length=60, layers=(Layer(1, keyframes=ends, **layer),))


PLANS = PlanCache()


def left_edge(document, frame):
    """How far the square has come, 0 to 1."""
    return picture_at(document, document.layers[0], frame, PLANS).outlines[0][0][0, 0] / 240


@given(SPANS, st.integers(1, 40))
def test_the_drawings_of_a_span_fill_it_without_a_gap(span, length):
    offsets = drawn_offsets(span, length)
    assert offsets[0] == 0
    assert list(offsets) == sorted(set(offsets))
    assert offsets[-1] < length
    assert sum(exposures_in(span, length)) == length


@given(SPANS, st.integers(1, 40), st.floats(0, 0.999))
def test_a_frame_shows_the_drawing_that_began_last(span, length, share):
    offset = int(share * length)
    assert drawn_ratio(span, length, offset) * length == pytest.approx(
        max(o for o in drawn_offsets(span, length) if o <= offset)
    )


def test_on_ones_a_time_between_frames_has_its_own_drawing():
    assert drawn_ratio(Span(), 8, 2.5) == 2.5 / 8
    assert drawn_ratio(Span(step=2), 8, 2.5) == 2 / 8


def test_on_twos_every_drawing_is_seen_twice():
    document = film(Span("linear", step=2))
    assert [left_edge(document, f) * 24 for f in range(1, 9)] == pytest.approx([0, 0, 2, 2, 4, 4, 6, 6])


def test_a_hold_shows_its_keyframe_up_to_the_next_one():
    document = film(Span("linear", hold=True))
    assert {left_edge(document, f) for f in range(1, 25)} == {0.0}
    assert left_edge(document, 25) == 1.0


def test_exposures_of_a_layer_name_every_drawing_and_who_made_it():
    layer = film(Span(exposures=(3, 2, 3)), length=8).layers[0]
    found = exposures_of(layer, 1, 12)
    assert [(x.frame, x.count, x.keyframe) for x in found] == [
        (1, 3, True),
        (4, 2, False),
        (6, 3, False),
        (9, 4, True),
    ]
    assert [(x.frame, x.count) for x in exposures_of(layer, 5, 6)] == [(5, 1), (6, 1)]
    assert exposures_of(replace(layer, keyframes=()), 1, 9) == ()


@given(st.lists(st.integers(1, 6), min_size=1, max_size=8).map(tuple), st.integers(1, 60))
def test_a_chart_fitted_to_another_length_fills_it_and_keeps_its_drawings(exposures, new):
    length = sum(exposures)
    fitted = fitted_exposures(Span(exposures=exposures), length, new)
    assert sum(fitted) == new
    assert min(fitted) >= 1
    assert len(fitted) == min(len(exposures), new)
    assert fitted_exposures(Span(exposures=exposures), length, length) == exposures


@given(st.integers(3, 30), EASINGS, st.integers(1, 3), st.data())
def test_a_moved_tick_has_its_t_and_all_others_keep_theirs(length, easing, step, data):
    document = film(Span("linear", easing, step=step), length)
    before = ticks_of(document.layers[0].keyframes[0].span, length)
    assume(len(before) > 1)
    index = data.draw(st.integers(1, len(before) - 1))
    t = data.draw(st.floats(-1, 2))
    after = ticks_of(edits.move_tick(document, 1, 1, index, t).layers[0].keyframes[0].span, length)
    assert [o for o, _ in after] == [o for o, _ in before]
    wanted = [t if i == index else x for i, (_, x) in enumerate(before)]
    assert [x for _, x in after] == pytest.approx(wanted, abs=1e-12)


@given(st.integers(2, 3), st.integers(4, 24))
def test_halves_and_thirds_lie_evenly_between_their_neighbours(parts, length):
    document = film(Span("linear", PRESETS["slow in and out"], exposures=(length,)), length)
    document = edits.divide_tick(document, 1, 1, 0, parts)
    assert [t for _, t in ticks_of(document.layers[0].keyframes[0].span, length)] == pytest.approx(
        [k / parts for k in range(parts)], abs=1e-12
    )


def test_the_film_shows_what_the_chart_says():
    document = film(Span("linear", exposures=(8, 8, 8)))
    document = edits.move_tick(document, 1, 1, 1, 0.9)
    document = edits.hold_tick(document, 1, 1, 0, 2)
    span = document.layers[0].keyframes[0].span
    assert exposures_in(span, 24) == (2, 14, 8)
    assert [left_edge(document, f) for f in (2, 3, 16, 17, 24)] == pytest.approx([0, 0.9, 0.9, 2 / 3, 2 / 3])
    document = edits.delete_tick(document, 1, 1, 1)
    assert exposures_in(document.layers[0].keyframes[0].span, 24) == (16, 8)


def test_what_a_chart_cannot_do_is_said():
    document = film(Span("linear", step=2), length=4)
    for edit, message in (
        (lambda d: edits.divide_tick(d, 1, 1, 0, 3), "frame 1 is held for 2 of the 3 frames"),
        (lambda d: edits.move_tick(d, 1, 1, 0, 0.5), "keyframe itself"),
        (lambda d: edits.delete_tick(d, 1, 1, 0), "keyframe itself"),
        (lambda d: edits.hold_tick(d, 1, 1, 0, 4), "1 to 3 frames, not for 4"),
        (lambda d: edits.hold_tick(d, 1, 1, 1, 1), "last drawing"),
        (lambda d: edits.move_tick(d, 1, 1, 7, 0.5), "2 drawings; there is no number 7"),
        (lambda d: edits.move_tick(edits.set_span(d, 1, 1, hold=True), 1, 1, 1, 0.5), "give up the hold"),
        (lambda d: edits.set_step(d, 1, 5, 2), "no span begins at frame 5"),
    ):
        with pytest.raises(DocumentError, match=message):
            edit(document)


def test_a_step_gives_up_the_chart_and_keeps_the_curve():
    document = film(Span("linear", PRESETS["slow out"], exposures=(20, 4)))
    span = edits.set_step(document, 1, 1, 3).layers[0].keyframes[0].span
    assert (span.step, span.exposures, span.easing) == (3, (), PRESETS["slow out"])


def test_a_moved_keyframe_takes_its_chart_along():
    document = film(Span("linear", exposures=(6, 6, 12)))
    moved = edits.move_keyframe(document, 1, 25, 13)
    assert moved.layers[0].keyframes[0].span.exposures == (3, 3, 6)
    assert edits.move_keyframe(film(Span("linear", step=2)), 1, 25, 13).layers[0].keyframes[0].span.step == 2


@given(EASINGS, st.integers(1, 23), st.sampled_from([(), (4, 9, 5, 6)]))
@settings(max_examples=25)
def test_a_broken_span_shows_the_film_as_it_was(easing, offset, exposures):
    from core.model.timing_edits import broken_span

    span = Span("linear", easing, exposures=exposures)
    first, second = broken_span(span, 24, offset)
    whole = film(span)
    t = left_edge(whole, 1 + offset)
    middle = Drawing((Outline(1, SQUARE + 240 * t),))
    start, end = whole.layers[0].keyframes
    keyframes = replace(start, span=first), Keyframe(1 + offset, middle, second), end
    broken = whole.with_layer(replace(whole.layers[0], keyframes=keyframes))
    shown = [left_edge(broken, f) for f in range(1, 26)]
    assert shown == pytest.approx([left_edge(whole, f) for f in range(1, 26)], abs=1e-6)
    assert all(b >= a - 1e-9 for a, b in pairwise(shown))
