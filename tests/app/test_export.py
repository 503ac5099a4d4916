import errno
import itertools
import os
import resource
import subprocess
import sys
import threading
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QSize
from PySide6.QtGui import QImage

from app.export import pool, whole
from app.export.export import export
from app.export.names import frame_path
from app.export.png import encode_png
from app.export.settings import ExportSettings
from app.painting import render_frame
from core.errors import InkbetweenError, StorageError
from core.io.project import save
from core.model.motion import PlanCache
from tests.app.sketches import film

RGBA64 = QImage.Format.Format_RGBA64_Premultiplied


def settings_of(document, folder, **changes):
    return replace(ExportSettings.whole_film(document, folder, "arm"), **changes)


def names(folder):
    return sorted(os.listdir(folder))


def decoded(path_or_bytes):
    """Return the (height, width, 4) straight channels that Qt's own reader finds."""
    content = path_or_bytes if isinstance(path_or_bytes, bytes) else path_or_bytes.read_bytes()
    return channels(QImage.fromData(content, "PNG"))


def channels(image):
    straight = image.convertToFormat(QImage.Format.Format_RGBA8888)
    rows = np.frombuffer(straight.constBits(), np.uint8).reshape(straight.height(), straight.bytesPerLine())
    return rows[:, : 4 * straight.width()].reshape(straight.height(), straight.width(), 4).copy()


def chunks(content):
    """Return the kinds of a PNG file's chunks, each with its bytes; every checksum is checked."""
    found, at = {}, 8
    while at < len(content):
        size = int.from_bytes(content[at : at + 4], "big")
        kind, body = content[at + 4 : at + 8], content[at + 8 : at + 8 + size]
        assert zlib.crc32(kind + body) == int.from_bytes(content[at + 8 + size : at + 12 + size], "big")
        found[kind] = body
        at += 12 + size
    return found


# The PNG itself


@pytest.mark.parametrize("size", [(1, 1), (3, 2), (64, 48), (257, 5), (1919, 3)])
@pytest.mark.parametrize("kind", [QImage.Format.Format_RGBA8888, QImage.Format.Format_RGB888])
def test_any_picture_comes_back_to_the_last_bit(size, kind):
    random = np.random.default_rng(size[0])
    image = QImage(*size, kind)
    rows = np.frombuffer(image.bits(), np.uint8)
    rows[:] = random.integers(0, 256, rows.size)
    assert np.array_equal(decoded(encode_png(image)), channels(image))


def test_a_picture_in_several_blocks_comes_back_too(monkeypatch):
    monkeypatch.setattr("app.export.png.BLOCK_BYTES", 1000)
    image = render_frame(film(), 1, QSize(64, 48), PlanCache(), format=RGBA64)
    assert np.array_equal(decoded(encode_png(image)), channels(image))


def test_the_file_says_eight_bits_srgb_and_nothing_else():
    image = render_frame(film(), 1, QSize(64, 48), PlanCache())
    found = chunks(encode_png(image))
    assert list(found) == [b"IHDR", b"sRGB", b"IDAT", b"IEND"]
    assert found[b"IHDR"] == bytes([0, 0, 0, 64, 0, 0, 0, 48, 8, 6, 0, 0, 0])
    assert len(zlib.decompress(found[b"IDAT"])) == 48 * (1 + 64 * 4)


# The frames


def test_files_are_numbered_as_animators_number_them(tmp_path):
    document = film(length=12)
    settings = settings_of(document, tmp_path / "new" / "folder", first=9, last=11)
    exported = export(document, settings)
    assert names(settings.out) == ["arm.0009.png", "arm.0010.png", "arm.0011.png"]
    assert exported.files == tuple(settings.out / n for n in names(settings.out))
    assert not exported.cancelled
    odd = replace(settings, separator="_", padding=2)
    assert frame_path(odd, 7).name == "arm_07.png"
    assert frame_path(odd, 12345).name == "arm_12345.png"


