"""Every format read again by another program's eyes: PyAV, Pillow, an XML and a JSON reader."""

import errno
import hashlib
import json
import os
import resource
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from app.cli import main
from app.export import pool, whole
from app.export.export import export
from app.export.film import Film, same_pictures
from app.export.formats import ENDINGS, FORMATS, format_of
from app.export.names import frame_path
from app.export.presets import PRESETS, Preset, kept_presets, presets_text
from app.export.settings import ExportSettings, fitting_size
from app.export.shapes import TOLERANCE, shape_layers
from app.export.whole import InTheWayError
from core.errors import InkbetweenError, StorageError
from core.io.project import save
from core.model.document import Document, Keyframe, Layer, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import Easing
from core.model.motion import PlanCache, picture_at
from tests.app.sketches import film, square

ROOT = Path(__file__).parents[2]
MOVING = [f.id for f in FORMATS.values() if f.moving]
FILES = [f.id for f in FORMATS.values() if not f.folder]
SIZE = (96, 64)
LINEAR = Easing()
STRAIGHT = Span("linear")


def moving_film(length=7, span=STRAIGHT, **changes):
    document = film(length=length, size=SIZE, shift=40.0, side=30.0, **changes)
    layer = document.layers[0]
    keyframes = (replace(layer.keyframes[0], span=span), *layer.keyframes[1:])
    return replace(document, layers=(replace(layer, keyframes=keyframes),))


def settings_of(document, folder, form, **changes):
    out = folder / ("arm" if FORMATS[form].folder else f"arm{FORMATS[form].ending}")
    return replace(ExportSettings.whole_film(document, out, "arm", form), **changes)


def made(document, folder, form, **changes):
    settings = settings_of(document, folder, form, **changes)
    export(document, settings)
    return settings.out


