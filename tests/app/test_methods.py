"""Methods, placement and turns of a span in the window."""

import numpy as np
import pytest
from PySide6.QtCore import QEvent, QPoint, QPointF
from PySide6.QtGui import QColor, QEnterEvent
from PySide6.QtWidgets import QApplication

from app.canvas.heat import CELLS, MARGIN, heat_picture
from app.theme import DARK
from core.certificate.inside import inner_stretch
from core.methods.plan import AlignedPair, plan
from core.model.edits import set_span
from tests.app.sketches import ring, swing


@pytest.fixture
def swinging(hand, qtbot):
    """The hand, in the middle of a span that crosses itself."""
    hand.session.new(swing(2.0))
    hand.session.go_to(8)
    hand.certify(qtbot)
    return hand


def point_at(button):
    """Rest the pointer on a button."""
    at = QPointF(button.rect().center())
    QApplication.sendEvent(button, QEnterEvent(at, at, QPointF(button.mapToGlobal(at.toPoint()))))


def leave(button):
    QApplication.sendEvent(button, QEvent(QEvent.Type.Leave))


def shown(hand):
    return hand.canvas.content.picture.outlines[0][0]


def test_the_method_under_the_pointer_is_shown_as_long_as_it_rests_there(swinging):
    panel, document = swinging.editor.window.span_panel, swinging.session.document
    own = shown(swinging)
    for method in ("intrinsic", "linear"):
        point_at(panel.methods.button(method))
        tried = shown(swinging)
        assert np.array_equal(tried, own) == (method == "linear")
        leave(panel.methods.button(method))
        assert np.array_equal(shown(swinging), own)
    assert swinging.session.document is document
    assert not swinging.session.undo_stack.canUndo()


def test_a_slow_method_under_the_pointer_is_solved_beside_the_window_and_then_shown(swinging, qtbot):
    panel = swinging.editor.window.span_panel
    point_at(panel.methods.button("rigid"))
    assert swinging.canvas.content.waiting
    swinging.settle(qtbot)
    assert swinging.canvas.content.plan.paths.method == "rigid"
    leave(panel.methods.button("rigid"))
    assert swinging.canvas.content.plan.paths.method == "linear"
    assert not swinging.canvas.content.waiting


def test_a_click_takes_the_method_that_is_shown(swinging):
    button = swinging.editor.window.span_panel.methods.button("intrinsic")
    point_at(button)
    swinging.press_button(button)
    tried = shown(swinging)
    leave(button)
    assert np.array_equal(shown(swinging), tried)
    assert swinging.session.span_keyframes()[0].span.method == "intrinsic"


@pytest.mark.qt_log_ignore("This plugin does not support")
def test_the_span_menu_shows_the_method_under_the_pointer_until_it_closes(swinging):
    menu, own = swinging.editor.window.menus["Span"], shown(swinging)
    menu.popup(QPoint(0, 0))
    menu.setActiveAction(swinging.editor.window.table["span.intrinsic"])
    assert not np.array_equal(shown(swinging), own)
    menu.setActiveAction(swinging.editor.window.table["span.clear"])
    assert np.array_equal(shown(swinging), own)
    menu.setActiveAction(swinging.editor.window.table["span.intrinsic"])
    menu.close()
    assert np.array_equal(shown(swinging), own)


def test_another_frame_under_the_pointer_is_shown_by_that_method_too(swinging):
    button = swinging.editor.window.span_panel.methods.button("intrinsic")
    point_at(button)
    swinging.session.go_to(9)
    assert swinging.canvas.content.plan.paths.method == "intrinsic"
    leave(button)
    assert swinging.canvas.content.plan.paths.method == "linear"


def test_the_placement_is_chosen_in_one_step_and_not_for_linear(swinging):
    panel, session = swinging.editor.window.span_panel, swinging.session
    assert not panel.placement.isEnabled()
    session.apply("Change Method", set_span, 1, 3, method="intrinsic")
    assert panel.placement.isEnabled()
    still = shown(swinging)
    swinging.press_button(panel.placement.button("centroid"))
    assert session.span_keyframes()[0].span.placement == "centroid"
    moved = shown(swinging) - still
    assert np.abs(moved).max() > 1
    np.testing.assert_allclose(moved, np.broadcast_to(moved[0], moved.shape), atol=1e-9)
    session.undo_stack.undo()
    assert session.span_keyframes()[0].span.placement == "still"


