"""What comes in from elsewhere, through the menus of the real window."""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QTimer, QUrl
from PySide6.QtGui import QDragEnterEvent, QDropEvent, QFont, QFontDatabase, QImage, QPainterPath
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QDialogButtonBox, QFileDialog

import resources
from app.dialogs.importing import ImportDialog
from app.dialogs.letters import LettersDialog
from app.letters import letter_outlines
from core import load
from core.geometry.outline import signed_area
from core.model.document import Reference

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1920 1080">'
RING = "M100 100H500V500H100zM200 200V400H400V200z"
SQUARE = [(400.0, 300.0), (800.0, 300.0), (800.0, 700.0), (400.0, 700.0)]


@pytest.fixture
def sketch(tmp_path: Path) -> Path:
    """A red ring, a blue circle and a text."""
    path = tmp_path / "sketch.svg"
    circle = '<circle id="ball" cx="900" cy="500" r="100" fill="blue" stroke="black" stroke-width="3"/>'
    path.write_text(f'{HEAD}<path id="ring" d="{RING}" fill="red"/>{circle}<text>hello</text></svg>')
    return path


@pytest.fixture
def photo(tmp_path: Path) -> Path:
    image = QImage(40, 40, QImage.Format.Format_RGB32)
    image.fill(Qt.GlobalColor.red)
    path = tmp_path / "photo.png"
    assert image.save(str(path))
    return path


def choose(monkeypatch, path: Path) -> None:
    """Answer the next file dialogs with a path."""
    monkeypatch.setattr(QFileDialog, "getOpenFileName", lambda *a, **k: (str(path), ""))


def arrived(hand, qtbot) -> None:
    qtbot.waitUntil(lambda: hand.editor.incoming.import_dialog is None, timeout=20_000)


def drop(hand, *paths: Path) -> None:
    window, mime = hand.editor.window, QMimeData()
    mime.setUrls([QUrl.fromLocalFile(str(p)) for p in paths])
    move, left, none = Qt.DropAction.CopyAction, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    enter = QDragEnterEvent(QPoint(300, 300), move, mime, left, none)
    QApplication.sendEvent(window, enter)
    assert enter.isAccepted()
    QApplication.sendEvent(window, QDropEvent(QPointF(300, 300), move, mime, left, none))


# SVG


def test_an_svg_becomes_the_keyframe_at_the_playhead_in_one_undo_step(hand, sketch, monkeypatch, qtbot) -> None:
    choose(monkeypatch, sketch)
    hand.session.go_to(7)
    hand.key(Qt.Key.Key_I, Qt.KeyboardModifier.ControlModifier)
    arrived(hand, qtbot)
    (keyframe,) = hand.session.layer.keyframes
    assert keyframe.frame == 7
    assert len(keyframe.drawing.outlines) == 3
    assert keyframe.drawing.style.fill == "#ff0000"
    assert keyframe.drawing.outlines[0].points.tolist() == [[100, 100], [500, 100], [500, 500], [100, 500]]
    assert hand.message == (
        "Imported sketch.svg as the keyframe at 7, 3 outlines; not taken over: a text, "
        "1 of 2 styles (a keyframe has one, the first is used)."
    )
    assert hand.session.undo_stack.undoText() == "Import SVG"
    hand.menu("edit.undo")
    assert hand.session.layer.keyframes == ()


def test_an_svg_becomes_layers_named_like_its_paths(hand, sketch, monkeypatch, qtbot) -> None:
    choose(monkeypatch, sketch)
    hand.menu("file.import_layers")
    arrived(hand, qtbot)
    layers = hand.session.document.layers
    assert [x.name for x in layers] == ["Layer 1", "ring", "ball"]
    assert [k.drawing.style.fill for x in layers for k in x.keyframes] == ["#ff0000", "#0000ff"]
    assert layers[2].keyframes[0].drawing.style.width == 3
    assert hand.session.layer is layers[2]
    assert hand.message == "Imported sketch.svg as 2 layers; not taken over: a text."
    hand.menu("edit.undo")
    assert len(hand.session.document.layers) == 1