def files_in(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def digest(path):
    parts = sorted(path.rglob("*")) if path.is_dir() else [path]
    return hashlib.sha256(b"".join(p.read_bytes() for p in parts if p.is_file())).hexdigest()


def reference(document, folder, background="stage"):
    """Return the straight channels of our PNG frames."""
    out = made(document, folder / "reference", "png", background=background)
    return [np.array(Image.open(p).convert("RGBA")).astype(int) for p in sorted(out.iterdir())]


def decoded(path):
    """Return the straight channels of every picture of a film, and its rate."""
    if path.suffix in (".apng", ".webp", ".gif"):
        return with_pillow(path)
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        if path.suffix == ".webm":  # only this decoder knows the alpha
            context = av.codec.CodecContext.create("libvpx-vp9", "r")
            packets = [*(p for p in container.demux(stream) if p.size), None]
            frames = [f for p in packets for f in context.decode(p)]
        else:
            frames = list(container.decode(stream))
        channels = [f.reformat(format="rgba", src_colorspace=1).to_ndarray().astype(int) for f in frames]
        return channels, stream.average_rate


def with_pillow(path):
    with Image.open(path) as picture:
        channels, times = [], []
        for i in range(picture.n_frames):
            picture.seek(i)
            picture.load()
            channels.append(np.array(picture.convert("RGBA")).astype(int))
            times.append(picture.info["duration"])
    return channels, Fraction(1000 * len(times)) / Fraction(sum(times)).limit_denominator(1000)


def over_white(channels):
    alpha = channels[..., 3:] / 255
    return np.dstack([channels[..., :3] * alpha + 255 * (1 - alpha), np.full(channels.shape[:2], 255)])


# Moving pictures


@pytest.mark.parametrize("form", MOVING)
def test_a_film_has_every_frame_its_size_and_its_rate(form, tmp_path):
    document = moving_film(length=9)
    pictures, rate = decoded(made(document, tmp_path, form))
    assert len(pictures) == 9
    assert {p.shape for p in pictures} == {(SIZE[1], SIZE[0], 4)}
    assert abs(9 / rate - 9 / document.rate) <= {"gif": Fraction(1, 100), "webp": Fraction(1, 1000)}.get(form, 0)


@pytest.mark.parametrize("form", MOVING)
def test_the_first_and_the_last_frame_are_those_of_the_png(form, tmp_path):
    document = moving_film(fill="#785ae6")
    pictures, _ = decoded(made(document, tmp_path, form))
    frames = reference(document, tmp_path)
    for seen, ours in ((pictures[0], frames[0]), (pictures[-1], frames[-1])):
        if form == "mp4":
            ours = over_white(ours)
        elif form == "gif":
            assert np.array_equal(seen[..., 3] > 127, ours[..., 3] > 127)
            assert set(np.unique(seen[..., 3])) <= {0, 255}
        else:
            assert np.abs(seen[..., 3] - ours[..., 3]).max() <= 4
        whole_pixels = ours[..., 3] == 255
        off = np.abs(seen[..., :3] - ours[..., :3])[whole_pixels]
        assert off.mean() < {"mp4": 2.5, "webm": 4.0, "prores": 1.0}.get(form, 1e-9)


@pytest.mark.parametrize("form", [f for f in MOVING if FORMATS[f].alpha == "full"])
def test_half_transparent_colours_stay_half_transparent(form, tmp_path):
    document = moving_film(fill="#785ae680")
    pictures, _ = decoded(made(document, tmp_path, form))
    ours = reference(document, tmp_path)[0]
    assert np.abs(pictures[0][..., 3] - ours[..., 3]).max() <= 4
    assert pictures[0][..., 3].max() in range(0x80 - 4, 0x80 + 5)


@pytest.mark.parametrize("form", MOVING)
def test_another_rate_keeps_the_length_of_the_film(form, tmp_path):
    document = moving_film(length=12)
    pictures, rate = decoded(made(document, tmp_path, form, rate=Fraction(12)))
    assert len(pictures) == 6
    assert abs(6 / rate - Fraction(1, 2)) <= {"gif": Fraction(1, 100), "webp": Fraction(1, 500)}.get(form, 0)


def test_an_mp4_of_a_transparent_film_is_on_white_paper(tmp_path):
    pictures, _ = decoded(made(moving_film(), tmp_path, "mp4"))
    assert (np.abs(pictures[0][0, 0] - 255) <= 2).all()
    pictures, _ = decoded(made(moving_film(), tmp_path, "mp4", background="#00000080", replace=True))
    assert (np.abs(pictures[0][0, 0][:3] - 127) <= 3).all()


def test_h264_asks_for_even_sides_and_says_which(tmp_path):
    document = replace(film(), stage=Stage(63, 47))
    assert fitting_size(document, "mp4") == (64, 48)
    with pytest.raises(InkbetweenError, match=r"even sides, 63 x 47 px are not; choose 64 x 48"):
        settings_of(document, tmp_path, "mp4", size=(63, 47))


# The same bytes


@pytest.mark.parametrize("form", FORMATS)
def test_the_same_film_gives_the_same_bytes(form, tmp_path):
    document = moving_film()
    first, second = (made(document, tmp_path / name, form, processes=1) for name in "ab")
    assert digest(first) == digest(second)
    names = [p.name for p in (tmp_path / "a").iterdir()]
    assert sorted(names) == sorted(p.name for p in (tmp_path / "b").iterdir())


def test_two_processes_give_the_bytes_of_one(tmp_path, monkeypatch):
    document = moving_film()
    wait_until_up(monkeypatch)
    for form in ("png", "mp4"):
        one, two = (made(document, tmp_path / f"{form}{n}", form, processes=n) for n in (1, 2))
        assert digest(one) == digest(two)


def wait_until_up(monkeypatch):
    """Let processes paint from the first picture on, and not only when they have come up."""
    submit = pool._Processes.submit
    monkeypatch.setattr(pool._Processes, "submit", lambda crew, job: crew._up.wait(30) and submit(crew, job))


def test_a_painter_imports_neither_scipy_nor_the_window():
    script = "import sys, app.export.worker, app.export.render; print(' '.join(sys.modules))"
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, cwd=ROOT, check=True)
    assert not set(ended.stdout.split()) & {"scipy", "PySide6.QtWidgets", "pyqtgraph", "av"}


# Nothing is overwritten, nothing is half


@pytest.mark.parametrize("form", FORMATS)
def test_nothing_is_overwritten_unasked(form, tmp_path):
    document = moving_film(length=3)
    out = made(document, tmp_path, form)
    before = digest(out)
    with pytest.raises(InTheWayError, match="exist"):
        export(replace(document, length=2), settings_of(document, tmp_path, form, last=2))
    assert digest(out) == before
    export(document, settings_of(document, tmp_path, form, last=2, replace=True))
    assert files_in(tmp_path)


