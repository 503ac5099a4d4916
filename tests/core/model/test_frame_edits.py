from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import DocumentError
from core.io.project import decode, encode
from core.model import edits, frame_edits
from core.model.document import Anchor, Document
from core.model.drawing import Drawing, Outline
from core.model.pins import SpanPin

SQUARE = np.array([(0, 0), (100, 0), (100, 100), (0, 100)], float)


def drawing(x):
    return Drawing((Outline(1, np.add(SQUARE, (x, 0))),))


def film(*layers):
    """A layer for each tuple of frames; the drawing at frame f of layer i is told by 1000 i + f."""
    document = Document()
    for i, frames in enumerate(layers or ((1, 13, 25),), start=1):
        if i > 1:
            document = edits.add_layer(document)
        for f in frames:
            document = edits.put_drawing(document, i, f, drawing(1000 * i + f))
    return document


def tied(document, layer=1, frame=1):
    """With an anchor and a pin on the span that begins there."""
    document = edits.add_anchor(document, layer, frame, 1, 1, Anchor(0.0, 0.0))
    return edits.add_pin(document, layer, frame, SpanPin(outline=1, position=2.0))


def frames(document, layer=1):
    return document.layer(layer).frames()


def told(document, layer=1):
    """{frame: what tells its drawing}"""
    return {k.frame: int(k.drawing.outlines[0].points[0, 0]) for k in document.layer(layer).keyframes}


def span(document, frame, layer=1):
    return document.layer(layer).keyframe_at(frame).span


# moving


def test_keyframes_of_several_layers_move_together_and_keep_what_ties_their_drawings():
    document = tied(film((1, 13, 25), (5, 13)))
    moved = frame_edits.move_keyframes(document, [(1, 1), (1, 13), (2, 13)], 3)
    assert told(moved) == {4: 1001, 16: 1013, 25: 1025}
    assert told(moved, 2) == {5: 2005, 16: 2013}
    assert span(moved, 4) is span(document, 1)
    assert frame_edits.move_keyframes(moved, [(1, 4), (1, 16), (2, 16)], -3) == document


def test_the_film_grows_with_a_keyframe_that_is_moved_behind_its_end():
    assert frame_edits.move_keyframes(film(), [(1, 25)], 40).length == 65


@pytest.mark.parametrize(
    ("keys", "delta", "text"),
    [
        ([(1, 1)], 12, "frame 13 of 'Layer 1' already holds a keyframe"),
        ([(1, 1), (1, 13)], -1, "a keyframe at frame 0"),
        ([(1, 2)], 1, "no keyframe at frame 2"),
        ([(1, 1), (2, 5)], 1, "layer 'Layer 2' is locked"),
    ],
)
def test_a_move_that_cannot_be_is_refused_with_the_reason(keys, delta, text):
    document = edits.set_layer(film((1, 13, 25), (5,)), 2, locked=True)
    with pytest.raises(DocumentError, match=text):
        frame_edits.move_keyframes(document, keys, delta)


def test_a_keyframe_may_pass_another_one_and_then_the_pairs_are_given_up():
    document = tied(film())
    moved = frame_edits.move_keyframes(document, [(1, 1)], 14)
    assert told(moved) == {13: 1013, 15: 1001, 25: 1025}
    assert span(moved, 15).pairs == ()


def test_a_move_by_nothing_is_the_very_same_document():
    document = film()
    assert frame_edits.move_keyframes(document, [(1, 1), (1, 13)], 0) is document
    assert frame_edits.stretch_keyframes(document, [(1, 1), (1, 13)], 1, 13) is document


# stretching


@given(
    st.lists(st.integers(1, 500), min_size=2, max_size=12, unique=True).map(sorted),
    st.integers(1, 500),
    st.integers(0, 600),
)
def test_stretched_frames_are_distinct_in_order_and_end_at_the_edges(places, first, room):
    last = first + len(places) - 1 + room
    new = frame_edits.stretched(places, first, last)
    assert list(new) == places
    assert (new[places[0]], new[places[-1]]) == (first, last)
    assert all(a < b for a, b in pairwise(new.values()))
    if room > 2 * (places[-1] - places[0]):  # with room enough nobody is pushed aside
        scale = (last - first) / (places[-1] - places[0])
        assert all(abs(new[f] - (first + (f - places[0]) * scale)) <= 0.5 for f in places)


