"""The command palette, by keys."""

from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest

from app.dialogs.palette import Entry, ranked, score
from tests.app.conftest import CTRL


@pytest.fixture
def palette(hand):
    hand.key("k", CTRL)
    made = hand.editor.guidance.palette
    assert made.isVisible()
    assert made.field.hasFocus()
    return made


def entry(text, enabled=True, keys="", words=""):
    return Entry(text, "Menu", keys, lambda: None, enabled, words)


def texts(query, *names):
    return [e.text for e in ranked(query, [entry(n) for n in names])]


def test_whole_words_and_beginnings_come_before_scattered_letters() -> None:
    names = ("Copy Drawing to Other Keyframe", "Next Kind of Lines", "Keys and Mouse", "Add Keyframe Here")
    assert texts("key", *names)[0] == "Keys and Mouse"
    assert texts("akh", *names) == ["Add Keyframe Here"]
    assert texts("lines", *names) == ["Next Kind of Lines"]
    assert texts("xyz", *names) == []


def test_spaces_do_not_matter() -> None:
    assert texts("add key", "Add Keyframe Here") == texts("addkey", "Add Keyframe Here") == ["Add Keyframe Here"]


def test_a_key_finds_its_action_first() -> None:
    found = ranked("f6", [entry("Final 6"), entry("Add", keys="F6")])
    assert found[0].text == "Add"


@example("aba a", "aaa")
@given(st.text(alphabet="abc d", max_size=12), st.text(alphabet="abc d", max_size=6))
def test_exactly_the_texts_that_hold_the_letters_in_order_are_found(text, query) -> None:
    letters = iter(text.replace(" ", ""))
    holds = all(c in letters for c in query.replace(" ", ""))
    if holds:
        assert score(query, text) > 0
    else:
        assert score(query, text) == 0


def test_enter_runs_what_was_typed_and_gives_the_keys_back_to_the_canvas(hand, palette) -> None:
    QTest.keyClicks(palette.field, "pencil")
    assert palette.shown[0] == "Pencil"
    QTest.keyClick(palette.field, Qt.Key.Key_Return)
    assert hand.canvas.tool.name == "Pencil"
    assert not palette.isVisible()
    assert hand.canvas.hasFocus()


def test_arrows_choose_and_pass_over_what_cannot_be_done_now(hand, palette) -> None:
    QTest.keyClicks(palette.field, "select")
    first = palette.shown.index("Select")
    names = palette.shown
    QTest.keyClick(palette.field, Qt.Key.Key_Down)
    QTest.keyClick(palette.field, Qt.Key.Key_Up)
    assert palette.list.currentItem().text(0) == names[first]


def test_what_cannot_be_done_is_greyed_and_enter_does_nothing(hand, palette) -> None:
    QTest.keyClicks(palette.field, "undo")
    assert palette.shown[0] == "Undo"
    assert palette.list.topLevelItem(0).isDisabled()
    document = hand.session.document
    QTest.keyClick(palette.field, Qt.Key.Key_Return)
    assert palette.isVisible()
    assert hand.session.document is document


def test_escape_closes_and_a_click_beside_it_too(hand, palette) -> None:
    QTest.keyClick(palette.field, Qt.Key.Key_Escape)
    assert not palette.isVisible()
    assert hand.canvas.hasFocus()
    hand.key("k", CTRL)
    hand.click((20.0, 1000.0))
    assert not palette.isVisible()


def test_samples_and_recent_files_are_found_and_open(hand, palette, settings, tmp_path: Path) -> None:
    QTest.keyClicks(palette.field, "bird wing")
    QTest.keyClick(palette.field, Qt.Key.Key_Return)
    assert hand.session.name == "bird wing"
    path = tmp_path / "my own film.inkb"
    hand.session.save(path)
    settings.add_recent(path)
    hand.session.new()
    hand.key("k", CTRL)
    QTest.keyClicks(palette.field, "own film")
    assert palette.shown[0] == path.name
    QTest.mouseClick(
        palette.list.viewport(),
        Qt.MouseButton.LeftButton,
        pos=palette.list.visualItemRect(palette.list.topLevelItem(0)).center(),
    )
    assert hand.session.path == path


def test_every_action_of_the_menus_is_there_with_its_key(hand, palette) -> None:
    table = hand.editor.window.table
    shown = {(e.text, e.keys) for e in palette._shown}
    left_out = ("file.recent", "help.find")
    actions = {n: a for n, a in table.actions.items() if n not in left_out}
    assert {(a.text().rstrip("…"), table.key_of(n)) for n, a in actions.items()} <= shown