@pytest.mark.parametrize("form", FORMATS)
def test_a_cancelled_export_leaves_whole_frames_or_nothing(form, tmp_path):
    document, asked = moving_film(length=30), []

    def cancelled():
        asked.append(1)
        return len(asked) > 3

    exported = export(document, settings_of(document, tmp_path, form), cancelled=cancelled)
    if FORMATS[form].frames:
        assert exported.cancelled
        assert files_in(tmp_path) == [f"arm/{f.name}" for f in exported.files]
    elif exported.cancelled:
        assert files_in(tmp_path) == []
        assert exported.files == ()


@pytest.mark.parametrize("form", [f for f in FORMATS if f != "png"])
def test_a_full_disk_is_one_sentence_and_leaves_no_part(form, tmp_path, monkeypatch):
    document = moving_film(length=5)
    made(document, tmp_path, form)
    before = {name: (tmp_path / name).read_bytes() for name in files_in(tmp_path)}

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(whole.os, "replace" if FORMATS[form].frames or form == "oca" else "fsync", full)
    with pytest.raises(StorageError, match=r"^cannot write .*: no space left on device$"):
        export(document, settings_of(document, tmp_path, form, last=4, replace=True))
    assert {name: (tmp_path / name).read_bytes() for name in files_in(tmp_path)} == before


LIMITED = (
    "import resource, signal, sys; from app.cli import main; signal.signal(signal.SIGXFSZ, signal.SIG_IGN); "
    "resource.setrlimit(resource.RLIMIT_FSIZE, (99, 99)); codes = [main(['export', sys.argv[1], a, '--force']) "
    "for a in sys.argv[2:]]; sys.exit(0 if set(codes) == {1} else 1)"
)


@pytest.mark.skipif(not hasattr(resource, "RLIMIT_FSIZE"), reason="no limit for the size of files here")
def test_a_disk_that_fills_up_while_a_film_is_written_leaves_the_old_file(tmp_path):
    save(moving_film(), tmp_path / "a.inkb")
    outs = [tmp_path / "out" / f"a{e}" for e in sorted(ENDINGS) if e != ".oca"]
    (tmp_path / "out").mkdir()
    for out in outs:
        out.write_bytes(b"yesterday")
    command = [sys.executable, "-c", LIMITED, str(tmp_path / "a.inkb"), *map(str, outs)]
    ended = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
    assert (ended.returncode, ended.stdout) == (0, "")
    told = ended.stderr.splitlines()
    assert [line.partition(": cannot write ")[0] for line in told] == ["inkbetween"] * len(outs)
    assert all(line.endswith(": file too large") for line in told)
    assert files_in(tmp_path / "out") == sorted(o.name for o in outs)
    assert {o.read_bytes() for o in outs} == {b"yesterday"}


