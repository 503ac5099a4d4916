import json
import os
import pty
import re
import signal
import subprocess
import sys
import time
import types
from pathlib import Path

import pytest

import app
import resources
from app.cli import display, main
from core.io.project import save
from tests.app.sketches import film

ROOT = Path(app.__file__).parents[1]


@pytest.fixture
def project(tmp_path):
    path = tmp_path / "my arm.inkb"
    save(film(length=6), path)
    return path


@pytest.fixture
def no_display(monkeypatch):
    for name in ("QT_QPA_PLATFORM", "DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(sys, "platform", "linux")


@pytest.fixture
def opened(monkeypatch):
    """What a stand-in for the window was asked to open: paths, and whether they are samples."""
    paths = []
    window = types.ModuleType("app.bootstrap")
    window.run = lambda path, sample: paths.append((path, sample)) or 0
    monkeypatch.setitem(sys.modules, "app.bootstrap", window)
    monkeypatch.setattr(app, "bootstrap", window, raising=False)
    return paths


def run(*words, **options):
    return subprocess.run(
        [sys.executable, *words], capture_output=True, text=True, cwd=ROOT, timeout=60, check=False, **options
    )


def imported_by(*words):
    """Return the exit code of a command and the names of all modules that it imported."""
    script = (
        "import sys; from app.cli import main\ncode = main(sys.argv[1:])\n"
        "sys.stderr.write(' '.join(sys.modules)); sys.exit(code)"
    )
    ended = run("-c", script, *words)
    return ended.returncode, set(ended.stderr.split())


# Answers


def test_python_m_app_is_the_program():
    ended = run("-m", "app", "--version")
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, f"inkbetween {app.__version__}\n", "")


def test_the_version_is_the_one_that_is_packaged():
    assert f'\nversion = "{app.__version__}"\n' in (ROOT / "pyproject.toml").read_text()


@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help_names_every_command(word, capsys):
    assert main([word]) == 0
    said = capsys.readouterr().out
    assert all(f"\n  {command} " in said for command in ("check", "demo", "export", "info"))


@pytest.mark.parametrize("command", ["check", "demo", "export", "info"])
def test_every_command_has_its_own_help(command, capsys):
    assert main([command, "--help"]) == 0
    assert capsys.readouterr().out.startswith(f"usage: inkbetween {command} ")


@pytest.mark.parametrize("words", [["--help"], ["--version"]])
def test_help_and_version_import_neither_numpy_nor_qt_nor_argparse(words):
    code, modules = imported_by(*words)
    assert code == 0
    assert not modules & {"numpy", "scipy", "PySide6", "shiboken6", "pyqtgraph", "argparse", "core"}


def test_info_imports_neither_qt_nor_scipy(project):
    code, modules = imported_by("info", str(project))
    assert code == 0
    assert not modules & {"PySide6", "shiboken6", "pyqtgraph", "scipy"}


def test_an_export_imports_no_window_toolkit(project, tmp_path):
    code, modules = imported_by("export", str(project), str(tmp_path / "out"))
    assert code == 0
    assert not modules & {"PySide6.QtWidgets", "pyqtgraph"}


def test_info_says_what_is_in_a_project(project, capsys):
    assert main(["info", str(project)]) == 0
    said = capsys.readouterr().out
    assert "64 x 48 px, transparent" in said
    assert "6 frames, 24 a second" in said
    assert "keyframe at 1: outlines 2, vertices 8, then auto\n" in said
    assert said.endswith("keyframe at 6: outlines 2, vertices 8\n")


def test_info_for_programs_is_json(project, capsys):
    assert main(["info", str(project), "--json"]) == 0
    keyframe = {"outlines": 2, "vertices": 8, "method": "auto"}
    assert json.loads(capsys.readouterr().out) == {
        "file": str(project),
        "stage": {"width": 64, "height": 48, "background": None},
        "rate": "24",
        "length": 6,
        "layers": [{"name": "Layer 1", "visible": True, "keyframes": [{"frame": f, **keyframe} for f in (1, 6)]}],
    }


# Exports


def test_export_writes_all_frames_under_the_projects_name(project, tmp_path, capsys):
    out = tmp_path / "out"
    assert main(["export", str(project), str(out)]) == 0
    assert sorted(os.listdir(out)) == [f"my arm.{n:04}.png" for n in range(1, 7)]
    assert capsys.readouterr() == (f"6 frames, {out / 'my arm.0001.png'} to my arm.0006.png\n", "")


def test_export_takes_frames_size_name_and_background(project, tmp_path):
    out = tmp_path / "out"
    options = ["--frames", "2-4", "--size", "128x96", "--name", "a", "--background", "102030"]
    assert main(["export", str(project), str(out), *options]) == 0
    assert sorted(os.listdir(out)) == ["a.0002.png", "a.0003.png", "a.0004.png"]
    from PySide6.QtGui import QImage

    picture = QImage(str(out / "a.0002.png"))
    assert (picture.width(), picture.height()) == (128, 96)
    assert picture.pixelColor(0, 0).getRgb() == (16, 32, 48, 255)


