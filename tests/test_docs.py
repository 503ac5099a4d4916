"""The pages say what is: commands, outputs, keys, links, pictures and examples are held to the program."""

import re
import shlex
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtGui import QImage

import resources
from app.actions import ACTIONS
from app.cli import HELP, display
from app.cli.commands import COMMANDS

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
CI = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
PAGES = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
PICTURES = sorted((ROOT / "docs" / "pictures").glob("*.png"))
LARGEST_PICTURE = 300_000


def fenced(language, page=README):
    """Return the texts of the fenced blocks of a language."""
    return re.findall(rf"^```{language}\n(.*?)^```", page, re.MULTILINE | re.DOTALL)


def page_id(page):
    return page.relative_to(ROOT).as_posix()


# the commands


def test_the_first_command_installs_the_test_extra_and_runs_the_demo():
    first, test, _ = fenced("sh")
    steps = first.strip().split(" && ")
    assert steps == ["python3 -m venv .venv", ".venv/bin/pip install -e '.[test]'", ".venv/bin/inkbetween demo"]
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert "inkbetween" in project["scripts"]
    assert any(x.startswith("pytest>") for x in project["optional-dependencies"]["test"])
    assert "demo" in COMMANDS
    assert test == ".venv/bin/pytest\n"


def test_what_must_pass_before_a_change_lands_runs_the_readmes_test_command():
    lines = CI.splitlines()
    assert "python3 -m venv .venv" in lines
    assert any(x.startswith(".venv/bin/pip install ") and "-e '.[test]'" in x for x in lines)
    for command in fenced("sh")[1].splitlines():
        assert command in lines


def test_contributing_names_every_check_that_must_pass():
    checks = fenced("sh", (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))[1].splitlines()
    run = CI[CI.index("--version\n") :].splitlines()[1:]
    assert sorted(checks) == sorted(x for x in run if x.startswith(".venv/bin/"))


def test_the_debian_packages_are_those_that_the_program_asks_for():
    base, window = fenced("sh")[2].splitlines()
    assert base.removeprefix("sudo apt install python3-venv ") == display.PACKAGES
    assert window.removeprefix("sudo apt install ").split() == list(display.WINDOW_LIBRARIES.values())
    assert f"need=({display.PACKAGES})" in CI


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_every_command_that_is_named_exists(page):
    named = re.findall(r"(?:`|\$ |bin/)inkbetween ([a-z]+)\b(?!\.)", page.read_text(encoding="utf-8"))
    assert set(named) <= set(COMMANDS)
    assert all(re.search(rf"^  {name}\b", HELP, re.MULTILINE) for name in named)


@pytest.fixture
def folder(tmp_path):
    """A folder in which the README's commands find the samples and may write."""
    shutil.copytree(resources.folder() / "samples", tmp_path / "resources" / "samples")
    return tmp_path


def test_the_commands_answer_what_the_readme_shows(folder):
    (session,) = fenced("console")
    entries = re.findall(r"^\$ inkbetween (.*)\n((?:(?!\$ ).*\n)*)", session, re.MULTILINE)
    assert session.count("$ ") == len(entries) > 2
    for words, answer in entries:
        ended = subprocess.run(
            [sys.executable, "-m", "app", *shlex.split(words)],
            capture_output=True,
            text=True,
            cwd=folder,
            env=_environment(),
            timeout=120,
            check=False,
        )
        assert (ended.returncode, ended.stdout, ended.stderr) == (0, answer, ""), words


def _environment():
    import os

    return os.environ | {"PYTHONPATH": str(ROOT), "QT_QPA_PLATFORM": "offscreen"}


def test_every_key_of_the_tutorial_is_in_the_table_of_actions():
    named = set(re.findall(r"<kbd>(.+?)</kbd>", README))
    assert named
    assert named <= {key for spec in ACTIONS for key in spec.keys}


# the engine


def test_the_example_of_the_engine_runs():
    (example,) = fenced("python")
    assert len(example.splitlines()) < 10
    made = {}
    exec(compile(example, "README.md", "exec"), made)
    frames, before, after = made["frames"], made["before"], made["after"]
    assert frames.shape == (24, len(before), 2)
    assert {tuple(p) for p in made["square"]} <= {tuple(p) for p in frames[0]}
    assert {tuple(p) for p in made["arrow"]} <= {tuple(p) for p in frames[-1]}
    np.testing.assert_array_equal(frames[-1], after)


def test_the_example_of_the_engine_needs_no_qt():
    (example,) = fenced("python")
    script = f"import sys\n{example}\nsys.exit(any(name.startswith('PySide6') for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", script], cwd=ROOT, timeout=60, check=False).returncode == 0


# links, files, pictures


def slug(heading):
    """Return the anchor that a page viewer gives a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_every_internal_link_leads_somewhere(page):
    text = page.read_text(encoding="utf-8")
    prose = re.sub(r"^```.*?^```|`[^`\n]*`", "", text, flags=re.MULTILINE | re.DOTALL)
    links = re.findall(r"\]\(([^)\s]+)\)", prose) + re.findall(r'(?:src|srcset)="([^"]+)"', prose)
    for link in links:
        if link.startswith("https://"):
            continue
        name, _, heading = link.partition("#")
        target = (page.parent / name).resolve() if name else page
        assert target.exists(), link
        assert target.is_relative_to(ROOT), link
        if heading:
            headings = re.findall(r"^#+ (.+)$", target.read_text(encoding="utf-8"), re.MULTILINE)
            assert heading in map(slug, headings), link


@pytest.mark.parametrize("page", PAGES, ids=page_id)
def test_every_file_that_is_named_exists(page):
    named = re.findall(
        r"`((?:app|core|docs|tests|resources|\.ci)/[\w./-]*)`",
        re.sub(r"::\w+", "", page.read_text(encoding="utf-8")),
    )
    assert [x for x in named if not (ROOT / x).exists()] == []


def test_every_decision_is_in_the_index():
    index = (ROOT / "docs" / "decisions" / "README.md").read_text(encoding="utf-8")
    pages = sorted(p.name for p in (ROOT / "docs" / "decisions").glob("0*.md"))
    assert sorted(re.findall(r"\((0\d+-[\w-]+\.md)\)", index)) == pages


def test_every_runtime_dependency_is_explained_and_no_other():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    names = {re.match(r"[\w-]+", x)[0] for x in project["dependencies"]}
    page = (ROOT / "docs" / "decisions" / "0007-dependencies.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| ([\w-]+) \|", page, re.MULTILINE)) - {"package"} == names


def test_the_pictures_are_small_and_each_is_shown():
    shown = {Path(x).name for x in re.findall(r'(?:src|srcset)="([^"]+)"', README)}
    assert {p.name for p in PICTURES} == shown
    assert max(p.stat().st_size for p in PICTURES) < LARGEST_PICTURE


def test_the_script_makes_every_picture_in_the_size_that_is_shown(tmp_path):
    script = ROOT / "docs" / "make_pictures.py"
    subprocess.run([sys.executable, script, tmp_path], cwd=ROOT, env=_environment(), timeout=300, check=True)
    made = sorted(tmp_path.glob("*.png"))
    assert [p.name for p in made] == [p.name for p in PICTURES]
    for new, shown in zip(made, PICTURES, strict=True):
        a, b = QImage(str(new)), QImage(str(shown))
        assert a.size() == b.size()
        assert shades(a) > 20  # a window that failed to paint is one grey


def shades(image):
    small = image.scaled(160, 100)
    return len({small.pixel(x, y) for x in range(0, 160, 3) for y in range(0, 100, 3)})