@pytest.mark.parametrize("form", ["webm", "png"])
def test_a_killed_export_leaves_nothing_half_under_its_name_and_no_process(form, tmp_path):
    save(film(length=3000, size=(640, 480)), tmp_path / "long.inkb")
    out = tmp_path / "out" / ("frames" if form == "png" else "long.webm")
    words = ["export", str(tmp_path / "long.inkb"), str(out), "--json", "--processes", "2"]
    killed = subprocess.Popen([sys.executable, "-m", "app", *words], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    assert json.loads(killed.stdout.readline())["total"] == 3000
    children = Path(f"/proc/{killed.pid}/task/{killed.pid}/children")
    painters = children.read_text().split() if children.exists() else []
    killed.send_signal(signal.SIGKILL)
    killed.communicate()
    if form == "png":
        assert all(p.read_bytes().endswith(b"IEND\xaeB`\x82") for p in out.glob("[!.]*"))
    else:
        assert not out.exists()
    assert wait_for(lambda: not any(Path(f"/proc/{pid}").exists() for pid in painters))


def test_what_a_killed_export_has_left_half_done_goes_with_the_next_one(tmp_path):
    ended = subprocess.run(
        [sys.executable, "-c", "import os; print(os.getpid())"], capture_output=True, text=True, check=True
    )
    dead = ended.stdout.strip()
    parts = [f".arm.webp.{dead}.part", f".arm.webp.{os.getppid()}.part", f".other.webp.{dead}.part"]
    for name in parts:
        (tmp_path / name).write_bytes(b"half")
    made(moving_film(2), tmp_path, "webp")
    assert files_in(tmp_path) == sorted([*parts[1:], "arm.webp"])


def wait_for(condition, seconds=20):
    deadline = time.monotonic() + seconds
    while time.monotonic() < deadline and not condition():
        time.sleep(0.02)
    return condition()


def test_an_interrupted_export_is_continued_with_the_missing_frames_only(tmp_path):
    document = moving_film(length=6)
    whole_film = made(document, tmp_path / "a", "png")
    out = made(document, tmp_path / "b", "png", last=3)
    (out / "arm.0002.png").unlink()
    kept = (out / "arm.0001.png").stat().st_mtime_ns
    exported = export(document, settings_of(document, tmp_path / "b", "png", proceed=True))
    assert [f.name for f in exported.files] == [f"arm.{n:04}.png" for n in (2, 4, 5, 6)]
    assert exported.kept == 2
    assert (out / "arm.0001.png").stat().st_mtime_ns == kept
    assert digest(out) == digest(whole_film)


def test_a_painter_that_dies_is_one_sentence_and_leaves_nothing(tmp_path, monkeypatch):
    document = film(length=400, size=(640, 480))
    crews = []
    wait_until_up(monkeypatch)
    begin = pool._Processes.__init__
    monkeypatch.setattr(pool._Processes, "__init__", lambda self, *a: (crews.append(self), begin(self, *a))[1])

    def progress(done, total):
        for painter in crews[0]._ready:
            painter.kill()

    with pytest.raises(InkbetweenError, match="a process that painted has ended before its time"):
        export(document, settings_of(document, tmp_path, "png", processes=2), progress=progress)
    assert [p.poll() is not None for p in crews[0]._started] == [True, True]
    assert all(n.endswith(".png") and not n.startswith("arm/.") for n in files_in(tmp_path))


def test_where_no_process_can_be_started_the_program_paints_itself(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    out = made(moving_film(), tmp_path, "png", processes=2)
    assert len(files_in(out)) == 7


# Frames


def test_sixteen_bits_hold_more_shades_than_eight(tmp_path):
    document = moving_film(fill="#785ae6b4")
    deep = sorted(made(document, tmp_path, "png", depth=16).iterdir())[0]
    with Image.open(deep) as picture:
        assert deep.read_bytes()[24:26] == bytes([16, 6])
        eight = np.array(picture.convert("RGBA")).astype(int)
    ours = reference(document, tmp_path)[0]
    assert np.abs(eight - ours)[ours[..., 3] > 0].max() <= 1


def test_drawings_that_are_held_are_written_once(tmp_path):
    document = replace(moving_film(length=4), length=9)  # the last drawing stays for six frames
    out = made(document, tmp_path, "png", exposures=True)
    assert files_in(out) == [f"arm.{n:04}.png" for n in (1, 2, 3, 4)]
    out = made(document, tmp_path / "b", "png", exposures=True, pattern="{layer}-{drawing}", number=10, padding=2)
    assert files_in(out) == [f"Layer 1-{n}.png" for n in (10, 11, 12, 13)]


def test_patterns_name_layer_frame_and_drawing(tmp_path):
    settings = settings_of(film(), tmp_path, "png", pattern="{layer}/x".replace("/", "_") + "{frame}", padding=2)
    assert frame_path(settings, 7, layer='a/b:"c"').name == "a_b__c__x07.png"
    assert frame_path(replace(settings, number=100), 7, layer="a").name == "a_x106.png"


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"pattern": "{shot}{frame}"}, "braces that mean nothing"),
        ({"pattern": "same"}, "gives all frames one name"),
        ({"pattern": "a/{frame}"}, "no file name may hold"),
        ({"format": "tiff"}, "unknown format 'tiff'"),
        ({"depth": 12}, "12 bits a channel"),
        ({"rate": Fraction(5000)}, "the frame rate is 5000"),
        ({"number": -1}, "the first number is -1"),
        ({"format": "gif", "depth": 16}, "16 bits a channel are for PNG frames"),
        ({"format": "gif", "exposures": True}, "each drawing once is for frames"),
        ({"format": "gif", "chart": True}, "the timing chart is for frames"),
        ({"format": "lottie", "rate": Fraction(12)}, "keeps the frame rate of the project"),
    ],
)
def test_settings_that_fit_no_format_are_refused_with_the_reason(changes, sentence, tmp_path):
    with pytest.raises(InkbetweenError, match=sentence):
        settings_of(film(), tmp_path, "png", **changes)


