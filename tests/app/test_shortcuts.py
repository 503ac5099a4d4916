"""Keys: presets, own ones, the dialog, the overlay, tooltips, and what the status bar says of modifiers."""

import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QAbstractButton, QAbstractSpinBox, QComboBox, QLineEdit, QSlider, QToolButton

import resources
from app.actions import ACTIONS
from app.bootstrap import Editor
from app.shortcuts import OWN, PRESETS, conflicts, preset_keys
from tests.app.conftest import CTRL, SHIFT, Hand

IDS = {spec.id for spec in ACTIONS if spec.id}
FIELDS = (QAbstractButton, QAbstractSpinBox, QComboBox, QLineEdit, QSlider)


@pytest.fixture
def shortcuts(editor):
    return editor.guidance.shortcuts


@pytest.fixture
def dialog(hand, qtbot):
    hand.menu("edit.shortcuts")
    made = hand.editor.guidance.dialog
    qtbot.addWidget(made)
    return made


def choose(dialog, name):
    row = dialog.rows[name]
    dialog.tree.scrollToItem(row)
    at = dialog.tree.visualItemRect(row).center()
    QTest.mouseClick(dialog.tree.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(60, at.y()))
    assert dialog.chosen == name


def close(hand, dialog):
    """Close the dialog; without a desktop nobody gives the window its keys back."""
    dialog.accept()
    hand.editor.window.activateWindow()
    assert QTest.qWaitForWindowActive(hand.editor.window)
    hand.canvas.setFocus()


@pytest.mark.parametrize("preset", PRESETS)
def test_no_two_actions_of_a_preset_have_the_same_key(preset) -> None:
    assert conflicts(preset_keys(preset)) == {}


@pytest.mark.parametrize("preset", PRESETS)
def test_a_preset_names_only_actions_that_exist(preset) -> None:
    assert PRESETS[preset].keys() <= IDS


def test_conflicts_are_found_however_a_key_is_written() -> None:
    assert conflicts({"a": ("ctrl+d",), "b": ("Ctrl+D", "F6"), "c": ("F6",), "d": ("F7",)}) == {
        "Ctrl+D": ("a", "b"),
        "F6": ("b", "c"),
    }


def test_a_preset_takes_the_keys_over_at_once_in_menus_and_tooltips(hand, dialog) -> None:
    dialog.presets.setFocus()
    QTest.keyClick(dialog.presets, Qt.Key.Key_Down)
    assert hand.editor.guidance.shortcuts.preset == "OpenToonz-like"
    close(hand, dialog)
    table = hand.editor.window.table
    assert table["tool.select"].shortcut().toString() == "S"
    assert table["tool.select"].toolTip() == "Select (S)"
    hand.key("g")
    assert hand.canvas.tool.name == "Pen"
    hand.key("p")
    assert hand.canvas.tool.name == "Pen"  # here P plays
    assert hand.editor.playback.playing
    hand.key("p")


def test_the_space_bar_only_pans_where_it_does_not_play(hand, shortcuts) -> None:
    shortcuts.set_preset("Animate-like")
    hand.key(Qt.Key.Key_Space)
    assert not hand.editor.playback.playing
    shortcuts.set_preset(OWN)
    hand.key(Qt.Key.Key_Space)
    assert hand.editor.playback.playing


def test_a_pressed_key_becomes_the_actions_and_is_kept_for_the_next_start(hand, dialog, settings, qtbot) -> None:
    choose(dialog, "key.copy")
    QTest.keyClick(dialog.edit, Qt.Key.Key_Y, CTRL | SHIFT)
    assert dialog.rows["key.copy"].text(1) == "Ctrl+Shift+Y"
    dialog.accept()
    assert hand.editor.window.table.key_of("key.copy") == "Ctrl+Shift+Y"
    again = Editor(settings)
    qtbot.addWidget(again.window)
    assert again.window.table["key.copy"].toolTip().endswith("(Ctrl+Shift+Y)")
    for part in (again.preview, again.ranked, again.certificates):
        part.stop()


def test_a_taken_key_names_its_owner_and_moves_only_when_told(hand, dialog, shortcuts) -> None:
    choose(dialog, "key.copy")
    QTest.keyClick(dialog.edit, Qt.Key.Key_F6)
    assert dialog.message.text() == "F6 is the key of “Add Keyframe Here”."
    assert shortcuts.own == {}
    QTest.mouseClick(dialog.take, Qt.MouseButton.LeftButton)
    assert (shortcuts.keys["key.copy"], shortcuts.keys["key.add"]) == (("F6",), ())
    assert conflicts(shortcuts.keys) == {}
    choose(dialog, "key.add")
    QTest.mouseClick(dialog.reset, Qt.MouseButton.LeftButton)
    assert "Copy Drawing to Other Keyframe" in dialog.message.text()
    QTest.mouseClick(dialog.reset_all, Qt.MouseButton.LeftButton)
    assert shortcuts.keys == preset_keys(OWN)


def test_an_action_can_be_left_without_a_key(hand, dialog, shortcuts) -> None:
    choose(dialog, "view.onion")
    QTest.mouseClick(dialog.none, Qt.MouseButton.LeftButton)
    close(hand, dialog)
    shown = hand.editor.view_state.options.onion
    hand.key("o")
    assert hand.editor.view_state.options.onion is shown
    assert hand.editor.window.table["view.onion"].toolTip() == "Onion Skin"


