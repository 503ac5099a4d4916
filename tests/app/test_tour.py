"""The tour: it goes on when a person has really done the step."""

import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

import resources
from app.bootstrap import Editor
from app.tour import STEPS
from tests.app.sketches import film

SQUARE = [(400.0, 300.0), (700.0, 300.0), (700.0, 600.0), (400.0, 600.0)]
HOUSE = [(900.0, 300.0), (1050.0, 150.0), (1200.0, 300.0), (1200.0, 600.0), (900.0, 600.0)]


@pytest.fixture
def tour(hand):
    made = hand.editor.guidance.tour
    made.offer()
    return made


@pytest.fixture
def card(hand):
    return hand.editor.guidance.card


def press(button):
    assert button.isVisible()
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)


def test_it_goes_from_step_to_step_as_they_are_done(hand, tour, card, settings) -> None:
    assert (card.isVisible(), card.title.text()) == (True, "Welcome")
    press(card.go)
    assert card.title.text() == "Draw"
    assert "<b>P</b>" in card.text.text()
    hand.key("p")
    hand.click(*SQUARE)
    assert tour.index == 0  # not before the outline is closed
    hand.click(SQUARE[0])
    assert (tour.index, card.count.text()) == (1, f"2 of {len(STEPS)}")
    hand.click(*HOUSE, HOUSE[0])
    assert tour.index == 1  # a second outline on the same frame is no second keyframe
    hand.key(Qt.Key.Key_End)
    hand.click(*HOUSE, HOUSE[0])
    assert tour.index == 2
    hand.key("c")
    hand.drag(SQUARE[0], (800.0, 400.0), HOUSE[0])
    assert hand.session.layer.keyframes[0].span.pairs
    assert tour.index == 3
    for _ in range(2):
        hand.key(",")
    assert tour.index == 3
    hand.key(",")
    assert tour.index == 4
    tour.note_export()
    assert card.title.text() == "That is all"
    assert settings.flag("tour/done", False)
    press(card.go)
    assert not card.isVisible()


def test_undoing_a_step_does_not_lead_back_and_doing_it_again_is_not_asked(hand, tour, card) -> None:
    press(card.go)
    hand.key("p")
    hand.click(*SQUARE, SQUARE[0])
    hand.key("z", Qt.KeyboardModifier.ControlModifier)
    assert tour.index == 1


def test_later_hides_it_for_this_time_and_never_for_good(hand, tour, card, settings, qtbot) -> None:
    press(card.later)
    assert not card.isVisible()
    assert not settings.flag("tour/done", False)
    tour.offer()
    press(card.never)
    assert settings.flag("tour/done", False)
    tour.offer()
    assert not card.isVisible()
    again = Editor(settings)
    qtbot.addWidget(again.window)
    again.guidance.tour.offer()
    assert again.guidance.tour.index is None
    for part in (again.preview, again.ranked, again.certificates):
        part.stop()


def test_the_help_menu_starts_it_again_on_an_empty_page(hand, card, settings) -> None:
    settings.keep("tour/done", True)
    hand.editor.files.open_sample(resources.samples()[0])
    hand.menu("help.tour")
    assert card.isVisible()
    press(card.go)
    assert not any(layer.keyframes for layer in hand.session.document.layers)
    assert card.title.text() == "Draw"


def test_a_document_that_must_not_be_lost_stays_and_the_tour_waits(hand, tour, card) -> None:
    hand.key("p")
    hand.click(*SQUARE, SQUARE[0])
    hand.editor.files.may_leave = lambda: False
    press(card.go)
    assert card.title.text() == "Welcome"
    assert hand.session.layer.keyframes


def test_the_card_stays_in_its_corner_and_names_the_keys_in_use(hand, tour, card) -> None:
    press(card.go)
    hand.editor.window.resize(1100, 640)
    canvas = hand.canvas.rect()
    assert canvas.contains(card.geometry())
    hand.editor.guidance.shortcuts.assign("tool.pen", "F7")
    assert "<b>F7</b>" in card.text.text()


def test_nothing_is_offered_by_itself_in_a_window_that_is_made(hand, card) -> None:
    assert not card.isVisible()


def test_frames_that_are_really_written_end_the_last_step(hand, tour, card, tmp_path, qtbot) -> None:
    hand.session.new(film(length=3), "arm")
    tour._go(len(STEPS) - 1)
    hand.menu("file.export")
    dialog = hand.editor.export_dialog
    dialog.fields.place.setText(str(tmp_path / "frames"))
    dialog.told.emit("Export cancelled; nothing was written.", "info")
    assert tour.index == len(STEPS) - 1
    with qtbot.waitSignal(dialog.exported, timeout=20_000):
        hand.press_button(dialog.start_button)
    assert card.title.text() == "That is all"
    assert len(list((tmp_path / "frames").iterdir())) == 3