def two_layers(length=5):
    document = moving_film(length=length)
    other = replace(document.layers[0], id=2, name="Layer 1")
    return replace(document, layers=(document.layers[0], other))


def test_every_layer_on_its_own_has_its_own_name(tmp_path):
    out = made(two_layers(2), tmp_path, "png", each_layer=True)
    assert files_in(out) == [f"arm.Layer 1{n}.{f:04}.png" for n in (" 2", "") for f in (1, 2)]
    made(two_layers(2), tmp_path / "film", "gif", each_layer=True)
    assert files_in(tmp_path / "film") == ["arm.Layer 1 2.gif", "arm.Layer 1.gif"]


def test_a_layer_that_is_asked_for_is_shown_alone(tmp_path):
    document = two_layers(2)
    hidden = replace(document, layers=(document.layers[0], replace(document.layers[1], visible=False)))
    alone = made(hidden, tmp_path / "a", "png", layers=(2,))
    assert digest(alone) == digest(made(moving_film(length=2), tmp_path / "b", "png"))


def test_the_timing_chart_is_beside_the_drawing_and_nowhere_else(tmp_path):
    document = moving_film(length=5)
    plain = reference(document, tmp_path)[1]
    out = made(document, tmp_path, "png", chart=True)
    charted = np.array(Image.open(sorted(out.iterdir())[1])).astype(int)
    differs = np.flatnonzero((plain != charted).any(axis=(0, 2)))
    assert differs.min() > 0.85 * SIZE[0]
    assert len(np.flatnonzero((plain != charted).any(axis=(1, 2)))) > 0.4 * SIZE[1]


# Shapes


def test_an_svg_frame_has_holes_even_odd_and_straight_alpha(tmp_path):
    out = made(moving_film(stroke="#102030"), tmp_path, "svg-frames", background="#ffffff80")
    assert len(files_in(out)) == 7
    root = ElementTree.parse(sorted(out.iterdir())[0]).getroot()
    path = next(root.iter("{http://www.w3.org/2000/svg}path"))
    assert path.get("fill") == "#785ae6"
    assert path.get("fill-rule") == "evenodd"
    assert path.get("d").count("M") == path.get("d").count("Z") == 2
    assert float(path.get("fill-opacity")) == pytest.approx(0xB4 / 255, abs=1e-3)
    assert root.get("viewBox") == "0 0 96 64"


def eased_film(method="linear", easing=LINEAR, length=9):
    return moving_film(length, Span(method, easing))


def test_a_linear_span_is_two_shapes_with_the_easing(tmp_path):
    document = eased_film(easing=Easing(0.4, 0.0, 0.6, 1.0))
    made_json = json.loads(made(document, tmp_path, "lottie").read_text())
    assert (made_json["fr"], made_json["ip"], made_json["op"], made_json["w"], made_json["h"]) == (
        24,
        0,
        9,
        96,
        64,
    )
    moving, still = sorted(made_json["layers"], key=lambda x: x["ip"])
    (group,) = moving["shapes"]
    paths = [x for x in group["it"] if x["ty"] == "sh"]
    assert len(paths) == 2
    for path in paths:
        first, last = path["ks"]["k"]
        assert (first["t"], last["t"]) == (0, 8)
        assert (first["o"], first["i"]) == ({"x": [0.4], "y": [0]}, {"x": [0.6], "y": [1]})
        assert len(first["s"][0]["v"]) == len(last["s"][0]["v"]) == 4
    assert next(x for x in group["it"] if x["ty"] == "fl")["r"] == 2
    assert (still["ip"], still["op"]) == (8, 9)