def test_the_other_way_round_is_one_step_and_again_is_back(swinging):
    panel, session = swinging.editor.window.span_panel, swinging.session
    assert not panel.other_way.isEnabled()
    session.apply("Change Method", set_span, 1, 3, method="intrinsic")
    natural = swinging.canvas.content.plan.natural_turn
    swinging.press_button(panel.other_way)
    assert session.span_keyframes()[0].span.turns == (-1 if natural >= 0 else 1)
    assert panel.turns.value() == session.span_keyframes()[0].span.turns
    swinging.press_button(panel.other_way)
    assert session.span_keyframes()[0].span.turns == 0
    session.undo_stack.undo()
    assert session.span_keyframes()[0].span.turns != 0


def test_linear_says_that_it_turns_no_way_round(swinging):
    swinging.menu("span.other_way")
    assert "turns no way round" in swinging.message


def test_badly_tangled_straight_paths_are_offered_to_be_repaired_as_intrinsic(swinging, qtbot):
    panel, session = swinging.editor.window.certificate_panel, swinging.session
    assert panel.better.isVisible()
    assert panel.advice.text().startswith("The straight paths tangle")
    swinging.press_button(panel.better)
    span = session.span_keyframes()[0].span
    assert (span.method, span.repair) == ("intrinsic", True)
    swinging.certify(qtbot)
    assert not panel.better.isVisible()
    session.undo_stack.undo()
    span = session.span_keyframes()[0].span
    assert (span.method, span.repair) == ("linear", False)


def test_nothing_is_offered_where_the_paths_are_clean(hand, qtbot):
    hand.session.new(swing(0.3))
    hand.session.go_to(8)
    hand.certify(qtbot)
    assert not hand.editor.window.certificate_panel.better.isVisible()


# the heat inside


def inside(method, turn=1.5):
    """Stretch inside a blob that turns, half way."""
    a = ring(120)
    spin = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    pair = AlignedPair(a, (a - a.mean(axis=0)) @ spin + a.mean(axis=0))
    frame = plan(pair.left, pair.right, method=method).evaluate(0.5)[0]
    return inner_stretch([pair]).at([frame])


def test_what_only_turns_has_no_heat_and_what_linear_presses_together_is_all_cold():
    _, doublings, _ = inside("intrinsic")
    assert np.abs(doublings).max() < 1e-3
    _, doublings, _ = inside("linear")
    np.testing.assert_allclose(doublings, np.log2(np.cos(0.75)), atol=1e-3)


def test_the_keyframes_themselves_have_no_heat_inside_and_holes_are_left_out():
    outer, hole = ring(80), ring(40, radius=60.0)
    pairs = [AlignedPair(outer, outer * [1.5, 0.8]), AlignedPair(hole, hole * [1.5, 0.8])]
    made = inner_stretch(pairs)
    for ends in ([p.left for p in pairs], [p.right for p in pairs]):
        places, doublings, areas = made.at(ends)
        assert np.abs(doublings).max() < 1e-4
        middle = ends[1].mean(axis=0)
        assert np.linalg.norm(places - middle, axis=1).min() > 20
        assert areas.sum() == pytest.approx(_area(ends[0]) - _area(ends[1]), rel=0.01)


def _area(p):
    x, y = p.T
    return abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def test_without_an_inside_there_is_no_mesh():
    line = np.stack([np.linspace(0, 100, 9), np.zeros(9)], axis=1)
    assert inner_stretch([]) is None
    assert inner_stretch([AlignedPair(line, line + 5, closed=False)]) is None
    assert inner_stretch([AlignedPair(ring(20), ring(20)[::-1].copy())]) is None


def test_the_picture_of_the_heat_is_blue_where_it_is_cold_and_orange_where_it_is_stretched():
    places = np.array([[0.0, 0.0], [100.0, 50.0]])
    image, corner, cell = heat_picture(DARK, places, np.array([-1.0, 1.0]), np.array([4.0, 4.0]))
    assert image.width() == image.height() == CELLS + 2 * MARGIN + 1

    def color(place):
        x, y = ((np.array(place) - corner) / cell).astype(int).tolist()
        return QColor(image.pixel(x, y)).name()

    assert (color(places[0]), color(places[1])) == (DARK.shorter, DARK.longer)


def test_the_heat_fills_the_shape_and_only_it(swinging):
    swinging.session.apply("Change Method", set_span, 1, 3, method="intrinsic")
    swinging.editor.view_state.set(lines="none", onion=False)
    points = shown(swinging)
    middle = tuple(((points[5] + points[-6]) / 2).tolist())
    plain = swinging.picture()
    swinging.menu("view.heat")
    hot = swinging.picture()
    assert hot.pixel(swinging.view(middle)) != plain.pixel(swinging.view(middle))
    outside = swinging.view((20.0, 20.0))
    assert hot.pixel(outside) == plain.pixel(outside)