def test_a_stretched_range_keeps_pairs_and_fits_its_charts():
    document = tied(film((1, 13, 25)))
    document = edits.hold_tick(edits.set_step(document, 1, 1, 4), 1, 1, 0, 6)
    wide = frame_edits.stretch_keyframes(document, [(1, 1), (1, 13), (1, 25)], 1, 49)
    assert told(wide) == {1: 1001, 25: 1013, 49: 1025}
    assert span(wide, 1).pairs == span(document, 1).pairs
    assert span(wide, 1).exposures == tuple(2 * e for e in span(document, 1).exposures)


def test_too_few_frames_for_the_drawings_are_refused():
    with pytest.raises(DocumentError, match="3 drawings do not fit into frames 4 to 5"):
        frame_edits.stretch_keyframes(film(), [(1, 1), (1, 13), (1, 25)], 4, 5)
    with pytest.raises(DocumentError, match="two or more"):
        frame_edits.stretch_keyframes(film(), [(1, 13)], 4, 9)


# frames put in and taken out


def test_frames_put_in_everywhere_make_the_film_longer_and_shift_what_is_behind():
    document = tied(film((1, 13, 25), (5, 13)))
    longer = frame_edits.insert_frames(document, 5, 4)
    assert (longer.length, frames(longer), frames(longer, 2)) == (29, (1, 17, 29), (5, 17))
    assert span(longer, 1).pairs == span(document, 1).pairs
    assert frame_edits.remove_frames(longer, 6, 9) == document


def test_frames_put_into_one_layer_leave_the_others_and_the_film_grows_only_if_it_must():
    document = edits.set_length(film((1, 13, 25), (5, 13)), 40)
    assert frame_edits.insert_frames(document, 5, 4, [1]).length == 40
    longer = frame_edits.insert_frames(document, 5, 20, [1])
    assert (longer.length, frames(longer), frames(longer, 2)) == (45, (1, 33, 45), (5, 13))


def test_a_frame_taken_out_takes_its_keyframe_along():
    document = film((1, 13, 25), (5, 13))
    shorter = frame_edits.remove_frames(document, 13, 14)
    assert (shorter.length, told(shorter), told(shorter, 2)) == (23, {1: 1001, 23: 1025}, {5: 2005})
    one = frame_edits.remove_frames(document, 2, 3, [2])
    assert (one.length, frames(one), frames(one, 2)) == (25, (1, 13, 25), (3, 11))
    assert frame_edits.remove_frames(document, 1, 99).length == 1


def test_frames_of_a_locked_layer_stay_where_they_are():
    document = edits.set_layer(film((1, 13), (1, 5)), 2, locked=True)
    with pytest.raises(DocumentError, match="locked"):
        frame_edits.insert_frames(document, 2)
    assert frames(frame_edits.insert_frames(document, 5)) == (1, 14)  # nothing of the locked one is behind it


@given(st.data())
def test_putting_frames_in_and_taking_them_out_again_is_no_change(data):
    places = data.draw(st.lists(st.integers(1, 60), min_size=1, max_size=5, unique=True).map(sorted))
    document = film(places)
    after, count = data.draw(st.integers(0, document.length)), data.draw(st.integers(1, 30))
    longer = frame_edits.insert_frames(document, after, count)
    assert frame_edits.remove_frames(longer, after + 1, after + count) == document


# several at once


def test_several_keyframes_are_deleted_held_and_smoothed_at_once():
    document = film((1, 13, 25), (5, 13))
    keys = [(1, 13), (2, 5)]
    assert frames(frame_edits.delete_keyframes(document, keys)) == (1, 25)
    held = frame_edits.hold_keyframes(document, keys, True)
    assert [k.span.hold for x in held.layers for k in x.keyframes] == [False, True, False, True, False]
    smooth = frame_edits.smooth_keyframes(document, keys, True)
    assert [k.smooth for x in smooth.layers for k in x.keyframes] == [False, True, False, True, False]
    assert frame_edits.smooth_keyframes(smooth, keys, False) == document
    with pytest.raises(DocumentError, match="no keyframe at frame 2"):
        frame_edits.delete_keyframes(document, [(1, 1), (1, 2)])


# copying


