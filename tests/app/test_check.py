"""The command that looks for problems: what it says, and how it ends."""

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

import app
from app.cli import main
from core.io.project import save
from core.model.drawing import Drawing, Outline
from tests.app.sketches import film, strip, swing


@pytest.fixture
def check(tmp_path, capsys):
    """Check a document; return the exit code and what was said."""

    def run(document, *options):
        path = tmp_path / "arm.inkb"
        save(document, path)
        code = main(["check", str(path), *options])
        return code, capsys.readouterr().out

    return run


def test_a_clean_film_ends_with_0(check):
    code, said = check(film(length=6))
    assert (code, said) == (0, "4 in-betweens checked: no problem\n")


def test_every_problem_is_a_line_with_layer_and_frame_and_an_error_ends_with_1(check):
    code, said = check(swing(2.0))
    *problems, summary = said.splitlines()
    assert code == 1
    assert "layer 'arm', frame 8: edge 6 crosses edge 9 (error)" in problems
    assert all(line.startswith("layer 'arm', frame ") for line in problems)
    assert summary == "9 in-betweens checked: 7 errors, 9 warnings"
    assert len(problems) == 16


def test_warnings_alone_end_with_0(check):
    code, said = check(swing(2.0, repair=True))
    assert code == 0
    assert "(warning)" in said
    assert "(error)" not in said


def test_what_concerns_the_whole_span_is_told_with_its_frames(check):
    document = swing(2.0, repair=True)
    before, after = document.layers[0].keyframes
    crossed = strip(-2.0)
    crossed[[0, -1]] = crossed[[-1, 0]]
    before = replace(before, drawing=Drawing((Outline(1, crossed),)))
    code, said = check(document.with_layer(replace(document.layers[0], keyframes=(before, after))))
    assert code == 0
    assert said.startswith("layer 'arm', frames 3 to 13: the keyframe before crosses itself")


def test_for_programs_there_is_json(check):
    code, said = check(swing(2.0), "--json")
    told = json.loads(said)
    assert code == 1
    assert told["frames"] == 9
    first = told["problems"][0]
    assert (first["layer"], first["span"], first["frame"]) == ("arm", [3, 13], 8)
    assert (first["kind"], first["severity"], first["t"]) == ("crossing", "error", 0.5)
    assert first["text"] == "edge 6 crosses edge 9"
    assert len(first["place"]) == len(first["edges"]) == len(first["outlines"]) == 2


def test_a_file_that_is_no_project_is_a_problem_in_one_sentence(tmp_path, capsys):
    assert main(["check", str(tmp_path / "none.inkb")]) == 1
    assert capsys.readouterr().err.count("\n") == 1


def test_checking_imports_no_qt(tmp_path):
    path = tmp_path / "arm.inkb"
    save(swing(2.0, repair=True), path)
    script = (
        "import sys; from app.cli import main; main(sys.argv[1:])\n"
        "sys.exit(any(x.startswith(('PySide6', 'shiboken6', 'pyqtgraph')) for x in sys.modules))"
    )
    ended = subprocess.run(
        [sys.executable, "-c", script, "check", str(path)],
        cwd=Path(app.__file__).parents[1],
        timeout=60,
        check=False,
    )
    assert ended.returncode == 0
