"""Saving and opening on disks that are full, slow, gone or shared."""

import os
import subprocess
import sys
import threading
from dataclasses import replace
from pathlib import Path

import pytest
from PySide6.QtCore import QEvent, Qt
from PySide6.QtWidgets import QApplication, QFileDialog, QMessageBox

from app.filelock import FileLock
from core.io.project import load, save
from core.io.storage import backup_of
from tests.app.answers import Person
from tests.app.sketches import film

CTRL = Qt.KeyboardModifier.ControlModifier
OURS, THEIRS = film(length=4), film(length=9)


@pytest.fixture
def path(tmp_path):
    made = tmp_path / "work" / "film.inkb"
    made.parent.mkdir()
    save(OURS, made)
    return made


@pytest.fixture
def person():
    made = Person()
    yield made
    made.leave()
    assert made.left == []


def change(hand, length=6):
    hand.session.apply("Change Length", lambda d: replace(d, length=length))
    return hand.session.document


def press(hand, text):
    """Press a button of the message bar."""
    (button,) = (b for b in hand.editor.window.message_bar.buttons if b.text() == text)
    hand.press_button(button)


def files_of(folder):
    return sorted(p.name for p in folder.iterdir())


# the backup


def test_saving_keeps_the_version_before_as_a_backup_and_restoring_it_can_be_undone(hand, path):
    hand.editor.files.open_path(path)
    changed = change(hand)
    hand.key(Qt.Key.Key_S, CTRL)
    assert load(backup_of(path)) == OURS
    assert load(path) == changed
    hand.menu("file.backup")
    assert hand.session.document == OURS
    assert hand.session.is_modified
    hand.menu("edit.undo")
    assert hand.session.document == changed
    assert not hand.session.is_modified


def test_reverting_takes_what_is_in_the_file_and_can_be_undone(hand, path):
    hand.editor.files.open_path(path)
    assert not hand.editor.window.table["file.revert"].isEnabled()
    changed = change(hand)
    hand.menu("file.revert")
    assert hand.session.document == OURS
    assert not hand.session.is_modified
    hand.menu("edit.undo")
    assert hand.session.document == changed
    assert hand.session.is_modified


def test_without_a_backup_it_is_said(hand, path):
    hand.editor.files.open_path(path)
    hand.menu("file.backup")
    assert "film.inkb~" in hand.message
    assert hand.session.document == OURS


# disks that fail


@pytest.mark.parametrize("number", [28, 13, 30, 5])
def test_what_the_disk_says_is_told_in_one_sentence_with_retry_and_save_as(hand, path, monkeypatch, number):
    hand.editor.files.open_path(path)
    changed = change(hand)

    def fail(*_):
        raise OSError(number, os.strerror(number))

    with monkeypatch.context() as broken:
        broken.setattr(os, "fsync", fail)
        hand.key(Qt.Key.Key_S, CTRL)
        assert os.strerror(number).lower() in hand.message
        assert [b.text() for b in hand.editor.window.message_bar.buttons] == ["Retry", "Save As…"]
        assert hand.session.document is changed
        assert hand.session.is_modified
        assert load(path) == OURS
        press(hand, "Retry")
        assert os.strerror(number).lower() in hand.message
    press(hand, "Retry")
    assert hand.message == ""
    assert load(path) == changed
    assert not hand.session.is_modified


def test_a_folder_that_is_gone_is_said_and_save_as_saves_elsewhere(hand, path, tmp_path, monkeypatch):
    hand.editor.files.open_path(path)
    changed = change(hand)
    path.parent.rename(tmp_path / "moved")
    hand.key(Qt.Key.Key_S, CTRL)
    assert "no such file or directory" in hand.message
    other = tmp_path / "other.inkb"
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(other), ""))
    press(hand, "Save As…")
    assert load(other) == changed
    assert hand.session.path == other
    assert not hand.session.is_modified


def test_a_slow_disk_leaves_the_window_awake_and_there_are_never_two_saves(hand, path, monkeypatch, qtbot):
    hand.editor.files.open_path(path)
    first = change(hand, 6)
    sync, hold, calls = os.fsync, threading.Event(), []

    def slow(file):
        calls.append(file)
        hold.wait(10)
        sync(file)

    monkeypatch.setattr(os, "fsync", slow)
    done = []

    def meanwhile():
        if not hand.editor.files.writing or "slow" not in hand.message:
            return
        timer.stop()
        hand.key(Qt.Key.Key_S, CTRL)
        assert "is being saved" in hand.message
        change(hand, 7)
        hand.editor.window.close()  # waits for the save, then asks about what came after
        done.append(hand.editor.window.isVisible())
        hold.set()

    from PySide6.QtCore import QTimer

    timer = QTimer()
    timer.timeout.connect(meanwhile)
    timer.start(10)
    monkeypatch.setattr(QMessageBox, "exec", lambda box: QMessageBox.StandardButton.Discard)
    hand.key(Qt.Key.Key_S, CTRL)
    assert done == [True]
    assert load(path) == first
    assert hand.session.is_modified
    assert hand.session.document.length == 7
    qtbot.waitUntil(lambda: not hand.editor.window.isVisible())


