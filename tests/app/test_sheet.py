"""The exposure sheet, by mouse and keys."""

from dataclasses import replace

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QLineEdit

from app.panels.sheet import EDGE
from app.panels.sheet_model import CELL
from core.model.document import Document, Keyframe, Layer
from core.model.edits import add_outline, set_layer, set_span, set_step
from core.model.timing import exposures_of
from tests.app.conftest import LEFT, NONE
from tests.app.sketches import square


@pytest.fixture
def table(hand):
    """An open sheet of two layers: one on twos with three keyframes, one that is drawn once."""
    document = Document(length=40, layers=(Layer(1, "body"), Layer(2, "shadow")))
    for frame, x in ((1, 300), (9, 700), (30, 1100)):
        document = add_outline(document, 1, frame, square(x, 300.0, 300.0))
    document = add_outline(document, 2, 5, square(600.0, 800.0, 100.0))
    for frame in (1, 9):
        document = set_span(document, 1, frame, method="linear")
    hand.session.new(set_step(document, 1, 1, 2))
    hand.session.set_layer(1)
    hand.key(Qt.Key.Key_X)
    return hand.editor.window.sheet.table


def place(table, frame, column=0):
    return table.visualRect(table.sheet.index(frame - 1, column)).center()


def edge(table, frame, column=0):
    return QPoint(place(table, frame, column).x(), table.visualRect(table.sheet.index(frame - 1, column)).bottom())


def click(table, frame, column=0):
    QTest.mouseClick(table.viewport(), LEFT, NONE, place(table, frame, column))


def drag(hand, table, start, *way, release=True):
    QTest.mousePress(table.viewport(), LEFT, NONE, start)
    for at in way:
        hand.move_on(table.viewport(), at)
    if release:
        QTest.mouseRelease(table.viewport(), LEFT, NONE, way[-1])


def column(table, index=0):
    """What is written in a column, a character a frame."""
    return [table.sheet.index(row, index).data() for row in range(table.sheet.rowCount())]


def held(hand, layer=0):
    document = hand.session.document
    return [e.count for e in exposures_of(document.layers[layer], 1, document.length)]


def test_the_sheet_says_which_drawing_every_frame_shows(table) -> None:
    assert column(table)[:12] == ["1", "|", "2", "|", "3", "|", "4", "|", "5", "6", "7", "8"]
    assert column(table)[28:] == ["25", "26", *["|"] * 10]
    assert column(table, 1) == [None] * 4 + ["1"] + ["|"] * 35
    cell = table.sheet.index(3, 0).data(CELL)
    assert (cell.number, cell.frame, cell.count, cell.keyframe, cell.first, cell.last) == (
        2,
        3,
        2,
        False,
        False,
        True,
    )
    assert table.sheet.index(8, 0).data(CELL).keyframe


def test_x_opens_and_closes_the_sheet_and_it_is_open_again_next_time(hand, table, settings) -> None:
    assert table.isVisible()
    assert settings.flag("view/sheet", False)
    hand.key(Qt.Key.Key_X)
    assert not table.isVisible()
    hand.menu("view.sheet")
    QTest.mouseClick(hand.editor.window.sheet.close_button, LEFT)
    assert not table.isVisible()
    assert not settings.flag("view/sheet", True)


def test_a_click_goes_to_the_frame_and_the_layer(hand, table) -> None:
    click(table, 7, 1)
    assert hand.session.frame == 7
    assert hand.session.layer.name == "shadow"
    hand.session.go_to(20)
    assert table.currentIndex().row() == 19
    for key, where in (
        (Qt.Key.Key_Down, (21, 2)),
        (Qt.Key.Key_Left, (21, 1)),
        (Qt.Key.Key_Up, (20, 1)),
        (Qt.Key.Key_Right, (20, 2)),
    ):
        hand.key(key, into=table)
        assert (hand.session.frame, hand.session.layer.id) == where


def test_a_number_typed_on_a_drawing_is_how_long_it_is_held(hand, table, qtbot) -> None:
    click(table, 3)
    steps = hand.session.undo_stack.count()
    hand.key(Qt.Key.Key_4, into=table)
    hand.key(Qt.Key.Key_Return, into=table.findChild(QLineEdit))
    qtbot.waitUntil(lambda: hand.session.undo_stack.count() > steps)
    assert held(hand)[:4] == [2, 4, 2, 1]
    assert hand.session.undo_stack.count() == steps + 1
    hand.menu("edit.undo")
    assert held(hand)[:4] == [2, 2, 2, 2]


def test_the_lower_edge_of_a_drawing_is_dragged(hand, table) -> None:
    drag(hand, table, edge(table, 4), place(table, 5), place(table, 7), release=False)
    assert held(hand)[:3] == [2, 5, 1]  # live: frames 3 to 7, and what is left of the next one
    QTest.mouseRelease(table.viewport(), LEFT, NONE, place(table, 7))
    assert held(hand)[:3] == [2, 5, 1]
    assert hand.session.undo_stack.count() == 1
    drag(hand, table, edge(table, 7), place(table, 5), place(table, 3))
    assert held(hand)[:3] == [2, 1, 5]