def test_every_frame_is_the_rendered_picture_pixel_for_pixel(tmp_path):
    document = film(length=5, stroke="#10203080")
    settings = settings_of(document, tmp_path, size=(200, 150))
    for number, file in enumerate(export(document, settings).files, start=1):
        expected = render_frame(document, number, QSize(200, 150), PlanCache(), format=RGBA64)
        assert np.array_equal(decoded(file), channels(expected))


def test_alpha_is_straight_and_edges_keep_their_colour(tmp_path):
    document = film(fill="#785ae6b4", shift=20.37)
    settings = settings_of(document, tmp_path, size=(331, 247))
    for file in export(document, settings).files:
        picture = decoded(file).astype(int)
        seen = picture[..., 3] > 0
        assert np.unique(picture[..., 3]).size > 5  # there are edges
        assert (np.abs(picture[seen][:, :3] - (120, 90, 230)) <= 1).all()
        assert picture[..., 3].max() == 180
        assert (picture[~seen] == 0).all()


def test_a_film_on_an_opaque_background_has_no_alpha_channel(tmp_path):
    document = film(background="#123456", fill="#000000")
    file = export(document, settings_of(document, tmp_path)).files[0]
    assert chunks(file.read_bytes())[b"IHDR"][9] == 2  # RGB
    assert tuple(decoded(file)[0, 0]) == (0x12, 0x34, 0x56, 255)
    transparent = export(document, settings_of(document, tmp_path, background=None, replace=True)).files[0]
    assert decoded(transparent)[0, 0, 3] == 0


def test_the_same_document_gives_the_same_bytes(tmp_path):
    document = film(length=6)
    first = export(document, settings_of(document, tmp_path / "a")).files
    second = export(document, settings_of(document, tmp_path / "b")).files
    assert [f.read_bytes() for f in first] == [f.read_bytes() for f in second]


def test_progress_counts_every_frame_in_the_calling_thread(tmp_path):
    document, seen = film(length=9), []
    export(
        document,
        settings_of(document, tmp_path),
        progress=lambda done, total: seen.append((done, total, threading.current_thread())),
    )
    assert seen == [(done, 9, threading.current_thread()) for done in range(1, 10)]


def test_frames_can_be_exported_from_any_thread_and_no_thread_is_left(tmp_path):
    document = film(length=6)
    before = threading.active_count()
    thread = threading.Thread(target=export, args=(document, settings_of(document, tmp_path)))
    thread.start()
    thread.join()
    assert len(names(tmp_path)) == 6
    assert threading.active_count() == before


def test_only_a_few_frames_are_rendered_ahead_of_those_written(tmp_path, monkeypatch):
    document = film(length=60)
    finished, ahead = [], []
    rendered = itertools.count(1)
    paint = pool.paint
    monkeypatch.setattr(pool, "paint", lambda *a: ahead.append(next(rendered) - len(finished)) or paint(*a))
    export(document, settings_of(document, tmp_path), progress=lambda done, _: finished.append(done))
    assert len(ahead) == 60
    assert max(ahead) <= pool.MOST_ENCODERS + 2


def test_huge_pictures_wait_for_one_another():
    assert pool.most_waiting((16384, 16384), 8) == 1
    assert pool.most_waiting((1920, 1080), 2) >= 2


# Stopping and failing


def test_a_cancelled_export_leaves_complete_frames_and_nothing_else(tmp_path):
    document, done = film(length=40), []
    exported = export(
        document,
        settings_of(document, tmp_path, size=(320, 240)),
        progress=lambda count, _: done.append(count),
        cancelled=lambda: len(done) >= 5,
    )
    assert exported.cancelled
    assert 5 <= len(exported.files) < 40
    assert names(tmp_path) == [f.name for f in exported.files]
    assert all(decoded(f).shape == (240, 320, 4) for f in exported.files)


def test_an_export_cancelled_at_once_writes_nothing(tmp_path):
    document = film()
    exported = export(document, settings_of(document, tmp_path), cancelled=lambda: True)
    assert exported.files == ()
    assert names(tmp_path) == []