def test_the_search_leaves_what_has_the_text_in_its_name_or_key(dialog) -> None:
    QTest.keyClicks(dialog.search, "f6")
    assert {n for n, row in dialog.rows.items() if not row.isHidden()} == {"key.add", "key.delete"}


@pytest.mark.parametrize(
    "kept", ["", "[]", "{", '{"gone.action": ["F5"]}', '{"view.fit": 3}', '{"view.fit": [""]}']
)
def test_damaged_settings_leave_the_presets_keys(settings, qtbot, kept) -> None:
    settings.keep("shortcuts/own", kept)
    settings.keep("shortcuts/preset", "Nobody's")
    editor = Editor(settings)
    qtbot.addWidget(editor.window)
    assert editor.guidance.shortcuts.keys == preset_keys(OWN)
    for part in (editor.preview, editor.ranked, editor.certificates):
        part.stop()


def test_the_keys_on_the_empty_page_are_those_in_use(hand, shortcuts) -> None:
    item = next(x for x in hand.canvas.scene().items() if type(x).__name__ == "LabelsItem")
    assert item._advice().startswith("Press P and click")
    shortcuts.assign("tool.pen", "Ctrl+7")
    assert item._advice().startswith("Press Ctrl+7 and click")
    shortcuts.assign("tool.pen", "")
    assert item._advice().startswith("Take the pen and click")


# the overlay


def test_f1_lays_every_key_over_the_window_and_escape_or_a_click_takes_it_away(hand, qtbot) -> None:
    hand.key(Qt.Key.Key_F1)
    overlay = hand.editor.guidance.overlay
    assert overlay.geometry() == hand.editor.window.rect()
    told = {text for _, rows in overlay.groups for _, text in rows}
    table = hand.editor.window.table
    assert {table[n].text().rstrip("…") for n in IDS if table.keys_of(n)} <= told
    with qtbot.waitSignal(overlay.destroyed):
        QTest.keyClick(overlay, Qt.Key.Key_Escape)
    assert hand.editor.guidance.overlay is None
    assert hand.canvas.hasFocus()
    hand.key(Qt.Key.Key_F1)
    overlay = hand.editor.guidance.overlay
    with qtbot.waitSignal(overlay.destroyed):
        QTest.mouseClick(overlay, Qt.MouseButton.LeftButton, pos=QPoint(5, 5))


def test_the_overlay_tells_the_preset_and_its_keys(hand, shortcuts, qtbot) -> None:
    shortcuts.set_preset("Animate-like")
    hand.key(Qt.Key.Key_F1)
    overlay = hand.editor.guidance.overlay
    assert ("Return", "Play") in [row for _, rows in overlay.groups for row in rows]
    with qtbot.waitSignal(overlay.destroyed):
        QTest.keyClick(overlay, Qt.Key.Key_Escape)


# tooltips


@pytest.mark.parametrize("sample", [None, "bending arm"])
def test_every_control_has_a_tooltip_and_names_its_key(hand, qtbot, sample) -> None:
    if sample:
        hand.editor.files.open_sample(resources.folder() / "samples" / f"{sample}.inkb")
        hand.session.go_to(9)
        hand.certify(qtbot)
    bare = []
    for widget in hand.editor.window.findChildren(FIELDS[0]) + [
        w for kind in FIELDS[1:] for w in hand.editor.window.findChildren(kind)
    ]:
        inner = isinstance(widget, QLineEdit) and isinstance(widget.parent(), QAbstractSpinBox | QComboBox)
        if widget.isVisible() and not inner and not widget.objectName().startswith("qt_"):
            if not widget.toolTip():
                bare.append(widget)
            action = widget.defaultAction() if isinstance(widget, QToolButton) else None
            if action is not None and not action.shortcut().isEmpty():
                assert action.shortcut().toString() in widget.toolTip()
    assert [(type(w).__name__, w.objectName(), w.accessibleName(), w.parent()) for w in bare] == []


# the status bar


def test_the_status_bar_lights_up_what_a_held_modifier_does(hand: Hand) -> None:
    hints = hand.editor.window.hints
    assert hints.text.text().startswith("Select: Drag vertices")
    assert [n for n, label in hints.labels.items() if label.isVisible()] == ["Shift", "Alt"]
    QTest.keyPress(hand.canvas, Qt.Key.Key_Shift)
    assert hints.held == {"Shift"}
    assert hints.labels["Shift"].property("held") is True
    QTest.keyRelease(hand.canvas, Qt.Key.Key_Shift)
    assert hints.held == frozenset()
    hand.move((500.0, 500.0), held=SHIFT, button=Qt.MouseButton.NoButton)
    assert hints.held == {"Shift"}
    hand.move((510.0, 500.0), button=Qt.MouseButton.NoButton)
    assert hints.held == frozenset()


def test_every_tool_says_what_it_does_and_no_hint_needs_more_than_the_window(hand) -> None:
    hints = hand.editor.window.hints
    for name in hand.editor.window.tools:
        hand.menu(name)
        assert hints.text.text().startswith(hand.canvas.tool.name)
        assert hints.text.sizeHint().width() <= hints.text.width(), name
