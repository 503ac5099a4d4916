"""Editing exposures."""

from dataclasses import replace
from itertools import accumulate

import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import DocumentError
from core.model.document import Document, Keyframe, Layer, Span
from core.model.easing import PRESETS
from core.model.edits import set_span, set_step
from core.model.sheet_edits import expose_drawing, hold_over
from core.model.timing import exposures_in, exposures_of
from core.model.timing_edits import ticks_of


def film(*frames, length=40, span=None):
    keys = tuple(Keyframe(f, span=span or Span(easing=PRESETS["slow in"])) for f in frames)
    return Document(length=length, layers=(Layer(1, keyframes=keys),))


def ticks(document, key=0):
    before, after = document.layers[0].keyframes[key : key + 2]
    return ticks_of(before.span, after.frame - before.frame)


def held(document, key=0):
    before, after = document.layers[0].keyframes[key : key + 2]
    return exposures_in(before.span, after.frame - before.frame)


def test_holding_longer_goes_over_the_drawings_that_follow_and_all_others_keep_their_t() -> None:
    document = film(1, 9)
    changed = hold_over(document, 1, 1, 2, 3)
    assert held(changed) == (1, 1, 3, 1, 1, 1)
    old = dict(ticks(document))
    assert [o for o, _ in ticks(changed)] == [0, 1, 2, 5, 6, 7]
    assert [t for _, t in ticks(changed)] == pytest.approx([old[o] for o in (0, 1, 2, 5, 6, 7)], abs=1e-12)


def test_a_drawing_that_is_partly_held_over_begins_later() -> None:
    document = set_step(film(1, 9), 1, 1, 2)
    changed = hold_over(document, 1, 1, 0, 3)
    assert held(changed) == (3, 1, 2, 2)
    assert [t for _, t in ticks(changed)] == pytest.approx([t for _, t in ticks(document)], abs=1e-12)


def test_holding_for_less_lets_the_next_one_begin_earlier() -> None:
    document = set_step(film(1, 9), 1, 1, 4)
    changed = hold_over(document, 1, 1, 0, 1)
    assert held(changed) == (1, 7)
    assert ticks(changed)[1][1] == pytest.approx(ticks(document)[1][1], abs=1e-12)


@given(st.integers(1, 20), st.integers(1, 4), st.data())
def test_a_drawing_is_held_for_exactly_as_long_as_asked_and_the_keyframes_stay(length, step, data) -> None:
    document = set_step(film(1, 1 + length), 1, 1, step)
    count = len(ticks(document))
    if count == 1:
        return
    index = data.draw(st.integers(0, count - 2))
    start = ticks(document)[index][0]
    exposure = data.draw(st.integers(1, length - start))
    changed = hold_over(document, 1, 1, index, exposure)
    assert held(changed)[index] == exposure
    assert sum(held(changed)) == length
    assert changed.layers[0].frames() == (1, 1 + length)
    kept = {round(t, 9) for _, t in ticks(document)}
    assert {round(t, 9) for _, t in ticks(changed)} <= kept


def test_the_last_drawing_pushes_the_keyframe_after_it() -> None:
    document = set_step(film(1, 9, 20), 1, 1, 2)
    changed = expose_drawing(document, 1, 8, 5)
    assert changed.layers[0].frames() == (1, 12, 20)
    assert held(changed) == (2, 2, 2, 5)
    assert [t for _, t in ticks(changed)] == pytest.approx([t for _, t in ticks(document)], abs=1e-12)
    assert expose_drawing(changed, 1, 7, 2).layers[0].frames() == (1, 9, 20)


def test_the_drawing_of_a_hold_pushes_too_and_stays_a_hold() -> None:
    document = set_span(film(1, 9), 1, 1, hold=True)
    changed = expose_drawing(document, 1, 4, 20)
    assert changed.layers[0].frames() == (1, 21)
    assert changed.layers[0].keyframes[0].span == document.layers[0].keyframes[0].span


@pytest.mark.parametrize("frame", range(1, 9))
def test_the_exposure_of_every_frames_drawing_can_be_set(frame) -> None:
    document = set_step(film(1, 9), 1, 1, 3)
    shown = next(e for e in exposures_of(document.layers[0], 1, 40) if e.frame <= frame < e.frame + e.count)
    changed = expose_drawing(document, 1, frame, 2)
    assert next(e for e in exposures_of(changed.layers[0], 1, 40) if e.frame == shown.frame).count == 2


def test_what_cannot_be_is_refused_with_a_sentence() -> None:
    document = film(3, 9, 20)
    for frame, exposure, words in (
        (1, 2, "shows nothing at frame 1"),
        (20, 2, "held to the end of the film"),
        (30, 2, "held to the end of the film"),
        (4, 6, "1 to 5 frames, until the keyframe at 9, not for 6"),
        (4, 0, "not for 0"),
        (8, 30, "the keyframe at 20 is in the way"),
        (8, 0, "the least is 1"),
    ):
        with pytest.raises(DocumentError, match=words):
            expose_drawing(document, 1, frame, exposure)
    locked = replace(document, layers=(replace(document.layers[0], locked=True),))
    for frame in (4, 8):
        with pytest.raises(DocumentError, match="locked"):
            expose_drawing(locked, 1, frame, 2)
    with pytest.raises(DocumentError, match="last drawing"):
        hold_over(document, 1, 3, 5, 2)
    with pytest.raises(DocumentError, match="give up the hold"):
        hold_over(set_span(document, 1, 3, hold=True), 1, 3, 0, 2)


def test_nothing_changes_where_nothing_is_asked_for() -> None:
    document = set_step(film(1, 9), 1, 1, 2)
    for start, exposure in zip(accumulate(held(document), initial=1), held(document), strict=False):
        assert expose_drawing(document, 1, start, exposure) is document