def test_export_works_on_a_machine_without_a_display(project, tmp_path):
    bare = {k: v for k, v in os.environ.items() if k not in ("QT_QPA_PLATFORM", "DISPLAY", "WAYLAND_DISPLAY")}
    ended = run("-m", "app", "export", str(project), str(tmp_path / "out"), "--frames", "3", env=bare)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert os.listdir(tmp_path / "out") == ["my arm.0003.png"]


def test_progress_is_one_line_and_only_on_a_terminal(project, tmp_path):
    command = [sys.executable, "-m", "app", "export", str(project), str(tmp_path / "out")]
    main_end, other_end = pty.openpty()
    ended = subprocess.run(command, stdout=subprocess.PIPE, stderr=other_end, cwd=ROOT, check=False)
    os.close(other_end)
    shown = os.read(main_end, 10_000).decode()
    os.close(main_end)
    assert ended.returncode == 0
    *steps, cleared = shown.split("\x1b[K")
    assert steps[-1] == cleared + "\r"
    # a frame that took long is told how many seconds are left; frames that came together share a step
    found = [re.fullmatch(r"\r\[(#+\.*)\] (\d) of 6(, \d+ s left)?", step) for step in steps[:-1]]
    counts = [int(step[2]) for step in found]
    assert counts == sorted(set(counts))
    assert counts[-1] == 6
    assert all(step[1] == ("#" * (5 * int(step[2]))).ljust(30, ".") for step in found)


def test_ctrl_c_stops_between_frames_with_130_and_no_traceback(tmp_path):
    project, out = tmp_path / "long.inkb", tmp_path / "out"
    save(film(length=20_000, size=(640, 480)), project)
    command = [sys.executable, "-m", "app", "export", str(project), str(out)]
    export = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, cwd=ROOT)
    deadline = time.monotonic() + 30
    while time.monotonic() < deadline and not (out / "long.0003.png").exists():
        time.sleep(0.01)
    export.send_signal(signal.SIGINT)
    said = export.communicate(timeout=30)[1]
    files = os.listdir(out)
    assert export.returncode == 130
    assert (
        said == f"inkbetween: stopped; {len(files)} complete frames stay in {out}, and --continue makes the rest\n"
    )
    assert 3 <= len(files) < 20_000
    assert all((out / name).read_bytes().endswith(b"IEND\xaeB`\x82") for name in files)


# Opening the window


def test_a_file_is_opened_in_the_editor(project, opened):
    assert main([str(project)]) == 0
    assert main([]) == 0
    assert opened == [(str(project), False), (None, False)]


def test_a_command_comes_before_a_file_of_its_name(project, opened, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    project.rename("info")
    assert main(["./info"]) == 0
    assert main(["--", "info"]) == 0
    assert main(["info"]) == 2
    assert opened == [("./info", False), ("info", False)]


def test_without_a_display_the_editor_says_so(project, opened, no_display, capsys):
    assert main([str(project)]) == 1
    said = capsys.readouterr().err
    assert said.startswith("inkbetween: there is no display to open a window on")
    assert said.count("\n") == 1
    assert opened == []


def test_demo_opens_the_sample(opened):
    assert main(["demo"]) == 0
    assert opened == [(str(resources.folder() / "samples" / f"{resources.DEMO}.inkb"), True)]


def test_demo_without_a_display_exports_beside_what_is_there(no_display, tmp_path, monkeypatch, capsys):
    stand_in = tmp_path / "stand-in"
    (stand_in / "samples").mkdir(parents=True)
    save(film(length=3), stand_in / "samples" / f"{resources.DEMO}.inkb")
    monkeypatch.setattr(resources, "folder", lambda: stand_in)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "inkbetween-demo").write_text("mine")
    assert main(["demo"]) == 0
    frames = sorted((tmp_path / "inkbetween-demo-2").iterdir())
    assert [f.name for f in frames] == [f"{resources.DEMO}.{n:04}.png" for n in (1, 2, 3)]
    assert str(frames[0]) in capsys.readouterr().out
    assert (tmp_path / "inkbetween-demo").read_text() == "mine"


