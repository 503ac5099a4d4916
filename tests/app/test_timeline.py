"""The timeline under a person's hand: rows, keyframes, the range that is played, flipping."""

from itertools import pairwise

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QColor, QContextMenuEvent, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu

from app.panels.track_view import HEADER, RULER
from app.playback import frame_after
from app.preview import tasks
from core.model.document import Document
from core.model.drawing import Drawing, Outline
from core.model.edits import add_layer, move_vertices, put_drawing, set_layer, set_span, set_step
from core.model.inbetweens import plan_span
from tests.app.conftest import CTRL, LEFT, NONE, SHIFT, move_pointer
from tests.app.sketches import square, swing

Key = Qt.Key


def film(*layers, length=48):
    """A layer for each tuple of frames, from the back to the front."""
    document = Document(length=length)
    for i, frames in enumerate(layers, start=1):
        document = document if i == 1 else add_layer(document)
        for frame in frames:
            outline = Outline(1, np.add(square(100, 100, 50), (frame, 0)))
            document = put_drawing(document, i, frame, Drawing((outline,)))
    return document


class TrackHand:
    """A hand on the timeline; a key is named by layer and frame."""

    def __init__(self, hand):
        self.hand, self.session = hand, hand.session
        self.opened = []
        self.track = hand.editor.window.timeline.track
        self.keys = hand.editor.film.keys

    def key(self, layer_id, frame):
        return self.track.key_place(self.session.document.layer(layer_id), frame).toPoint()

    def ruler(self, frame, y=10):
        return QPoint(round(self.track.x_of(frame)), y)

    def part(self, layer_id, part):
        return self.track.part_place(self.session.document.layer(layer_id), part).toPoint()

    def click(self, at, held=NONE):
        QTest.mouseClick(self.track, LEFT, held, at)

    def drag(self, start, *way, held=NONE, drop=True):
        QTest.mousePress(self.track, LEFT, held, start)
        for at in way:
            move_pointer(self.track, at, held, LEFT)
        if drop:
            QTest.mouseRelease(self.track, LEFT, held, way[-1])

    def wheel(self, at, dy=0, held=NONE, dx=0):
        event = QWheelEvent(
            QPointF(at), QPointF(self.track.mapToGlobal(at)), QPoint(), QPoint(dx, dy),
            Qt.MouseButton.NoButton, held, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(self.track, event)

    def press_key(self, key, held=NONE):
        self.hand.key(key, held, into=self.track)

    def menu(self, at):
        """Open the menu there and return its entries by their text."""
        event = QContextMenuEvent(QContextMenuEvent.Reason.Mouse, at, self.track.mapToGlobal(at))
        QApplication.sendEvent(self.track, event)
        menu = self.opened.pop()
        actions = [a for m in (menu, *menu.findChildren(QMenu)) for a in m.actions()]
        return {a.text(): a for a in actions}

    def frames(self, layer_id):
        return self.session.document.layer(layer_id).frames()

    @property
    def steps(self):
        return self.session.undo_stack.count()

    def undo(self):
        self.press_key(Key.Key_Z, CTRL)


@pytest.fixture
def timeline(hand, monkeypatch):
    """Three layers: 1 at the back with keyframes at 1 and 40, then 5, 13, 25, in front 13, 30."""
    hand.editor.window.split.setSizes([560, 290])
    hand.session.new(film((1, 40), (5, 13, 25), (13, 30)))
    made = TrackHand(hand)
    # without a screen, opening a menu warns
    monkeypatch.setattr(QMenu, "popup", lambda menu, _: made.opened.append(menu))
    made.track.setFocus()
    return made


# selecting


def test_another_document_is_opened_while_keyframes_are_selected(timeline):
    timeline.click(timeline.key(3, 13))
    timeline.session.new(film((1, 20)))
    assert (timeline.keys.chosen, timeline.keys.keyframes()) == (frozenset(), timeline.session.layer.keyframes[:1])


def test_clicks_select_keyframes_and_take_the_playhead_there(timeline):
    timeline.click(timeline.key(2, 13))
    assert timeline.keys.chosen == {(2, 13)}
    assert (timeline.session.frame, timeline.session.layer.id) == (13, 2)
    timeline.click(timeline.key(1, 1), CTRL)
    assert timeline.keys.chosen == {(2, 13), (1, 1)}
    timeline.click(timeline.key(2, 13), CTRL)
    assert timeline.keys.chosen == {(1, 1)}
    timeline.click(timeline.key(2, 5))
    timeline.click(timeline.key(2, 25), SHIFT)
    assert timeline.keys.chosen == {(2, 5), (2, 13), (2, 25)}
    timeline.click(timeline.key(2, 13))
    assert timeline.keys.chosen == {(2, 13)}
    timeline.press_key(Key.Key_Escape)
    assert timeline.keys.chosen == frozenset()


def test_a_rubber_band_selects_across_rows_and_a_click_beside_selects_none(timeline):
    top, bottom = timeline.key(3, 10), timeline.key(2, 28)
    timeline.drag(QPoint(top.x(), top.y() - 8), QPoint(bottom.x() - 40, bottom.y()), bottom)
    assert timeline.keys.chosen == {(3, 13), (2, 13), (2, 25)}
    timeline.click(timeline.key(1, 20) + QPoint(0, 12))
    assert timeline.keys.chosen == frozenset()
    assert timeline.session.frame == 20
    assert timeline.steps == 0


def test_a_single_selected_keyframe_is_let_go_when_the_playhead_leaves_it(timeline):
    timeline.click(timeline.key(2, 13))
    timeline.press_key(".")
    assert timeline.keys.chosen == frozenset()
    timeline.click(timeline.key(2, 5))
    timeline.click(timeline.key(2, 25), CTRL)
    timeline.press_key(",")
    assert timeline.keys.chosen == {(2, 5), (2, 25)}
    timeline.hand.canvas.setFocus()
    timeline.hand.key(Key.Key_A, CTRL)  # vertices
    assert timeline.session.selection.count == 4
    assert timeline.keys.chosen == frozenset()


def test_all_of_a_layer_are_selected_with_the_usual_key(timeline):
    timeline.click(timeline.key(2, 13))
    timeline.press_key(Key.Key_A, CTRL)
    assert timeline.keys.chosen == {(2, 5), (2, 13), (2, 25)}


# moving


def test_selected_keyframes_of_several_layers_move_together_in_one_step(timeline):
    before = timeline.session.document
    timeline.click(timeline.key(2, 13))
    timeline.click(timeline.key(3, 30), CTRL)
    timeline.drag(timeline.key(2, 13), timeline.key(2, 15), timeline.key(2, 17))
    assert (timeline.frames(2), timeline.frames(3)) == ((5, 17, 25), (13, 34))
    assert timeline.keys.chosen == {(2, 17), (3, 34)}
    assert (timeline.steps, timeline.session.frame) == (1, 17)
    timeline.undo()
    assert timeline.session.document is before
    assert timeline.keys.chosen == {(2, 13), (3, 30)}  # what was selected then


def test_escape_takes_a_move_back_and_leaves_no_step(timeline):
    before = timeline.session.document
    timeline.drag(timeline.key(2, 13), timeline.key(2, 20), drop=False)
    assert timeline.frames(2) == (5, 20, 25)
    timeline.press_key(Key.Key_Escape)
    assert timeline.session.document is before
    QTest.mouseRelease(timeline.track, LEFT, NONE, timeline.key(2, 20))
    assert (timeline.session.document is before, timeline.steps, timeline.session.frame) == (True, 0, 13)
    assert timeline.keys.chosen == {(2, 13)}


def test_a_keyframe_dropped_on_another_one_stays_beside_it_and_the_reason_is_told(timeline):
    timeline.drag(timeline.key(2, 13), timeline.key(2, 20), timeline.key(2, 24), timeline.key(2, 25))
    assert timeline.frames(2) == (5, 24, 25)
    assert timeline.hand.message == "Frame 25 of 'Layer 2' already holds a keyframe"


def test_keyframes_stop_at_the_first_frame_and_the_film_grows_at_its_end(timeline):
    timeline.drag(timeline.key(2, 5), timeline.ruler(-30, timeline.key(2, 5).y()))
    assert timeline.frames(2) == (1, 13, 25)
    timeline.drag(timeline.key(1, 40), timeline.key(1, 49))
    assert (timeline.frames(1), timeline.session.document.length) == ((1, 49), 49)


def test_a_drag_past_the_end_goes_on_as_far_as_the_pointer_and_is_one_step(timeline):
    way = [timeline.key(1, frame) for frame in (45, 50, 55)]  # where they lie before the film grows
    timeline.drag(timeline.key(1, 40), *way)
    assert timeline.frames(1)[1] > 50
    timeline.undo()
    assert (timeline.frames(1), timeline.session.document.length, timeline.steps) == ((1, 40), 48, 1)


def test_a_locked_layer_refuses_with_a_sentence(timeline):
    timeline.session.apply("Lock", set_layer, 2, locked=True)
    before = timeline.session.document
    timeline.drag(timeline.key(2, 13), timeline.key(2, 20))
    assert timeline.session.document is before
    assert timeline.hand.message == "Layer 'Layer 2' is locked; unlock it to change it"
    timeline.click(timeline.key(2, 5))
    timeline.press_key(Key.Key_Delete)
    assert timeline.session.document is before


def test_an_edit_in_the_middle_of_a_drag_ends_it(timeline):
    timeline.drag(timeline.key(2, 13), timeline.key(2, 20), drop=False)
    timeline.press_key(Key.Key_F5, CTRL)
    document = timeline.session.document
    move_pointer(timeline.track, timeline.key(2, 23), NONE, LEFT)
    QTest.mouseRelease(timeline.track, LEFT, NONE, timeline.key(2, 23))
    assert timeline.session.document is document
    assert timeline.steps == 2
    timeline.undo()
    assert timeline.frames(2) == (5, 20, 25)


def test_what_is_deleted_between_press_and_move_is_not_moved(timeline):
    timeline.click(timeline.key(2, 13))
    QTest.mousePress(timeline.track, LEFT, NONE, timeline.key(2, 13))
    timeline.press_key(Key.Key_Delete)
    move_pointer(timeline.track, timeline.key(2, 20), NONE, LEFT)
    QTest.mouseRelease(timeline.track, LEFT, NONE, timeline.key(2, 20))
    assert (timeline.frames(2), timeline.steps) == ((5, 25), 1)


def test_a_press_after_a_lost_release_keeps_what_was_dragged(timeline):
    timeline.drag(timeline.key(2, 13), timeline.key(2, 20), drop=False)
    timeline.click(timeline.ruler(3))
    assert (timeline.frames(2), timeline.steps, timeline.session.in_gesture) == ((5, 20, 25), 1, False)


def test_moving_a_keyframe_solves_nothing_again_and_redrawing_it_only_its_two_spans(timeline, monkeypatch, qtbot):
    solved = []

    def counted(before, after, *args, **options):
        solved.append((before, after))
        return plan_span(before, after, *args, **options)

    def drawings(layer_id):
        return [k.drawing for k in timeline.session.document.layer(layer_id).keyframes]

    def all_solved():
        return timeline.hand.editor.preview.settled and all(
            any(a is x and b is y for x, y in solved) for i in (1, 2, 3) for a, b in pairwise(drawings(i))
        )

    monkeypatch.setattr(tasks, "plan_span", counted)
    timeline.session.new(film(*[(1, 9, 17, 25)] * 3))
    timeline.session.set_layer(2)
    qtbot.waitUntil(all_solved, timeout=20_000)
    timeline.hand.certify(qtbot)
    solved.clear()
    timeline.drag(timeline.key(2, 17), timeline.key(2, 19), timeline.key(2, 21))
    timeline.hand.certify(qtbot)
    assert solved == []
    redrawn = drawings(2)[2].outlines[0].points * 1.1
    timeline.session.apply("Redraw", lambda d: move_vertices(d, 2, 21, {1: redrawn}))
    timeline.hand.certify(qtbot)
    timeline.session.go_to(15)
    timeline.hand.certify(qtbot)
    assert {frozenset(map(id, pair)) for pair in solved} == {
        frozenset(map(id, pair)) for pair in pairwise(drawings(2)[1:])
    }


# stretching


@pytest.mark.parametrize(("last", "to", "frames"), [(True, 45, (5, 21, 45)), (False, 15, (15, 19, 25))])
def test_the_handles_beside_the_selection_stretch_it_in_proportion(timeline, last, to, frames):
    timeline.click(timeline.key(2, 5))
    timeline.click(timeline.key(2, 25), SHIFT)
    grip = timeline.track.view.grips(timeline.keys.chosen)[last].center().toPoint()
    by = timeline.key(2, to) - timeline.key(2, 25 if last else 5)
    timeline.drag(grip, grip + by / 2, grip + by)
    assert timeline.frames(2) == frames
    assert timeline.keys.chosen == {(2, f) for f in frames}
    assert timeline.steps == 1


def test_a_range_pushed_together_leaves_each_drawing_a_frame(timeline):
    timeline.click(timeline.key(2, 5))
    timeline.click(timeline.key(2, 25), SHIFT)
    grip = timeline.track.view.grips(timeline.keys.chosen)[1].center().toPoint()
    timeline.drag(grip, QPoint(HEADER + 2, grip.y()))
    assert timeline.frames(2) == (5, 6, 7)


# delete, copy, paste, duplicate, hold, smooth


def test_delete_takes_the_selected_keyframes_while_the_timeline_has_the_keyboard(timeline):
    timeline.click(timeline.key(2, 5))
    timeline.click(timeline.key(3, 30), CTRL)
    timeline.hand.canvas.setFocus()
    timeline.hand.key(Key.Key_Delete)
    assert timeline.steps == 0  # on the canvas nothing is selected
    timeline.track.setFocus()
    timeline.press_key(Key.Key_Delete)
    assert (timeline.frames(2), timeline.frames(3), timeline.steps) == ((13, 25), (13,), 1)


def test_copies_are_pasted_at_the_playhead_into_the_active_layer_and_those_behind(timeline):
    timeline.click(timeline.key(3, 13))
    timeline.click(timeline.key(2, 25), CTRL)
    timeline.press_key(Key.Key_C, CTRL)
    timeline.click(timeline.part(2, "name"))
    timeline.click(timeline.ruler(30))
    timeline.press_key(Key.Key_V, CTRL)
    assert timeline.frames(2) == (5, 13, 25, 30)
    assert timeline.frames(1) == (1, 40, 42)
    assert timeline.keys.chosen == {(2, 30), (1, 42)}
    timeline.click(timeline.part(1, "name"))
    timeline.press_key(Key.Key_V, CTRL)
    assert "of 2 layers" in timeline.hand.message


def test_cut_and_paste_move_a_keyframe_to_another_layer(timeline):
    drawing = timeline.session.document.layer(3).keyframe_at(30).drawing
    timeline.click(timeline.key(3, 30))
    timeline.press_key(Key.Key_X, CTRL)
    timeline.click(timeline.part(1, "name"))
    timeline.press_key(Key.Key_V, CTRL)
    assert (timeline.frames(3), timeline.frames(1)) == ((13,), (1, 30, 40))
    assert timeline.session.document.layer(1).keyframe_at(30).drawing == drawing


def test_what_was_copied_last_is_pasted_outlines_or_keyframes(timeline):
    timeline.click(timeline.key(2, 13))
    timeline.press_key(Key.Key_C, CTRL)
    timeline.hand.canvas.setFocus()
    timeline.hand.key(Key.Key_A, CTRL)
    timeline.hand.key(Key.Key_C, CTRL)
    timeline.click(timeline.ruler(20))  # the timeline has the keyboard, and yet an outline was copied last
    timeline.press_key(Key.Key_V, CTRL)
    assert timeline.frames(2) == (5, 13, 20, 25)
    assert timeline.session.selection.count == 4
    assert timeline.hand.editor.window.table["edit.undo"].text() == "Undo Paste"


def test_duplicates_follow_the_last_one_and_are_selected(timeline):
    timeline.click(timeline.key(2, 13))
    timeline.press_key(Key.Key_D, CTRL)
    assert timeline.frames(2) == (5, 13, 14, 25)
    assert timeline.keys.chosen == {(2, 14)}


def test_the_menu_of_a_keyframe_holds_it_and_makes_it_smooth(timeline):
    timeline.menu(timeline.key(2, 13))["Hold Until Next Keyframe"].trigger()
    timeline.menu(timeline.key(2, 13))["Smooth Through Keyframe"].trigger()
    keyframe = timeline.session.document.layer(2).keyframe_at(13)
    assert (keyframe.span.hold, keyframe.smooth) == (True, True)
    entries = timeline.menu(timeline.key(2, 13))
    assert entries["Hold Until Next Keyframe"].isChecked()
    entries["Hold Until Next Keyframe"].trigger()
    assert not timeline.session.document.layer(2).keyframe_at(13).span.hold


def test_frames_are_put_in_and_taken_out_in_a_layer_or_in_all(timeline):
    timeline.click(timeline.part(2, "name"))
    timeline.click(timeline.ruler(10))
    timeline.press_key(Key.Key_F5)
    assert (timeline.frames(2), timeline.frames(3)) == ((5, 14, 26), (13, 30))
    timeline.press_key(Key.Key_F5, CTRL)
    assert (timeline.frames(2), timeline.frames(3)) == ((5, 15, 27), (14, 31))
    assert timeline.session.document.length == 49
    timeline.press_key(Key.Key_F5, CTRL | SHIFT)
    timeline.press_key(Key.Key_F5, SHIFT)
    assert (timeline.frames(2), timeline.frames(3), timeline.session.document.length) == (
        (5, 13, 25),
        (13, 30),
        48,
    )


def test_the_plus_adds_a_keyframe_at_the_playhead(timeline, qtbot):
    timeline.click(timeline.part(2, "name"))
    timeline.click(timeline.ruler(9))
    button = next(b for b in timeline.hand.editor.window.timeline.findChildren(type(timeline.track.add_button))
                  if b.defaultAction() is timeline.hand.editor.window.table["key.add"])  # fmt: skip
    timeline.hand.press_button(button)
    assert timeline.frames(2) == (5, 9, 13, 25)


# layers


def test_eye_lock_and_solo_are_switched_in_the_row(timeline):
    timeline.click(timeline.part(2, "visible"))
    timeline.click(timeline.part(2, "locked"))
    layer = timeline.session.document.layer(2)
    assert (layer.visible, layer.locked, timeline.steps) == (False, True, 2)
    timeline.click(timeline.part(1, "solo"))
    assert timeline.session.solo == {1}
    timeline.click(timeline.part(1, "solo"))
    assert (timeline.session.solo, timeline.steps) == (frozenset(), 2)
    timeline.click(timeline.part(2, "visible"))
    timeline.click(timeline.part(2, "locked"))
    layer = timeline.session.document.layer(2)
    assert (layer.visible, layer.locked) == (True, False)


def test_a_layer_is_added_named_in_its_place_and_drawn_on(timeline):
    timeline.click(timeline.part(2, "name"))
    timeline.hand.press_button(timeline.track.add_button)
    assert [x.id for x in timeline.session.document.layers] == [1, 2, 4, 3]
    assert timeline.session.layer.id == 4
    QTest.mouseDClick(timeline.track, LEFT, NONE, timeline.part(4, "name"))
    field = timeline.track.name_field
    QTest.keyClicks(field, "shadow, v2")
    QTest.keyClick(field, Key.Key_Return)
    assert timeline.session.layer.name == "shadow, v2"
    QTest.mouseDClick(timeline.track, LEFT, NONE, timeline.part(4, "name"))
    QTest.keyClicks(timeline.track.name_field, "no")
    QTest.keyClick(timeline.track.name_field, Key.Key_Escape)
    assert timeline.session.layer.name == "shadow, v2"
    assert timeline.track.hasFocus()


def test_rows_are_reordered_by_dragging_and_escape_leaves_them(timeline):
    front, back = timeline.part(3, "name"), timeline.part(1, "name")
    timeline.drag(front, front + QPoint(0, 20), back + QPoint(0, 14), drop=False)
    timeline.press_key(Key.Key_Escape)
    QTest.mouseRelease(timeline.track, LEFT, NONE, back)
    assert [x.id for x in timeline.session.document.layers] == [1, 2, 3]
    timeline.drag(front, front + QPoint(0, 20), back + QPoint(0, 14))
    assert [x.id for x in timeline.session.document.layers] == [3, 1, 2]
    timeline.drag(timeline.part(3, "name"), front + QPoint(0, 30), front - QPoint(0, 14))
    assert [x.id for x in timeline.session.document.layers] == [1, 2, 3]
    assert timeline.steps == 2


def test_the_menu_of_a_row_colours_deletes_and_lets_it_follow(timeline):
    timeline.menu(timeline.part(2, "name"))["Rose"].trigger()
    assert timeline.session.document.layer(2).color == "#e0568a"
    timeline.menu(timeline.part(2, "name"))["Layer 3"].trigger()
    assert timeline.session.document.layer(2).parent == 3
    entries = timeline.menu(timeline.part(3, "name"))
    assert "Layer 2" not in entries  # it would follow itself
    entries["Delete Layer"].trigger()
    assert [x.id for x in timeline.session.document.layers] == [1, 2]
    assert timeline.session.document.layer(2).parent is None


def test_up_and_down_go_from_row_to_row(timeline):
    timeline.click(timeline.part(3, "name"))
    timeline.press_key(Key.Key_Down)
    assert timeline.session.layer.id == 2
    timeline.press_key(Key.Key_Up)
    timeline.press_key(Key.Key_Up)
    assert timeline.session.layer.id == 3


# looking


def test_the_wheel_zooms_with_ctrl_at_the_pointer_and_scrolls_without(timeline):
    track, at = timeline.track, timeline.ruler(24, 60)
    for _ in range(8):
        timeline.wheel(at, 120, CTRL)
    assert track.x_of(24) == pytest.approx(at.x(), abs=1)
    assert track.view.step > 40
    assert track.across.isVisible()
    timeline.wheel(at, -120, SHIFT)
    assert track.x_of(24) < at.x() - 30
    timeline.press_key(Key.Key_F, SHIFT)
    assert track.x_of(1) > HEADER
    assert track.x_of(48) < track.width()
    assert not track.across.isVisible()


def test_many_rows_scroll_and_the_active_one_is_in_sight(timeline):
    timeline.session.new(film(*[(1, 9)] * 20))
    track = timeline.track
    assert track.down.isVisible()
    timeline.session.set_layer(1)
    assert RULER <= timeline.key(1, 1).y() <= track.height()
    timeline.wheel(timeline.ruler(5, 80), 120 * 40)
    assert timeline.key(20, 1).y() > RULER
    timeline.click(timeline.key(20, 9))
    assert timeline.keys.chosen == {(20, 9)}


def test_a_long_film_fits_into_the_window_when_asked(timeline):
    timeline.session.new(film((1, 2000), length=2000))
    assert timeline.track.x_of(2000) > timeline.track.width()
    timeline.press_key(Key.Key_F, SHIFT)
    assert timeline.track.x_of(2000) < timeline.track.width()


def pixel(timeline, at):
    return QColor(timeline.track.grab().toImage().pixel(at))


def test_smooth_keyframes_are_round_held_spans_thin_and_drawings_on_twos_blocks(timeline):
    here = timeline.key(2, 13)
    corner = here + QPoint(4, 4)
    sharp = pixel(timeline, corner)
    timeline.session.apply("Smooth", lambda d: set_span(d, 2, 5, method="linear"))
    timeline.menu(here)["Smooth Through Keyframe"].trigger()
    assert pixel(timeline, corner) != sharp
    inside = QPoint(timeline.key(2, 19).x() + 3, here.y() + 4)
    bar, panel = pixel(timeline, inside), pixel(timeline, QPoint(inside.x(), here.y() + 12))
    assert bar != panel
    timeline.session.apply("Hold", lambda d: set_span(d, 2, 13, hold=True))
    assert pixel(timeline, inside) == panel
    timeline.session.apply("Twos", lambda d: set_step(set_span(d, 2, 13, hold=False), 2, 13, 2))
    marks = [pixel(timeline, QPoint(round(timeline.track.x_of(f)) - 4, here.y() + 3)) for f in (17, 18)]
    assert marks[0] != marks[1]


def test_only_the_active_layer_shows_its_certificate(timeline, qtbot):
    timeline.session.set_layer(2)
    timeline.hand.certify(qtbot)
    at = timeline.key(2, 9) + QPoint(3, 3)
    active = pixel(timeline, at)
    timeline.session.set_layer(1)
    assert pixel(timeline, at) != active
    assert pixel(timeline, at).saturation() < 60 < active.saturation()


def test_a_click_on_a_problem_goes_to_the_worst_frame_of_it(hand, qtbot):
    hand.session.new(swing(2.0))
    hand.certify(qtbot)
    timeline = TrackHand(hand)
    before, after = hand.session.layer.keyframes
    certificate = hand.editor.certificates.of(before, after)
    run = next((first, last) for first, last, severity in certificate.runs if severity == "error")
    went = set()
    for frame in range(run[0], run[1] + 1):
        hand.session.go_to(1)
        timeline.click(timeline.key(1, frame) + QPoint(3, 3))
        went.add(hand.session.frame)
        assert run[0] <= hand.session.frame <= run[1]
    assert len(went) == 1


# playing


def test_shift_and_a_drag_in_the_ruler_set_the_range_its_edges_are_dragged_and_it_is_cleared(timeline):
    timeline.drag(timeline.ruler(10), timeline.ruler(15), timeline.ruler(20), held=SHIFT)
    assert timeline.session.range == (10, 20)
    timeline.drag(timeline.ruler(20, 28), timeline.ruler(30, 28))
    timeline.drag(timeline.ruler(10, 28), timeline.ruler(5, 28))
    assert timeline.session.range == (5, 30)
    timeline.drag(timeline.ruler(5, 28), timeline.ruler(12, 28), drop=False)
    timeline.press_key(Key.Key_Escape)
    assert timeline.session.range == (5, 30)
    QTest.mouseRelease(timeline.track, LEFT, NONE, timeline.ruler(12, 28))
    timeline.menu(timeline.ruler(8))["Play the Whole Film"].trigger()
    assert not timeline.session.has_range
    assert timeline.steps == 0


def test_playing_stays_inside_the_range(timeline, qtbot):
    timeline.session.set_range((10, 14))
    seen = []
    timeline.session.frameChanged.connect(seen.append)
    timeline.press_key(Key.Key_Space)
    qtbot.waitUntil(lambda: seen.count(10) > 1, timeout=5000)
    timeline.press_key(Key.Key_Space)
    assert set(seen) <= set(range(10, 15))


def test_frames_that_come_too_late_are_counted_and_shown(timeline, qtbot):
    timeline.press_key(Key.Key_Space)
    QTest.qSleep(300)  # the window is busy meanwhile
    qtbot.waitUntil(lambda: timeline.hand.editor.playback.dropped > 3, timeout=5000)
    timeline.press_key(Key.Key_Space)
    label = timeline.hand.editor.window.timeline.dropped_label
    assert label.text() == f"{timeline.hand.editor.playback.dropped} dropped"


@pytest.mark.parametrize(
    ("loop", "ping_pong", "frames"),
    [
        (True, False, [3, 4, 5, 2, 3, 4, 5, 2]),
        (False, False, [3, 4, 5, None, None, None, None, None]),
        (True, True, [3, 4, 5, 4, 3, 2, 3, 4]),
        (False, True, [3, 4, 5, 4, 3, None, None, None]),
    ],
)
def test_the_order_of_frames_by_loop_and_ping_pong(loop, ping_pong, frames):
    assert [frame_after(3, p, 2, 5, loop=loop, ping_pong=ping_pong) for p in range(8)] == frames
    assert frame_after(4, 7, 4, 4, loop=True, ping_pong=ping_pong) == 4


def test_a_held_key_flips_to_the_neighbouring_drawings_and_its_release_back(timeline):
    timeline.session.apply("Twos", lambda d: set_step(d, 2, 5, 3))
    timeline.session.set_layer(2)
    timeline.session.go_to(9)  # shows the drawing made at 8
    widget = timeline.hand.canvas
    widget.setFocus()
    for key, frame in ((Key.Key_A, 5), (Key.Key_D, 11)):
        QTest.keyPress(widget, key)
        assert timeline.session.frame == frame
        QTest.keyRelease(widget, key)
        assert timeline.session.frame == 9
    timeline.session.go_to(30)  # behind the last keyframe: its drawing, then the one before
    QTest.keyPress(widget, Key.Key_A)
    assert timeline.session.frame == 24
    QTest.keyRelease(widget, Key.Key_A)
    assert (timeline.session.frame, timeline.hand.editor.film.flip.flipping) == (30, False)
