import hashlib
import importlib.util
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from shapely.geometry import LinearRing, Polygon

import resources
from core.io.project import load
from core.model.checking import certify_span
from core.model.inbetweens import plan_span
from core.model.motion import PlanCache, picture_at, pictures_at
from core.model.timing import exposures_of

ROOT = Path(__file__).resolve().parent.parent
NAMES = (
    "walk",
    "bending arm",
    "bird wing",
    "bouncing ball",
    "letter",
    "square to diamond",
    "turning letter",
    "walking leg",
)
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
        for points, closed in (o for p in pictures_at(document, frame, plans) for o in p.outlines):
            assert closed
            assert LinearRing(points).is_simple, (name, frame)
            assert (points >= 0).all(), (name, frame)
            assert (points <= (document.stage.width, document.stage.height)).all(), (name, frame)


@pytest.mark.parametrize("name", NAMES)
def test_no_inbetween_of_a_sample_shrinks_or_swells_beyond_its_keyframes(name):
    spans = [x for layer in sample(name).layers for x in pairwise(layer.keyframes) if layer.name != "shadow"]
    for before, after in (x for x in spans if x[1].frame - x[0].frame > 1):
        plan = plan_span(before.drawing, after.drawing, before.span)
        for frames in plan.frames(np.linspace(0, 1, 9)):
            areas = [Polygon(points).area for points in frames]
            assert min(areas) > 0.93 * min(areas[0], areas[-1])
            assert max(areas) < 1.07 * max(areas[0], areas[-1])


@pytest.mark.parametrize("name", ["bending arm", "bird wing", "walk"])
def test_a_sample_that_loops_ends_as_it_begins(name):
    for layer in sample(name).layers:
        assert layer.keyframes[-1].drawing == layer.keyframes[0].drawing


@pytest.mark.parametrize("name", NAMES)
def test_the_certificate_finds_neither_error_nor_warning_in_a_sample(name):
    document, plans = sample(name), PlanCache()
    for layer in document.layers:
        for before, after in pairwise(layer.keyframes):
            certificate = certify_span(plans.motions.of(document, layer, before, after)).certificate
            assert [p for p in certificate.problems if p.severity != "info"] == [], (layer.name, before.frame)


def test_the_walk_is_drawn_on_twos_and_its_arms_go_with_the_body():
    document, plans = sample("walk"), PlanCache()
    body = next(x for x in document.layers if x.name == "body")
    for layer in document.layers:
        shown = exposures_of(layer, 1, document.length - 1)
        assert {e.count for e in shown} == {2}
        assert layer.parent == (body.id if layer.name.endswith("arm") else None)
    places = {
        frame: {x.name: picture_at(document, x, frame, plans).outlines[0][0] for x in document.layers}
        for frame in range(1, document.length)
    }
    for odd in range(1, document.length, 2):
        for name, points in places[odd].items():
            held = places[odd + 1][name]
            assert Polygon(points).symmetric_difference(Polygon(held)).area < 1e-6 * Polygon(points).area
    # the top of the arm stays at the shoulder, however the body bobs
    gaps = [p["near arm"][:, 1].min() - p["body"][:, 1].min() for p in places.values()]
    assert max(gaps) - min(gaps) < 12


def test_a_standing_foot_of_the_walk_goes_back_evenly_on_the_floor():
    document, plans = sample("walk"), PlanCache()
    leg = next(x for x in document.layers if x.name == "near leg")
    backs, lows = [], []
    for frame in (5, 7, 9, 11):  # it stands flat from the second phase to the third, and a little longer
        points = picture_at(document, leg, frame, plans).outlines[0][0]
        sole = points[points[:, 1] > points[:, 1].max() - 8]
        backs.append(sole[:, 0].mean())
        lows.append(points[:, 1].max())
    steps = np.diff(backs)
    assert (steps < 0).all()
    assert np.ptp(steps) < 0.25 * abs(steps.mean())
    assert np.ptp(lows) < 6


def test_the_ball_falls_ever_faster_hits_the_floor_and_keeps_its_area():
    document, plans = sample("bouncing ball"), PlanCache()
    ball = next(x for x in document.layers if x.name == "ball")
    shapes = [picture_at(document, ball, f, plans).outlines[0][0] for f in range(1, document.length + 1)]
    areas = np.array([Polygon(p).area for p in shapes])
    assert areas.max() / areas.min() < 1.06
    low = np.array([p[:, 1].max() for p in shapes])
    fall = np.diff(low[:11])  # from the first apex to the ground
    assert (np.diff(fall) > -0.5).all()
    assert fall[-1] > 10 * fall[0]
    for contact in (11, 29, 43, 53):
        assert low[contact - 1] == low[contact - 4 : contact + 3].max() == pytest.approx(930, abs=0.5)


def test_the_turning_letter_takes_its_hole_along():
    document, plans = sample("turning letter"), PlanCache()
    for frame in range(1, document.length + 1):
        (outer, _), (hole, _) = pictures_at(document, frame, plans)[0].outlines
        assert Polygon(outer).contains(Polygon(hole)), frame


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