def test_missing_libraries_of_x_are_named_by_their_packages(no_display, opened, monkeypatch, capsys):
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr(display, "_loads", lambda name: "cursor" not in name)
    assert main([]) == 1
    assert capsys.readouterr().err == (
        "inkbetween: Qt cannot open a window without libxcb-cursor0; "
        "on Debian and Ubuntu: sudo apt install libxcb-cursor0\n"
    )


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (
            ImportError("libEGL.so.1: cannot open shared object file: No such file or directory"),
            "Qt cannot be loaded, libEGL.so.1 is missing; on Debian and Ubuntu: sudo apt install libgl1 libegl1 ",
        ),
        (ModuleNotFoundError("No module named 'PySide6'", name="PySide6"), "Qt for Python is not installed; "),
    ],
)
def test_a_qt_that_cannot_be_imported_is_one_sentence(error, sentence, project, tmp_path, monkeypatch, capsys):
    class Refuse:
        def find_spec(self, name, path=None, target=None):
            if name == "app.export.export":
                raise error

    monkeypatch.delitem(sys.modules, "app.export.export", raising=False)
    monkeypatch.delattr("app.export.export", raising=False)
    monkeypatch.setattr(sys, "meta_path", [Refuse(), *sys.meta_path])
    assert main(["export", str(project), str(tmp_path / "out")]) == 1
    said = capsys.readouterr().err
    assert said.startswith(f"inkbetween: {sentence}")
    assert said.count("\n") == 1


# What is wrong


@pytest.mark.parametrize(
    ("option", "text", "sentence"),
    [
        ("--size", "1920", "'1920' is no size; write width x height in px, such as 1920x1080"),
        ("--size", "0x10", "0x10 px; each side must be 1 to 16384"),
        ("--size", "99999x10", "99999x10 px; each side must be 1 to 16384"),
        ("--frames", "all", "'all' are no frames; write the first and the last, such as 1-24"),
        ("--frames", "5-2", "'5-2' ends before it begins; write 2-5"),
        ("--frames", "0-3", "'0-3' begins at 0; the first frame is 1"),
        ("--background", "pinkish", "'pinkish' is no colour; write rrggbb, rrggbbaa, none or stage"),
    ],
)
def test_a_wrong_argument_is_wrong_usage(option, text, sentence, project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "out"), option, text]) == 2
    assert capsys.readouterr().err.splitlines()[-1].endswith(f"argument {option}: {sentence}")
    assert not (tmp_path / "out").exists()


def test_a_command_that_is_none_is_named_with_those_that_are(opened, capsys):
    assert main(["exprot", "a.inkb", "out"]) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert said.endswith("there is no command 'exprot'; the commands are check, demo, export, info, new")
    assert opened == []


def test_a_place_without_a_name_is_wrong_usage(project, capsys):
    assert main(["export", str(project), ""]) == 2
    assert capsys.readouterr().err.endswith("it is empty; name a file or a folder, . for this one\n")


def test_a_file_is_not_given_the_ending_of_another_format(project, tmp_path, capsys):
    film = tmp_path / "film.mp4"
    assert main(["export", str(project), str(film), "--format", "gif"]) == 1
    assert capsys.readouterr().err == f"inkbetween: {film} ends as MP4 (H.264) does, GIF ends in .gif\n"
    assert not film.exists()


@pytest.mark.parametrize("words", [["--nonsense"], ["one.inkb", "two.inkb"], ["export", "a.inkb"], ["info"]])
def test_words_that_fit_nothing_are_wrong_usage(words, opened, capsys):
    assert main(words) == 2
    assert capsys.readouterr().err.startswith("usage: inkbetween")
    assert opened == []


def test_frames_beyond_the_film_are_a_problem_that_names_its_length(project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "out"), "--frames", "4-400"]) == 1
    assert capsys.readouterr().err == "inkbetween: frames 4 to 400 are not all in the film, which ends at 6\n"


@pytest.mark.parametrize("command", [[], ["info"], ["export"]])
def test_a_missing_file_is_a_problem(command, tmp_path, opened, capsys):
    words = [*command, str(tmp_path / "none.inkb"), *(["out"] if command == ["export"] else [])]
    assert main(words) == 1
    said = capsys.readouterr().err
    assert str(tmp_path / "none.inkb") in said
    assert said.count("\n") == 1
    assert opened == []


def test_a_file_that_is_no_project_is_a_problem_without_traceback(tmp_path):
    (tmp_path / "note.inkb").write_text("buy ink")
    ended = run("-m", "app", "info", str(tmp_path / "note.inkb"))
    assert (ended.returncode, ended.stdout) == (1, "")
    assert ended.stderr.startswith("inkbetween: cannot open note.inkb: it is no Inkbetween project")
    assert ended.stderr.count("\n") == 1


def test_a_reader_that_leaves_early_gets_no_traceback(project):
    read, write = os.pipe()
    os.close(read)
    command = [sys.executable, "-m", "app", "info", str(project)]
    ended = subprocess.run(command, stdout=write, stderr=subprocess.PIPE, cwd=ROOT, check=False)
    os.close(write)
    assert (ended.returncode, ended.stderr) == (1, b"")


def test_a_file_name_that_no_terminal_can_show_is_still_answered(tmp_path):
    name = os.fsencode(tmp_path) + b"/arm-\xff.inkb"
    save(film(), os.fsdecode(name))
    command = [sys.executable, "-m", "app", "info", name]
    ended = subprocess.run(command, capture_output=True, cwd=ROOT, check=False)
    assert ended.returncode == 0
    assert b"arm-\\udcff.inkb" in ended.stdout
