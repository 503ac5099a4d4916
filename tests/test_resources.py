import hashlib
import importlib.util
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from shapely.geometry import LinearRing, Polygon

import resources
from core.io.project import load
from core.model.inbetweens import plan_span
from core.model.motion import PlanCache, pictures_at

ROOT = Path(__file__).resolve().parent.parent
NAMES = ("bending arm", "bird wing", "letter", "square to diamond", "walking leg")
ICONS = sorted(p.stem for p in resources.folder().joinpath("icons").glob("*.svg"))
SHAPES = {"path", "circle", "rect"}


@pytest.fixture(scope="module")
def script():
    spec = importlib.util.spec_from_file_location("make_samples", ROOT / "docs" / "make_samples.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def sample(name):
    return load(resources.folder() / "samples" / f"{name}.inkb")


def test_the_samples_are_listed_with_the_demo_first():
    assert tuple(p.stem for p in resources.samples()) == NAMES


def test_the_samples_are_what_the_script_draws(script, tmp_path):
    script.main(tmp_path)
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == {
        p.name: p.read_bytes() for p in resources.samples()
    }


@pytest.mark.parametrize("name", NAMES)
def test_every_frame_of_a_sample_is_simple_and_on_the_stage(name):
    document, plans = sample(name), PlanCache()
    for frame in range(1, document.length + 1):
        (picture,) = pictures_at(document, frame, plans)
        for points, closed in picture.outlines:
            assert closed
            assert LinearRing(points).is_simple, (name, frame)
            assert (points >= 0).all(), (name, frame)
            assert (points <= (document.stage.width, document.stage.height)).all(), (name, frame)


@pytest.mark.parametrize("name", NAMES)
def test_no_inbetween_of_a_sample_shrinks_or_swells_beyond_its_keyframes(name):
    layer = sample(name).layers[0]
    for before, after in zip(layer.keyframes, layer.keyframes[1:], strict=False):
        plan = plan_span(before.drawing, after.drawing, before.span)
        for frames in plan.frames(np.linspace(0, 1, 9)):
            areas = [Polygon(points).area for points in frames]
            assert min(areas) > 0.93 * min(areas[0], areas[-1])
            assert max(areas) < 1.07 * max(areas[0], areas[-1])


@pytest.mark.parametrize("name", ["bending arm", "bird wing"])
def test_a_sample_that_loops_ends_as_it_begins(name):
    keyframes = sample(name).layers[0].keyframes
    assert keyframes[-1].drawing == keyframes[0].drawing


def test_the_walking_foot_stands_while_it_bears_the_body():
    document, plans = sample("walking leg"), PlanCache()
    first, second, third = (k.frame for k in document.layers[0].keyframes[:3])

    def soles(frames):
        lowest = []
        for frame in frames:
            ((points, _),) = pictures_at(document, frame, plans)[0].outlines
            lowest.append(points[points[:, 1] > points[:, 1].max() - 12])
        return lowest

    for sole in soles(range(first, second + 1)):
        assert sole[:, 0].min() == pytest.approx(soles([first])[0][:, 0].min(), abs=15)
    for sole in soles(range(first, third + 1)):
        assert sole[:, 1].max() == pytest.approx(soles([first])[0][:, 1].max(), abs=12)


def test_the_letter_keeps_its_hole_inside():
    document, plans = sample("letter"), PlanCache()
    for frame in range(1, document.length + 1):
        (outer, _), (hole, _) = pictures_at(document, frame, plans)[0].outlines
        assert Polygon(outer).contains(Polygon(hole)), frame


@pytest.mark.parametrize("name", [n for n in ICONS if n != "app"])
def test_an_icon_is_lines_in_the_colour_of_the_theme(name):
    root = ElementTree.parse(resources.icon(name)).getroot()
    assert root.get("viewBox") == "0 0 24 24"
    assert root.get("stroke") == "currentColor"
    assert root.get("fill") == "none"
    assert float(root.get("stroke-width")) >= 1.75  # wider only where it is shown smaller
    assert {child.tag.removeprefix("{http://www.w3.org/2000/svg}") for child in root} <= SHAPES
    assert not re.search("fill=|stroke=", "".join(ElementTree.tostring(c, "unicode") for c in root))


@pytest.mark.parametrize("name", ICONS)
def test_an_icon_paints_something_and_stays_in_its_frame(name):
    gui, svg = pytest.importorskip("PySide6.QtGui"), pytest.importorskip("PySide6.QtSvg")
    renderer = svg.QSvgRenderer(resources.icon(name).read_bytes().replace(b"currentColor", b"#ff0000"))
    assert renderer.isValid()
    image = gui.QImage(96, 96, gui.QImage.Format.Format_ARGB32)
    image.fill(0)
    painter = gui.QPainter(image)
    renderer.render(painter)
    painter.end()
    alpha = np.frombuffer(image.constBits(), np.uint8).reshape(96, 96, 4)[..., 3]
    assert (alpha > 0).sum() > 200
    assert not np.concatenate([alpha[0], alpha[-1], alpha[:, 0], alpha[:, -1]]).any()


def test_an_icon_that_is_not_there_is_named():
    with pytest.raises(FileNotFoundError, match="no icon 'unicorn'"):
        resources.icon("unicorn")


def test_the_font_comes_with_its_licence():
    fonts = resources.folder() / "fonts"
    assert (fonts / "DejaVuSans.ttf").read_bytes()[:4] == b"\x00\x01\x00\x00"
    text = (fonts / "LICENSE-DejaVu.txt").read_text()
    assert "Copyright (c) 2003 by Bitstream" in text
    assert "Copyright (c) 2006 by Tavmjong Bah" in text


def test_no_two_icons_are_the_same():
    digests = [hashlib.sha256(resources.icon(n).read_bytes()).digest() for n in ICONS]
    assert len(set(digests)) == len(ICONS)


def test_the_resources_need_no_qt():
    code = (
        "import sys, resources; resources.samples(); sys.exit(any(m.startswith('PySide6') for m in sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False).returncode == 0
