from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.errors import CorrespondenceError, DocumentError, GeometryError, InkbetweenError
from core.geometry.outline import perimeter, points_at
from core.io.project import decode, encode
from core.model import edits
from core.model.document import Anchor, Document, Layer, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS, Easing
from core.model.pins import SpanPin

SQUARE = ((0, 0), (100, 0), (100, 100), (0, 100))
DIAMOND = ((50, -20), (120, 50), (50, 120), (-20, 50))
HOUSE = ((0, 40), (50, 0), (100, 40), (100, 100), (0, 100))
LINE = ((0, 0), (40, 10), (80, 0), (120, 30))


def drawing(*outlines, style=None):
    return Drawing(tuple(Outline(i, np.array(o, float)) for i, o in enumerate(outlines, 1)), style or Style())


def film(*drawings, step=12):
    """Keyframes at 1, 13, 25 ..."""
    document = Document()
    for i, d in enumerate(drawings or (drawing(SQUARE), drawing(DIAMOND), drawing(HOUSE))):
        document = edits.put_drawing(document, 1, 1 + i * step, d)
    return document


def anchored(document, frame=1, *anchors):
    for anchor in anchors or (Anchor(0.0, 0.0), Anchor(2.5, 2.0)):
        document = edits.add_anchor(document, 1, frame, 1, 1, Anchor(*anchor))
    return document


def span(document, frame):
    return document.layers[0].keyframe_at(frame).span


def anchors(document, frame, before=1, after=1):
    return span(document, frame).pair_of(before, after).anchors


def drawing_at(document, frame):
    return document.layers[0].keyframe_at(frame).drawing


# one vertex more or less


@given(
    places=st.lists(st.floats(0, 3.999), min_size=1, max_size=4, unique_by=lambda p: round(p, 3)),
    position=st.floats(0, 4),
)
def test_a_vertex_inserted_keeps_the_anchors_in_place(places, position):
    pairs = [Anchor(p, p) for p in places]
    document = anchored(film(drawing(SQUARE), drawing(SQUARE)), 1, *pairs)
    for frame, side in ((1, "before"), (13, "after")):
        changed = edits.insert_vertex(document, 1, frame, 1, position)
        kept = [getattr(x, side) for x in anchors(changed, 1)]
        outline = drawing_at(changed, frame).outline(1).points
        np.testing.assert_allclose(points_at(outline, kept), points_at(np.array(SQUARE, float), places), atol=1e-9)


@given(position=st.floats(0, 4))
def test_a_vertex_inserted_keeps_the_shape_and_the_other_vertices(position):
    document = edits.insert_vertex(film(), 1, 1, 1, position)
    points = drawing_at(document, 1).outline(1).points
    assert {tuple(p) for p in SQUARE} <= {tuple(p) for p in points.tolist()}
    assert len(points) == 4 + (position != int(position))
    assert perimeter(points) == pytest.approx(400, rel=1e-12)


@pytest.mark.parametrize("position", [-0.5, 4.5, float("nan"), float("inf")])
def test_a_vertex_cannot_be_inserted_off_the_outline(position):
    with pytest.raises(DocumentError, match="which ends at 4"):
        edits.insert_vertex(film(), 1, 1, 1, position)


@pytest.mark.parametrize("gone", [[1], [0], [4], [0, 4], [2, 3]])
def test_vertices_deleted_keep_the_anchors_between_the_others_in_place(gone):
    places = [0.0, 0.5, 1.0, 1.25, 2.0, 2.75, 3.0, 3.5, 4.0, 4.75]
    document = anchored(film(drawing(HOUSE), drawing(HOUSE)), 1, *((p, p) for p in places))
    changed = edits.delete_vertices(document, 1, 1, {1: gone})
    outline = drawing_at(changed, 1).outline(1).points
    whole = np.array(HOUSE, float)
    for anchor in anchors(changed, 1):
        first, last = int(anchor.after), int(np.ceil(anchor.after)) % 5
        if first not in gone and last not in gone:
            np.testing.assert_allclose(
                points_at(outline, anchor.before), points_at(whole, anchor.after), atol=1e-9
            )
    assert len(anchors(changed, 1)) == len(places)
    assert [x.after for x in anchors(changed, 1)] == places


def test_an_anchor_on_a_deleted_vertex_stays_at_its_share_of_the_way():
    document = anchored(film(drawing(((0, 0), (30, 0), (100, 0), (50, 80))), drawing(SQUARE)), 1, (1.0, 1.0))
    changed = edits.delete_vertices(document, 1, 1, {1: [1]})
    assert anchors(changed, 1)[0].before == pytest.approx(0.3)


