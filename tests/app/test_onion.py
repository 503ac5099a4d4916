"""The onion skin: which drawings it shows, and that painted ones are kept."""

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from core.model.edits import add_layer, put_drawing, set_step

SQUARE = [(400.0, 300.0), (800.0, 300.0), (800.0, 700.0), (400.0, 700.0)]
HOUSE = [(1100.0, 400.0), (1300.0, 250.0), (1500.0, 400.0), (1500.0, 800.0), (1100.0, 800.0)]


def two_keyframes(hand):
    """Draw on frames 1 and 24 with the pen."""
    hand.key("p")
    hand.click(*SQUARE, SQUARE[0])
    hand.key(Qt.Key.Key_End)
    hand.click(*HOUSE, HOUSE[0])
    hand.key("v")


@pytest.fixture
def fields(hand):
    two_keyframes(hand)
    hand.session.go_to(12)
    return hand.editor.window.timeline.onion_fields


def item(hand):
    return next(x for x in hand.canvas._items if type(x).__name__ == "OnionItem")


def frames(hand, side):
    return sorted(s.frame for s in hand.canvas.content.onion if s.side == side)


def choose(hand, fields, option, value):
    """Open the small window and press one of its buttons."""
    QTest.mouseClick(fields.more, Qt.MouseButton.LeftButton)
    QTest.mouseClick(fields.options.choices[option].button(value), Qt.MouseButton.LeftButton)
    fields.options.close()


def paint(hand):
    return hand.canvas.grab().toImage()


def test_it_shows_as_many_drawings_as_asked_for_fainter_the_farther(hand, fields) -> None:
    fields.before.setValue(3)
    fields.after.setValue(1)
    fields.options.strength.setValue(80)
    skins = hand.canvas.content.onion
    assert [s.side for s in skins] == ["before"] * 3 + ["after"]
    assert [s.strength for s in skins] == pytest.approx([0.4, 0.6, 0.8, 0.8])
    hand.key("o")
    assert hand.canvas.content.onion == ()


def test_a_narrow_window_keeps_the_button_and_its_window_the_counts(hand, fields) -> None:
    assert fields.before.isVisible()
    hand.editor.window.resize(1100, 700)
    assert not fields.before.isVisible()
    assert fields.more.isVisible()
    QTest.mouseClick(fields.more, Qt.MouseButton.LeftButton)
    counts = fields.options.counts
    QTest.keyClick(counts["before"], Qt.Key.Key_Up)
    assert (counts["before"].value(), fields.before.value()) == (3, 3)
    assert frames(hand, "before") == [9, 10, 11]
    fields.options.close()


def test_a_drawing_held_for_two_frames_counts_once(hand, fields) -> None:
    hand.session.apply("Twos", set_step, 1, 1, 2)
    assert frames(hand, "before") == [7, 9]  # frame 12 shows the drawing of frame 11
    assert frames(hand, "after") == [13, 15]


def test_only_keyframes_if_asked_for(hand, fields) -> None:
    choose(hand, fields, "onion_keys", "keys")
    assert (frames(hand, "before"), frames(hand, "after")) == ([1], [24])


def test_the_last_drawing_is_no_neighbour_of_itself(hand, fields) -> None:
    hand.session.go_to(24)
    assert frames(hand, "after") == []
    assert frames(hand, "before") == [22, 23]


def test_all_visible_layers_show_it_and_each_can_be_switched_off(hand, fields) -> None:
    drawing = hand.session.document.layers[0].keyframes[0].drawing
    hand.session.apply("Add", add_layer, "second")
    second = hand.session.document.layers[-1].id
    hand.session.apply("Draw", put_drawing, second, 1, drawing)
    choose(hand, fields, "onion_all", "every")
    assert {s.layer for s in hand.canvas.content.onion} == {1}  # a single drawing has no neighbours
    hand.session.apply("Draw", put_drawing, second, 20, drawing)
    assert {s.layer for s in hand.canvas.content.onion} == {1, second}
    QTest.mouseClick(fields.more, Qt.MouseButton.LeftButton)
    switch = fields.options.layer_switches[1]
    QTest.mouseClick(switch, Qt.MouseButton.LeftButton, pos=QPoint(8, switch.height() // 2))
    assert {s.layer for s in hand.canvas.content.onion} == {second}
    fields.options.close()
    hand.session.new()
    assert hand.editor.view_state.options.onion_off == frozenset()


def test_the_tints_change_the_pixels_and_are_remembered(hand, fields, settings, qtbot) -> None:
    hand.settle(qtbot)
    red = paint(hand)
    choose(hand, fields, "onion_tints", "blue and orange")
    assert paint(hand) != red
    assert settings.text("view/onion_tints") == "blue and orange"
    assert "blue" in fields.before.toolTip()


def test_a_repaint_paints_no_drawing_again_and_a_step_only_the_new_one(hand, fields, qtbot) -> None:
    hand.settle(qtbot)
    paint(hand)
    onion = item(hand)
    skins, sheets = onion.pictures.painted, onion.sheets.painted
    paint(hand)
    assert (onion.pictures.painted, onion.sheets.painted) == (skins, sheets)
    hand.key(".")
    hand.settle(qtbot)
    paint(hand)
    # 11 and 12 come up before, 14 and 15 after; 14 is there already, and 11 too, in the other colour only
    assert onion.pictures.painted - skins <= 2
    assert onion.sheets.painted == sheets + 1


def test_pictures_are_what_painting_directly_gives(hand, fields, qtbot) -> None:
    hand.settle(qtbot)
    kept = paint(hand)
    gesture = hand.session.begin("Nothing")  # within a gesture nothing is kept
    direct = paint(hand)
    gesture.cancel()
    a, b = (np.array(x.bits()).reshape(x.height(), -1, 4).astype(int) for x in (kept, direct))
    assert np.abs(a - b).max() <= 20  # opacity is applied to a picture instead of to a stroke


def test_panning_by_whole_pixels_and_zooming_show_the_right_place(hand, fields, qtbot) -> None:
    hand.settle(qtbot)
    paint(hand)
    painted = item(hand).pictures.painted
    hand.canvas._set_camera(hand.canvas.camera.panned(40, 30))
    paint(hand)
    assert item(hand).pictures.painted == painted
    for factor in (8.0, 0.01):
        hand.canvas.zoom(factor)
        kept = paint(hand)
        gesture = hand.session.begin("Nothing")
        direct = paint(hand)
        gesture.cancel()
        a, b = (np.array(x.bits()).reshape(x.height(), -1, 4).astype(int) for x in (kept, direct))
        assert np.abs(a - b).max() <= 20


def test_the_kept_pictures_are_bounded(hand, fields, qtbot) -> None:
    hand.settle(qtbot)
    item(hand).pictures.capacity = 300_000
    for frame in range(2, 24):
        hand.session.go_to(frame)
        paint(hand)
    pictures = item(hand).pictures
    assert pictures.pixels <= 300_000 or len(pictures._kept) == 1
