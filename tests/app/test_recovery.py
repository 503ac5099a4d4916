"""Unsaved work outlives the program: what is kept, what is offered, and what happens to it."""

import os
import stat
from dataclasses import replace

import pytest
from PySide6.QtCore import Qt, QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMessageBox

from app.dialogs.recovery import RecoveryDialog
from app.recovery import find, new_place
from core.io.project import load, save
from core.io.recovery import Recovery, read_recovery
from core.io.storage import hidden_beside
from tests.app.sketches import film

SAVED, CHANGED = film(length=4), film(length=7)
NOON = 1_750_000_000.0


@pytest.fixture
def state(tmp_path):
    return tmp_path / "state" / "recovery"


@pytest.fixture
def path(tmp_path):
    made = tmp_path / "work" / "film.inkb"
    made.parent.mkdir()
    save(SAVED, made)
    return made


def change(hand, length):
    hand.session.apply("Change Length", lambda d: replace(d, length=length))
    return hand.session.document


def kept(hand, qtbot):
    """Let the timer run out now, wait until it is written, and return what is on the disk."""
    with qtbot.waitSignal(hand.editor.safekeeping.autosave.written, timeout=5000):
        hand.editor.safekeeping.autosave.keep()
    place = hand.editor.safekeeping.autosave.place
    return read_recovery(place.file) if place.file.exists() else None


def leave(state, document, path=None, title="untitled", time=NOON, frame=1):
    """Leave unsaved work as a program does that is killed."""
    place = new_place(state)
    place.write(Recovery(document, path, title, time, frame))
    place.abandon()
    return place.file


class Reader:
    """A person in front of the list of unsaved work."""

    def __init__(self, *presses):
        self.presses = presses
        self.texts = []
        self._timer = QTimer()
        self._timer.timeout.connect(self._look)
        self._timer.start(5)

    def _look(self):
        dialog = QApplication.activeModalWidget()
        if not isinstance(dialog, RecoveryDialog) or not dialog.isVisible():
            return
        self._timer.stop()
        self.texts = [dialog.list.item(i).text() for i in range(dialog.list.count())]
        self.pictures = [dialog.list.item(i).icon().pixmap(160, 90).toImage() for i in range(dialog.list.count())]
        for press in self.presses:
            if isinstance(press, int):
                at = dialog.list.visualItemRect(dialog.list.item(press)).center()
                QTest.mouseClick(dialog.list.viewport(), Qt.MouseButton.LeftButton, pos=at)
            elif press == "Escape":
                QTest.keyClick(dialog, Qt.Key.Key_Escape)
            else:
                buttons = (dialog.open_button, dialog.discard_button, dialog.later_button)
                (button,) = (b for b in buttons if b.text() == press)
                QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def offered(hand, *presses, project=None):
    reader = Reader(*presses)
    hand.editor.safekeeping.offer(project)
    reader._timer.stop()
    return reader


# what is kept


def test_changes_are_kept_beside_the_file_within_seconds_and_go_when_they_are_saved(hand, path, state, qtbot):
    hand.editor.files.open_path(path)
    autosave = hand.editor.safekeeping.autosave
    with qtbot.waitSignal(autosave.written, timeout=5000):
        changed = change(hand, 9)  # and nothing else
    file = hidden_beside(path, f"{autosave.place.name}.recovery")
    found = read_recovery(file)
    assert (found.document, found.path, found.frame) == (changed, path, 1)
    assert load(path) == SAVED
    with qtbot.waitSignal(autosave.written, timeout=5000):
        hand.key(Qt.Key.Key_S, Qt.KeyboardModifier.ControlModifier)
    assert not file.exists()
    assert [p.suffix for p in state.iterdir()] == [".lock"]


SQUARE = [(200.0, 200.0), (500.0, 200.0), (500.0, 500.0), (200.0, 500.0)]


