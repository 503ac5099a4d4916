from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import CorrespondenceError
from core.model import edits
from core.model.document import Anchor, Document, Keyframe, Layer, OutlinePair, Span
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import PRESETS, Easing
from core.model.inbetweens import (
    match_span,
    mix_styles,
    paired_outlines,
    plan_span,
)
from core.model.motion import PlanCache, picture_at, pictures_at

SQUARE = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])
HOLE = SQUARE * 0.4 + 30
PENTAGON = np.array([(0.0, 40.0), (50.0, 0.0), (100.0, 40.0), (90.0, 100.0), (10.0, 100.0)]) + 200
LINE = np.array([(0.0, 0.0), (40.0, 10.0), (80.0, 0.0)])


def drawing(*outlines, style=None, closed=True):
    return Drawing(tuple(Outline(i, o, closed) for i, o in enumerate(outlines, 1)), style or Style())


def film(*drawings, span=None):
    """Keyframes at 5, 15, 25 ..."""
    keyframes = tuple(Keyframe(5 + 10 * i, d, span or Span()) for i, d in enumerate(drawings))
    return Document(length=60, layers=(Layer(1, keyframes=keyframes),))


def picture(document, frame, plans=None):
    return picture_at(document, document.layers[0], frame, plans or PlanCache())


METHODS = pytest.mark.parametrize("method", ["linear", "intrinsic"])


@METHODS
def test_keyframes_are_shown_exactly_and_without_a_plan(method):
    document, plans = film(drawing(SQUARE), drawing(PENTAGON), span=Span(method)), PlanCache()
    for frame, points in ((5, SQUARE), (15, PENTAGON)):
        ((shown, closed),) = picture(document, frame, plans).outlines
        assert (shown == points).all()
        assert closed
    assert plans.solved == 0


@METHODS
def test_a_plan_shows_every_vertex_of_both_keyframes_bit_for_bit(method):
    after = (PENTAGON, HOLE + 200)
    plan = plan_span(drawing(SQUARE, HOLE), drawing(*after), Span(method))
    for t, outlines in ((0.0, (SQUARE, HOLE)), (1.0, after)):
        for (shown, _), points in zip(plan.picture(t).outlines, outlines, strict=True):
            assert {tuple(p) for p in points} <= {tuple(p) for p in shown}


def test_nothing_is_shown_before_the_first_keyframe_and_the_last_one_is_held():
    document = film(drawing(SQUARE), drawing(PENTAGON))
    assert picture(document, 4) is None
    assert picture(document, 4.9) is None
    for frame in (15, 16, 60, 1000.5):
        assert (picture(document, frame).outlines[0][0] == PENTAGON).all()
    assert picture(film(drawing(SQUARE)), 30).outlines[0][0] is not None
    assert picture(film(), 30) is None


def test_easing_says_which_t_a_frame_shows():
    document = film(drawing(SQUARE), drawing(SQUARE + 100), span=Span("linear", PRESETS["slow in and out"]))
    t = float(PRESETS["slow in and out"].t_at(0.3))
    np.testing.assert_allclose(picture(document, 8).outlines[0][0], SQUARE + 100 * t, atol=1e-9)


def test_easing_may_overshoot():
    document = film(drawing(SQUARE), drawing(SQUARE + 100), span=Span("linear", Easing(0.2, 2.0, 0.6, 2.0)))
    assert picture(document, 10).outlines[0][0].max() > 200


def test_half_frames_lie_between_whole_ones():
    document = film(drawing(SQUARE), drawing(SQUARE + 100), span=Span("linear"))
    np.testing.assert_allclose(picture(document, 7.5).outlines[0][0], SQUARE + 25, atol=1e-9)


@METHODS
def test_a_hole_stays_in_its_place(method):
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    before, after = drawing(SQUARE, HOLE), drawing(SQUARE @ turn + 300, HOLE @ turn + 300)
    tied = tuple(OutlinePair(i, i, (Anchor(0.0, 0.0),)) for i in (1, 2))
    plan = plan_span(before, after, Span(method, pairs=tied))
    outer, hole = plan.frames(np.linspace(0, 1, 5))
    np.testing.assert_allclose(outer.mean(axis=1), hole.mean(axis=1), atol=1e-6)


@METHODS
def test_outlines_without_a_partner_grow_out_of_a_point_and_shrink_into_one(method):
    plan = plan_span(drawing(SQUARE, HOLE), drawing(SQUARE), Span(method))
    assert [(x.before, x.after) for x in plan.links] == [(1, 1), (2, None)]
    gone = plan.frames([0.0, 0.5, 1.0])[1]
    assert (gone[0] == HOLE).all()
    assert np.ptp(gone[2], axis=0).max() == 0
    assert 0 < np.ptp(gone[1], axis=0).max() < np.ptp(HOLE, axis=0).max()
    back = plan_span(drawing(SQUARE), drawing(SQUARE, HOLE), Span(method))
    assert [(x.before, x.after) for x in back.links] == [(1, 1), (None, 2)]
    np.testing.assert_allclose(back.frames([0.5])[1][0], gone[1], atol=1e-9)


@METHODS
def test_a_drawing_can_appear_out_of_nothing(method):
    document = film(Drawing(), drawing(SQUARE), Drawing(), span=Span(method))
    assert picture(document, 5).outlines == ()
    for frame in range(6, 25):
        assert np.isfinite(picture(document, frame).outlines[0][0]).all()