def test_a_dropped_svg_is_imported_and_a_dropped_project_opened(hand, sketch, tmp_path, qtbot) -> None:
    drop(hand, sketch)
    arrived(hand, qtbot)
    assert hand.session.layer.frames() == (1,)
    hand.session.save(tmp_path / "film.inkb")
    document = hand.session.document
    hand.session.new()
    drop(hand, tmp_path / "film.inkb")
    assert hand.session.document == document


@pytest.mark.parametrize("content", ["no", '<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>', f"{HEAD}</svg>"])
def test_a_bad_svg_is_one_sentence_and_nothing_changes(hand, tmp_path, content, qtbot) -> None:
    (tmp_path / "bad.svg").write_text(content)
    document = hand.session.document
    drop(hand, tmp_path / "bad.svg")
    arrived(hand, qtbot)
    assert hand.message.startswith("Cannot import bad.svg: ")
    assert hand.session.document is document
    assert hand.session.undo_stack.count() == 0


@pytest.fixture
def big(tmp_path: Path) -> Path:
    path = tmp_path / "big.svg"
    curves = "".join(f"c{i % 7} 1 2 {i % 5} 5 6" for i in range(400))
    path.write_text(f"{HEAD}" + f'<path fill="none" stroke="red" d="M0 0{curves}"/>' * 500 + "</svg>")
    return path


def test_a_big_file_shows_its_progress_and_the_window_stays_awake(hand, big, qtbot) -> None:
    hand.editor.incoming.import_path(big)
    dialog = hand.editor.incoming.import_dialog
    assert isinstance(dialog, ImportDialog)
    assert dialog.isVisible()
    done: list[int] = []  # how much of the work was done at each turn of the window's loop
    beat = QTimer(hand.editor)
    beat.timeout.connect(lambda: done.append(dialog.bar.value()))
    beat.start(20)
    qtbot.waitUntil(lambda: dialog.bar.value() > 400, timeout=20_000)
    beat.stop()
    hand.press_button(dialog.buttons.button(QDialogButtonBox.StandardButton.Cancel))
    arrived(hand, qtbot)
    assert hand.message == "The import of big.svg was cancelled."
    assert hand.session.layer.keyframes == ()
    read = [share for share in done if share >= 250]  # the file is taken apart before, which is quick
    assert len(read) > 3
    assert np.diff(read).max() <= 100  # of 1000: the window never waits for more than a small part of the work


def test_escape_cancels_and_a_second_import_waits_its_turn(hand, big, sketch, qtbot) -> None:
    hand.editor.incoming.import_path(big)
    hand.editor.incoming.import_path(sketch)
    assert hand.message.startswith("Another file is being read")
    QTest.keyClick(hand.editor.incoming.import_dialog, Qt.Key.Key_Escape)
    arrived(hand, qtbot)
    assert "cancelled" in hand.message


def test_nothing_of_it_is_imported_before_the_first_svg() -> None:
    code = (
        "import sys; from app.bootstrap import Editor, make_application; make_application(); e = Editor();"
        "e.preview.stop(); print(sorted({'svgelements', 'defusedxml', 'core.io.svg'} & set(sys.modules)))"
    )
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ended.stdout.strip() == "[]"


def test_closing_the_window_ends_an_import(hand, big) -> None:
    hand.editor.incoming.import_path(big)
    job = hand.editor.incoming.import_dialog.job
    hand.editor.window.close()
    assert not job._thread.is_alive()
    assert hand.editor.incoming.import_dialog is None


# letters


@pytest.fixture
def font(qapp) -> QFont:
    number = QFontDatabase.addApplicationFont(str(resources.folder() / "fonts" / "DejaVuSans.ttf"))
    return QFont(QFontDatabase.applicationFontFamilies(number)[0])


@pytest.mark.parametrize(("text", "count"), [("A", 2), ("B", 3), ("il", 3), ("8\n8", 6), ("  ", 0), ("", 0)])
def test_letters_have_their_holes(font, text, count) -> None:
    outlines = letter_outlines(text, font, 400, (500, 300))
    assert len(outlines) == count
    if outlines:
        every = np.concatenate(outlines)
        assert np.allclose((every.min(axis=0) + every.max(axis=0)) / 2, (500, 300))
        assert all(len(np.unique(o, axis=0)) == len(o) for o in outlines)
        assert max(map(len, outlines)) < 120


