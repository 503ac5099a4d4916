"""Mistakes of the program itself: the drawing is kept, one dialog says so, and the window goes on."""

import sys
import threading
from dataclasses import replace

import pytest
from PySide6.QtCore import QMessageLogContext, QTimer, QtMsgType
from PySide6.QtGui import QGuiApplication

from app.emergency import Emergency, report_of
from core.io.recovery import read_recovery


@pytest.fixture
def emergency(hand, tmp_path, monkeypatch):
    """Its hooks are called here as Python calls them; pytest has its own in their place."""
    made = Emergency(hand.editor.safekeeping.autosave.keep_now, tmp_path, hand.editor)
    made.failed.connect(hand.editor.safekeeping.show_failure)
    monkeypatch.setattr(sys, "stderr", None)  # as in a program without a terminal
    hand.session.apply("Change Length", lambda d: replace(d, length=9))
    return made


def fail(emergency, text="the pen is broken"):
    try:
        raise RuntimeError(text)
    except RuntimeError as e:
        emergency._on_exception(type(e), e, e.__traceback__)


def test_the_drawing_is_kept_and_one_dialog_says_so_with_a_report_to_copy(hand, emergency, tmp_path):
    fail(emergency)
    dialog = hand.editor.safekeeping.failure
    place = hand.editor.safekeeping.autosave.place
    assert read_recovery(place.file).document is not hand.session.document
    assert read_recovery(place.file).document == hand.session.document
    assert str(place.file) in dialog.text.text()
    hand.press_button(dialog.copy_button)
    report = QGuiApplication.clipboard().text()
    assert "RuntimeError: the pen is broken" in report
    assert "Inkbetween " in report
    assert "the pen is broken" in (tmp_path / "inkbetween.log").read_text()
    hand.press_button(dialog.go_on_button)
    assert hand.editor.safekeeping.failure is None
    assert hand.editor.window.isVisible()


def test_a_mistake_in_every_frame_makes_one_dialog(hand, emergency):
    for i in range(100):
        fail(emergency, f"in frame {i}")
    dialog = hand.editor.safekeeping.failure
    assert "in frame 0" in dialog.report.toPlainText()
    assert "in frame 1" not in dialog.report.toPlainText()
    hand.press_button(dialog.go_on_button)
    fail(emergency)
    assert hand.editor.safekeeping.failure is None


def test_another_mistake_is_added_to_the_dialog_that_is_open(hand, emergency):
    fail(emergency)
    dialog = hand.editor.safekeeping.failure
    try:
        {}["no such key"]
    except KeyError as e:
        emergency._on_exception(type(e), e, e.__traceback__)
    assert hand.editor.safekeeping.failure is dialog
    assert "the pen is broken" in dialog.report.toPlainText()
    assert "no such key" in dialog.report.toPlainText()


def test_a_mistake_while_telling_of_a_mistake_ends_there(hand, emergency):
    emergency.failed.connect(lambda *_: fail(emergency, "again"))
    fail(emergency)
    assert "again" not in hand.editor.safekeeping.failure.report.toPlainText()


def test_a_copy_that_cannot_be_written_is_said_honestly(hand, emergency, monkeypatch):
    monkeypatch.setattr("app.recovery.Place.write", lambda *_: 1 / 0)
    fail(emergency)
    assert "could not be written" in hand.editor.safekeeping.failure.text.text()


def test_a_mistake_in_a_thread_reaches_the_dialog(hand, emergency, qtbot, monkeypatch):
    hooked = threading.Thread(target=lambda: fail(emergency, "in a thread"))
    hooked.start()
    hooked.join()
    qtbot.waitUntil(lambda: hand.editor.safekeeping.failure is not None)
    assert "in a thread" in hand.editor.safekeeping.failure.report.toPlainText()


def test_before_qt_gives_up_the_drawing_is_kept(hand, emergency):
    emergency._on_qt_message(QtMsgType.QtFatalMsg, QMessageLogContext(), "no more memory")
    assert read_recovery(hand.editor.safekeeping.autosave.place.file).document.length == 9


def test_the_hooks_are_put_in_place_and_taken_away_again(hand, emergency):
    before = sys.excepthook, threading.excepthook, sys.unraisablehook
    emergency.install()
    try:
        assert sys.excepthook == emergency._on_exception
        assert threading.excepthook is not before[1]
    finally:
        emergency.uninstall()
    assert (sys.excepthook, threading.excepthook, sys.unraisablehook) == before


def test_the_report_names_versions_and_nothing_of_the_drawing():
    assert report_of("Traceback").endswith("\n\nTraceback")
    assert "PySide6" in report_of("")


def test_an_exception_in_a_slot_of_the_real_program_is_caught(qtbot, hand, emergency):
    emergency.install()
    try:
        QTimer.singleShot(0, lambda: fail_plainly())
        qtbot.waitUntil(lambda: hand.editor.safekeeping.failure is not None)
    finally:
        emergency.uninstall()
    assert "fail_plainly" in hand.editor.safekeeping.failure.report.toPlainText()


def fail_plainly():
    raise ValueError("nobody catches this")
