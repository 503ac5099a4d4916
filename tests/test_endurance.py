"""A little of what tests/endurance does at length: real processes are killed, hostile files opened."""

import random
import sys
import tempfile
from pathlib import Path

import pytest

from core.errors import InkbetweenError
from core.io.project import save
from core.io.svg import read_svg

FOLDER = Path(__file__).resolve().parent / "endurance"


@pytest.fixture
def scripts(monkeypatch):
    """Return a function that imports a script of the folder."""
    monkeypatch.syspath_prepend(str(FOLDER))
    before = set(sys.modules)
    yield __import__
    for name in set(sys.modules) - before:
        if str(FOLDER) in str(getattr(sys.modules[name], "__file__", "")):
            del sys.modules[name]


def test_a_program_killed_at_work_leaves_work_that_opens(scripts, monkeypatch):
    kill = scripts("kill_while_editing")
    monkeypatch.setattr(kill, "LONGEST_S", 3.0)  # how much was lost is a matter of time, and not for a test
    assert isinstance(kill.attempt(5), kill.Run)


def test_a_program_killed_while_it_saves_leaves_the_old_file_or_the_new_one(scripts):
    kill, films = scripts("kill_while_saving"), scripts("films")
    document = films.many_vertices(kill.VERTICES)
    for seed in range(3):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "film.inkb"
            save(document, path)
            assert kill.run(seed, path, document) in ("old", "new")


@pytest.mark.parametrize("how", ["damaged", "redrawn"])
def test_a_mutated_svg_gives_drawings_or_one_sentence(scripts, how):
    mutations, rng = scripts("mutations"), random.Random(4)
    for _ in range(120):
        content = rng.choice(mutations.SVGS)
        content = (
            mutations.damaged(content, rng, mutations.TOKENS)
            if how == "damaged"
            else mutations.redrawn(content, rng)
        )
        if len(content) < 100_000:
            try:
                assert read_svg(content, tolerance=None).drawings
            except InkbetweenError as e:
                assert "\n" not in str(e)  # noqa: PT017