# others


def test_a_second_window_on_a_file_says_who_has_it_and_can_take_a_copy(hand, path, person):
    other = FileLock(path)
    assert other.take() is None
    person.left = ["Open a Copy"]
    assert hand.editor.files.open_path(path)
    assert f"process {os.getpid()} on " in person.asked[0]
    assert hand.session.path is None
    assert hand.session.name == "film copy"
    assert hand.session.document == OURS
    person.left = ["Cancel"]
    assert not hand.editor.files.open_path(path)
    person.left = ["Open Anyway"]
    assert hand.editor.files.open_path(path)
    assert hand.session.path == path
    other.release()


LOCKER = """
import sys, time
from pathlib import Path
from app.filelock import FileLock
lock = FileLock(Path(sys.argv[1]))
print(lock.take(), flush=True)
time.sleep(60)
"""


def test_the_lock_of_another_process_holds_until_it_is_killed(hand, path, person):
    with subprocess.Popen([sys.executable, "-c", LOCKER, str(path)], stdout=subprocess.PIPE, text=True) as other:
        assert other.stdout.readline() == "None\n"
        person.left = ["Cancel"]
        assert not hand.editor.files.open_path(path)
        assert f"process {other.pid} on " in person.asked[0]
        other.kill()
        other.wait()
        assert hand.editor.files.open_path(path)
    assert len(person.asked) == 1


def test_the_lock_goes_with_the_file_and_nothing_is_left_beside_it(hand, path, tmp_path):
    hand.editor.files.open_path(path)
    assert files_of(path.parent) == [".film.inkb.lock", "film.inkb"]
    assert hand.editor.files.open_path(path)  # again, in the same window
    hand.menu("file.new")
    assert files_of(path.parent) == ["film.inkb"]
    assert FileLock(path).take() is None


@pytest.mark.skipif(os.name != "posix", reason="a folder that cannot be written")
def test_a_folder_without_locks_keeps_nobody_out(hand, path, monkeypatch):
    monkeypatch.setattr("app.filelock.hidden_beside", lambda *_: Path("/no such folder/lock"))
    assert hand.editor.files.open_path(path)
    assert hand.session.path == path


@pytest.mark.parametrize("answer", ["Save Anyway", "Reload", "Save As…", "Cancel"])
def test_a_file_that_someone_else_changed_is_not_saved_over_unasked(hand, path, person, monkeypatch, answer):
    hand.editor.files.open_path(path)
    changed = change(hand)
    save(THEIRS, path)
    other = path.with_name("mine.inkb")
    monkeypatch.setattr(QFileDialog, "getSaveFileName", lambda *_: (str(other), ""))
    person.left = [answer]
    hand.key(Qt.Key.Key_S, CTRL)
    assert "changed by another program" in person.asked[0]
    if answer == "Save Anyway":
        assert (load(path), load(backup_of(path))) == (changed, THEIRS)
    else:
        assert load(path) == THEIRS
    if answer == "Reload":
        assert hand.session.document == THEIRS
        assert not hand.session.is_modified
        hand.menu("edit.undo")
    if answer == "Save As…":
        assert load(other) == changed
    assert hand.session.document == changed
    assert hand.session.is_modified == (answer in ("Reload", "Cancel"))


def test_a_file_that_was_only_touched_is_saved_without_a_question(hand, path, person):
    hand.editor.files.open_path(path)
    changed = change(hand)
    os.utime(path, ns=(1, 1))
    hand.key(Qt.Key.Key_S, CTRL)
    assert load(path) == changed
    assert person.asked == []


def come_back():
    state = Qt.ApplicationState
    QApplication.instance().applicationStateChanged.emit(state.ApplicationInactive)
    QApplication.instance().applicationStateChanged.emit(state.ApplicationActive)
    QApplication.sendEvent(QApplication.instance(), QEvent(QEvent.Type.ApplicationActivate))


def test_coming_back_to_a_file_that_was_changed_meanwhile_tells_it_once(hand, path, qtbot):
    hand.editor.files.open_path(path)
    come_back()
    save(THEIRS, path)
    come_back()
    qtbot.waitUntil(lambda: "changed by another program" in hand.message)
    press(hand, "Reload")
    assert hand.session.document == THEIRS
    save(OURS, path)
    come_back()
    qtbot.waitUntil(lambda: "changed by another program" in hand.message)
    hand.editor.window.message_bar.hide()
    come_back()
    qtbot.wait(100)
    assert hand.message == ""


def test_recent_files_that_are_gone_are_greyed_and_kept(hand, path, tmp_path):
    hand.editor.files.open_path(path)
    other = tmp_path / "other.inkb"
    save(OURS, other)
    hand.editor.files.open_path(other)
    path.unlink()
    hand.editor.window.menus["File"].aboutToShow.emit()
    first, second = hand.editor.window.recent_menu.actions()[:2]
    assert (first.text(), first.isEnabled()) == ("other.inkb", True)
    assert (second.text(), second.isEnabled()) == ("film.inkb (not found)", False)