def test_a_hole_runs_the_other_way_and_straight_strokes_have_few_vertices(font) -> None:
    outlines = letter_outlines("A", font, 1000, (0, 0))
    areas = [float(signed_area(o)) for o in outlines]
    assert areas[0] * areas[1] < 0
    assert sorted(len(o) for o in outlines) == [3, 8]


def test_overlapping_strokes_of_a_letter_become_one_outline(font, monkeypatch) -> None:
    cross = QPainterPath()
    cross.addRect(0, 40, 100, 20)
    cross.addRect(40, 0, 20, 100)
    monkeypatch.setattr("app.letters._path", lambda *_: QPainterPath(cross))
    (outline,) = letter_outlines("+", font, 1000, (0, 0))
    assert abs(float(signed_area(outline))) == pytest.approx(3600, abs=1)


def test_letters_are_inserted_at_the_playhead_in_one_undo_step(hand, font, monkeypatch) -> None:
    def write(dialog: LettersDialog) -> bool:
        dialog.font_field.setCurrentFont(font)
        dialog.text.setFocus()
        dialog.text.selectAll()
        QTest.keyClicks(dialog.text, "B8")
        dialog.height_field.setValue(600)
        dialog.bold.setChecked(True)
        assert dialog.count.text().startswith("outlines 6")
        dialog.accept()
        return True

    monkeypatch.setattr(LettersDialog, "exec", write)
    hand.session.go_to(3)
    hand.menu("insert.letters")
    drawing = hand.session.layer.keyframe_at(3).drawing
    assert len(drawing.outlines) == 6
    every = np.concatenate([o.points for o in drawing.outlines])
    assert np.allclose((every.min(axis=0) + every.max(axis=0)) / 2, (960, 540))
    assert hand.session.undo_stack.undoText() == "Insert Letters"
    hand.menu("edit.undo")
    assert hand.session.layer.keyframes == ()


def test_a_text_without_outlines_cannot_be_inserted(hand, monkeypatch) -> None:
    def look(dialog: LettersDialog) -> bool:
        dialog.text.setPlainText("   ")
        assert not dialog.buttons.button(QDialogButtonBox.StandardButton.Ok).isEnabled()
        dialog.grab()
        dialog.reject()
        return False

    monkeypatch.setattr(LettersDialog, "exec", look)
    hand.menu("insert.letters")
    assert hand.session.undo_stack.count() == 0


# reference pictures


def color_at(hand, place) -> tuple[int, int, int]:
    color = hand.picture().pixelColor(hand.view(place))
    return color.red(), color.green(), color.blue()


def test_a_picture_lies_under_the_stage_and_its_opacity_is_one_undo_step(hand, photo, monkeypatch) -> None:
    choose(monkeypatch, photo)
    bare = color_at(hand, (960, 900))
    hand.menu("insert.reference")
    assert hand.session.layer.keyframe_at(1).reference == Reference(str(photo), 0.5)
    half = color_at(hand, (960, 900))
    assert half[0] > bare[0]
    assert color_at(hand, (100, 540)) == color_at(hand, (1800, 540))  # a square picture leaves the sides free
    panel = hand.editor.window.reference_panel
    assert panel.isVisible()
    steps = hand.session.undo_stack.count()
    panel.opacity.setSliderDown(True)
    for value in (60, 80, 100):
        panel.opacity.setValue(value)
        assert hand.session.layer.keyframe_at(1).reference.opacity == value / 100
    panel.opacity.setSliderDown(False)
    assert hand.session.undo_stack.count() == steps + 1
    assert color_at(hand, (960, 900)) == (255, 0, 0)
    hand.menu("edit.undo")
    assert color_at(hand, (960, 900)) == half
    hand.menu("insert.no_reference")
    assert hand.session.layer.keyframe_at(1).reference is None
    assert not panel.isVisible()
    assert color_at(hand, (960, 900)) == bare


def test_a_picture_stays_until_the_next_keyframe_and_is_not_in_the_final_look(hand, photo, qtbot) -> None:
    drop(hand, photo)
    hand.key(Qt.Key.Key_P)
    hand.click(*SQUARE, SQUARE[0])
    hand.key(Qt.Key.Key_End)
    hand.click(*SQUARE, SQUARE[0])
    bare = color_at(hand, (960, 900))
    hand.session.go_to(12)
    hand.settle(qtbot)
    assert color_at(hand, (960, 900)) != bare
    hand.menu("view.final")
    assert color_at(hand, (960, 900)) == bare