def test_closed_outlines_pair_with_closed_ones_and_open_with_open():
    a = Drawing((Outline(1, LINE, False), Outline(2, SQUARE), Outline(3, HOLE)))
    b = Drawing((Outline(7, SQUARE), Outline(8, LINE, False)))
    assert set(paired_outlines(a, b, Span())) == {(2, 7), (1, 8)}
    assert set(paired_outlines(a, b, Span(pairs=(OutlinePair(3, 7),)))) == {(3, 7), (1, 8)}


def test_pairs_whose_outlines_are_gone_are_ignored():
    span = Span(pairs=(OutlinePair(9, 1), OutlinePair(1, 9)))
    assert paired_outlines(drawing(SQUARE), drawing(PENTAGON), span) == ((1, 1),)


@METHODS
def test_an_anchor_holds_at_every_t(method):
    fixed = OutlinePair(1, 1, (Anchor(1.0, 3.0), Anchor(2.5, 4.5)))
    plan = plan_span(drawing(SQUARE), drawing(PENTAGON), Span(method, pairs=(fixed,)))
    (link,) = plan.links
    for anchor in fixed.anchors:
        row = np.flatnonzero(np.isclose(link.before_positions, anchor.before))
        assert link.after_positions[row] == pytest.approx(anchor.after)


def test_a_kept_correspondence_is_used_as_it_is():
    a, b = drawing(SQUARE), drawing(PENTAGON)
    kept = match_span(a, b, Span(pairs=(OutlinePair(1, 1, (Anchor(0.5, 2.0),)),))).of(1, 1)
    span = Span(pairs=(OutlinePair(1, 1, (), kept),))
    assert match_span(a, b, span).of(1, 1) is kept


def test_correspondences_solved_before_serve_drawings_whose_vertices_moved():
    a, b = drawing(SQUARE), drawing(PENTAGON)
    matched = match_span(a, b, Span())
    moved = SQUARE + np.array([9.0, 4.0])
    plan = plan_span(drawing(moved), b, Span(), matched)
    assert {tuple(p) for p in moved} <= {tuple(p) for p in plan.picture(0.0).outlines[0][0]}
    with pytest.raises(CorrespondenceError, match="4 and 5 vertices; before has 5"):
        plan_span(drawing(PENTAGON), b, Span(), matched)


@given(st.floats(0, 1))
def test_styles_mix_and_keep_their_ends(t):
    a, b = Style("#ff0000", None, 2.0), Style("#0000ff", "#00ff00", 6.0)
    mixed = mix_styles(a, b, t)
    assert mixed.width == pytest.approx(2 + 4 * t)
    assert mix_styles(a, b, 0.0) == a
    assert mix_styles(a, b, 1.0) == b
    assert mix_styles(a, a, t) is a


def test_a_width_that_overshoots_is_never_below_nothing():
    assert mix_styles(Style(width=1.0), Style(width=9.0), -0.5).width == 0.0


# plans are solved once


def whole(document, plans):
    for frame in range(1, 60):
        pictures_at(document, frame, plans)
    return plans.solved


@pytest.mark.parametrize(
    ("edit", "more"),
    [
        (lambda d: edits.set_rate(d, Fraction(12)), 0),
        (lambda d: edits.set_length(d, 99), 0),
        (lambda d: edits.move_keyframe(d, 1, 15, 17), 0),
        (lambda d: edits.set_layer(d, 1, name="ink"), 0),
        (lambda d: edits.move_vertices(d, 1, 15, {1: PENTAGON + 3}), 2),
        (lambda d: edits.move_vertices(d, 1, 5, {1: SQUARE + 3}), 1),
        (lambda d: edits.move_vertices(d, 1, 45, {1: SQUARE + 3}), 1),
        (lambda d: edits.insert_vertex(d, 1, 15, 1, 0.5), 2),
        (lambda d: edits.set_style(d, 1, 15, Style("#000000")), 2),
        (lambda d: edits.set_span(d, 1, 25, method="linear"), 1),
        (lambda d: edits.add_anchor(d, 1, 25, 1, 1, Anchor(0.0, 0.0)), 1),
        (lambda d: edits.put_drawing(d, 1, 20, drawing(HOLE)), 2),
        (lambda d: edits.delete_keyframe(d, 1, 25), 1),
        (lambda d: edits.delete_keyframe(d, 1, 45), 0),
    ],
)
def test_only_the_spans_that_an_edit_changes_are_solved_again(edit, more):
    document = film(*(drawing(p) for p in (SQUARE, PENTAGON, SQUARE + 50, PENTAGON, SQUARE)))
    plans = PlanCache()
    assert whole(document, plans) == 4
    assert whole(document, plans) == 4
    assert whole(edit(document), plans) == 4 + more
    assert whole(document, plans) == 4 + more  # undo costs nothing


def test_the_longest_unused_plan_is_forgotten_first():
    document = film(*(drawing(SQUARE + i) for i in range(4)))
    plans = PlanCache(capacity=2)
    for frame, solved in ((6, 1), (16, 2), (6, 2), (26, 3), (6, 3), (16, 4)):
        picture(document, frame, plans)
        assert plans.solved == solved, frame


def test_hidden_layers_are_not_shown_and_the_back_comes_first():
    (layer,) = film(drawing(SQUARE)).layers
    (other,) = film(drawing(PENTAGON)).layers
    layers = (
        layer,
        Layer(2, "hidden", False, layer.keyframes),
        Layer(3, "front", True, other.keyframes),
        Layer(4),
    )
    shown = pictures_at(Document(layers=layers), 5, PlanCache())
    assert len(shown) == 2
    assert (shown[0].outlines[0][0] == SQUARE).all()
    assert (shown[1].outlines[0][0] == PENTAGON).all()