def test_an_error_in_the_window_stops_the_export_and_leaves_no_part(tmp_path):
    document = film(length=40)

    def progress(done, total):
        raise RuntimeError("the window has gone")

    with pytest.raises(RuntimeError, match="the window has gone"):
        export(document, settings_of(document, tmp_path), progress=progress)
    assert len(names(tmp_path)) < 40
    assert all(n.endswith(".png") and not n.startswith(".") for n in names(tmp_path))


def test_a_full_disk_is_one_sentence_and_the_frames_before_stay(tmp_path, monkeypatch):
    document = film(length=8)
    replace_file, seen = os.replace, []

    def full_after_three(source, target):
        if len(seen) == 3:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        seen.append(target)
        replace_file(source, target)

    monkeypatch.setattr(whole.os, "replace", full_after_three)
    monkeypatch.setattr(pool, "MOST_ENCODERS", 1)
    with pytest.raises(StorageError, match=r"^cannot write .*arm\.0004\.png: no space left on device$"):
        export(document, settings_of(document, tmp_path))
    assert names(tmp_path) == ["arm.0001.png", "arm.0002.png", "arm.0003.png"]


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="no limit for the size of files here")
def test_a_file_cut_off_while_it_is_written_takes_nobodys_place(tmp_path):
    save(film(size=(640, 480)), tmp_path / "a.inkb")
    out = tmp_path / "out"
    out.mkdir()
    (out / "a.0001.png").write_bytes(b"the frame of yesterday")
    script = (
        "import resource, signal, sys; from app.cli import main; "
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN); resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300)); "
        "sys.exit(main(sys.argv[1:]))"
    )
    command = [sys.executable, "-c", script, "export", str(tmp_path / "a.inkb"), str(out), "--force"]
    ended = subprocess.run(command, capture_output=True, text=True, cwd=Path(whole.__file__).parents[2])
    assert ended.returncode == 1
    assert ended.stderr == f"inkbetween: cannot write {out / 'a.0001.png'}: file too large\n"
    assert names(out) == ["a.0001.png"]
    assert (out / "a.0001.png").read_bytes() == b"the frame of yesterday"


@pytest.mark.parametrize("below", ["", "deeper/still"])
def test_a_file_in_the_folders_place_is_said_and_kept(tmp_path, below):
    blocking = tmp_path / "frames"
    blocking.write_text("mine")
    document = film()
    with pytest.raises(StorageError, match=r"cannot make the folder .*frames.*: a file is in the way"):
        export(document, settings_of(document, blocking / below))
    assert blocking.read_text() == "mine"


def test_a_folder_in_a_frames_place_is_said_and_kept(tmp_path):
    document = film()
    (tmp_path / "arm.0002.png").mkdir()
    with pytest.raises(StorageError, match=r"cannot write .*arm\.0002\.png: is a directory"):
        export(document, settings_of(document, tmp_path, replace=True))
    assert (tmp_path / "arm.0002.png").is_dir()
    assert not list(tmp_path.glob(".*"))


def test_frames_outside_the_film_are_refused_before_anything_is_made(tmp_path):
    document = film(length=24)
    with pytest.raises(InkbetweenError, match=r"frames 10 to 400 are not all in the film, which ends at 24"):
        export(document, settings_of(document, tmp_path / "new", first=10, last=400))
    assert names(tmp_path) == []


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"name": ""}, "cannot begin a file name"),
        ({"name": "../arm"}, "cannot begin a file name"),
        ({"separator": "/"}, "cannot begin a file name"),
        ({"first": 0}, "frames 0 to 4 are no range"),
        ({"first": 5}, "frames 5 to 4 are no range"),
        ({"size": (0, 10)}, "0 x 10 px; each side must be 1 to 16384"),
        ({"size": (10, 99999)}, "each side must be 1 to 16384"),
        ({"padding": 0}, "frame numbers of 0 digits"),
        ({"background": "red"}, "background is 'red'"),
    ],
)
def test_settings_that_cannot_work_are_refused_with_the_reason(tmp_path, changes, sentence):
    with pytest.raises(InkbetweenError, match=sentence):
        settings_of(film(), tmp_path, **changes)