def test_anchors_that_fall_together_leave_the_one_made_first():
    doubled = ((0, 0), (50, 0), (50, 0), (100, 0), (50, 80))
    document = anchored(film(drawing(doubled), drawing(HOUSE)), 1, (1.0, 1.0), (2.0, 2.0), (4.0, 4.0))
    changed = edits.delete_vertices(document, 1, 1, {1: [1, 2]})
    assert [x.after for x in anchors(changed, 1)] == [1.0, 4.0]
    assert decode(encode(changed)) == changed


def test_an_anchor_that_becomes_the_end_of_an_open_outline_goes():
    line = Drawing((Outline(1, np.array(LINE, float), closed=False),))
    document = anchored(film(line, line), 1, (1.0, 1.0), (2.0, 2.0))
    changed = edits.delete_vertices(document, 1, 1, {1: [0]})
    assert anchors(changed, 1) == (Anchor(1.0, 2.0),)
    assert decode(encode(changed)) == changed


def test_an_outline_left_with_too_few_vertices_goes_and_its_pair_with_it():
    document = anchored(film(drawing(SQUARE, DIAMOND), drawing(SQUARE)))
    changed = edits.delete_vertices(document, 1, 1, {1: [0, 3]})
    assert [o.id for o in drawing_at(changed, 1).outlines] == [2]
    assert span(changed, 1).pairs == ()


def test_the_last_outline_takes_its_keyframe_with_it():
    document = edits.delete_vertices(film(), 1, 13, {1: [0, 1, 2, 3]})
    assert document.layers[0].frames() == (1, 25)


@pytest.mark.parametrize("index", [-1, 4])
def test_a_vertex_that_is_not_there_cannot_be_deleted(index):
    with pytest.raises(DocumentError, match="outline 1 has 4 vertices"):
        edits.delete_vertices(film(), 1, 1, {1: [0, index]})


def test_vertices_move_only_in_full_number():
    with pytest.raises(DocumentError, match="has 4 vertices, the moved one has 5"):
        edits.move_vertices(film(), 1, 1, {1: np.array(HOUSE, float)})


def test_vertices_move_never_to_one_point():
    with pytest.raises(GeometryError, match="same point"):
        edits.move_vertices(film(), 1, 1, {1: np.ones((4, 2))})


def test_vertices_moved_keep_their_anchors():
    document = anchored(film())
    changed = edits.move_vertices(document, 1, 1, {1: np.array(SQUARE) + 5.0})
    assert span(changed, 1) is span(document, 1)


# anchors


