"""A folder of SVG drawings as keyframes."""

import numpy as np
import pytest

from core.errors import CancelledError, FileFormatError, StorageError
from core.io.film import film_document
from core.io.svg_folder import frames_of, read_svg_folder


def drawing(left, extra="", size=(100, 50)):
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size[0]}" height="{size[1]}">'
        f'<rect x="{left}" y="5" width="20" height="20" fill="#ff0000"/>{extra}</svg>'
    )


@pytest.fixture
def folder(tmp_path):
    made = tmp_path / "walk"
    made.mkdir()
    for number, left in ((1, 0), (9, 30), (21, 60)):
        (made / f"walk.{number:04}.svg").write_text(drawing(left))
    (made / "notes.txt").write_text("mine")
    return made


def test_numbers_in_the_names_are_the_frames(folder):
    film = read_svg_folder(folder)
    (layer,) = film.layers
    assert (layer.name, film.length, film.size) == ("walk", 21, (100, 50))
    assert [k.frame for k in layer.keyframes] == [1, 9, 21]
    lefts = [float(k.drawing.outlines[0].points[:, 0].min()) for k in layer.keyframes]
    assert lefts == [0, 30, 60]
    assert film.left_out == ()


def test_it_becomes_a_project_of_its_own(folder):
    document = film_document(read_svg_folder(folder))
    assert (document.stage.width, document.stage.height, document.length) == (100, 50, 21)
    assert [x.id for x in document.layers] == [1]
    assert np.array_equal(document.layers[0].keyframes[0].drawing.outlines[0].points.min(axis=0), (0, 5))


@pytest.mark.parametrize(
    ("names", "frames"),
    [
        (["a1", "a2", "a3"], [1, 9, 17]),  # no gap to draw in
        (["a1", "a3", "a4"], [1, 3, 4]),
        (["a0", "a8"], [1, 9]),
        (["a5", "b5"], [1, 9]),
        (["head", "tail"], [1, 9]),
        (["a1", "a999999"], [1, 9]),
        (["only 12"], [1]),
    ],
)
def test_without_useful_numbers_they_are_spaced_evenly(names, frames):
    assert frames_of(names) == frames


def test_the_tenth_comes_after_the_second(tmp_path):
    for name in ("key 10", "key 2"):
        (tmp_path / f"{name}.svg").write_text(drawing(int(name[4:])))
    film = read_svg_folder(tmp_path)
    assert [k.frame for k in film.layers[0].keyframes] == [2, 10]
    assert film.layers[0].keyframes[0].drawing.outlines[0].points[:, 0].min() == 2


def test_what_is_left_out_is_named_with_its_file(folder):
    (folder / "walk.0009.svg").write_text(drawing(3, "<text>a</text>"))
    assert read_svg_folder(folder).left_out == ("a text of walk.0009.svg",)


def test_progress_rises_to_one_and_cancel_stops(folder):
    seen = []
    read_svg_folder(folder, progress=seen.append)
    assert seen == sorted(seen)
    assert seen[-1] <= 1
    with pytest.raises(CancelledError):
        read_svg_folder(folder, cancelled=lambda: True)


def test_an_empty_folder_a_broken_file_and_no_folder_are_one_sentence(folder, tmp_path):
    with pytest.raises(FileFormatError, match=r"^there is no SVG file in the folder "):
        read_svg_folder(tmp_path)
    (folder / "walk.0009.svg").write_text("<svg")
    with pytest.raises(FileFormatError, match=r"^cannot import walk\.0009\.svg: "):
        read_svg_folder(folder)
    with pytest.raises(StorageError, match=r"^cannot read the folder .*: no such file"):
        read_svg_folder(tmp_path / "none")
