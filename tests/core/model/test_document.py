from dataclasses import FrozenInstanceError, replace
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.errors import DocumentError, GeometryError
from core.model.document import (
    Document,
    Keyframe,
    Layer,
    OutlinePair,
    Span,
    Stage,
    as_rate,
)
from core.model.drawing import Drawing, Outline, Style

TRIANGLE = np.array([(0.0, 0.0), (10.0, 0.0), (5.0, 8.0)])


def keyframes(*frames):
    return tuple(Keyframe(f) for f in frames)


@given(st.sets(st.integers(1, 60), max_size=5).map(sorted), st.floats(0, 61) | st.integers(0, 61))
def test_around_gives_the_two_keyframes_that_enclose_a_frame(frames, frame):
    before, after = Layer(1, keyframes=keyframes(*frames)).around(frame)
    first, second = before and before.frame, after and after.frame
    if not frames:
        assert (first, second) == (None, None)
    elif frame < frames[0]:
        assert (first, second) == (None, frames[0])
    elif frame > frames[-1] or len(frames) == 1:
        assert (first, second) == (frames[-1], None)
    else:
        assert first <= frame <= second
        assert frames.index(second) == frames.index(first) + 1
        assert frame < second or second == frames[-1]


@given(st.sets(st.integers(1, 60), max_size=5).map(sorted), st.integers(1, 60))
def test_a_keyframe_is_found_at_its_frame_only(frames, frame):
    found = Layer(1, keyframes=keyframes(*frames)).keyframe_at(frame)
    assert (found.frame if found else None) == (frame if frame in frames else None)


@pytest.mark.parametrize("frames", [(2, 1), (1, 1), (1, 5, 5)])
def test_keyframes_stand_in_order(frames):
    with pytest.raises(DocumentError, match="has a keyframe at"):
        Layer(1, keyframes=keyframes(*frames))


def test_nothing_in_a_document_can_be_changed():
    outline = Outline(1, TRIANGLE.copy())
    for part, name in ((Document(), "length"), (Layer(1), "name"), (outline, "id"), (Style(), "fill")):
        with pytest.raises(FrozenInstanceError):
            setattr(part, name, 1)
    with pytest.raises(ValueError, match="read-only"):
        outline.points[0, 0] = 1


def test_an_outline_keeps_its_vertices_when_the_array_it_came_from_changes():
    points = TRIANGLE.copy()
    outline, part = Outline(1, points), Outline(2, points[:3])
    points += 1
    np.testing.assert_array_equal(outline.points, TRIANGLE)
    np.testing.assert_array_equal(part.points, TRIANGLE)


def test_a_checked_array_is_shared_not_copied():
    outline = Outline(1, TRIANGLE)
    assert replace(outline, id=2).points is outline.points


def test_outlines_are_equal_when_every_number_is():
    a = Outline(1, TRIANGLE)
    assert a == Outline(1, TRIANGLE.copy())
    assert hash(a) == hash(Outline(1, TRIANGLE.copy()))
    for other in (Outline(2, TRIANGLE), Outline(1, TRIANGLE, closed=False), Outline(1, TRIANGLE + 1e-12), "a"):
        assert a != other


@pytest.mark.parametrize(
    ("points", "closed", "message"),
    [
        (TRIANGLE[:2], True, "has 2 vertices; a closed outline needs at least 3"),
        (TRIANGLE[:1], False, "has 1 vertices; an open outline needs at least 2"),
        (TRIANGLE * np.nan, True, "vertex 0 of outline 4 is not a finite number"),
        (TRIANGLE * 0, True, "are the same point"),
        (TRIANGLE * 1e9, True, "the limit is 1e"),
        (np.zeros((3, 3)), True, r"has the shape \(3, 3\)"),
    ],
)
def test_an_outline_that_cannot_be_drawn_is_refused(points, closed, message):
    with pytest.raises(GeometryError, match=message):
        Outline(4, points, closed)


def test_a_drawing_finds_adds_replaces_and_drops_outlines_by_id():
    a, b, c = (Outline(i, TRIANGLE + i) for i in (3, 5, 5))
    drawing = Drawing().with_outline(a).with_outline(b)
    assert drawing.outlines == (a, b)
    assert drawing.free_id() == 6
    assert drawing.with_outline(c).outlines == (a, c)
    assert drawing.without_outline(3).outlines == (b,)
    assert drawing.outline(3) is a
    with pytest.raises(DocumentError, match="no outline 4"):
        drawing.without_outline(4)


def test_two_outlines_never_have_one_id():
    with pytest.raises(DocumentError, match="have the id 5"):
        Drawing((Outline(5, TRIANGLE), Outline(5, TRIANGLE)))


@pytest.mark.parametrize("pairs", [((1, 1), (1, 2)), ((1, 1), (2, 1))])
def test_an_outline_is_in_one_pair_of_a_span(pairs):
    with pytest.raises(DocumentError, match="in two pairs"):
        Span(pairs=tuple(OutlinePair(*p) for p in pairs))


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Stage(0, 5), "0 px wide"),
        (lambda: Stage(5, 16_385), "16385 px high"),
        (lambda: Stage(background="white"), "background is 'white'"),
        (lambda: Style(fill="#12"), "fill is '#12'"),
        (lambda: Style(width=-1), "stroke width is -1"),
        (lambda: Keyframe(0), "frames run from 1"),
        (lambda: Keyframe(100_001), "to 100000"),
        (lambda: Span("magic"), "unknown method 'magic'; known are linear, intrinsic"),
        (lambda: Span(turns=-101), "-101 extra turns"),
        (lambda: Document(rate=Fraction(0)), "frame rate is 0"),
        (lambda: Document(rate=Fraction(1001)), "frame rate is 1001"),
        (lambda: Document(length=0), "0 frames"),
        (lambda: Document(layers=(Layer(1), Layer(1))), "same id"),
        (lambda: Document().layer(9), "no layer 9"),
    ],
)
def test_a_number_out_of_range_is_named(make, message):
    with pytest.raises(DocumentError, match=message):
        make()


def test_a_layer_set_in_its_place_leaves_the_others():
    document = Document(layers=(Layer(1), Layer(2), Layer(3)))
    assert document.with_layer(document.layers[1]) is document
    changed = document.with_layer(Layer(2, "ink"))
    assert [x.name for x in changed.layers] == ["Layer 1", "ink", "Layer 1"]
    assert changed.layers[0] is document.layers[0]


@pytest.mark.parametrize(
    ("text", "rate"),
    [
        ("24", Fraction(24)),
        (" 25.0 ", Fraction(25)),
        ("23.976", Fraction(2997, 125)),
        ("24000/1001", Fraction(24000, 1001)),
        ("30000 / 1001", Fraction(30000, 1001)),
        (".5", Fraction(1, 2)),
        ("1000", Fraction(1000)),
    ],
)
def test_a_frame_rate_is_read_as_people_write_it(text, rate):
    assert as_rate(text) == rate


WRONG = ["", "x", "0", "-24", "1001", "1/0", "0.0000001", "1e999999999", "nan", "inf", "24 25", "1" * 5000, "٢٤"]


@pytest.mark.parametrize("text", WRONG)
def test_what_is_no_frame_rate_is_refused_at_once(text):
    with pytest.raises(DocumentError, match="frame rate") as error:
        as_rate(text)
    assert len(str(error.value)) < 120


@given(st.fractions(Fraction(1, 1000), 1000, max_denominator=1001))
def test_every_frame_rate_that_is_shown_can_be_typed(rate):
    assert as_rate(str(rate)) == rate
