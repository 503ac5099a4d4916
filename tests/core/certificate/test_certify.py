import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely.geometry import Polygon

import core
from core.certificate import SEVERITIES, certify, certify_drawing
from core.errors import GeometryError
from core.geometry.outline import signed_area

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
KNOT = SQUARE[[0, 2, 1, 3]]
HOLE = SQUARE / 2 + 2.5


def kinds(certificate):
    return {p.kind for p in certificate.problems}


def only(certificate, kind):
    found = [p for p in certificate.problems if p.kind == kind]
    assert len(found) == 1, certificate.problems
    return found[0]


def test_the_public_face_certifies():
    assert (core.certify, core.certify_drawing) == (certify, certify_drawing)


def test_a_span_without_a_fault_has_no_problem():
    found = certify(core.inbetween(SQUARE, SQUARE + 5, np.linspace(0, 1, 9)), SQUARE, SQUARE + 5)
    assert found.ok
    assert found.problems == ()
    assert found.severities == ("",) * 9
    assert found.area == pytest.approx(100)
    assert found.perimeter == pytest.approx(40)
    assert found.stretch == pytest.approx(1)


def test_a_crossing_is_an_error_with_its_edges_place_and_time():
    found = certify([SQUARE, SQUARE, KNOT, SQUARE], times=[0, 0.2, 0.42, 1])
    p = only(found, "crossing")
    assert (p.severity, p.frame, p.t, p.edges, p.place) == ("error", 2, 0.42, (0, 2), (5.0, 5.0))
    assert p.text == "frame at t 0.42: edge 0 crosses edge 2"
    assert found.problems[0] is p
    assert not found.ok
    assert found.severities == ("", "", "error", "")
    assert found.counts["crossing"].tolist() == [0, 0, 1, 0]


@pytest.mark.parametrize(
    ("before", "after", "severity", "words"),
    [(SQUARE, SQUARE, "error", ""), (KNOT, SQUARE, "warning", "before"), (KNOT, KNOT, "info", "before and after")],
)
def test_a_crossing_that_keyframes_have_themselves_is_told_as_such(before, after, severity, words):
    p = only(certify([KNOT], before, after, times=[0.5]), "crossing")
    assert p.severity == severity
    assert p.text.endswith(words)


def test_an_outline_turned_inside_out_is_an_error_though_it_crosses_nothing():
    p = only(certify([SQUARE[::-1]], SQUARE, SQUARE, times=[0.5]), "inside out")
    assert p.severity == "error"


def test_an_edge_that_doubles_back_is_told_unless_the_keyframes_do_it():
    spike = np.array([[0.0, 0], [10, 0], [10, 10], [5.1, 10], [5, 30], [4.9, 10], [0, 10]])
    blunt = np.where(spike == 30, 12, spike)
    blunt[[3, 5], 0] = 8, 2
    p = only(certify([spike], blunt, blunt, times=[0.5]), "fold")
    assert (p.severity, p.edges, p.place) == ("warning", (3, 4), (5.0, 30.0))
    assert p.value > 170
    assert "fold" not in kinds(certify([spike], spike, blunt, times=[0.5]))


def test_a_collapsed_and_an_exploded_edge_are_told():
    short, long = SQUARE.copy(), SQUARE.copy()
    short[1] = [0.5, 0.0]
    long[1:3] *= [4, 1]
    found = certify([short, long], SQUARE, SQUARE, times=[0.25, 0.5])
    p = only(found, "collapse")
    assert (p.frame, p.edges, p.value) == (0, (0,), 0.05)
    assert "shrunk to 5 %" in p.text
    explosions = [p for p in found.problems if p.kind == "explosion"]
    assert [(p.frame, p.edges, p.value) for p in explosions] == [(1, (0,), 4.0), (1, (2,), 4.0)]
    assert found.stretch[1] == pytest.approx(4, rel=1e-2)


def test_a_last_edge_that_gapes_is_a_missing_closure():
    open_ = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [-40.0, 10.0]])
    p = only(certify([open_], SQUARE, SQUARE, times=[0.5]), "closure")
    assert p.edges == (3,)
    assert "does not close" in p.text


def test_an_area_beyond_both_keyframes_is_told_with_its_share():
    found = certify([SQUARE * 0.9, SQUARE, SQUARE * 1.5], SQUARE, SQUARE * 1.2, times=[0.2, 0.4, 0.6])
    area = [p for p in found.problems if p.kind == "area"]
    assert [(p.frame, round(p.value, 4)) for p in area] == [(0, 0.81), (2, 1.5625)]
    assert area[0].text == "frame at t 0.2: the area is 81 % of the smaller keyframe's"


def test_what_a_method_had_to_say_comes_as_a_warning():
    found = certify([SQUARE, SQUARE], notes=["rigid fell back on intrinsic"])
    assert [(p.kind, p.severity, p.frame, p.text) for p in found.problems] == [
        ("fallback", "warning", None, "rigid fell back on intrinsic")
    ]
    assert found.ok
    assert found.severities == ("", "")