def test_drawing_over_a_picture_on_an_empty_keyframe(hand, photo, qtbot) -> None:
    drop(hand, photo)
    hand.session.go_to(24)
    hand.menu("key.copy")
    hand.settle(qtbot)
    hand.key(Qt.Key.Key_P)
    hand.click(*SQUARE, SQUARE[0])
    hand.session.go_to(12)
    hand.settle(qtbot)
    hand.picture()


def test_a_missing_picture_is_told_once_and_shown_as_nothing(hand, photo, qtbot) -> None:
    bare = color_at(hand, (960, 900))
    drop(hand, photo)
    photo.unlink()
    hand.session.go_to(2)
    assert color_at(hand, (960, 900)) == bare
    qtbot.waitUntil(lambda: "photo.png is not there" in hand.message, timeout=2000)
    hand.editor.window.message_bar.hide()
    hand.session.go_to(3)
    hand.picture()
    qtbot.wait(30)
    assert hand.message == ""


def test_a_picture_beside_the_project_moves_with_it(hand, photo, tmp_path) -> None:
    drop(hand, photo)
    hand.session.save(tmp_path / "film.inkb")
    assert hand.session.layer.keyframe_at(1).reference.path == str(photo)
    assert load(tmp_path / "film.inkb").layers[0].keyframes[0].reference.path == "photo.png"
    moved = tmp_path / "elsewhere"
    moved.mkdir()
    (tmp_path / "film.inkb").rename(moved / "film.inkb")
    photo.rename(moved / "photo.png")
    hand.session.open(moved / "film.inkb")
    assert hand.session.layer.keyframe_at(1).reference.path == str(moved / "photo.png")
    hand.session.save(tmp_path / "other.inkb")
    assert load(tmp_path / "other.inkb").layers[0].keyframes[0].reference.path == "elsewhere/photo.png"


# Keyframes


def test_a_dropped_folder_of_svg_becomes_a_layer_with_keyframes(hand, sketch, tmp_path, qtbot) -> None:
    folder = tmp_path / "walk"
    folder.mkdir()
    for frame in (1, 9):
        (folder / f"walk.{frame:04}.svg").write_bytes(sketch.read_bytes())
    hand.session.go_to(3)
    drop(hand, folder)
    arrived(hand, qtbot)
    assert hand.session.layer.name == "walk"
    assert hand.session.layer.frames() == (3, 11)
    assert hand.message.startswith("Imported walk as 1 layer with 2 keyframes")
    hand.session.undo_stack.undo()
    assert len(hand.session.document.layers) == 1


def test_lottie_comes_in_by_the_menu_with_what_was_left_out_named(hand, tmp_path, monkeypatch, qtbot) -> None:
    square = {"i": [[0, 0]] * 4, "o": [[0, 0]] * 4, "v": [[0, 0], [9, 0], [9, 9], [0, 9]], "c": True}
    red = {"ty": "fl", "c": {"k": [1, 0, 0, 1]}, "o": {"k": 100}}
    text = {"ty": 5, "nm": "t", "ip": 0, "op": 24, "ks": {}}
    shape = {"ty": 4, "nm": "box", "ip": 0, "op": 24, "ks": {}, "shapes": [{"ty": "sh", "ks": {"k": square}}, red]}
    animation = {"fr": 24, "ip": 0, "op": 24, "w": 100, "h": 100, "layers": [text, shape]}
    (tmp_path / "box.json").write_text(json.dumps(animation))
    choose(monkeypatch, tmp_path / "box.json")
    hand.menu("file.import_lottie")
    arrived(hand, qtbot)
    assert hand.message == "Imported box.json as 1 layer with 1 keyframe; not taken over: a text."
    assert hand.session.layer.keyframes[0].drawing.style.fill == "#ff0000"


def test_a_folder_without_drawings_is_said_in_one_sentence(hand, tmp_path, monkeypatch, qtbot) -> None:
    monkeypatch.setattr(QFileDialog, "getExistingDirectory", lambda *a, **k: str(tmp_path))
    hand.menu("file.import_folder")
    arrived(hand, qtbot)
    assert hand.message.startswith("There is no SVG file in the folder")