def test_copies_of_two_neighbours_keep_what_ties_them_and_a_single_one_does_not():
    document = edits.set_span(tied(film()), 1, 1, turns=1, method="linear")
    both = frame_edits.copy_keyframes(document, [(1, 1), (1, 13)])
    pasted, made = frame_edits.paste_keyframes(document, both, 1, 40)
    assert made == ((1, 40), (1, 52))
    assert pasted.length == 52
    assert span(pasted, 40) == span(document, 1)
    one = frame_edits.copy_keyframes(document, [(1, 1)])
    pasted, _ = frame_edits.paste_keyframes(document, one, 1, 7)
    assert (span(pasted, 7).pairs, span(pasted, 7).pins, span(pasted, 7).turns) == ((), (), 0)
    assert span(pasted, 7).method == "linear"


def test_a_copy_keeps_no_pairs_where_another_keyframe_is_in_between():
    document = tied(film())
    both = frame_edits.copy_keyframes(document, [(1, 1), (1, 13)])
    pasted, _ = frame_edits.paste_keyframes(document, both, 1, 15)  # at 15 and 27, with 25 between them
    assert frames(pasted) == (1, 13, 15, 25, 27)
    assert span(pasted, 15).pairs == ()


def test_keyframes_are_pasted_into_other_layers_in_the_same_order():
    document = film((1, 13), (3, 13), ())
    copied = frame_edits.copy_keyframes(document, [(2, 3), (1, 13)])
    pasted, made = frame_edits.paste_keyframes(document, copied, 3, 20)
    assert made == ((3, 20), (2, 30))
    assert told(pasted, 3) == {20: 2003}
    assert told(pasted, 2) == {3: 2003, 13: 2013, 30: 1013}
    with pytest.raises(DocumentError, match="of 2 layers; from 'Layer 1' down there are 1"):
        frame_edits.paste_keyframes(document, copied, 1, 20)


def test_a_pasted_keyframe_takes_the_place_of_the_one_that_is_there_and_its_neighbours_pairs_go():
    document = tied(film(), frame=1)
    copied = frame_edits.copy_keyframes(document, [(1, 25)])
    pasted, _ = frame_edits.paste_keyframes(document, copied, 1, 13)
    assert told(pasted) == {1: 1001, 13: 1025, 25: 1025}
    assert span(pasted, 1).pairs == ()


def test_a_chart_is_fitted_to_the_span_that_the_copy_begins():
    document = edits.hold_tick(edits.set_step(film(), 1, 1, 4), 1, 1, 0, 6)
    copied = frame_edits.copy_keyframes(document, [(1, 1)])
    pasted, _ = frame_edits.paste_keyframes(document, copied, 1, 19)
    assert span(pasted, 19).exposures == (3, 1, 2)
    assert sum(span(pasted, 1).exposures) == 12


def test_duplicates_go_behind_where_nothing_is_in_the_way():
    document = film((1, 2, 4, 7))
    doubled, made = frame_edits.duplicate_keyframes(document, [(1, 1), (1, 2)])
    assert made == ((1, 5), (1, 6))
    assert told(doubled) == {1: 1001, 2: 1002, 4: 1004, 5: 1001, 6: 1002, 7: 1007}


def test_a_locked_layer_takes_no_paste():
    document = film((1, 13), (3,))
    copied = frame_edits.copy_keyframes(document, [(1, 1)])
    with pytest.raises(DocumentError, match="locked"):
        frame_edits.paste_keyframes(edits.set_layer(document, 2, locked=True), copied, 2, 9)


@settings(max_examples=60)
@given(st.data())
def test_what_the_edits_make_can_be_saved_and_opened(data):
    places = data.draw(st.lists(st.integers(1, 30), min_size=2, max_size=6, unique=True).map(sorted))
    document = tied(film(places, (4, 9)), frame=places[0])
    keys = data.draw(st.sets(st.sampled_from([(1, f) for f in places] + [(2, 4), (2, 9)]), min_size=1))
    copied = frame_edits.copy_keyframes(document, keys)
    layer, frame = data.draw(st.integers(1, 2)), data.draw(st.integers(1, 60))
    steps = (
        lambda: frame_edits.paste_keyframes(document, copied, layer, frame)[0],
        lambda: frame_edits.move_keyframes(document, keys, frame - 20),
        lambda: frame_edits.stretch_keyframes(document, keys, frame, frame + 9),
        lambda: frame_edits.duplicate_keyframes(document, keys)[0],
        lambda: frame_edits.remove_frames(document, frame, frame + 3),
    )
    try:
        changed = data.draw(st.sampled_from(steps))()
    except DocumentError:
        return
    assert decode(encode(changed)) == changed
