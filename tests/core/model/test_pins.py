from dataclasses import replace

import numpy as np
import pytest

from core.errors import DocumentError, FileFormatError
from core.geometry.outline import points_at
from core.io.project import decode, encode
from core.model import edits
from core.model.document import Document, Span
from core.model.inbetweens import plan_span
from core.model.motion import PlanCache
from core.model.pins import SpanPin

U = np.linspace(0, 2 * np.pi, 24, endpoint=False)
METHODS = pytest.mark.parametrize("method", ["linear", "intrinsic", "rigid", "auto"])
TIMES = np.linspace(0, 1, 21)
SIZE = 1000.0


def limb(bend):
    x, y = 500 * np.cos(U), 130 * np.sin(U)
    turn = bend * np.clip(x / 500, 0, 1)
    return np.column_stack([960 + x * np.cos(turn) - y * np.sin(turn), 540 + x * np.sin(turn) + y * np.cos(turn)])


def film(*pins, method="linear"):
    """A bending limb with a hole in it, at frames 1 and 24."""
    document = Document()
    for frame, bend in ((1, 0.0), (24, -1.1)):
        document = edits.add_outline(document, 1, frame, limb(bend))
        document = edits.add_outline(document, 1, frame, 0.3 * (limb(bend) - (960, 540)) + (800, 540))
    document = edits.set_span(document, 1, 1, method=method)
    for pin in pins:
        document = edits.add_pin(document, 1, 1, pin)
    return document


def span(document):
    return document.layers[0].keyframes[0].span


def planned(document):
    first, last = document.layers[0].keyframes
    return plan_span(first.drawing, last.drawing, first.span)


def way(document, index=0):
    """Where a pin is at TIMES, by its own weights on the vertices."""
    plan = planned(document)
    frames = np.concatenate(plan.frames(TIMES), axis=1)
    places = plan.paths.plan.paths.held.at(frames[..., 0] + 1j * frames[..., 1])[:, index]
    return np.column_stack([places.real, places.imag])


def along(outline, position, frames):
    return np.array([points_at(f, np.array([position]), closed=True)[0] for f in frames[outline]])


@METHODS
def test_a_pinned_vertex_goes_straight_and_starts_where_it_was_pinned(method):
    document = film(SpanPin(1, 3.0), method=method)
    plan = planned(document)
    row = int(np.flatnonzero(plan.links[0].before_positions == 3.0)[0])
    path = plan.frames(TIMES)[0][:, row]
    assert np.allclose(path[0], limb(0.0)[3])
    straight = path[0] + TIMES[:, None] * (path[-1] - path[0])
    assert np.abs(path - straight).max() < 1e-9 * SIZE


@METHODS
def test_pins_between_vertices_on_a_hole_and_inside_are_where_they_must_be(method):
    pins = SpanPin(1, 11.5), SpanPin(2, 23.75), SpanPin(place=(1200.0, 560.0))
    document = film(*pins, method=method)
    a = document.layers[0].keyframes[0].drawing.outlines
    starts = [
        points_at(a[0].points, np.array([11.5]), closed=True)[0],
        points_at(a[1].points, np.array([23.75]), closed=True)[0],
        (1200.0, 560.0),
    ]
    for k, start in enumerate(starts):
        path = way(document, k)
        assert np.allclose(path[0], start, atol=1e-9 * SIZE)
        assert np.abs(path - path[0] - TIMES[:, None] * (path[-1] - path[0])).max() < 1e-9 * SIZE


@METHODS
def test_an_arc_is_followed(method):
    (x0, y0), (x1, y1) = way(film(SpanPin(1, 0.0)))[[0, -1]]
    arc = (x0, y0 - 400.0), (x1 + 300.0, y1)
    path = way(film(SpanPin(1, 0.0, handles=arc), method=method))
    s = np.linspace(0, 1, 20_001)[:, None]
    curve = (1 - s) ** 3 * (x0, y0) + 3 * (1 - s) ** 2 * s * arc[0] + 3 * (1 - s) * s**2 * arc[1] + s**3 * (x1, y1)
    gaps = [np.hypot(*(curve - p).T).min() for p in path]
    assert max(gaps) < 0.05  # px, between two samples of the curve
    steps = np.hypot(*np.diff(path, axis=0).T)
    assert np.ptp(steps) < 0.05 * steps.mean()


