"""The story of a first day with the program, told with mouse and keys on the real window."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialogButtonBox, QFileDialog, QMessageBox
from pytestqt.qtbot import QtBot

import resources
from core import load
from core.model.edits import set_length

SQUARE = [(400.0, 300.0), (800.0, 300.0), (800.0, 700.0), (400.0, 700.0)]
HOUSE = [(1100.0, 400.0), (1300.0, 250.0), (1500.0, 400.0), (1500.0, 800.0), (1100.0, 800.0)]


def draw(hand, places) -> None:
    """Click a closed outline with the pen."""
    hand.key(Qt.Key.Key_P)
    hand.click(*places)
    hand.click(places[0])


def two_keyframes(hand) -> None:
    draw(hand, SQUARE)
    hand.key(Qt.Key.Key_End)
    draw(hand, HOUSE)
    hand.key(Qt.Key.Key_Home)


def drawn(hand, frame: int) -> np.ndarray:
    return hand.session.layer.keyframe_at(frame).drawing.outlines[0].points


def shown(hand) -> np.ndarray:
    return hand.canvas.content.picture.outlines[0][0]


def near(points, places, hand) -> bool:
    """Whether vertices lie where the hand put them, to half a pixel of the screen."""
    return np.allclose(points, places, atol=0.8 / hand.canvas.camera.scale)


def test_the_pen_draws_two_keyframes_with_different_vertex_counts_and_the_in_between_is_there(hand, qtbot) -> None:
    two_keyframes(hand)
    assert hand.session.layer.frames() == (1, 24)
    assert near(drawn(hand, 1), SQUARE, hand)
    assert near(drawn(hand, 24), HOUSE, hand)
    hand.session.go_to(12)
    hand.settle(qtbot)
    middle = shown(hand).mean(axis=0)
    assert 700 < middle[0] < 1200
    assert hand.canvas.content.t is not None


def test_enter_closes_backspace_takes_back_and_escape_gives_up(hand) -> None:
    hand.key(Qt.Key.Key_P)
    hand.click(*SQUARE, (100.0, 100.0))
    hand.key(Qt.Key.Key_Backspace)
    hand.key(Qt.Key.Key_Return)
    assert near(drawn(hand, 1), SQUARE, hand)
    hand.click(*HOUSE)
    hand.key(Qt.Key.Key_Escape)
    assert len(hand.session.layer.keyframe_at(1).drawing.outlines) == 1
    assert hand.session.undo_stack.count() == 1


def test_two_vertices_are_refused_with_a_sentence_and_the_pen_goes_on(hand) -> None:
    hand.key(Qt.Key.Key_P)
    hand.click(*SQUARE[:2])
    hand.key(Qt.Key.Key_Return)
    assert "at least 3" in hand.message
    hand.click(*SQUARE[2:])
    hand.key(Qt.Key.Key_Return)
    assert near(drawn(hand, 1), SQUARE, hand)


def test_the_pencil_draws_freehand_and_simplifies_on_release(hand) -> None:
    hand.key(Qt.Key.Key_B)
    angles = np.linspace(0, 2 * np.pi, 90)
    way = [(960 + 300 * np.cos(a), 540 + 300 * np.sin(a)) for a in angles]
    hand.drag(way[0], *way[1:])
    points = drawn(hand, 1)
    assert 8 <= len(points) <= 60
    radii = np.hypot(*(points - [960, 540]).T)
    assert np.abs(radii - 300).max() < 6


def test_a_looser_pencil_tolerance_leaves_fewer_vertices(hand) -> None:
    counts = []
    for tolerance in (0.5, 12.0):
        hand.editor.window.drawing_panel.tolerance_field.setValue(tolerance)
        hand.key(Qt.Key.Key_B)
        way = [(960 + 300 * np.cos(a), 540 + 300 * np.sin(a)) for a in np.linspace(0, 2 * np.pi, 90)]
        hand.drag(way[0], *way[1:])
        counts.append(len(hand.session.layer.keyframe_at(1).drawing.outlines[-1].points))
    assert counts[1] < counts[0] / 2


def test_dragging_a_vertex_changes_the_in_between_at_every_step(hand, qtbot) -> None:
    two_keyframes(hand)
    hand.settle(qtbot)
    hand.session.go_to(12)
    hand.key(Qt.Key.Key_V)
    hand.press(SQUARE[0])
    seen = [shown(hand).copy()]
    for step in range(1, 5):
        hand.move((400 - 20 * step, 300 - 20 * step))
        seen.append(shown(hand).copy())
    hand.release((320.0, 220.0))
    assert all(not np.allclose(p, q) for p, q in pairwise(seen))
    assert near(drawn(hand, 1)[0], (320, 220), hand)
    assert hand.session.undo_stack.undoText() == "Move Vertex"


def test_escape_cancels_a_drag_and_leaves_no_undo_step(hand) -> None:
    draw(hand, SQUARE)
    hand.key(Qt.Key.Key_V)
    before, steps = hand.session.document, hand.session.undo_stack.count()
    hand.press(SQUARE[0])
    hand.move((200.0, 200.0))
    assert hand.session.document != before
    hand.key(Qt.Key.Key_Escape)
    hand.release((200.0, 200.0))
    assert hand.session.document == before
    assert hand.session.undo_stack.count() == steps


def test_a_box_selects_several_vertices_and_arrows_move_them_as_one_step(hand) -> None:
    draw(hand, SQUARE)
    hand.key(Qt.Key.Key_V)
    hand.drag((300.0, 200.0), (500.0, 400.0), (900.0, 400.0))
    assert hand.session.selection.count == 2
    start, steps = drawn(hand, 1).copy(), hand.session.undo_stack.count()
    for _ in range(3):
        hand.key(Qt.Key.Key_Right)
    hand.key(Qt.Key.Key_Down, Qt.KeyboardModifier.ShiftModifier)
    moved = drawn(hand, 1) - start
    assert moved.tolist() == [[3, 10], [3, 10], [0, 0], [0, 0]]
    assert hand.session.undo_stack.count() == steps + 1
    hand.menu("edit.undo")
    assert np.array_equal(drawn(hand, 1), start)


def test_a_double_click_on_an_edge_inserts_a_vertex_and_delete_takes_it_away(hand) -> None:
    draw(hand, SQUARE)
    hand.key(Qt.Key.Key_V)
    hand.double_click((600.0, 300.0))
    assert len(drawn(hand, 1)) == 5
    assert near(drawn(hand, 1)[1], (600, 300), hand)
    hand.key(Qt.Key.Key_Delete)
    assert near(drawn(hand, 1), SQUARE, hand)


def test_deleting_down_to_two_vertices_takes_the_outline_and_undo_brings_it_back(hand) -> None:
    draw(hand, SQUARE[:3])
    hand.key(Qt.Key.Key_V)
    hand.click(SQUARE[0])
    hand.key(Qt.Key.Key_Delete)
    assert hand.session.layer.keyframes == ()
    hand.menu("edit.undo")
    assert near(drawn(hand, 1), SQUARE[:3], hand)


def test_the_whole_shape_is_moved_turned_and_scaled_with_handles(hand) -> None:
    draw(hand, SQUARE)
    hand.key(Qt.Key.Key_V)
    hand.drag((600.0, 500.0), (620.0, 520.0), (700.0, 600.0))  # inside: the whole shape
    moved = np.array(SQUARE) + 100
    assert near(drawn(hand, 1), moved, hand)
    tool, paper = hand.canvas.tool, hand.canvas.content.papers[0]
    from app.tools.select import handle_places

    def handle(name):
        at = handle_places(tool._view_box(tool._box(), paper))[name]
        return hand.canvas.camera.to_stage(at)

    corner = handle("se")
    hand.drag(corner, (corner[0] + 50, corner[1] + 50), (corner[0] + 200, corner[1] + 200))
    assert np.allclose(np.ptp(drawn(hand, 1), axis=0), 600, atol=2 / hand.canvas.camera.scale)
    assert near(drawn(hand, 1)[0], moved[0], hand)
    centre = drawn(hand, 1).mean(axis=0)
    knob = np.array(handle("turn"))
    reach = centre[1] - knob[1]
    hand.drag(tuple(knob), (knob[0] + reach / 2, knob[1] + 9), (centre[0] + reach, centre[1]))
    first = drawn(hand, 1)[0] - centre
    assert np.allclose(first, [300, -300], atol=4)
    assert [hand.session.undo_stack.text(i) for i in range(1, 4)] == ["Move Vertices", "Scale", "Turn"]


def test_a_drawing_is_copied_to_the_other_keyframe(hand) -> None:
    draw(hand, SQUARE)
    hand.menu("key.copy")
    assert hand.session.frame == 24
    assert np.array_equal(drawn(hand, 24), drawn(hand, 1))
    hand.session.go_to(1)
    hand.key(Qt.Key.Key_A, Qt.KeyboardModifier.ControlModifier)
    hand.menu("edit.copy")
    hand.session.go_to(12)
    hand.menu("edit.paste")
    assert hand.session.layer.frames() == (1, 12, 24)
    assert np.array_equal(drawn(hand, 12), drawn(hand, 1))


def test_linear_and_intrinsic_at_a_click_and_both_beside_each_other(hand, qtbot) -> None:
    two_keyframes(hand)
    hand.session.go_to(12)
    panel = hand.editor.window.span_panel
    intrinsic = shown(hand).copy()
    hand.press_button(panel.methods.button("linear"))
    linear = shown(hand).copy()
    assert hand.session.layer.keyframe_at(1).span.method == "linear"
    assert not np.allclose(linear, intrinsic)
    hand.press_button(panel.compare)
    films = hand.canvas.content.films
    assert [p.method for p in films] == ["linear", "intrinsic"]
    assert [len(f) for f in films.values()] == [6, 6]
    hand.press_button(panel.compare)
    assert hand.canvas.content.films == {}


def test_an_anchor_is_dragged_from_outline_to_outline_and_holds(hand, qtbot) -> None:
    two_keyframes(hand)
    hand.key(Qt.Key.Key_C)
    hand.press(SQUARE[0])
    hand.move((900.0, 500.0))
    hand.move(HOUSE[3])
    live = hand.canvas.content.plan.links[0]
    hand.release(HOUSE[3])
    pair = hand.session.layer.keyframe_at(1).span.pairs[0]
    assert pair.held == ((0.0, 3.0),)
    hand.settle(qtbot)
    link = hand.canvas.content.plan.links[0]
    for each in (live, link):
        row = np.flatnonzero(each.before_positions == 0.0)[0]
        assert each.after_positions[row] == 3.0
    assert hand.session.undo_stack.undoText() == "Add Anchor"


def test_an_anchors_end_is_dragged_along_its_outline_deleted_and_brought_back(hand) -> None:
    two_keyframes(hand)
    hand.key(Qt.Key.Key_C)
    hand.drag(SQUARE[0], (900.0, 500.0), HOUSE[3])
    hand.drag(HOUSE[3], (1500.0, 700.0), HOUSE[2])
    assert hand.session.layer.keyframe_at(1).span.pairs[0].held == ((0.0, 2.0),)
    assert hand.session.undo_stack.undoText() == "Move Anchor"
    middle = (1300.0, 800.0)
    hand.drag(HOUSE[2], (1500.0, 790.0), middle)
    after = hand.session.layer.keyframe_at(1).span.pairs[0].anchors[0].after
    assert 3.4 < after < 3.6
    hand.key(Qt.Key.Key_Delete)
    assert hand.session.layer.keyframe_at(1).span.pairs[0].anchors == ()
    for expected in (after, 2.0, 3.0):
        hand.menu("edit.undo")
        assert hand.session.layer.keyframe_at(1).span.pairs[0].anchors[0].after == expected


def test_anchors_that_would_cross_are_refused_and_nothing_changes(hand) -> None:
    two_keyframes(hand)
    hand.key(Qt.Key.Key_C)
    for start, end in ((0, 1), (1, 2), (2, 3)):
        hand.drag(SQUARE[start], (950.0, 500.0), HOUSE[end])
    before = hand.session.document
    hand.drag(SQUARE[3], (950.0, 500.0), (1500.0, 600.0))
    assert hand.session.document == before
    assert "cross" in hand.message


def test_escape_while_an_anchor_is_dragged_leaves_nothing(hand) -> None:
    two_keyframes(hand)
    before = hand.session.document
    hand.key(Qt.Key.Key_C)
    hand.press(SQUARE[0])
    hand.move((900.0, 500.0))
    hand.move(HOUSE[3])
    hand.key(Qt.Key.Key_Escape)
    hand.release(HOUSE[3])
    assert hand.session.document == before
    assert hand.session.selection.anchor is None


def test_comma_and_point_step_home_and_end_jump_and_a_frame_is_typed(hand) -> None:
    two_keyframes(hand)
    hand.key(".")
    hand.key(".")
    assert hand.session.frame == 3
    hand.key(",")
    assert hand.session.frame == 2
    hand.key(Qt.Key.Key_End)
    assert hand.session.frame == 24
    hand.key(Qt.Key.Key_Comma, Qt.KeyboardModifier.ControlModifier)
    assert hand.session.frame == 1
    field = hand.editor.window.timeline.frame_field
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, "17")
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert hand.session.frame == 17


def test_the_playhead_is_dragged_on_the_timeline(hand) -> None:
    two_keyframes(hand)
    track = hand.editor.window.timeline.track
    y = 12
    QTest.mousePress(track, Qt.MouseButton.LeftButton, pos=QPoint(round(track.x_of(5)), y))
    assert hand.session.frame == 5
    hand.move_on(track, QPoint(round(track.x_of(20)), y))
    assert hand.session.frame == 20
    QTest.mouseRelease(track, Qt.MouseButton.LeftButton, pos=QPoint(round(track.x_of(20)), y))


def test_space_plays_the_film_in_a_loop_and_stops_again(hand, qtbot) -> None:
    two_keyframes(hand)
    hand.key(Qt.Key.Key_Space)
    assert hand.editor.playback.playing
    seen = set()
    hand.session.frameChanged.connect(seen.add)
    qtbot.waitUntil(lambda: len(seen) > 4 and 1 in seen, timeout=5000)
    hand.key(Qt.Key.Key_Space)
    assert not hand.editor.playback.playing


def test_rate_and_length_are_set_and_undone(hand) -> None:
    timeline = hand.editor.window.timeline
    timeline.rate_field.setFocus()
    timeline.rate_field.selectAll()
    QTest.keyClicks(timeline.rate_field, "30000/1001")
    QTest.keyClick(timeline.rate_field, Qt.Key.Key_Return)
    assert hand.session.document.rate.denominator == 1001
    timeline.length_field.setFocus()
    timeline.length_field.selectAll()
    QTest.keyClicks(timeline.length_field, "48")
    QTest.keyClick(timeline.length_field, Qt.Key.Key_Return)
    assert hand.session.document.length == 48
    hand.menu("edit.undo")
    assert hand.session.document.length == 24
    hand.menu("edit.undo")
    assert hand.session.document.rate == 24


@pytest.mark.parametrize("text", ["", "fast", "0", "-3", "1/0", "1e9"])
def test_a_senseless_rate_is_refused_with_a_sentence(hand, text) -> None:
    field = hand.editor.window.timeline.rate_field
    field.setFocus()
    field.selectAll()
    QTest.keyClick(field, Qt.Key.Key_Delete)
    QTest.keyClicks(field, text)
    QTest.keyClick(field, Qt.Key.Key_Return)
    assert hand.session.document.rate == 24
    assert field.text() == "24"
    assert "rate" in hand.message


def test_everything_is_undone_to_the_start_and_redone_to_the_end(hand) -> None:
    start = hand.session.document
    two_keyframes(hand)
    hand.key(Qt.Key.Key_C)
    hand.drag(SQUARE[0], (900.0, 500.0), HOUSE[3])
    hand.key(Qt.Key.Key_V)
    hand.drag(SQUARE[1], (850.0, 250.0), (900.0, 200.0))
    hand.press_button(hand.editor.window.span_panel.methods.button("linear"))
    end, count = hand.session.document, hand.session.undo_stack.count()
    assert count == 5
    for _ in range(count):
        hand.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert hand.session.document == start
    for _ in range(count):
        hand.key(Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert hand.session.document == end


def test_the_undo_entry_names_the_step(hand) -> None:
    draw(hand, SQUARE)
    assert hand.editor.window.table["edit.undo"].text() == "Undo Draw Outline"


def test_a_saved_file_opens_to_the_same_document_and_picture(hand, tmp_path: Path, monkeypatch, qtbot) -> None:
    two_keyframes(hand)
    hand.session.go_to(12)
    hand.settle(qtbot)
    picture, document = hand.picture(), hand.session.document
    assert hand.editor.window.isWindowModified()
    target = tmp_path / "first day.inkb"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *a, **k: (str(tmp_path / "first day"), ""))
    hand.key(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    saved = load(target)
    assert saved == hand.editor.preview.with_answers(document)
    assert saved.layers[0].keyframes[0].span.pairs[0].correspondence is not None
    assert not hand.editor.window.isWindowModified()
    assert "first day" in hand.editor.window.windowTitle()
    hand.menu("file.new")
    assert hand.session.layer.keyframes == ()
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *a, **k: (str(target), ""))
    hand.menu("file.open")
    hand.session.go_to(12)
    hand.settle(qtbot)
    hand.canvas.setFocus()
    assert hand.session.document == saved
    assert hand.picture() == picture
    hand.editor.window.menus["File"].aboutToShow.emit()
    assert hand.editor.window.recent_menu.actions()[0].text() == "first day.inkb"


def test_closing_with_changes_asks_once_and_cancel_keeps_the_window(hand, monkeypatch) -> None:
    draw(hand, SQUARE)
    asked = []

    def answer(box):
        asked.append(box.text())
        return QMessageBox.StandardButton.Cancel

    monkeypatch.setattr(QMessageBox, "exec", answer)
    hand.editor.window.close()
    assert hand.editor.window.isVisible()
    assert len(asked) == 1
    assert "untitled" in asked[0]
    monkeypatch.setattr(QMessageBox, "exec", lambda box: QMessageBox.StandardButton.Discard)
    hand.editor.window.close()
    assert not hand.editor.window.isVisible()


def test_a_window_without_changes_closes_without_a_question(hand, monkeypatch) -> None:
    monkeypatch.setattr(QMessageBox, "exec", lambda box: pytest.fail("asked for nothing"))
    hand.editor.window.close()
    assert not hand.editor.window.isVisible()


def test_frames_are_exported_with_progress_and_the_window_stays_usable(hand, tmp_path: Path, qtbot: QtBot) -> None:
    two_keyframes(hand)
    hand.menu("file.export")
    dialog = hand.editor.export_dialog
    dialog.fields.place.setText(str(tmp_path / "frames"))
    dialog.fields.name.setText("walk")
    dialog.fields.wide.setValue(320)
    dialog.fields.high.setValue(180)
    dialog.fields.last.setValue(6)
    with qtbot.waitSignal(dialog.told, timeout=20_000) as told:
        hand.press_button(dialog.start_button)
        hand.session.go_to(7)  # while it runs
    assert "6 frames" in told.args[0]
    names = sorted(p.name for p in (tmp_path / "frames").iterdir())
    assert names == [f"walk.{i:04}.png" for i in range(1, 7)]


def test_a_cancelled_export_leaves_no_half_frame(hand, tmp_path: Path, qtbot: QtBot) -> None:
    two_keyframes(hand)
    hand.session.apply("Change Length", set_length, 500)
    hand.menu("file.export")
    dialog = hand.editor.export_dialog
    dialog.fields.place.setText(str(tmp_path / "frames"))
    with qtbot.waitSignal(dialog.told, timeout=30_000) as told:
        hand.press_button(dialog.start_button)
        qtbot.waitUntil(lambda: dialog.bar.value() >= 1, timeout=20_000)
        hand.press_button(dialog.buttons.button(QDialogButtonBox.StandardButton.Cancel))
    assert "cancelled" in told.args[0]
    files = list((tmp_path / "frames").iterdir())
    assert 0 < len(files) < 500
    assert all(p.suffix == ".png" for p in files)


def test_a_folder_that_cannot_be_made_is_said_in_one_sentence(hand, tmp_path: Path, qtbot: QtBot) -> None:
    draw(hand, SQUARE)
    (tmp_path / "frames").write_text("in the way")
    hand.menu("file.export")
    dialog = hand.editor.export_dialog
    dialog.fields.place.setText(str(tmp_path / "frames"))
    with qtbot.waitSignal(dialog.told, timeout=20_000) as told:
        hand.press_button(dialog.start_button)
    assert told.args[1] == "error"
    assert str(tmp_path / "frames") in told.args[0]


@pytest.mark.parametrize("content", [b"", b"no project", b'{"format":"inkbetween","version":99}', b"\xff\x00"])
def test_a_file_that_is_no_project_is_refused_and_the_drawing_stays(hand, tmp_path: Path, content) -> None:
    draw(hand, SQUARE)
    document = hand.session.document
    bad = tmp_path / "bad.inkb"
    bad.write_bytes(content)
    assert not hand.editor.files.open_path(bad, ask=False)
    assert "bad.inkb" in hand.message
    assert hand.session.document is document


def test_a_full_disk_while_saving_keeps_the_drawing_and_the_old_file(hand, tmp_path: Path, monkeypatch) -> None:
    draw(hand, SQUARE)
    target = tmp_path / "film.inkb"
    hand.session.save(target)
    old = target.read_bytes()
    hand.key(Qt.Key.Key_V)
    hand.drag(SQUARE[0], (300.0, 200.0))
    document = hand.session.document

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    hand.key(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert "no space left" in hand.message.lower()
    assert target.read_bytes() == old
    assert hand.session.document is document
    assert hand.session.is_modified


@pytest.mark.parametrize("sample", [p.stem for p in resources.samples()])
def test_every_sample_opens_from_the_menu_and_plays_without_a_message(hand, sample, qtbot) -> None:
    action = next(a for a in hand.editor.window.menus["Samples"].actions() if a.text().lower() == sample.lower())
    action.trigger()
    assert hand.session.name == sample
    assert hand.session.path is None  # saving never overwrites the bundled file
    assert not hand.session.is_modified
    for frame in range(1, hand.session.document.length + 1):
        hand.session.go_to(frame)
        assert all(np.isfinite(p).all() for p, _ in hand.canvas.content.picture.outlines)
    hand.settle(qtbot)
    assert hand.message == ""


def test_the_canvas_pans_with_space_and_drag_and_zooms_at_the_pointer(hand) -> None:
    camera = hand.canvas.camera
    QTest.keyPress(hand.canvas, Qt.Key.Key_Space)
    hand.drag((960.0, 540.0), (1000.0, 560.0), (1060.0, 580.0))
    QTest.keyRelease(hand.canvas, Qt.Key.Key_Space)
    assert not hand.editor.playback.playing
    assert hand.canvas.camera.dx - camera.dx == pytest.approx(100 * camera.scale, abs=1.5)
    hand.key("f")
    assert hand.canvas.camera == camera
    assert QApplication.focusWidget() is hand.canvas


def test_no_key_is_given_twice(hand) -> None:
    keys = [k.toString() for a in hand.editor.window.table.actions.values() for k in a.shortcuts()]
    assert sorted(set(keys)) == sorted(keys)
