"""Fields beside the canvas: who has the keys after typing, and that nothing lies over anything else."""

from itertools import pairwise

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from core.model.document import Document
from core.model.drawing import Drawing, Outline
from core.model.edits import put_drawing, set_layer
from tests.app.conftest import CTRL
from tests.app.sketches import square

Key = Qt.Key


def type_into(hand, field, text, end):
    field.setFocus()
    field.selectAll()
    QTest.keyClicks(field, text)
    QTest.keyClick(field, end)


def test_return_keeps_what_was_typed_and_the_next_keys_are_the_canvass(hand) -> None:
    field = hand.editor.window.timeline.length_field
    type_into(hand, field, "12", Key.Key_Return)
    assert hand.session.document.length == 12
    assert hand.canvas.hasFocus()
    hand.key(Key.Key_P)
    assert hand.canvas.tool is hand.editor.window.tools["tool.pen"]
    hand.key(Key.Key_Z, CTRL)
    assert hand.session.document.length == 24


@pytest.mark.parametrize("name", ["length_field", "rate_field", "frame_field"])
def test_escape_takes_back_what_was_typed(hand, name) -> None:
    field, before = getattr(hand.editor.window.timeline, name), hand.session.document
    shown = field.text()
    type_into(hand, field, "12", Key.Key_Escape)
    assert (field.text(), hand.session.document is before, hand.session.frame) == (shown, True, 1)
    assert hand.session.undo_stack.count() == 0
    assert hand.canvas.hasFocus()


@pytest.mark.parametrize("sheet", [False, True])
@pytest.mark.parametrize("width", [1000, 1200, 1440])
def test_nothing_in_the_bar_of_the_timeline_lies_over_anything_else(hand, width, sheet) -> None:
    window = hand.editor.window
    hand.editor.view_state.set(sheet=sheet)
    window.resize(width, 560)
    QTest.qWait(1)
    bar = window.timeline.frame_field.parentWidget()
    shown = [w for w in bar.children() if w.isWidgetType() and w.isVisible()]
    places = sorted((w.mapTo(window, QPoint()).x(), w.width()) for w in shown)
    assert all(x + w <= after for (x, w), (after, _) in pairwise(places))
    assert window.timeline.frame_field.isVisible()
    assert window.timeline.length_field.isVisible()


@pytest.mark.parametrize("tool", ["tool.pen", "tool.pencil", "tool.correspond", "tool.pin"])
def test_a_locked_layer_is_told_at_the_press_whatever_draws(hand, tool) -> None:
    drawn = put_drawing(Document(), 1, 1, Drawing((Outline(1, square(100, 100, 50)),)))
    hand.session.new(set_layer(drawn, 1, locked=True))
    before = hand.session.document
    hand.menu(tool)
    hand.press((300.0, 300.0))
    assert hand.message == "Layer 'Layer 1' is locked; unlock it to change it"
    hand.move((400.0, 300.0))
    hand.release((400.0, 300.0))
    assert hand.session.document is before
    assert not hand.canvas.tool.busy
