"""The easing's curve and the timing chart beside it, by mouse and keys."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication

from core.model.document import Document
from core.model.easing import PRESETS, Easing
from core.model.edits import add_outline, set_layer, set_span, set_step
from core.model.timing import exposures_in
from core.model.timing_edits import ticks_of
from tests.app.conftest import ALT, LEFT, NONE, move_pointer
from tests.app.sketches import square


@pytest.fixture
def panel(hand):
    """The easing panel over three keyframes, the playhead in the first span."""
    document = Document(length=40)
    for frame, x in ((1, 300), (13, 700), (30, 1100)):
        document = add_outline(document, 1, frame, square(x, 300.0, 300.0))
    for frame in (1, 13):
        document = set_span(document, 1, frame, method="linear")
    hand.session.new(document)
    hand.session.go_to(5)
    return hand.editor.window.easing_panel


def span(panel):
    return panel.session.layer.keyframes[0].span


def held(panel):
    return exposures_in(span(panel), 12)


def ts(panel):
    return [t for _, t in ticks_of(span(panel), 12)]


def choose(box, text):
    """Choose from a combo box as the keyboard does."""
    box.setFocus()
    box.setCurrentText(text)
    box.activated.emit(box.currentIndex())


def drag(hand, widget, start, *way, release=True):
    QTest.mousePress(widget, LEFT, NONE, start)
    for at in way:
        hand.move_on(widget, at)
    if release:
        QTest.mouseRelease(widget, LEFT, NONE, way[-1])


def wheel(widget, at, up):
    angle = QPoint(0, 120 if up else -120)
    where = QPointF(at)
    event = QWheelEvent(
        where,
        QPointF(widget.mapToGlobal(at)),
        QPoint(),
        angle,
        Qt.MouseButton.NoButton,
        NONE,
        Qt.ScrollPhase.NoScrollPhase,
        False,
    )
    QApplication.sendEvent(widget, event)


def grip(panel, index, part):
    return next(p.toPoint() for g, p in panel.plot.grips() if g == (index, part))


# the curve


def test_a_dragged_handle_changes_the_curve_live_in_one_step(hand, panel) -> None:
    start = grip(panel, None, "out")
    drag(hand, panel.plot, start, start + QPoint(10, 20), start + QPoint(30, 40), release=False)
    live = span(panel).easing
    assert live.x1 > 1 / 3
    assert live.y1 < 1 / 3
    QTest.mouseRelease(panel.plot, LEFT, NONE, start + QPoint(30, 40))
    assert span(panel).easing == live
    assert panel.session.undo_stack.count() == 1
    hand.menu("edit.undo")
    assert span(panel).easing == Easing()


def test_escape_gives_a_drag_of_a_handle_up(hand, panel) -> None:
    start = grip(panel, None, "in")
    drag(hand, panel.plot, start, start + QPoint(10, 40), release=False)
    assert span(panel).easing != Easing()
    hand.key(Qt.Key.Key_Escape, into=panel.plot)
    QTest.mouseRelease(panel.plot, LEFT, NONE, start)
    assert span(panel).easing == Easing()
    assert panel.session.undo_stack.count() == 0


def test_the_plot_makes_room_for_what_overshoots(hand, panel) -> None:
    choose(panel.presets, "overshoot")
    assert span(panel).easing == PRESETS["overshoot"]
    assert 0 < panel.plot.place(0.5, 1.4).y() < panel.plot.y_of(1.0)
    start = grip(panel, None, "in")
    drag(hand, panel.plot, start, start - QPoint(0, 60), start - QPoint(0, 120))
    assert span(panel).easing.y2 > 1.9
    assert 0 <= panel.plot.y_of(span(panel).easing.y2) <= panel.plot.height()


def test_a_double_click_on_the_curve_adds_a_knot_and_one_on_the_knot_takes_it_away(hand, panel) -> None:
    at = panel.plot.place(0.5, 0.5).toPoint()
    QTest.mouseDClick(panel.plot, LEFT, NONE, at)
    (knot,) = span(panel).easing.knots
    assert (knot.x, knot.y) == pytest.approx((0.5, 0.5), abs=0.02)
    assert span(panel).easing.t_at(np.linspace(0, 1, 9)) == pytest.approx(np.linspace(0, 1, 9), abs=1e-6)
    drag(hand, panel.plot, at, at - QPoint(0, 20), at - QPoint(10, 40))
    moved = span(panel).easing.knots[0]
    assert moved.x < knot.x
    assert moved.y > knot.y + 0.2
    QTest.mouseDClick(panel.plot, LEFT, NONE, grip(panel, 0, "knot"))
    assert span(panel).easing.knots == ()


def test_the_chosen_knot_has_handles_and_follows_the_arrow_keys(hand, panel) -> None:
    choose(panel.presets, "bounce")
    QTest.mouseClick(panel.plot, LEFT, NONE, grip(panel, 1, "knot"))
    assert panel.plot.chosen == 1
    grips = [g for g, _ in panel.plot.grips()]
    assert (1, "in") in grips
    assert (1, "out") in grips
    hand.session.go_to(20)
    assert panel.plot.chosen is None  # a knot of the other span
    hand.session.go_to(5)
    QTest.mouseClick(panel.plot, LEFT, NONE, grip(panel, 1, "knot"))
    before = span(panel).easing.knots[1]
    hand.key(Qt.Key.Key_Up, into=panel.plot)
    hand.key(Qt.Key.Key_Up, into=panel.plot)
    assert span(panel).easing.knots[1].y == pytest.approx(before.y + 0.02)
    assert panel.session.undo_stack.count() == 2  # the preset, and the two keys together
    hand.key(Qt.Key.Key_Delete, into=panel.plot)
    assert len(span(panel).easing.knots) == len(PRESETS["bounce"].knots) - 1


def test_alt_moves_one_handle_of_a_knot_alone(hand, panel) -> None:
    QTest.mouseDClick(panel.plot, LEFT, NONE, panel.plot.place(0.5, 0.5).toPoint())
    other = span(panel).easing.knots[0][2:4]
    start = grip(panel, 0, "out")
    drag(hand, panel.plot, start, start + QPoint(0, 15))
    turned = span(panel).easing.knots[0]
    assert turned[2:4] != other
    start = grip(panel, 0, "out")
    QTest.mousePress(panel.plot, LEFT, NONE, start)
    move_pointer(panel.plot, start - QPoint(0, 20), ALT, LEFT)
    QTest.mouseRelease(panel.plot, LEFT, ALT, start - QPoint(0, 20))
    assert span(panel).easing.knots[0][2:4] == turned[2:4]
    assert span(panel).easing.knots[0][4:] != turned[4:]


# the chart


def test_the_ladder_has_a_tick_for_every_drawing_at_the_heights_of_the_curve(hand, panel) -> None:
    choose(panel.presets, "slow in and out")
    assert len(panel.chart.spacing.ticks) == 12
    for i, (offset, t) in enumerate(panel.chart.spacing.ticks):
        assert panel.chart.tick_place(i).y() == panel.plot.place(offset / 12, t).y()


def test_a_dragged_tick_takes_its_drawing_along_and_no_other(hand, panel) -> None:
    QTest.mouseClick(panel.steps.button("3"), LEFT)
    old = ts(panel)
    start = panel.chart.at(2)
    drag(hand, panel.chart, start, start - QPoint(0, 10), start - QPoint(0, 20), release=False)
    assert ts(panel)[2] > old[2] + 0.1  # live
    QTest.mouseRelease(panel.chart, LEFT, NONE, start - QPoint(0, 20))
    new = ts(panel)
    assert [new[i] for i in (0, 1, 3)] == pytest.approx([old[i] for i in (0, 1, 3)], abs=1e-12)
    assert panel.session.undo_stack.count() == 2
    assert panel.session.frame == 7  # the press went to the drawing
    assert panel.presets.currentText() == "own curve"


def test_escape_gives_a_dragged_tick_up(hand, panel) -> None:
    document, start = panel.session.document, panel.chart.at(5)
    drag(hand, panel.chart, start, start - QPoint(0, 20), release=False)
    assert panel.session.document != document
    hand.key(Qt.Key.Key_Escape, into=panel.chart)
    QTest.mouseRelease(panel.chart, LEFT, NONE, start)
    assert panel.session.document is document
    assert panel.session.undo_stack.count() == 0


def test_a_drag_stays_with_its_span_while_the_film_plays_on(hand, panel) -> None:
    second, start = panel.session.layer.keyframes[1].span, panel.chart.at(5)
    drag(hand, panel.chart, start, start - QPoint(0, 10), release=False)
    once = ts(panel)[5]
    hand.session.go_to(20)
    hand.move_on(panel.chart, start - QPoint(0, 20))
    QTest.mouseRelease(panel.chart, LEFT, NONE, start - QPoint(0, 20))
    assert ts(panel)[5] > once
    assert panel.session.layer.keyframes[1].span is second


def test_a_click_on_a_tick_goes_to_its_frame_and_the_keys_go_on_from_there(hand, panel) -> None:
    QTest.mouseClick(panel.steps.button("2"), LEFT)
    QTest.mouseClick(panel.chart, LEFT, NONE, panel.chart.at(3))
    assert panel.session.frame == 7
    assert "frame 7" in panel.note.text()
    assert "held 2 frames" in panel.note.text()
    hand.key(Qt.Key.Key_Right, into=panel.chart)
    assert panel.session.frame == 9
    hand.key(Qt.Key.Key_Left, into=panel.chart)
    hand.key(Qt.Key.Key_Left, into=panel.chart)
    assert panel.session.frame == 5
    before = ts(panel)[2]
    hand.key(Qt.Key.Key_Up, into=panel.chart)
    hand.key(Qt.Key.Key_Up, into=panel.chart)
    assert ts(panel)[2] == pytest.approx(before + 0.02)
    hand.menu("edit.undo")
    assert ts(panel)[2] == pytest.approx(before)


def test_plus_minus_wheel_and_field_change_how_long_a_drawing_is_held(hand, panel) -> None:
    QTest.mouseClick(panel.steps.button("2"), LEFT)
    QTest.mouseClick(panel.chart, LEFT, NONE, panel.chart.at(1))
    panel.chart.setFocus()
    hand.key(Qt.Key.Key_Plus, into=panel.chart)
    assert held(panel) == (2, 3, 1, 2, 2, 2)
    hand.key(Qt.Key.Key_Minus, into=panel.chart)
    assert held(panel) == (2,) * 6
    wheel(panel.chart, panel.chart.at(1), up=True)
    assert held(panel) == (2, 3, 1, 2, 2, 2)
    assert panel.held_field.value() == 3
    panel.held_field.setFocus()
    panel.held_field.selectAll()
    QTest.keyClicks(panel.held_field, "6")
    QTest.keyClick(panel.held_field, Qt.Key.Key_Return)
    assert held(panel) == (2, 6, 2, 2)


def test_the_wheel_scrolls_the_panel_as_long_as_nobody_works_on_the_chart(hand, panel) -> None:
    hand.canvas.setFocus()
    wheel(panel.chart, panel.chart.at(4), up=True)
    assert panel.session.undo_stack.count() == 0


def test_halves_and_thirds_are_added_and_drawings_deleted_from_the_menu(hand, panel) -> None:
    hand.session.show_document(set_step(hand.session.document, 1, 1, 6))
    first, second = panel.chart.tick_place(0), panel.chart.tick_place(1)
    menu = panel.chart.menu_at((first + second) / 2)
    entries = {a.text(): a for a in menu.actions()}
    entries["Add Thirds"].trigger()
    assert held(panel) == (2, 2, 2, 6)
    assert ts(panel) == pytest.approx([0, 1 / 6, 1 / 3, 0.5])
    menu = panel.chart.menu_at((panel.chart.tick_place(3) + panel.chart.tick_place(4)) / 2)
    {a.text(): a for a in menu.actions()}["Add Half"].trigger()
    assert held(panel) == (2, 2, 2, 3, 3)
    menu = panel.chart.menu_at(panel.chart.tick_place(1))
    {a.text(): a for a in menu.actions()}["Delete Drawing"].trigger()
    assert held(panel) == (4, 2, 3, 3)
    assert panel.session.undo_stack.count() == 3


def test_the_buttons_divide_the_way_from_the_drawing_at_the_playhead(hand, panel) -> None:
    QTest.mouseClick(panel.steps.button("3"), LEFT)
    hand.session.go_to(5)
    QTest.mouseClick(panel.half, LEFT)
    assert held(panel) == (3, 2, 1, 3, 3)
    QTest.mouseClick(panel.delete, LEFT)
    assert held(panel) == (5, 1, 3, 3)
    hand.session.go_to(6)
    QTest.mouseClick(panel.half, LEFT)
    assert "hold it longer" in hand.message


def test_ones_twos_threes_and_any_other_number(hand, panel) -> None:
    for step in ("2", "3", "1"):
        QTest.mouseClick(panel.steps.button(step), LEFT)
        assert span(panel).step == int(step)
        assert panel.steps.button(step).isChecked()
        assert panel.step_field.value() == int(step)
    assert panel.session.undo_stack.count() == 3
    panel.step_field.setFocus()
    panel.step_field.selectAll()
    QTest.keyClicks(panel.step_field, "4")
    QTest.keyClick(panel.step_field, Qt.Key.Key_Return)
    assert held(panel) == (4, 4, 4)
    assert not any(panel.steps.button(s).isChecked() for s in "123")
    QTest.mouseClick(panel.chart, LEFT, NONE, panel.chart.at(1))
    hand.key(Qt.Key.Key_Plus, into=panel.chart)
    assert panel.step_field.text() == "own"
    QTest.mouseClick(panel.steps.button("2"), LEFT)
    assert held(panel) == (2,) * 6


def test_hold_is_a_preset_and_any_other_one_ends_it(hand, panel) -> None:
    choose(panel.presets, "hold")
    assert span(panel).hold
    assert len(panel.chart.spacing.ticks) == 1
    assert not panel.steps.isEnabled()
    assert panel.presets.currentText() == "hold"
    choose(panel.presets, "slow in")
    assert not span(panel).hold
    assert span(panel).easing == PRESETS["slow in"]


def test_keyframes_are_smooth_or_sharp_where_two_spans_meet(hand, panel) -> None:
    first, second = panel.smooth
    assert not first.isEnabled()  # the layer's first one
    assert second.text() == "13"
    QTest.mouseClick(second, LEFT, NONE, QPoint(8, second.height() // 2))
    assert panel.session.layer.keyframes[1].smooth
    hand.session.go_to(20)
    assert panel.smooth[0].isChecked()
    hand.menu("key.smooth_layer")
    assert [k.smooth for k in panel.session.layer.keyframes] == [True, True, True]
    hand.menu("key.sharp_layer")
    assert not any(k.smooth for k in panel.session.layer.keyframes)
    assert panel.session.undo_stack.count() == 3


def test_a_locked_layer_refuses_with_a_sentence_and_shows_what_it_has(hand, panel) -> None:
    hand.session.show_document(set_layer(hand.session.document, 1, locked=True))
    document = panel.session.document
    QTest.mouseClick(panel.steps.button("2"), LEFT)
    assert "locked" in hand.message
    assert panel.steps.button("1").isChecked()
    start = panel.chart.at(4)
    drag(hand, panel.chart, start, start - QPoint(0, 30))
    choose(panel.presets, "slow in")
    assert panel.presets.currentText() == "linear"
    assert panel.session.document is document


def test_without_a_span_there_is_nothing_to_edit(hand, panel) -> None:
    hand.session.go_to(35)
    for widget in (panel.presets, panel.plot, panel.chart, panel.steps, panel.half, *panel.smooth[1:]):
        assert not widget.isEnabled()
    QTest.mouseClick(panel.chart, LEFT, NONE, QPoint(30, 60))
    assert panel.note.text() == ""


def test_a_section_folds_at_its_title_and_stays_so(hand, panel, settings) -> None:
    QTest.mouseClick(panel.title.parentWidget(), LEFT, NONE, QPoint(40, 5))
    assert not panel.plot.isVisible()
    assert settings.flag("folded/easing", False)
    QTest.mouseClick(panel.arrow, LEFT)
    assert panel.plot.isVisible()
    assert not settings.flag("folded/easing", True)


def test_the_pointer_rests_on_a_tick_that_an_edit_takes_away(panel, hand) -> None:
    chart = panel.chart
    move_pointer(chart, chart.at(10), NONE, Qt.MouseButton.NoButton)
    panel.session.apply("Step", set_step, 1, 1, 6)
    assert len(chart.spacing.ticks) == 2
    picture = chart.grab().toImage()
    move_pointer(chart, QPoint(0, 0), NONE, Qt.MouseButton.NoButton)
    assert picture == chart.grab().toImage()
