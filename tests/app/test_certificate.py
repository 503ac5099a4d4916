"""The certificate in the window: which spans have one, the strip, the panel, the marks on the canvas."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtGui import QColor
from PySide6.QtTest import QTest

from app.canvas.heat import shade_color, shades_of
from app.theme import DARK, LIGHT
from app.view import ViewState
from core.model.document import Document, Keyframe, Layer, Span
from core.model.edits import set_span
from tests.app.conftest import LEFT, NONE, move_pointer
from tests.app.sketches import film, swing


@pytest.fixture
def crossing(hand, qtbot):
    """The hand, with a span open that crosses itself in its middle (frame 8)."""
    hand.session.new(swing(2.0))
    hand.session.go_to(5)
    hand.certify(qtbot)
    return hand


def certificate(hand):
    return hand.editor.certificates.of(*hand.session.span_keyframes())


def test_the_spans_of_the_layer_are_certified_when_the_hand_rests(hand, qtbot):
    document = film(length=12, size=(640, 480), side=200.0)
    layer = document.layers[0]
    hand.session.new(
        document.with_layer(replace(layer, keyframes=(*layer.keyframes, swing(2.0).layers[0].keyframes[1])))
    )
    assert certificate(hand) is None
    hand.certify(qtbot)
    assert certificate(hand).certificate.problems == ()
    assert hand.editor.certificates.of(*hand.session.layer.keyframes[1:]).frames == ()


def test_a_breakdown_beside_a_keyframe_leaves_a_span_without_in_betweens(crossing, qtbot):
    crossing.session.go_to(crossing.session.layer.frames()[1] - 1)
    crossing.key(Qt.Key.Key_F6)
    crossing.certify(qtbot)
    assert certificate(crossing).frames == ()
    assert crossing.editor.window.certificate_panel.section.note.text() == "no in-between"


def test_while_the_hand_drags_nothing_is_certified(crossing, qtbot):
    first = certificate(crossing)
    assert first.severity_at(8) == "error"
    gesture = crossing.session.begin("Change Turns")
    gesture.update(lambda d: set_span(d, 1, 3, method="intrinsic"))
    qtbot.wait(400)
    assert certificate(crossing) is None
    gesture.commit()
    crossing.certify(qtbot)
    assert certificate(crossing).severity_at(8) == ""
    crossing.menu("edit.undo")
    assert certificate(crossing) is first


def test_a_span_is_certified_again_only_when_its_plan_is_another_one(crossing, qtbot):
    first = certificate(crossing)
    crossing.editor.preview.planned.emit()
    crossing.certify(qtbot)
    assert certificate(crossing) is first


def test_a_repaired_span_is_certified_when_the_repair_is_there(crossing, qtbot):
    crossing.session.apply("Repair", set_span, 1, 3, repair=True)
    crossing.certify(qtbot)
    assert certificate(crossing).certificate.ok


def test_every_span_of_a_film_is_planned_and_certified_in_the_end(hand, qtbot):
    first, last = (k.drawing for k in swing(2.0).layers[0].keyframes)
    keys = tuple(Keyframe(1 + 5 * i, (first, last)[i % 2], Span("auto", repair=True)) for i in range(6))
    hand.session.new(Document(length=30, layers=(Layer(1, keyframes=keys),)))
    hand.session.go_to(13)
    hand.certify(qtbot)
    assert all(hand.editor.certificates.of(*pair) for pair in pairwise(keys))
    assert hand.editor.preview.settled


def test_scrubbing_does_not_begin_a_long_repair_anew(crossing, qtbot):
    crossing.session.apply("Repair", set_span, 1, 3, repair=True)
    for _ in range(8):
        for frame in (6, 7):
            crossing.session.go_to(frame)
            qtbot.wait(30)
    crossing.settle(qtbot)
    assert not crossing.editor.preview.waiting(crossing.session.span_keyframes()[0], crossing.session.layer.id)


# the strip


def spot(hand, frame):
    """The place of a frame on the first row's bar, beside its dot."""
    track = hand.editor.window.timeline.track
    at = track.key_place(hand.session.layer, frame).toPoint()
    return track, QPoint(at.x() + 3, at.y() + 3)


def strip_color(hand, frame):
    """The token whose colour the strip has there, most nearly by its hue."""
    track, at = spot(hand, frame)
    seen = QColor(track.grab().toImage().pixel(at)).hue()
    theme = hand.editor.window.theme
    tokens = ("good", "warning", "error", "accent")
    return min(tokens, key=lambda n: abs((theme.color(n).hue() - seen + 180) % 360 - 180))


def test_the_strip_is_coloured_frame_by_frame(crossing, qtbot):
    assert strip_color(crossing, 8) == "error"
    assert strip_color(crossing, 5) == "warning"
    crossing.session.apply("Repair", set_span, 1, 3, repair=True)
    crossing.certify(qtbot)
    assert strip_color(crossing, 8) != "error"


def test_a_clean_span_is_green_and_one_that_is_not_yet_certified_neutral(hand, qtbot):
    hand.session.new(film(length=12, size=(640, 480), side=200.0))
    assert strip_color(hand, 6) == "accent"
    hand.certify(qtbot)
    assert strip_color(hand, 6) == "good"
    hand.session.apply("Change Turns", set_span, 1, 1, turns=1)
    assert strip_color(hand, 6) == "accent"