@pytest.mark.parametrize("easing", [Easing(), Easing(0.42, 0, 0.58, 1), Easing(0.4, 0.0, 0.64, 1.4)])
@pytest.mark.parametrize("method", ["linear", "intrinsic"])
def test_shapes_between_those_that_are_kept_are_off_by_less_than_can_be_seen(method, easing, tmp_path):
    document = eased_film(method, easing, length=24)
    film_ = Film(document, settings_of(document, tmp_path, "lottie"))
    plans = PlanCache()
    for stretch in shape_layers(film_)[0].stretches:
        times = [m.time for m in stretch.moments]
        for frame in range(int(stretch.start), int(stretch.end)):
            expected = picture_at(document, document.layers[0], frame + 1, plans)
            ratio = (frame - times[0]) / (times[-1] - times[0]) if len(times) == 2 else 0.0
            for i, (points, _) in enumerate(expected.outlines):
                shapes = np.array([m.picture.outlines[i][0] for m in stretch.moments])
                if len(shapes[0]) != len(points):
                    continue
                if stretch.easing is not None:
                    t = float(stretch.easing.t_at(ratio))
                    shown = shapes[0] + t * (shapes[1] - shapes[0])
                else:
                    flat = shapes.reshape(len(times), -1)
                    shown = np.array([np.interp(frame, times, flat[:, j]) for j in range(flat.shape[1])])
                assert np.abs(shown.reshape(points.shape) - points).max() <= TOLERANCE + 1e-3


@pytest.mark.parametrize("form", ["svg", "svg-css"])
def test_an_animated_svg_is_well_formed_and_as_long_as_the_film(form, tmp_path):
    document = eased_film("intrinsic", length=24)
    text = made(document, tmp_path, form, background="#ffffff").read_text()
    root = ElementTree.fromstring(text)
    assert (root.get("width"), root.get("height")) == ("96", "64")
    if form == "svg":
        moves = list(root.iter("{http://www.w3.org/2000/svg}animate"))
        assert {a.get("dur") for a in moves} == {"1s"}
        for a in moves:
            times, values = a.get("keyTimes").split(";"), a.get("values").split(";")
            assert len(times) == len(values)
            assert times[0] == "0"
            assert list(map(float, times)) == sorted(map(float, times))
    else:
        assert "d:path(" in text
        assert " 1s linear infinite" in text


def test_a_layer_that_begins_late_is_hidden_until_then(tmp_path):
    document = moving_film(length=6)
    layer = document.layers[0]
    late = replace(layer, keyframes=tuple(replace(k, frame=k.frame + 2) for k in layer.keyframes[:1]))
    data = json.loads(made(replace(document, layers=(late,)), tmp_path, "lottie").read_text())
    assert [(x["ip"], x["op"]) for x in data["layers"]] == [(2, 6)]


def test_open_outlines_are_lines_and_never_filled(tmp_path):
    line = np.array([[10, 10], [50, 40], [80, 10]], float)
    drawing = Drawing((Outline(1, line, closed=False),), Style("#112233", None, 3.0))
    document = Document(Stage(*SIZE), length=2, layers=(Layer(1, keyframes=(Keyframe(1, drawing),)),))
    data = json.loads(made(document, tmp_path, "lottie").read_text())
    kinds = [x["ty"] for x in data["layers"][0]["shapes"][0]["it"]]
    assert kinds == ["sh", "st", "tr"]
    text = made(document, tmp_path, "svg-frames").joinpath("arm.0001.svg").read_text()
    assert 'fill="none" stroke="#112233" stroke-width="3"' in text


def on_twos(length=9):
    return moving_film(length, Span("linear", step=2))


def test_a_span_on_twos_is_shapes_that_stay(tmp_path):
    data = json.loads(made(on_twos(), tmp_path, "lottie").read_text())
    paths = [x["it"][0]["ks"] for y in data["layers"] for x in y["shapes"]]
    times = sorted(k["t"] for p in paths if p["a"] for k in p["k"])
    assert {k.get("h") for p in paths if p["a"] for k in p["k"]} == {1}
    begins = sorted({*times, *(y["ip"] for y in data["layers"])})
    assert begins == [0, 2, 4, 6, 8]
    text = made(on_twos(), tmp_path, "svg").read_text()
    assert 'attributeName="d"' in text
    assert 'calcMode="linear"' not in text