def test_crossing_anchors_are_refused():
    document = anchored(film(), 1, (0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (3.0, 3.0))
    with pytest.raises(CorrespondenceError, match="cross"):
        edits.add_anchor(document, 1, 1, 1, 1, Anchor(3.5, 0.5))
    with pytest.raises(CorrespondenceError, match="cross"):
        edits.move_anchor(document, 1, 1, 1, 1, 0, Anchor(0.0, 1.5))


def test_two_anchors_may_turn_the_direction_but_a_third_must_agree():
    document = anchored(film(), 1, (0.0, 0.0), (1.0, 3.0), (2.0, 2.0))
    with pytest.raises(CorrespondenceError, match="cross"):
        edits.add_anchor(document, 1, 1, 1, 1, Anchor(1.5, 3.5))


@pytest.mark.parametrize("anchor", [(4.5, 0.0), (-0.1, 0.0), (0.0, 4.5), (float("nan"), 0.0)])
def test_an_anchor_off_the_outline_is_refused(anchor):
    with pytest.raises(CorrespondenceError):
        edits.add_anchor(film(), 1, 1, 1, 1, Anchor(*anchor))


def test_an_anchor_takes_the_place_of_one_that_starts_at_the_same_point():
    document = anchored(film(), 1, (0.0, 0.0), (0.0, 1.0))
    assert anchors(document, 1) == (Anchor(0.0, 1.0),)


def test_an_anchor_to_another_outline_gives_up_the_pair():
    document = anchored(film(drawing(SQUARE), drawing(SQUARE, DIAMOND)))
    document = edits.add_anchor(document, 1, 1, 1, 2, Anchor(0.0, 0.0))
    assert [(p.before, p.after) for p in span(document, 1).pairs] == [(1, 2)]


def test_a_closed_outline_is_never_tied_to_an_open_one():
    document = edits.add_outline(film(drawing(SQUARE)), 1, 13, LINE, closed=False)
    with pytest.raises(CorrespondenceError, match="closed"):
        anchored(document)


def test_anchors_need_a_span():
    with pytest.raises(DocumentError, match="no span begins at frame 25"):
        anchored(film(), 25)


@pytest.mark.parametrize("index", [-1, 2])
def test_an_anchor_that_is_not_there_is_an_error(index):
    document = anchored(film())
    for edit in (edits.delete_anchor, lambda *a: edits.move_anchor(*a, Anchor(0, 0))):
        with pytest.raises(DocumentError, match="no anchor"):
            edit(document, 1, 1, 1, 1, index)


def test_anchors_moved_and_deleted_leave_the_others():
    document = anchored(film(), 1, (0.0, 0.0), (1.0, 1.0), (2.0, 2.0))
    moved = edits.move_anchor(document, 1, 1, 1, 1, 1, Anchor(1.5, 1.25))
    assert anchors(moved, 1) == (Anchor(0, 0), Anchor(1.5, 1.25), Anchor(2, 2))
    assert anchors(edits.delete_anchor(moved, 1, 1, 1, 1, 0), 1) == (Anchor(1.5, 1.25), Anchor(2, 2))
    assert span(edits.clear_anchors(moved, 1, 1), 1).pairs == ()


# keyframes


def test_a_drawing_put_inside_a_span_inherits_method_and_easing():
    easing = PRESETS["slow in"]
    document = edits.set_span(anchored(film()), 1, 1, method="linear", easing=easing, turns=2)
    document = edits.put_drawing(document, 1, 7, drawing(HOUSE))
    assert span(document, 7) == Span("linear", easing)
    assert span(document, 1) == Span("linear", easing, 2)  # the anchors led to a keyframe that is no longer next


def test_a_drawing_put_behind_the_end_makes_the_film_longer():
    assert edits.put_drawing(Document(), 1, 100, drawing(SQUARE)).length == 100


def test_a_drawing_with_the_same_build_keeps_the_anchors():
    document = anchored(anchored(film(drawing(SQUARE), drawing(DIAMOND), drawing(SQUARE))), 13)
    changed = edits.put_drawing(document, 1, 13, drawing(SQUARE))
    assert span(changed, 1) is span(document, 1)
    assert span(changed, 13) is span(document, 13)


@pytest.mark.parametrize("other", [drawing(HOUSE), Drawing((Outline(2, np.array(SQUARE, float)),)), Drawing()])
def test_a_drawing_built_otherwise_drops_the_anchors_on_both_sides(other):
    document = anchored(anchored(film(drawing(SQUARE), drawing(DIAMOND), drawing(SQUARE))), 13)
    changed = edits.put_drawing(document, 1, 13, other)
    assert span(changed, 1).pairs == span(changed, 13).pairs == ()
    assert decode(encode(changed)) == changed


@pytest.mark.parametrize(
    ("edit", "kept"),
    [
        (lambda d: edits.delete_keyframe(d, 1, 13), {25}),
        (lambda d: edits.delete_keyframe(d, 1, 1), {13, 25}),
        (lambda d: edits.delete_keyframe(d, 1, 37), {1, 13}),
        (lambda d: edits.move_keyframe(d, 1, 13, 20), {1, 20, 25}),
        (lambda d: edits.move_keyframe(d, 1, 13, 30), set()),
        (lambda d: edits.move_keyframe(d, 1, 37, 2), {13}),
        (lambda d: edits.put_drawing(d, 1, 18, drawing(HOUSE)), {1, 25}),
    ],
)
@pytest.mark.parametrize("shared", [False, True])
def test_only_the_spans_whose_next_keyframe_is_another_forget_their_anchors(edit, kept, shared):
    same = drawing(SQUARE)
    document = film(*(same if shared else drawing(np.array(SQUARE) + i) for i in range(4)))
    for frame in (1, 13, 25):
        document = anchored(document, frame)
    changed = edit(document)
    if shared:  # the next keyframe may show the very same drawing: then the anchors hold as well
        assert kept <= {k.frame for k in changed.layers[0].keyframes if k.span.pairs}
    else:
        assert kept == {k.frame for k in changed.layers[0].keyframes if k.span.pairs}


def test_a_drawing_used_twice_does_not_cost_the_anchors_of_another_span():
    a = drawing(SQUARE)
    document = anchored(film(a, drawing(DIAMOND), a, drawing(HOUSE), drawing(DIAMOND)))
    assert span(edits.delete_keyframe(document, 1, 49), 1) is span(document, 1)


def test_a_keyframe_cannot_move_onto_another():
    with pytest.raises(DocumentError, match="frame 13 of 'Layer 1' already holds a keyframe"):
        edits.move_keyframe(film(), 1, 1, 13)


def test_the_first_outline_makes_the_keyframe_painted_like_its_neighbour():
    style = Style("#112233", "#445566", 7.0)
    document = edits.add_outline(film(drawing(SQUARE, style=style)), 1, 9, HOUSE)
    assert drawing_at(document, 9).style == style
    document = edits.add_outline(document, 1, 9, DIAMOND)
    assert [o.id for o in drawing_at(document, 9).outlines] == [1, 2]


# every edit

MISSING = [
    lambda d: edits.delete_keyframe(d, 1, 2),
    lambda d: edits.move_keyframe(d, 1, 2, 3),
    lambda d: edits.insert_vertex(d, 1, 2, 1, 0.5),
    lambda d: edits.insert_vertex(d, 1, 1, 9, 0.5),
    lambda d: edits.delete_vertices(d, 1, 1, {9: [0]}),
    lambda d: edits.delete_outline(d, 1, 1, 9),
    lambda d: edits.set_style(d, 1, 2, Style()),
    lambda d: edits.set_span(d, 1, 2, turns=1),
    lambda d: edits.set_layer(d, 7, name="x"),
    lambda d: edits.add_anchor(d, 1, 1, 9, 1, Anchor(0, 0)),
    lambda d: edits.clear_anchors(d, 1, 2),
    lambda d: edits.move_vertices(d, 1, 1, {9: np.array(SQUARE, float)}),
]


@pytest.mark.parametrize("edit", MISSING)
def test_what_is_not_there_is_named(edit):
    with pytest.raises(DocumentError, match=r"no (keyframe at frame 2|outline 9|layer 7)"):
        edit(film())


WRONG = [
    lambda d: edits.set_length(d, 0),
    lambda d: edits.set_rate(d, Fraction(0)),
    lambda d: edits.set_span(d, 1, 1, method="magic"),
    lambda d: edits.set_span(d, 1, 1, turns=1000),
    lambda d: edits.move_keyframe(d, 1, 1, 0),
    lambda d: edits.put_drawing(d, 1, 10**9, drawing(SQUARE)),
    lambda d: edits.add_outline(d, 1, 1, [(0, 0), (1, float("nan")), (1, 1)]),
    lambda d: edits.add_outline(d, 1, 1, [(0, 0), (1, 1)]),
    lambda d: edits.set_layer(d, 1, name="x" * 1001),
    lambda d: edits.set_layer(d, 1, name="\ud800"),
]


@pytest.mark.parametrize("edit", WRONG)
def test_what_cannot_be_is_refused(edit):
    with pytest.raises(InkbetweenError):
        edit(film())


SAME = [
    lambda d: edits.set_stage(d, Stage()),
    lambda d: edits.set_rate(d, Fraction(24)),
    lambda d: edits.set_length(d, d.length),
    lambda d: edits.set_layer(d, 1, name="Layer 1", visible=True),
    lambda d: edits.put_drawing(d, 1, 1, drawing(SQUARE)),
    lambda d: edits.move_keyframe(d, 1, 13, 13),
    lambda d: edits.move_vertices(d, 1, 1, {1: np.array(SQUARE)}),
    lambda d: edits.insert_vertex(d, 1, 1, 1, 2.0),
    lambda d: edits.delete_vertices(d, 1, 1, {1: []}),
    lambda d: edits.set_style(d, 1, 1, Style()),
    lambda d: edits.set_span(d, 1, 1, method="auto", easing=Easing(), turns=0, repair=False),
    lambda d: edits.add_anchor(d, 1, 1, 1, 1, Anchor(2.5, 2.0)),
    lambda d: edits.move_anchor(d, 1, 1, 1, 1, 1, Anchor(2.5, 2.0)),
    lambda d: edits.clear_anchors(d, 1, 13),
]


@pytest.mark.parametrize("edit", SAME)
def test_an_edit_that_changes_nothing_returns_the_same_document(edit):
    document = anchored(film())
    assert edit(document) is document


def test_an_edit_shares_all_that_it_does_not_touch():
    document = Document(layers=(film().layers[0], Layer(2, "back")))
    changed = edits.move_vertices(document, 1, 13, {1: np.array(DIAMOND) + 1.0})
    assert changed.layers[1] is document.layers[1]
    old, new = document.layers[0].keyframes, changed.layers[0].keyframes
    assert new[0] is old[0]
    assert new[2] is old[2]
    assert new[1].span is old[1].span


POINTS = st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)), min_size=2, max_size=7)
FRAMES = st.integers(1, 30)