def test_hovering_a_coloured_frame_names_its_problem_and_a_click_goes_there(crossing):
    track, at = spot(crossing, 8)
    move_pointer(track, at, NONE, Qt.MouseButton.NoButton)
    assert track.toolTip() == "Frame 8: edge 6 crosses edge 9"
    QTest.mouseClick(track, LEFT, NONE, at)
    assert crossing.session.frame == 8
    move_pointer(track, spot(crossing, 16)[1], NONE, Qt.MouseButton.NoButton)
    assert track.toolTip() == ""


def test_a_click_on_amber_or_red_goes_to_the_worst_of_these_frames_and_rings_its_place(hand, qtbot):
    hand.session.new(swing(1.9))
    hand.certify(qtbot)
    found = hand.editor.certificates.of(*hand.session.layer.keyframes)
    first, last, _ = next(run for run in found.runs if run[2] == "warning" and run[0] < run[1])
    track, at = spot(hand, first)
    QTest.mouseClick(track, LEFT, NONE, at)
    assert first < hand.session.frame == found.worst_near(first) <= last
    assert hand.canvas.marked == (found.worst[hand.session.frame].place, "warning")


def test_where_a_bar_is_green_a_click_goes_to_the_frame_itself(hand, qtbot):
    hand.session.new(swing(0.3))
    hand.certify(qtbot)
    track, at = spot(hand, 9)
    QTest.mouseClick(track, LEFT, NONE, at)
    assert hand.session.frame == 9
    assert hand.canvas.marked is None


# the panel


@pytest.fixture
def panel(crossing):
    return crossing.editor.window.certificate_panel


def test_the_panel_plots_the_measures_with_the_playhead_in_them(crossing, panel):
    frames, area = panel.plot.curves["area"].getData()
    assert frames.tolist() == list(range(4, 13))
    assert (area.min(), area.max()) == pytest.approx((0, 1))
    assert panel.plot.playhead.value() == 5
    crossing.session.go_to(9)
    assert panel.plot.playhead.value() == 9


def test_the_panel_lists_the_worst_of_every_kind_errors_first(panel):
    assert panel.section.note.text() == "7 errors"
    assert [row.text() for row in panel.rows] == ["frame 8: edge 6 crosses 9", "frame 8: area × 0.51"]
    assert panel.rows[0].toolTip() == "frame 8: edge 6 crosses edge 9"


def test_a_click_on_a_problem_goes_there_and_rings_its_place_until_the_playhead_moves(crossing, panel):
    crossing.press_button(panel.rows[0])
    assert crossing.session.frame == 8
    place, token = crossing.canvas.marked
    assert place == certificate(crossing).worst[8].place
    assert token == "error"
    ringed = crossing.picture()
    crossing.canvas.mark(None)
    assert crossing.picture() != ringed
    crossing.press_button(panel.rows[1])
    assert crossing.canvas.marked[1] == "warning"
    crossing.session.go_to(9)
    assert crossing.canvas.marked is None


def test_the_repair_button_takes_the_crossings_away_in_one_step(crossing, panel, qtbot):
    crossing.press_button(panel.repair)
    assert panel.section.note.text() == "checking …"
    crossing.certify(qtbot)
    assert "error" not in panel.section.note.text()
    assert panel.repair.isHidden()
    assert strip_color(crossing, 8) != "error"
    crossing.menu("edit.undo")
    assert panel.section.note.text() == "7 errors"
    assert not panel.repair.isHidden()


def test_a_clean_span_has_no_problem_and_outside_there_is_nothing(hand, qtbot):
    document = film(length=12, size=(640, 480), side=200.0)
    hand.session.new(replace(document, length=20))
    hand.certify(qtbot)
    panel = hand.editor.window.certificate_panel
    assert panel.section.note.text() == "no problem"
    assert panel.rows == []
    hand.session.go_to(20)
    assert panel.plot.isHidden()


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_panel_follows_the_theme(crossing, panel, theme):
    crossing.editor.set_theme(theme)
    colors = crossing.editor.window.theme
    assert panel.plot.curves["area"].opts["pen"].color().name() == colors.good
    assert colors.error in panel.section.note.styleSheet()


# the heat map


def test_the_heat_map_colours_the_in_between_by_stretch_and_is_remembered(crossing, settings):
    crossing.session.go_to(8)
    plain = crossing.picture()
    crossing.menu("view.heat")
    assert crossing.editor.window.table["view.heat"].isChecked()
    assert ViewState(settings).options.heat
    assert crossing.picture() != plain
    crossing.menu("view.heat")
    assert crossing.picture() == plain


def test_heat_is_blue_where_edges_are_shorter_grey_where_they_are_the_same_and_orange_where_longer():
    assert shades_of(np.array([0.2, 0.5, 1.0, 1.01, 2.0, 9.0])).tolist() == [-6, -6, 0, 0, 6, 6]
    for theme in (DARK, LIGHT):
        colors = [shade_color(theme, shade).name() for shade in (-6, 0, 6)]
        assert colors == [theme.shorter, theme.same, theme.longer]


def test_a_keyframe_itself_has_no_heat(crossing):
    crossing.session.go_to(3)
    plain = crossing.picture()
    crossing.menu("view.heat")
    assert crossing.picture() == plain