def test_drawings_on_twos_are_written_once_and_counted_on_the_sheet(tmp_path):
    out = made(on_twos(), tmp_path, "png", exposures=True)
    assert files_in(out) == [f"arm.{n:04}.png" for n in (1, 3, 5, 7, 9)]
    (table,) = json.loads(made(on_twos(), tmp_path, "xdts").read_text().partition("\n")[2])["timeTables"]
    frames = [f["frame"] for f in table["fields"][0]["tracks"][0]["frames"]]
    assert frames == [0, 2, 4, 6, 8, 9]


def test_a_held_drawing_stays_until_the_next_keyframe(tmp_path):
    document = moving_film(9, Span("linear", hold=True))
    out = made(document, tmp_path, "png", exposures=True)
    assert files_in(out) == ["arm.0001.png", "arm.0009.png"]
    data = json.loads(made(document, tmp_path, "lottie").read_text())
    assert sorted((x["ip"], x["op"]) for x in data["layers"]) == [(0, 8), (8, 9)]


def test_the_opacity_of_a_layer_is_that_of_the_whole_layer(tmp_path):
    document = moving_film(fill="#ff0000", stroke="#000000")
    faded = replace(document, layers=(replace(document.layers[0], opacity=0.5),))
    data = json.loads(made(faded, tmp_path, "lottie").read_text())
    assert {x["ks"]["o"]["k"] for x in data["layers"]} == {50}
    assert '<g opacity="0.5">' in made(faded, tmp_path, "svg-frames").joinpath("arm.0001.svg").read_text()
    pictures, _ = decoded(made(faded, tmp_path, "apng"))
    assert abs(pictures[0][..., 3].max() - 127.5) <= 1


# Sheets


def test_a_sprite_sheet_says_where_every_picture_is(tmp_path):
    document = moving_film(length=5)
    out = made(document, tmp_path, "sprites")
    sheet = np.array(Image.open(out).convert("RGBA")).astype(int)
    told = json.loads(out.with_suffix(".json").read_text())
    assert len(told["frames"]) == 5
    assert sum(f["duration"] for f in told["frames"]) == round(5000 / 24)
    for frame, ours in zip(told["frames"], reference(document, tmp_path), strict=True):
        x, y, w, h = (frame["frame"][k] for k in "xywh")
        assert np.array_equal(sheet[y : y + h, x : x + w], ours)


def test_an_exposure_sheet_names_drawings_and_crosses(tmp_path):
    document = moving_film(length=4)
    layer = document.layers[0]
    moved = replace(layer, keyframes=tuple(replace(k, frame=k.frame + 2) for k in layer.keyframes))
    document = replace(document, length=9, layers=(replace(moved, name="A"),))
    header, _, text = made(document, tmp_path, "xdts").read_text().partition("\n")
    assert header == "exchangeDigitalTimeSheet Save Data"
    (table,) = json.loads(text)["timeTables"]
    assert table["duration"] == 9
    assert table["timeTableHeaders"] == [{"fieldId": 0, "names": ["A"]}]
    (track,) = table["fields"][0]["tracks"]
    cells = [(f["frame"], f["data"][0]["values"][0]) for f in track["frames"]]
    null = "SYMBOL_NULL_CELL"
    assert cells == [(0, null), (2, "1"), (3, "2"), (4, "3"), (5, "4"), (9, null)]


def test_an_oca_folder_has_every_drawing_once_and_says_when(tmp_path):
    document = replace(moving_film(length=4), length=9)
    out = made(document, tmp_path, "oca", background="#336699")
    told = json.loads((out / "arm.oca").read_text())
    assert (told["width"], told["height"], told["startTime"], told["endTime"]) == (96, 64, 0, 9)
    assert told["backgroundColor"] == [0.2, 0.4, 0.6, 1.0]
    (layer,) = told["layers"]
    assert [(f["frameNumber"], f["duration"]) for f in layer["frames"]] == [(0, 1), (1, 1), (2, 1), (3, 6)]
    assert files_in(out) == sorted(["arm.oca", *(f["fileName"] for f in layer["frames"])])
    assert (np.array(Image.open(out / layer["frames"][0]["fileName"]))[0, 0, 3]) == 0