def test_a_pin_that_both_keyframes_have_at_one_place_is_held_still():
    document = film(SpanPin(1, 12.0), method="intrinsic")
    assert np.abs(way(document) - limb(0.0)[12]).max() < 1e-9 * SIZE


def test_a_pin_is_carried_when_vertices_are_inserted_and_deleted():
    document = film(SpanPin(1, 3.0), SpanPin(1, 22.5), SpanPin(2, 1.0), SpanPin(place=(900.0, 500.0)))
    before = [way(document, k)[0] for k in range(4)]
    grown = edits.insert_vertex(document, 1, 1, 1, 1.5)
    assert [p.position for p in span(grown).pins] == [4.0, 23.5, 1.0, 0.0]
    assert np.allclose([way(grown, k)[0] for k in range(4)], before)
    fewer = edits.delete_vertices(document, 1, 1, {1: [0, 8]})
    assert span(fewer).pins[0].position == 2.0
    assert np.allclose(way(fewer)[0], before[0])
    after = edits.insert_vertex(document, 1, 24, 1, 1.5)
    assert span(after).pins == span(document).pins


def test_a_pin_goes_with_its_outline():
    document = film(SpanPin(1, 3.0), SpanPin(2, 1.0), SpanPin(place=(900.0, 500.0)))
    kept = span(document).pins
    assert span(edits.delete_outline(document, 1, 1, 2)).pins == (kept[0], kept[2])
    assert span(edits.delete_outline(document, 1, 24, 2)).pins == kept
    other = document.layers[0].keyframes[1].drawing.without_outline(1)
    assert span(edits.put_drawing(document, 1, 1, other)).pins == kept[1:]


def test_a_span_with_another_end_forgets_arcs_and_one_without_end_its_pins():
    document = film(SpanPin(1, 3.0, handles=((0.0, 0.0), (9.0, 9.0))))
    drawing = document.layers[0].keyframes[0].drawing
    broken = edits.put_drawing(document, 1, 12, drawing)
    assert span(broken).pins == (SpanPin(1, 3.0),)
    assert broken.layers[0].keyframes[1].span.pins == ()
    assert span(edits.delete_keyframe(document, 1, 24)).pins == ()
    assert span(edits.move_keyframe(document, 1, 24, 20)).pins == span(document).pins


def test_pins_are_added_moved_bent_and_deleted():
    document = film(SpanPin(1, 3.0))
    assert edits.add_pin(document, 1, 1, SpanPin(1, 3.0, handles=((0.0, 0.0), (1.0, 1.0)))) is document
    moved = edits.move_pin(document, 1, 1, 0, SpanPin(place=(900.0, 540.0)))
    assert span(moved).pins == (SpanPin(place=(900.0, 540.0)),)
    bent = edits.set_pin_handles(moved, 1, 1, 0, ((0.0, 0.0), (1.0, 1.0)))
    assert span(bent).pins[0].handles == ((0.0, 0.0), (1.0, 1.0))
    assert edits.move_pin(bent, 1, 1, 0, SpanPin(1, 3.0)) != bent
    assert edits.set_pin_handles(bent, 1, 1, 0, ((0.0, 0.0), (1.0, 1.0))) is bent
    assert edits.set_pin_handles(bent, 1, 1, 0, None) == moved
    assert edits.move_pin(document, 1, 1, 0, SpanPin(1, 3.0)) is document
    assert edits.delete_pin(document, 1, 1, 0) == film()
    assert edits.clear_pins(bent, 1, 1) == film()
    assert edits.clear_pins(film(), 1, 1) == film()


@pytest.mark.parametrize(
    ("edit", "reason"),
    [
        (lambda d: edits.add_pin(d, 1, 1, SpanPin(9, 0.0)), "no outline 9"),
        (lambda d: edits.add_pin(d, 1, 1, SpanPin(1, 24.5)), r"a pin at 24.5 on outline 1, which ends at 24"),
        (lambda d: edits.add_pin(d, 1, 24, SpanPin(1, 0.0)), "no span begins at frame 24"),
        (lambda d: edits.add_pin(d, 1, 2, SpanPin(1, 0.0)), "no keyframe at frame 2"),
        (lambda d: edits.delete_pin(d, 1, 1, 2), r"no pin 2; it has 2"),
        (lambda d: edits.move_pin(d, 1, 1, 0, SpanPin(1, 5.0)), "there is a pin already"),
        (lambda d: SpanPin(), "either on an outline or at a place"),
        (lambda d: SpanPin(1, np.nan), "not a finite number"),
        (lambda d: SpanPin(place=(2e9, 0.0)), "beyond 1e[+]09 px"),
        (lambda d: SpanPin(1, handles=((np.nan, 0.0), (0.0, 0.0))), "beyond 1e[+]09 px"),
        (lambda d: Span(pins=tuple(SpanPin(1, k) for k in range(201))), "201 pins in one span"),
    ],
)
def test_what_cannot_be_pinned_is_refused_with_a_reason(edit, reason):
    with pytest.raises(DocumentError, match=reason):
        edit(film(SpanPin(1, 3.0), SpanPin(1, 5.0)))