def test_a_drag_under_way_is_kept_and_nothing_of_it_once_it_is_cancelled(hand, qtbot):
    hand.key("p")
    hand.click(*SQUARE, SQUARE[0])
    drawn = hand.session.document
    hand.key("v")
    hand.press(SQUARE[0])
    hand.move((180.0, 190.0))
    hand.move((100.0, 120.0))
    shown = hand.session.document
    assert kept(hand, qtbot).document == shown != drawn
    assert hand.session.in_gesture
    hand.key(Qt.Key.Key_Escape)
    assert kept(hand, qtbot).document == drawn


def test_undoing_all_changes_takes_away_what_was_kept(hand, path, qtbot):
    hand.editor.files.open_path(path)
    change(hand, 9)
    assert kept(hand, qtbot).document.length == 9
    with qtbot.waitSignal(hand.editor.safekeeping.autosave.written, timeout=5000):
        hand.menu("edit.undo")
    assert not hand.editor.safekeeping.autosave.place.file.exists()


def test_closing_in_order_leaves_nothing(hand, path, state, qtbot, monkeypatch):
    hand.editor.files.open_path(path)
    change(hand, 9)
    assert kept(hand, qtbot)
    monkeypatch.setattr(QMessageBox, "exec", lambda box: QMessageBox.StandardButton.Discard)
    hand.editor.window.close()
    assert list(state.iterdir()) == []
    assert [p.name for p in path.parent.iterdir()] == ["film.inkb"]


def test_a_program_that_is_told_to_end_leaves_its_work_for_the_next_start(hand, state):
    changed = change(hand, 9)
    hand.editor.safekeeping.stop(leave=True)
    (found,), problems = find(state)
    assert (found.recovery.document, problems) == (changed, [])
    found.place.release()


@pytest.mark.skipif(os.name != "posix", reason="permissions of POSIX")
def test_only_its_owner_can_read_what_is_kept(hand, qtbot):
    change(hand, 9)
    assert kept(hand, qtbot)
    assert stat.S_IMODE(hand.editor.safekeeping.autosave.place.file.stat().st_mode) == 0o600


def test_a_folder_that_takes_nothing_is_no_reason_to_keep_nothing(hand, path, state, qtbot, monkeypatch):
    hand.editor.files.open_path(path)
    monkeypatch.setattr("app.recovery.hidden_beside", lambda p, ending: p.parent / "gone" / ending)
    changed = change(hand, 9)
    assert kept(hand, qtbot).document == changed
    assert hand.editor.safekeeping.autosave.place.file.parent == state


def test_a_full_disk_is_said_once_and_again_only_after_it_had_room(hand, qtbot, monkeypatch):
    told = []
    hand.editor.safekeeping.autosave.troubled.connect(told.append)
    change(hand, 5)
    kept(hand, qtbot)

    def fails(times):
        with monkeypatch.context() as full:

            def no_room(*_):
                raise OSError(28, os.strerror(28))

            full.setattr("os.fsync", no_room)
            for _ in range(times):
                with qtbot.waitSignal(hand.editor.safekeeping.autosave._worker.finished):
                    hand.editor.safekeeping.autosave.keep()

    fails(3)
    assert len(told) == 1
    assert "no space left on device" in told[0]
    assert hand.message.startswith("Your changes cannot be kept safe")
    kept(hand, qtbot)
    fails(2)
    assert len(told) == 2


# what is offered


def test_after_a_crash_the_work_is_offered_with_its_picture_and_time_and_opens_unsaved(hand, path, state, qtbot):
    leave(state, CHANGED, path, "film", frame=3)
    reader = offered(hand, "Open")
    (text,) = reader.texts
    assert text.startswith("film.inkb\n")
    assert str(path.parent) in text
    colors = {reader.pictures[0].pixelColor(x, y).name() for x in range(160) for y in range(90)}
    assert len(colors) > 2  # the drawing on its paper
    assert hand.session.document == CHANGED
    assert hand.session.path == path
    assert hand.session.frame == 3
    assert hand.session.is_modified
    assert load(path) == SAVED
    assert kept(hand, qtbot).document == CHANGED  # another crash would not lose it
    hand.menu("file.save")
    assert load(path).length == CHANGED.length
    assert offered(hand).texts == []


