"""The layer panel, by mouse and keys."""

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from app.layercolors import LAYER_COLORS
from core.model.document import Document, Layer
from core.model.edits import add_outline, set_parent
from tests.app.conftest import LEFT, NONE
from tests.app.sketches import square


@pytest.fixture
def panel(hand):
    document = Document(layers=(Layer(1, "body"), Layer(2, "arm"), Layer(3, "hand")))
    hand.session.new(add_outline(document, 2, 1, square(300.0, 300.0, 300.0)))
    hand.session.set_layer(2)
    return hand.editor.window.layer_panel


def names(panel):
    return [panel.parents.itemText(i) for i in range(panel.parents.count())]


def tick(box):
    QTest.mouseClick(box, LEFT, NONE, QPoint(8, box.height() // 2))


def test_the_panel_shows_the_active_layer(hand, panel) -> None:
    assert panel.name_field.text() == "arm"
    hand.session.set_layer(3)
    assert panel.name_field.text() == "hand"
    assert panel.opacity_field.value() == 100
    assert panel.visible_box.isChecked()
    assert not panel.locked_box.isChecked()


def test_a_layer_is_renamed_and_an_empty_name_is_not_taken(hand, panel) -> None:
    panel.name_field.setFocus()
    panel.name_field.selectAll()
    QTest.keyClicks(panel.name_field, "upper arm")
    QTest.keyClick(panel.name_field, Qt.Key.Key_Return)
    assert hand.session.layer.name == "upper arm"
    panel.name_field.setFocus()
    panel.name_field.selectAll()
    QTest.keyClick(panel.name_field, Qt.Key.Key_Backspace)
    QTest.keyClick(panel.name_field, Qt.Key.Key_Return)
    assert hand.session.layer.name == panel.name_field.text() == "upper arm"
    assert hand.session.undo_stack.count() == 1


def test_opacity_by_slider_and_by_field_is_one_step_a_sweep(hand, panel) -> None:
    panel.opacity.setFocus()
    for _ in range(5):
        QTest.keyClick(panel.opacity, Qt.Key.Key_Down)
    assert hand.session.layer.opacity == 0.95
    assert panel.opacity_field.value() == 95
    assert hand.session.undo_stack.count() == 1
    panel.opacity_field.setFocus()
    panel.opacity_field.selectAll()
    QTest.keyClicks(panel.opacity_field, "40")
    QTest.keyClick(panel.opacity_field, Qt.Key.Key_Return)
    assert hand.session.layer.opacity == 0.4
    assert panel.opacity.value() == 40
    hand.menu("edit.undo")
    assert hand.session.layer.opacity == 1.0


def test_a_colour_is_chosen_from_the_menu_and_given_up_again(hand, panel) -> None:
    entries = {a.text(): a for a in panel.color_menu().actions()}
    entries["Teal"].trigger()
    assert hand.session.layer.color == LAYER_COLORS["Teal"]
    {a.text(): a for a in panel.color_menu().actions()}["Automatic"].trigger()
    assert hand.session.layer.color is None


def test_a_layer_follows_another_but_none_that_follows_it(hand, panel) -> None:
    assert names(panel) == ["none", "body", "hand"]
    panel.parents.setFocus()
    QTest.keyClick(panel.parents, Qt.Key.Key_Down)
    assert hand.session.layer.parent == 1
    hand.session.show_document(set_parent(hand.session.document, 3, 2))
    assert names(panel) == ["none", "body"]
    hand.session.set_layer(1)
    assert names(panel) == ["none"]
    assert not panel.parents.isEnabled()
    hand.session.set_layer(3)
    assert panel.parents.currentText() == "arm"
    panel.parents.setFocus()
    for _ in names(panel):
        QTest.keyClick(panel.parents, Qt.Key.Key_Up)
    assert hand.session.layer.parent is None


def test_hide_and_lock_are_undone_one_by_one(hand, panel) -> None:
    tick(panel.visible_box)
    tick(panel.locked_box)
    layer = hand.session.layer
    assert (layer.visible, layer.locked) == (False, True)
    assert panel.note.text() == "locked"
    hand.menu("edit.undo")
    assert not panel.locked_box.isChecked()
    hand.menu("edit.undo")
    assert panel.visible_box.isChecked()