PINS = SpanPin(1, 3.0), SpanPin(2, 1.25, handles=((-1.0, 2.0), (3.5, 4.0))), SpanPin(place=(900.0, 500.0))


def test_pins_come_back_from_a_file_and_cost_nothing_where_there_are_none():
    document = film(*PINS)
    assert decode(encode(document)) == document
    assert encode(decode(encode(document))) == encode(document)
    assert b"pins" not in encode(film())
    plain = film(SpanPin(1, np.float64(3)), SpanPin(2, 1.25, handles=np.array(PINS[1].handles)), PINS[2])
    assert encode(plain) == encode(document)


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (b'{"outline":1,"position":3.0}', b'{"outline":1}', "has both `outline` and `position`"),
        (b'{"outline":1,"position":3.0}', b'{"place":[1,2],"position":3.0}', "has both `outline` and `position`"),
        (b'{"outline":1,"position":3.0}', b"{}", "either on an outline or at a place"),
        (b'"outline":1,"position":3.0', b'"outline":1,"position":24.1', "which ends at 24"),
        (b'"outline":1,"position":3.0', b'"outline":7,"position":3.0', "no outline 7"),
        (b'"outline":1,"position":3.0', b'"outline":1,"position":NaN', "damaged"),
        (b'"outline":1,"position":3.0', b'"outline":1,"at":3.0', "unknown field `at`"),
        (b"[3.5,4.0]", b"[3.5]", "length 2"),
        (b"[3.5,4.0]", b"[3.5,4e9]", "beyond"),
    ],
)
def test_a_wrong_pin_in_a_file_is_refused_with_its_place(old, new, reason):
    content = encode(film(*PINS))
    assert old in content
    with pytest.raises(FileFormatError, match=reason) as caught:
        decode(content.replace(old, new))
    assert "damaged" in str(caught.value) or "keyframes[0].span.pins[" in str(caught.value).replace("...", "0")


def test_pins_of_the_last_keyframe_are_refused():
    document = film()
    layer = document.layers[0]
    last = replace(layer.keyframes[1], span=Span(pins=(SpanPin(1, 3.0),)))
    wrong = document.with_layer(replace(layer, keyframes=(layer.keyframes[0], last)))
    with pytest.raises(FileFormatError, match="a pin in the span of the last keyframe"):
        decode(encode(wrong))


def test_the_plans_notice_a_changed_pin():
    plans = PlanCache()
    for document in (film(), film(SpanPin(1, 3.0)), film(SpanPin(1, 3.0, handles=((0.0, 0.0), (9.0, 9.0))))):
        plans.plan(*document.layers[0].keyframes)
    assert plans.solved == 3


def test_a_pin_on_an_outline_that_shrinks_away_ends_where_it_does():
    document = film(SpanPin(2, 3.0))
    document = edits.delete_outline(document, 1, 24, 2)
    path = way(document)
    plan = planned(document)
    row = [link.before for link in plan.links].index(2)
    assert np.allclose(path[-1], plan.links[row].aligned.right[0])


def test_a_repair_leaves_pins_on_their_arcs():
    up, down = (((960.0, y), (960.0, y)) for y in (300.0, 780.0))
    document = film(SpanPin(1, 6.0, handles=up), SpanPin(1, 18.0, handles=down))
    for frame in (1, 24):
        document = edits.delete_outline(document, 1, frame, 2)
    document = edits.set_span(document, 1, 1, repair=True)
    paths = planned(document).paths
    held = paths.plan.drawing.paths.held
    frames = np.concatenate(paths.plan.evaluate(TIMES), axis=1)
    off = np.abs(held.at(frames[..., 0] + 1j * frames[..., 1]) - held.wanted(TIMES)).max()
    assert paths.plan.changed
    assert off < 1e-9 * 1000
    assert paths.notes == ()
