"""Open outlines as strokes, and drawings of several outlines, drawn and edited as a person does."""

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest

from core.model.document import Document
from core.model.edits import add_outline, set_span, set_style
from core.model.motion import picture_at
from tests.app.conftest import ALT, LEFT, NONE, SHIFT
from tests.app.sketches import square

ZIGZAG = ((400.0, 300.0), (800.0, 500.0), (1200.0, 300.0))
LOW = tuple((x + 100, y + 400) for x, y in ZIGZAG)


def outlines(hand, frame=1):
    keyframe = hand.session.layer.keyframe_at(frame)
    return keyframe.drawing.outlines if keyframe else ()


def choose_kind(hand, kind):
    QTest.mouseClick(hand.editor.window.drawing_panel.kinds.button(kind), LEFT)
    hand.canvas.setFocus()


@pytest.fixture
def strokes(hand, qtbot):
    """Two keyframes of a stroke, thin and thick, with the playhead between them."""
    document = add_outline(Document(), 1, 1, np.array(ZIGZAG), closed=False)
    document = add_outline(document, 1, 13, np.array(LOW), closed=False)
    thick = replace(document.layers[0].keyframes[1].drawing.style, width=40.0)
    hand.session.new(set_style(document, 1, 13, thick))
    hand.session.go_to(7)
    hand.settle(qtbot)
    return hand


# drawing them


def end_with_shift_enter(hand):
    hand.key(Qt.Key.Key_Return, SHIFT)


def end_with_double_click(hand):
    QTest.mouseDClick(hand.canvas.viewport(), LEFT, NONE, hand.view(ZIGZAG[-1]))


def end_with_right_click(hand):
    QTest.mouseClick(hand.canvas.viewport(), Qt.MouseButton.RightButton, NONE, hand.view((100.0, 100.0)))


@pytest.mark.parametrize("end", [end_with_shift_enter, end_with_double_click, end_with_right_click])
def test_the_pen_leaves_an_outline_open_in_three_ways(hand, end) -> None:
    hand.key(Qt.Key.Key_P)
    hand.click(*ZIGZAG)
    end(hand)
    (outline,) = outlines(hand)
    assert not outline.closed
    assert len(outline.points) == 3
    assert not hand.canvas.tool.busy


def test_with_open_outlines_chosen_enter_leaves_open_and_shift_enter_closes(hand, settings) -> None:
    choose_kind(hand, "open")
    assert not settings.flag("pen/closed", True)
    hand.key(Qt.Key.Key_P)
    hand.click(*ZIGZAG)
    hand.key(Qt.Key.Key_Return)
    hand.click(*LOW)
    hand.key(Qt.Key.Key_Return, SHIFT)
    assert [o.closed for o in outlines(hand)] == [False, True]


@pytest.mark.parametrize(
    ("kind", "held", "closed"),
    [("closed", NONE, True), ("closed", ALT, False), ("open", NONE, False), ("open", ALT, True)],
)
def test_the_pencil_draws_what_is_chosen_and_with_alt_the_other(hand, kind, held, closed) -> None:
    choose_kind(hand, kind)
    hand.key(Qt.Key.Key_B)
    hand.drag((300.0, 300.0), (600.0, 600.0), (900.0, 300.0), (600.0, 250.0), held=held)
    assert [o.closed for o in outlines(hand)] == [closed]