@st.composite
def an_edit(draw, document):
    """A random edit of this document, more often one of something that is there."""
    keyframes = document.layers[0].keyframes
    frame = draw(st.sampled_from([k.frame for k in keyframes]) if keyframes else FRAMES)
    ids = st.sampled_from([1, 1, 1, 2])
    place = st.integers(0, 14).map(lambda i: i / 2)
    anchor = st.builds(Anchor, place, place)
    number = st.integers(0, 3)
    choices = [
        st.tuples(st.just(edits.add_outline), FRAMES, POINTS),
        st.tuples(st.just(edits.add_outline), st.just(frame), POINTS),
        st.tuples(st.just(edits.delete_keyframe), st.just(frame)),
        st.tuples(st.just(edits.move_keyframe), st.just(frame), FRAMES),
        st.tuples(st.just(edits.insert_vertex), st.just(frame), ids, place.map(lambda p: p + 0.25)),
        st.tuples(
            st.just(edits.delete_vertices),
            st.just(frame),
            st.dictionaries(ids, st.lists(st.integers(0, 3), min_size=1, max_size=3)),
        ),
        st.tuples(st.just(edits.delete_outline), st.just(frame), ids),
        st.tuples(st.just(edits.add_anchor), st.just(frame), ids, ids, anchor),
        st.tuples(st.just(edits.move_anchor), st.just(frame), ids, ids, number, anchor),
        st.tuples(st.just(edits.delete_anchor), st.just(frame), ids, ids, number),
        st.tuples(st.just(edits.clear_anchors), st.just(frame)),
        st.tuples(st.just(edits.add_pin), st.just(frame), st.builds(SpanPin, ids, place)),
        st.tuples(st.just(edits.move_pin), st.just(frame), number, st.builds(SpanPin, ids, place)),
        st.tuples(st.just(edits.set_pin_handles), st.just(frame), number, st.just(((0.0, 0.0), (9.0, 5.0)))),
        st.tuples(st.just(edits.delete_pin), st.just(frame), number),
        st.tuples(st.just(edits.clear_pins), st.just(frame)),
    ]
    if keyframes:
        copied = st.sampled_from([k.drawing for k in keyframes])
        choices += [st.tuples(st.just(edits.put_drawing), at, copied) for at in (FRAMES, st.just(frame))]
    return draw(st.one_of(choices))