def test_what_was_never_saved_opens_without_a_file(hand, state):
    leave(state, CHANGED, None, "walk")
    assert "never saved" in offered(hand, "Open").texts[0]
    assert hand.session.path is None
    assert hand.session.name == "walk"
    assert hand.session.document == CHANGED


def test_opening_one_loses_none_of_the_others(hand, path, state):
    leave(state, CHANGED, path, "film", NOON)
    leave(state, film(length=8), None, "second", NOON + 60)
    leave(state, film(length=9), None, "third", NOON + 120)
    reader = offered(hand, 1, "Open")
    assert [t.split("\n")[0] for t in reader.texts] == ["third", "second", "film.inkb"]
    assert hand.session.document.length == 8
    assert [t.split("\n")[0] for t in offered(hand, "Escape").texts] == ["third", "film.inkb"]


def test_discarding_takes_away_what_was_marked_and_only_when_the_list_is_left_by_its_button(hand, state):
    first = leave(state, CHANGED, None, "first", NOON)
    second = leave(state, CHANGED, None, "second", NOON + 1)
    offered(hand, 0, "Discard", "Escape")
    assert second.exists()
    offered(hand, 0, "Discard", "Do Not Discard", "Keep for Later")
    assert second.exists()
    offered(hand, 0, "Discard", "Discard Marked")
    assert not second.exists()
    assert first.exists()
    assert len(offered(hand, "Escape").texts) == 1


def test_keeping_it_for_later_offers_it_again_as_does_the_menu(hand, state):
    leave(state, CHANGED)
    assert len(offered(hand, "Keep for Later").texts) == 1
    reader = Reader("Open")
    hand.menu("file.recover")
    assert len(reader.texts) == 1
    assert hand.session.document == CHANGED
    hand.menu("file.recover")
    assert hand.message == "There is no unsaved work to recover."


def test_opening_the_file_offers_what_was_not_saved_of_it_and_of_no_other(hand, path, state, qtbot):
    leave(state, CHANGED, path, "film")
    leave(state, film(length=8), None, "other")
    reader = Reader("Open")
    hand.editor.files.open_path(path)
    qtbot.waitUntil(lambda: hand.session.document == CHANGED)
    assert len(reader.texts) == 1
    assert hand.session.path == path


def test_what_another_computer_left_beside_the_file_is_found_too(hand, path, state, tmp_path):
    leave(tmp_path / "state of another", CHANGED, path, "film")
    assert offered(hand).texts == []
    offered(hand, "Open", project=path)
    assert hand.session.document == CHANGED


def test_what_a_living_window_keeps_is_offered_to_nobody(hand, state, qtbot):
    change(hand, 9)
    assert kept(hand, qtbot)
    assert offered(hand).texts == []
    assert find(state) == ([], [])


def test_opening_what_was_kept_asks_about_the_changes_that_are_open(hand, state, monkeypatch):
    leave(state, CHANGED)
    mine = change(hand, 12)
    monkeypatch.setattr(QMessageBox, "exec", lambda box: QMessageBox.StandardButton.Cancel)
    offered(hand, "Open")
    assert hand.session.document is mine
    assert len(find(state)[0]) == 1


def test_a_file_that_was_saved_later_is_said_to_be(hand, path, state):
    leave(state, CHANGED, path, "film", NOON)
    assert "The file was saved after this." in offered(hand, "Escape").texts[0]
    os.utime(path, (NOON - 9, NOON - 9))
    assert "saved after" not in offered(hand, "Escape").texts[0]


@pytest.mark.parametrize("content", [b"", b"{}", b'{"format":"inkbetween recovery"', b"\xff\xfe"])
def test_damaged_work_is_named_and_left_alone(hand, state, content):
    file = leave(state, CHANGED)
    file.write_bytes(content)
    assert offered(hand).texts == []
    assert file.name in hand.message
    assert file.read_bytes() == content


def test_parts_that_a_killed_program_left_are_taken_away(state):
    leave(state, CHANGED)
    part = state / f".{next(state.glob('*.recovery')).name}.0123.part"
    part.write_bytes(b"{")
    find(state)[0][0].place.abandon()
    assert not part.exists()