def test_a_new_open_outline_is_seen_in_the_colour_of_the_fill(hand) -> None:
    hand.key(Qt.Key.Key_P)
    hand.click((400.0, 500.0), (1400.0, 500.0))
    end_with_shift_enter(hand)
    hand.menu("view.final")
    shown = hand.picture().pixelColor(hand.view((900.0, 500.0)))
    fill = QColor(hand.session.layer.keyframes[0].drawing.style.fill)
    assert max(abs(shown.red() - fill.red()), abs(shown.green() - fill.green())) < 40
    panel = hand.editor.window.drawing_panel
    assert "colour of the fill" in panel.about.text()
    QTest.mouseClick(panel.stroke_on, LEFT, NONE, QPoint(8, panel.stroke_on.height() // 2))
    assert "the fill is not for them" in panel.about.text()
    QTest.mouseClick(panel.fill_on, LEFT, NONE, QPoint(8, panel.fill_on.height() // 2))
    assert panel.about.text() == ""


def test_opacity_of_the_drawings_at_the_playhead_is_one_step(strokes) -> None:
    panel = strokes.editor.window.drawing_panel
    panel.opacity_field.setFocus()
    panel.opacity_field.selectAll()
    QTest.keyClicks(panel.opacity_field, "50")
    QTest.keyClick(panel.opacity_field, Qt.Key.Key_Return)
    assert [k.drawing.style.opacity for k in strokes.session.layer.keyframes] == [0.5, 0.5]
    assert panel.opacity.value() == 50
    strokes.menu("edit.undo")
    assert [k.drawing.style.opacity for k in strokes.session.layer.keyframes] == [1.0, 1.0]


# in-between


@pytest.mark.parametrize("method", ["linear", "intrinsic", "rigid", "auto"])
def test_strokes_in_between_stay_strokes_whose_ends_go_to_ends_and_whose_width_changes(
    strokes, qtbot, method
) -> None:
    session = strokes.session
    session.apply("method", set_span, 1, 1, method=method)
    strokes.settle(qtbot)
    about = strokes.editor.window.span_panel.about.text()
    assert ("as with intrinsic" in about) == (method == "rigid")
    content = strokes.canvas.content
    (link,) = content.plan.links
    assert (link.before_positions[0], link.before_positions[-1]) == (0, 2)
    assert (link.after_positions[0], link.after_positions[-1]) == (0, 2)
    for frame in range(1, 14):
        picture = picture_at(session.document, session.layer, frame, strokes.editor.preview)
        ((points, closed),) = picture.outlines
        assert not closed
        assert np.isfinite(points).all()
        assert picture.style.width == pytest.approx(4 + 36 * (frame - 1) / 12)
        shift = np.multiply((100, 400), (frame - 1) / 12)
        assert points[[0, -1]] == pytest.approx(np.array(ZIGZAG)[[0, 2]] + shift, abs=1)


def test_a_stroke_has_no_inside_on_the_canvas(strokes) -> None:
    strokes.menu("view.onion")
    inside, outside = (900.0, 560.0), (900.0, 900.0)  # in the notch of the in-between, and far away
    shown = strokes.picture()
    assert shown.pixelColor(strokes.view(inside)) == shown.pixelColor(strokes.view(outside))


# editing them


def test_vertices_of_a_stroke_are_moved_added_and_deleted(hand, qtbot) -> None:
    hand.session.new(add_outline(Document(), 1, 1, np.array(ZIGZAG), closed=False))
    hand.settle(qtbot)
    hand.drag(ZIGZAG[0], (420.0, 320.0), (300.0, 400.0))
    assert outlines(hand)[0].points[0] == pytest.approx((300, 400), abs=3)
    hand.double_click((1000.0, 400.0))
    assert len(outlines(hand)[0].points) == 4
    hand.double_click((750.0, 350.0))  # where the closing edge of a closed outline would run
    assert len(outlines(hand)[0].points) == 4
    hand.click((1200.0, 300.0))
    hand.key(Qt.Key.Key_Delete)
    assert len(outlines(hand)[0].points) == 3
    assert not outlines(hand)[0].closed


def test_a_hole_is_edited_with_the_same_tools_as_what_is_around_it(hand, qtbot) -> None:
    document = Document()
    for frame, x in ((1, 400.0), (13, 700.0)):
        document = add_outline(document, 1, frame, square(x, 200.0, 600.0))
        document = add_outline(document, 1, frame, square(x + 200, 400.0, 200.0))
    hand.session.new(set_span(document, 1, 1, method="linear"))
    hand.settle(qtbot)
    hand.drag((600.0, 400.0), (590.0, 390.0), (550.0, 350.0))
    assert outlines(hand)[1].points[0] == pytest.approx((550, 350), abs=3)
    hand.double_click((700.0, 600.0))
    assert [len(o.points) for o in outlines(hand)] == [4, 5]
    hand.key(Qt.Key.Key_Delete)
    assert [len(o.points) for o in outlines(hand)] == [4, 4]
    hand.settle(qtbot)
    pairs = [(link.before, link.after) for link in hand.canvas.content.plan.links]
    assert pairs == [(1, 1), (2, 2)]
    middle = picture_at(hand.session.document, hand.session.layer, 7, hand.editor.preview)
    assert [closed for _, closed in middle.outlines] == [True, True]


# what a held drawing is called


def test_labels_say_which_drawing_is_held(strokes) -> None:
    canvas = strokes.canvas
    assert canvas.content.drawing_words == ""
    strokes.editor.window.easing_panel.steps.button("3").click()
    strokes.session.go_to(9)
    assert canvas.content.drawing_words == ", drawing of 7"
    strokes.session.apply("hold", set_span, 1, 1, hold=True)
    assert canvas.content.is_held
    assert "Held" in strokes.editor.window.span_panel.about.text()
    strokes.session.go_to(1)
    assert not canvas.content.is_held


def test_looking_at_a_drawing_does_not_round_its_style(strokes) -> None:
    fine = replace(strokes.session.layer.keyframes[0].drawing.style, width=1.3333, opacity=0.3333)
    strokes.session.new(set_style(strokes.session.document, 1, 1, fine))
    for frame in (13, 1):
        strokes.session.go_to(frame)
    assert strokes.session.undo_stack.count() == 0
    assert strokes.session.layer.keyframes[0].drawing.style == fine