def test_a_missed_keyframe_is_told_with_the_vertex_and_the_distance():
    p = only(
        certify([SQUARE + np.array([3, 4]) * (SQUARE[:, :1] > SQUARE[:, 1:])], SQUARE, SQUARE, times=[0.0]),
        "keyframe",
    )
    assert p.value == 5
    assert "vertex 1 is 5 px off the keyframe before" in p.text


def test_a_frame_that_is_no_number_is_an_error_and_harms_no_other():
    found = certify([SQUARE, np.where(SQUARE == 10, np.nan, SQUARE), KNOT, SQUARE])
    assert [(p.kind, p.frame) for p in found.problems if p.severity == "error"] == [("number", 1), ("crossing", 2)]
    assert np.isfinite([found.area, found.perimeter, found.stretch]).all()


def test_outlines_of_a_drawing_are_checked_against_each_other():
    frames = (np.stack([SQUARE] * 3), np.stack([HOLE, HOLE + 4, HOLE]))
    found = certify_drawing(frames, (True, True))
    crossed = [p for p in found.problems if p.kind == "crossing"]
    assert {(p.frame, p.outlines, p.severity) for p in crossed} == {(1, (0, 1), "error")}
    assert "crosses edge" in crossed[0].text
    assert "outline 1" in crossed[0].text
    assert found.area.tolist() == [75, 75, 75]
    assert found.perimeter.tolist() == [60, 60, 60]


def test_only_the_worst_are_listed_but_all_are_counted():
    rng = np.random.default_rng(0)
    tangle = rng.uniform(0, 100, (60, 2))
    angle = np.linspace(0, 6, 60)
    ring = 50 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    found = certify([tangle], ring, ring, times=[0.5])
    listed = [p for p in found.problems if p.kind == "crossing"]
    assert len(listed) == 8
    assert found.counts["crossing"][0] > 100
    assert listed[0].value == found.counts["crossing"][0]


@given(st.integers(0, 2**32 - 1), st.integers(3, 10), st.integers(1, 6))
def test_frames_have_an_error_exactly_where_an_independent_judge_finds_one(seed, count, frames):
    rng = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    p = ring + rng.normal(0, 0.4, (frames, count, 2))
    found = certify(p, ring, ring, times=np.linspace(0.1, 0.9, frames))
    expected = [not Polygon(q).is_valid for q in p]
    assert [c > 0 for c in found.counts["crossing"]] == expected
    order = [SEVERITIES.index(q.severity) for q in found.problems]
    assert order == sorted(order)
    assert found.area == pytest.approx(np.abs(signed_area(p)))


@given(st.floats(0, 6), st.sampled_from([2.0**-20, 2.0**-3, 2.0**10]))
def test_scale_and_turn_change_no_finding(angle, scale):
    turn = scale * np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    frames = np.stack([SQUARE, KNOT, SQUARE * [1, 0.05], SQUARE * 2, SQUARE])
    plain, turned = certify(frames), certify(frames @ turn)
    assert {k: v.tolist() for k, v in plain.counts.items()} == {k: v.tolist() for k, v in turned.counts.items()}


def test_open_outlines_have_no_area_and_no_edge_back():
    line = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, 5.0]])
    found = certify([line, line[::-1], line], line, line, closed=False)
    assert found.area.tolist() == [0, 0, 0]
    assert "crossing" not in kinds(found)
    crossed = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [5.0, -5.0]])
    assert only(certify([line, crossed, line], closed=False), "crossing").edges == (0, 2)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"frames": SQUARE}, r"shape \(4, 2\); expected \(T, n, 2\)"),
        ({"frames": np.zeros((0, 4, 2))}, "no frame"),
        ({"frames": [SQUARE], "before": SQUARE[:3]}, r"before has the shape \(3, 2\), a frame \(4, 2\)"),
        ({"frames": [SQUARE], "times": [0, 1]}, r"times have the shape \(2,\), but there are 1 frames"),
    ],
)
def test_arrays_that_do_not_fit_are_refused_with_their_numbers(arguments, message):
    with pytest.raises(GeometryError, match=message):
        certify(**arguments)


def test_drawings_that_do_not_fit_are_refused_with_their_numbers():
    frames = (np.stack([SQUARE] * 2), np.stack([HOLE] * 3))
    with pytest.raises(GeometryError, match="outline 1 has 3 frames, outline 0 has 2"):
        certify_drawing(frames, (True, True))
    with pytest.raises(GeometryError, match="2 outlines, but 1 say"):
        certify_drawing(frames, (True,))
    with pytest.raises(GeometryError, match="after has 1 outlines, the frames have 2"):
        certify_drawing(frames, (True, True), None, (SQUARE,))


def test_a_drawing_without_outlines_has_no_problem_at_any_time():
    certificate = certify_drawing((), (), times=(0.0, 0.5, 1.0))
    assert certificate.problems == ()
    assert certificate.stretch.tolist() == [1, 1, 1]
