"""`inkbetween new`, as typed."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.cli import main
from core import load
from core.geometry.outline import locate
from core.model.motion import PlanCache, pictures_at

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 300 200">'


@pytest.fixture
def drawings(tmp_path, monkeypatch):
    """Two drawings in the current folder."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.svg").write_text(f'{HEAD}<path fill="red" d="M10 10H110V110H10z"/></svg>')
    (tmp_path / "b.svg").write_text(f'{HEAD}<circle cx="200" cy="100" r="50" fill="blue"/><text>b</text></svg>')
    return tmp_path


def test_two_drawings_become_a_film(drawings, capsys):
    assert main(["new", "a.svg", "b.svg", "-o", "ab.inkb", "--frames", "12", "--method", "linear"]) == 0
    document = load(drawings / "ab.inkb")
    (layer,) = document.layers
    assert (document.stage.width, document.stage.height, document.length) == (300, 200, 12)
    assert layer.frames() == (1, 12)
    assert layer.keyframes[0].span.method == "linear"
    assert layer.keyframes[0].drawing.outlines[0].points.tolist() == [[10, 10], [110, 10], [110, 110], [10, 110]]
    circle = layer.keyframes[1].drawing
    assert circle.style.fill == "#0000ff"
    assert np.allclose(np.hypot(*(circle.outlines[0].points - (200, 100)).T), 50)
    said = capsys.readouterr()
    assert said.out == "ab.inkb: 12 frames, 300 x 200 px\n"
    assert said.err == "inkbetween: b.svg: not taken over: a text\n"


def test_twenty_four_frames_and_intrinsic_unless_told_otherwise(drawings):
    assert main(["new", "a.svg", "a.svg", "-o", "aa.inkb"]) == 0
    document = load(drawings / "aa.inkb")
    assert document.length == 24
    assert document.layers[0].keyframes[0].span.method == "intrinsic"


def test_a_file_that_is_there_is_replaced_only_by_force(drawings, capsys):
    (drawings / "ab.inkb").write_text("mine")
    assert main(["new", "a.svg", "b.svg", "-o", "ab.inkb"]) == 1
    assert capsys.readouterr().err == (
        "inkbetween: ab.inkb exists already; choose another name, or replace it with --force\n"
    )
    assert (drawings / "ab.inkb").read_text() == "mine"
    assert main(["new", "a.svg", "b.svg", "-o", "ab.inkb", "--force"]) == 0
    assert load(drawings / "ab.inkb").length == 24


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (None, "cannot read"),
        ("no", "cannot import b.svg: it is no SVG"),
        (f"{HEAD}<text>b</text></svg>", "there is no path or shape"),
        ('<!DOCTYPE svg [<!ENTITY a "b">]><svg>&a;</svg>', "entities"),
    ],
)
def test_a_bad_drawing_is_one_sentence_and_nothing_is_written(drawings, content, words, capsys):
    (drawings / "b.svg").unlink()
    if content is not None:
        (drawings / "b.svg").write_text(content)
    assert main(["new", "a.svg", "b.svg", "-o", "ab.inkb"]) == 1
    said = capsys.readouterr().err
    assert said.startswith("inkbetween: ")
    assert words in said
    assert said.count("\n") == 1
    assert not (drawings / "ab.inkb").exists()


@pytest.mark.parametrize(
    "words",
    [
        ["a.svg", "b.svg"],
        ["a.svg", "b.svg", "-o", "x.inkb", "--frames", "1"],
        ["a.svg", "b.svg", "-o", "x.inkb", "--frames", "many"],
        ["a.svg", "b.svg", "-o", "x.inkb", "--method", "magic"],
    ],
)
def test_wrong_words_are_wrong_usage(drawings, words, capsys):
    assert main(["new", *words]) == 2
    assert capsys.readouterr().err.startswith("usage: inkbetween new")
    assert not (drawings / "x.inkb").exists()


def test_no_window_toolkit_is_imported(drawings):
    code = (
        "import sys; from app.cli import main; main(['new', 'a.svg', 'b.svg', '-o', 'ab.inkb']);"
        "sys.exit(any(m.startswith(('PySide6', 'pyqtgraph')) for m in sys.modules))"
    )
    command = [sys.executable, "-c", code]
    assert subprocess.run(command, cwd=drawings, env=None, check=False).returncode == 0


def test_a_folder_of_svg_becomes_keyframes_at_the_numbers_of_the_names(drawings, capsys):
    (drawings / "walk").mkdir()
    for name, frame in (("a", 1), ("b", 9)):
        (drawings / f"{name}.svg").rename(drawings / "walk" / f"walk.{frame:04}.svg")
    assert main(["new", "walk", "-o", "walk.inkb", "--method", "linear"]) == 0
    document = load("walk.inkb")
    assert capsys.readouterr().out.startswith("walk.inkb: 9 frames, ")
    (layer,) = document.layers
    assert (layer.name, layer.frames()) == ("walk", (1, 9))
    assert layer.keyframes[0].span.method == "linear"


def test_an_exported_lottie_comes_back_as_a_project_that_looks_the_same(drawings, capsys):
    assert main(["new", "a.svg", "b.svg", "-o", "ab.inkb", "--method", "linear", "--frames", "9"]) == 0
    assert main(["export", "ab.inkb", "ab.json"]) == 0
    assert main(["new", "ab.json", "-o", "back.inkb"]) == 0
    first, back = load("ab.inkb"), load("back.inkb")
    assert (back.stage, back.rate, back.length) == (first.stage, first.rate, first.length)
    assert len(back.layers) == 1
    plans = PlanCache()
    for frame in (1, 4, 9):
        ours, theirs = (pictures_at(d, frame, plans)[0].outlines for d in (first, back))
        for (a, _), (b, _) in zip(ours, theirs, strict=True):
            for points, other in ((a, b), (b, a)):
                assert locate(other, points, closed=True)[1].max() < 0.01


def test_one_drawing_alone_or_a_length_for_a_folder_is_one_sentence(drawings, capsys):
    assert main(["new", "a.svg", "-o", "x.inkb"]) == 1
    assert "a.svg alone makes no film" in capsys.readouterr().err
    assert main(["new", ".", "-o", "x.inkb", "--frames", "7"]) == 1
    assert "a length of its own" in capsys.readouterr().err
    assert not Path("x.inkb").exists()