def test_the_edge_of_the_last_drawing_pushes_the_keyframe(hand, table) -> None:
    drag(hand, table, edge(table, 8) - QPoint(0, EDGE - 1), place(table, 9), place(table, 11))
    assert hand.session.document.layers[0].frames() == (1, 12, 30)
    assert held(hand)[:5] == [2, 2, 2, 5, 1]


def test_escape_gives_a_drag_up(hand, table) -> None:
    document = hand.session.document
    drag(hand, table, edge(table, 4), place(table, 7), release=False)
    assert hand.session.document != document
    hand.key(Qt.Key.Key_Escape, into=table)
    QTest.mouseRelease(table.viewport(), LEFT, NONE, place(table, 7))
    assert hand.session.document is document
    assert hand.session.undo_stack.count() == 0


def test_a_keyframe_is_dragged_to_another_frame(hand, table) -> None:
    drag(hand, table, place(table, 9), place(table, 12), place(table, 15))
    assert hand.session.document.layers[0].frames() == (1, 15, 30)
    assert hand.session.frame == 15
    assert hand.session.undo_stack.count() == 1


def test_a_drag_over_other_cells_moves_the_playhead(hand, table) -> None:
    drag(hand, table, place(table, 3), place(table, 10), place(table, 14))
    assert hand.session.frame == 14
    assert hand.session.undo_stack.count() == 0


def test_delete_takes_out_the_drawing_of_the_cell(hand, table) -> None:
    click(table, 3)
    hand.key(Qt.Key.Key_Delete, into=table)
    assert held(hand)[:3] == [4, 2, 2]
    click(table, 9)
    hand.key(Qt.Key.Key_Delete, into=table)
    assert hand.session.document.layers[0].frames() == (1, 30)
    click(table, 35)
    hand.key(Qt.Key.Key_Delete, into=table)
    assert "No drawing begins here" in hand.message


def test_the_menu_holds_divides_and_puts_on_threes(hand, table) -> None:
    def choose(text):
        action = next(a for a in table.menu().actions() if a.text() == text)
        assert action.isEnabled()
        action.trigger()

    click(table, 3)
    choose("Add Half")
    assert held(hand)[:4] == [2, 1, 1, 2]
    choose("On Threes")
    assert held(hand)[:3] == [3, 3, 2]
    choose("Hold Until Next Keyframe")
    assert held(hand)[0] == 8
    assert hand.session.layer.keyframes[0].span.hold
    choose("Hold Until Next Keyframe")
    assert held(hand)[:3] == [3, 3, 2]
    click(table, 9)
    click(table, 14)
    hand.menu("key.add")
    assert hand.session.layer.frames() == (1, 9, 14, 30)


def test_a_locked_layer_refuses_with_a_sentence(hand, table) -> None:
    hand.session.show_document(set_layer(hand.session.document, 1, locked=True))
    document = hand.session.document
    click(table, 3)
    hand.key(Qt.Key.Key_Delete, into=table)
    assert "'body' is locked" in hand.message
    hand.editor.window.message_bar.hide()
    drag(hand, table, edge(table, 4), place(table, 7), place(table, 8))
    drag(hand, table, place(table, 9), place(table, 12))
    assert hand.session.document is document
    assert not hand.session.in_gesture


def test_what_cannot_be_held_is_refused_with_a_sentence(hand, table) -> None:
    click(table, 30)
    assert not table.sheet.setData(table.currentIndex(), "3")
    assert "held to the end of the film" in hand.message
    click(table, 2, 1)
    assert not table.sheet.flags(table.currentIndex()) & Qt.ItemFlag.ItemIsEditable


def test_only_the_layer_that_changed_is_worked_out_anew(hand, table) -> None:
    table.grab()
    kept = dict(table.sheet._columns)
    click(table, 3)
    hand.key(Qt.Key.Key_Delete, into=table)
    table.grab()
    assert table.sheet._columns[2] is kept[2]
    assert table.sheet._columns[1] is not kept[1]


def test_a_large_film_shows_at_once_and_works_out_only_what_is_looked_at(hand, table) -> None:
    keys = tuple(Keyframe(f) for f in range(1, 1001, 50))
    layers = tuple(Layer(i, f"layer {i}", keyframes=keys) for i in range(1, 21))
    hand.session.new(replace(Document(), length=1000, layers=layers))
    table.grab()
    assert (table.sheet.rowCount(), table.sheet.columnCount()) == (1000, 20)
    assert len(table.sheet._columns) < 20
    hand.session.set_layer(20)
    table.grab()
    assert table.sheet.index(50, 19).data() == "51"


def test_another_document_is_shown_in_the_open_sheet(hand, table) -> None:
    click(table, 30, 1)
    hand.session.new(add_outline(Document(length=3), 1, 2, square(0.0, 0.0, 50.0)))
    assert column(table) == [None, "1", "|"]
    assert table.currentIndex().row() == 0
