"""Exporting and copying in the window."""

import xml.etree.ElementTree as ElementTree
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QGuiApplication, QImage
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QDialogButtonBox, QMessageBox

from app.export.presets import kept_presets
from core.model.edits import set_length
from tests.app.sketches import film

CTRL_SHIFT = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
CTRL_ALT = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier


@pytest.fixture
def dialog(hand, tmp_path):
    hand.session.new(film(length=5), "arm")
    hand.menu("file.export")
    opened = hand.editor.export_dialog
    opened.fields.place.setText(str(tmp_path / "arm frames"))
    return opened


def choose(box, text):
    """Choose an entry as a person does: by its first letters and Enter."""
    box.setCurrentIndex(box.findText(text))
    box.activated.emit(box.currentIndex())


def exported(dialog, hand, qtbot):
    with qtbot.waitSignal(dialog.told, timeout=20_000) as told:
        hand.press_button(dialog.start_button)
    return told.args


def test_a_preset_fills_the_fields_and_the_place_gets_its_ending(dialog, hand, tmp_path, qtbot):
    choose(dialog.presets, "Web GIF")
    fields = dialog.fields
    assert fields.format.currentData() == "gif"
    assert fields.place.text() == str(tmp_path / "arm.gif")
    assert (fields.wide.value(), fields.high.value()) == (32, 24)
    assert dialog.example.text() == "arm.gif"
    assert not fields.pattern.isVisible()
    assert exported(dialog, hand, qtbot) == [f"Exported arm.gif to {tmp_path}", "info"]
    assert [p.name for p in tmp_path.glob("*.gif")] == ["arm.gif"]


def test_names_follow_every_field_that_makes_them(dialog):
    fields = dialog.fields
    assert dialog.example.text() == "arm.0001.png to arm.0005.png"
    fields.separator.setText("_")
    fields.padding.setValue(2)
    fields.number.setValue(10)
    assert dialog.example.text() == "arm_10.png to arm_14.png"
    fields.pattern.setText("{layer} {frame}")
    assert dialog.example.text() == "Layer 1 10.png to Layer 1 14.png"
    fields.pattern.setText("{shot}")
    assert "braces that mean nothing" in dialog.example.text()
    assert not dialog.start_button.isEnabled()


def test_the_size_is_told_when_the_hand_rests(dialog, qtbot):
    qtbot.waitUntil(lambda: dialog.size.text() != "", timeout=5000)
    assert dialog.size.text().startswith("5 pictures, 0.21 s, about ")


def test_own_settings_can_be_kept_and_removed(dialog, hand):
    choose(dialog.presets, "Frames PNG 16 bit")
    dialog.presets.setEditText("mine")
    hand.press_button(dialog.keep)
    kept = kept_presets(hand.editor.settings.text("export/presets"))
    assert list(kept) == ["mine"]
    assert (kept["mine"].format, kept["mine"].depth, kept["mine"].background) == ("png", 16, "none")
    choose(dialog.presets, "Video MP4")
    choose(dialog.presets, "mine")
    assert dialog.fields.depth.currentData() == 16
    hand.press_button(dialog.drop)
    assert kept_presets(hand.editor.settings.text("export/presets")) == {}
    assert not dialog.drop.isEnabled()


@pytest.mark.parametrize(("answer", "written"), [("Replace", 5), ("Make the Missing Ones", 3), ("Cancel", 0)])
def test_files_that_are_there_are_asked_about_once(answer, written, dialog, hand, tmp_path, qtbot, monkeypatch):
    folder = tmp_path / "arm frames"
    folder.mkdir()
    for number in (1, 4):
        (folder / f"arm.{number:04}.png").write_text("mine")
    asked = []

    def choose_button(box):
        asked.append(box.text())
        next(b for b in box.buttons() if b.text().replace("&", "") == answer).click()

    monkeypatch.setattr(QMessageBox, "exec", choose_button)
    if answer == "Cancel":
        hand.press_button(dialog.start_button)
        assert dialog.job is None
    else:
        exported(dialog, hand, qtbot)
    assert len(asked) == 1
    assert asked[0].startswith("2 of the files exist already")
    mine = sum(p.read_bytes() == b"mine" for p in folder.iterdir())
    assert (mine, len(list(folder.iterdir())) - mine) == {5: (0, 5), 3: (2, 3), 0: (2, 0)}[written]


@pytest.mark.parametrize("preset", ["Video MP4", "Compositing ProRes 4444"])
def test_a_cancelled_film_leaves_no_file_and_the_dialog_stays(preset, dialog, hand, tmp_path, qtbot):
    hand.session.apply("Change Length", set_length, 2000)
    choose(dialog.presets, preset)
    dialog.fields.last.setValue(2000)
    with qtbot.waitSignal(dialog.told, timeout=30_000) as told:
        hand.press_button(dialog.start_button)
        qtbot.waitUntil(lambda: dialog.bar.value() >= 1, timeout=20_000)
        hand.session.go_to(3)  # the editor stays usable
        hand.press_button(dialog.buttons.button(QDialogButtonBox.StandardButton.Cancel))
    assert told.args == ["Export cancelled; nothing was written.", "info"]
    assert list(tmp_path.glob("arm*")) == list(tmp_path.glob(".arm*")) == []
    assert dialog.isVisible()
    assert dialog.start_button.isEnabled()


def test_what_is_drawn_after_the_dialog_was_opened_is_exported(dialog, hand, tmp_path, qtbot):
    other = film(length=5, fill="#00ff00", background="#0000ff")
    hand.session.apply("Draw", lambda document: replace(other, length=5))
    exported(dialog, hand, qtbot)
    picture = QImage(str(tmp_path / "arm frames" / "arm.0001.png"))
    assert picture.pixelColor(0, 0).getRgb() == (0, 0, 255, 255)


def test_a_second_call_brings_the_open_dialog_back(dialog, hand):
    hand.menu("file.export")
    assert hand.editor.export_dialog is dialog


# The clipboard


def test_a_frame_is_copied_as_a_picture_with_its_alpha(hand):
    hand.session.new(film(length=5, fill="#785ae6"), "arm")
    QTest.keyClick(hand.canvas, Qt.Key.Key_C, CTRL_SHIFT)
    data = QGuiApplication.clipboard().mimeData()
    picture = QImage.fromData(data.data("image/png"), "PNG")
    assert (picture.width(), picture.height()) == (64, 48)
    assert picture.pixelColor(12, 12).getRgb() == (120, 90, 230, 255)
    assert picture.pixelColor(0, 0).alpha() == picture.pixelColor(20, 20).alpha() == 0
    assert data.hasImage()
    assert hand.message == "Frame 1 is on the clipboard as picture."


def test_a_frame_is_copied_as_svg(hand):
    hand.session.new(film(length=5), "arm")
    hand.session.go_to(5)
    QTest.keyClick(hand.canvas, Qt.Key.Key_C, CTRL_ALT)
    data = QGuiApplication.clipboard().mimeData()
    root = ElementTree.fromstring(bytes(data.data("image/svg+xml")))
    path = next(root.iter("{http://www.w3.org/2000/svg}path"))
    numbers = np.array(path.get("d").replace("M", " ").replace("Z", " ").split(), float).reshape(-1, 2)
    expected = np.concatenate([o.points for o in hand.session.layer.keyframes[-1].drawing.outlines])
    assert np.array_equal(numbers, expected)
    assert data.text().startswith("<svg ")
