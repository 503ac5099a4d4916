import numpy as np
import pytest

from core.correspondence.pairing import Correspondence
from core.model.checking import certify_span, edge_stretch, finding
from core.model.document import Keyframe, Span
from core.model.drawing import Drawing, Outline
from core.model.easing import PRESETS
from core.model.inbetweens import PairMatch, SpanMatch, plan_span
from core.model.motion import SpanMotion
from core.model.smooth import Bend

SQUARE = np.array([(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)])
TURN = np.array([(100.0, 100.0), (0.0, 100.0), (0.0, 0.0), (100.0, 0.0)])
BAR = np.array([(0.0, 0.0), (300.0, 0.0), (300.0, 60.0), (0.0, 60.0)])
BENT = BAR[[2, 1, 0, 3]] + (0.0, 20.0)
"""Corner by corner, the bar's straight way here crosses itself."""


def span(*ends, method="linear", frames=(5, 15), **fields):
    """A span between two keyframes; corner goes to corner of the same number."""
    drawings = [Drawing((Outline(1, points),)) if points is not None else Drawing() for points in ends]
    before = Keyframe(frames[0], drawings[0], Span(method, **fields))
    after = Keyframe(frames[1], drawings[1])
    matched = None
    if all(points is not None for points in ends):
        places = np.arange(len(ends[0]), dtype=float)
        answer = Correspondence(places, places, (len(ends[0]), len(ends[1])), True)
        matched = SpanMatch((PairMatch(1, 1, answer),))
    return SpanMotion(before, after, plan_span(drawings[0], drawings[1], before.span, matched), Bend())


def test_every_in_between_is_certified_under_its_frame_of_the_film():
    made = certify_span(span(SQUARE, SQUARE + 40))
    assert made.frames == tuple(range(6, 15))
    assert made.certificate.problems == ()
    assert [made.severity_at(f) for f in made.frames] == [""] * 9
    assert made.runs == ((6, 14, ""),)
    np.testing.assert_allclose(made.certificate.area, 10_000)


def test_times_are_the_eased_ones():
    made = certify_span(span(SQUARE, SQUARE * 2, easing=PRESETS["slow in and out"]))
    np.testing.assert_allclose(made.certificate.times, PRESETS["slow in and out"].t_at(np.arange(1, 10) / 10))


def test_a_square_that_turns_inside_itself_is_small_in_the_middle_frames():
    made = certify_span(span(SQUARE, TURN))
    assert made.severity_at(6) == "warning"
    assert made.severity_at(10) != ""
    worst = made.worst[9]
    assert made.frame_of(worst) == 9
    assert worst.frame == 3


def test_crossings_are_errors_and_told_without_their_time():
    made = certify_span(span(BAR, BENT))
    crossed = [p for p in made.certificate.problems if p.kind == "crossing"]
    assert {p.severity for p in crossed} == {"error"}
    assert {made.frame_of(p) for p in crossed} <= set(made.frames)
    assert made.summary[0].kind in ("crossing", "inside out")
    assert len({(p.severity, p.kind) for p in made.summary}) == len(made.summary)
    areas = [p.value for p in made.certificate.problems if p.kind == "area"]
    assert [p.value for p in made.summary if p.kind == "area"] == [min(areas)]
    firsts, lasts, worst = zip(*made.runs, strict=True)
    assert (firsts[0], lasts[-1]) == (6, 14)
    assert firsts[1:] == tuple(f + 1 for f in lasts[:-1])
    assert "error" in worst
    assert finding(crossed[0]).startswith("edge ")
    assert crossed[0].text.endswith(finding(crossed[0]))


@pytest.mark.parametrize(("ends", "frames"), [((SQUARE, TURN), (5, 6)), ((None, None), (5, 15))])
def test_where_nothing_moves_there_is_nothing_to_find(ends, frames):
    made = certify_span(span(*ends, frames=frames))
    assert len(made.frames) == frames[1] - frames[0] - 1
    assert made.certificate.ok
    assert len(made.certificate.area) == len(made.frames)


def test_a_note_of_the_plan_is_a_problem_of_the_whole_span():
    motion = span(BAR, BAR[::-1] + 10.0, repair=True)
    plan = motion.plan
    assert plan.paths.notes
    made = certify_span(motion)
    (note,) = (p for p in made.certificate.problems if p.kind == "fallback")
    assert made.frame_of(note) is None
    assert finding(note) == plan.paths.notes[0]


def test_the_stretch_of_an_edge_is_told_against_both_keyframes():
    pair = span(SQUARE, SQUARE * 3).plan.links[0].aligned
    np.testing.assert_allclose(edge_stretch(pair, SQUARE * 2, 0.5), 1.0)
    np.testing.assert_allclose(edge_stretch(pair, SQUARE * 4, 0.5), 2.0, rtol=2e-3)