def test_a_folder_of_something_else_is_never_replaced_by_an_oca(tmp_path):
    (tmp_path / "arm").mkdir()
    (tmp_path / "arm" / "diary.txt").write_text("mine")
    with pytest.raises(InTheWayError):
        export(film(), settings_of(film(), tmp_path, "oca", replace=True))
    assert files_in(tmp_path) == ["arm/diary.txt"]


# Choosing


def test_the_ending_tells_the_format(tmp_path):
    assert {e: format_of(f"a{e}") for e in ENDINGS} == ENDINGS
    assert format_of("frames") == format_of("frames.v2/") == format_of(str(tmp_path)) == "png"
    with pytest.raises(InkbetweenError, match=r"no format ends in \.tiff"):
        format_of("a.tiff")


def test_own_presets_come_back_and_damaged_ones_are_left_out():
    kept = {"mine": Preset("gif", 0.25, "12")}
    assert kept_presets(presets_text(kept)) == kept
    assert kept_presets("{") == kept_presets("[1]") == kept_presets("") == {}
    assert kept_presets('{"a": {"format": "tiff"}, "b": 7, "c": {"depth": 16}}') == {"c": Preset(depth=16)}
    assert all(PRESETS.values())


def test_pictures_are_the_same_when_every_number_is():
    document = film()
    plans = PlanCache()
    a, b = (picture_at(document, document.layers[0], f, plans) for f in (2, 3))
    assert same_pictures((a,), (a,))
    assert not same_pictures((a,), (b,))
    assert not same_pictures((a,), ())
    assert square(0, 0, 1).shape == (4, 2)


# The command line


@pytest.fixture
def project(tmp_path):
    save(two_layers(), tmp_path / "arm.inkb")
    return str(tmp_path / "arm.inkb")


def test_a_file_is_not_replaced_without_force_and_the_ways_out_are_told(project, tmp_path, capsys):
    out = tmp_path / "a.gif"
    assert main(["export", project, str(out)]) == 0
    assert capsys.readouterr().out == f"{out}: 5 frames, 96 x 64 px\n"
    assert main(["export", project, str(out)]) == 1
    ways = "choose another place, replace with --force, or make the rest with --continue"
    assert capsys.readouterr().err == f"inkbetween: {out} exists already; {ways}\n"
    assert main(["export", project, str(out), "--continue"]) == 0
    assert capsys.readouterr().out == "nothing to do, the file was there already\n"
    assert main(["export", project, str(out), "--overwrite", "--scale", "50%"]) == 0
    assert capsys.readouterr().out == f"{out}: 5 frames, 48 x 32 px\n"


def test_json_lines_tell_progress_and_the_files(project, tmp_path, capsys):
    out = tmp_path / "a.webp"
    assert main(["export", project, str(out), "--json"]) == 0
    lines = [json.loads(x) for x in capsys.readouterr().out.splitlines()]
    assert [(x["done"], x["total"]) for x in lines[:-1]] == [(n, 5) for n in range(1, 6)]
    assert lines[-1] == {"files": [str(out)], "kept": 0, "cancelled": False}
    assert main(["export", project, str(out), "--json"]) == 1
    assert json.loads(capsys.readouterr().out) == {"error": f"{out} exists already"}


def test_layers_are_chosen_by_name(project, tmp_path, capsys):
    assert main(["export", project, str(tmp_path / "out"), "--layer", "head"]) == 1
    assert "the project has no layer 'head'; its layers are Layer 1, Layer 1" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("option", "text", "sentence"),
    [
        ("--format", "tiff", "'tiff' is no format; known are png, svg-frames"),
        ("--scale", "0", "'0' is no scale; write a number above 0"),
        ("--rate", "fast", "'fast' is no frame rate"),
        ("--padding", "0", "'0' is no number of digits"),
        ("--number", "-3", "'-3' is no number for a file"),
        ("--processes", "0", "'0' is no number of processes"),
    ],
)
def test_a_wrong_choice_is_wrong_usage(option, text, sentence, project, tmp_path, capsys):
    assert main(["export", project, str(tmp_path / "out"), option, text]) == 2
    assert sentence in capsys.readouterr().err