@given(st.data(), st.booleans())
@settings(max_examples=150)
def test_whatever_edits_leave_can_be_saved_and_opened(data, closed):
    document = Document()
    for frame in (1, 10, 20):
        points = data.draw(
            st.lists(st.sampled_from(HOUSE), min_size=4, max_size=6).filter(lambda p: len(set(p)) > 1)
        )
        document = edits.add_outline(document, 1, frame, points, closed=closed)
    for frame in (1, 10):
        for i in data.draw(st.lists(st.integers(0, 3))):
            document = (
                edits.add_anchor(document, 1, frame, 1, 1, Anchor(i, i)) if closed or i in (1, 2) else document
            )
            document = edits.add_pin(document, 1, frame, SpanPin(1, i))
    for _ in range(4):
        edit, *arguments = data.draw(an_edit(document))
        kept = encode(document)
        try:
            after = edit(document, 1, *arguments)
        except InkbetweenError:
            after = document
        assert encode(document) == kept
        assert after is document or after != document
        assert decode(encode(after)) == after
        document = after


def test_a_new_layer_lies_in_front_and_has_an_id_of_its_own():
    document = edits.add_layer(Document(layers=(Layer(2, "a"), Layer(1, "b"))), "c")
    assert [(x.id, x.name) for x in document.layers] == [(2, "a"), (1, "b"), (3, "c")]
    highest = edits.add_layer(Document(layers=(Layer(2**31 - 1),)), "next")
    assert highest.layers[-1].id == 1
    with pytest.raises(DocumentError, match="name"):
        edits.add_layer(document, "x" * 1001)
