import numpy as np
import pytest

from core.methods.plan import AlignedPair, plan_drawing
from core.model.document import Keyframe, Span
from core.model.drawing import Drawing, Outline
from core.model.inbetweens import plan_span
from core.model.solving import solve_paths

U = np.linspace(0, 2 * np.pi, 60, endpoint=False)
TIMES = np.linspace(0, 1, 9)


def limb(bend):
    x, y = 500 * np.cos(U), 90 * np.sin(U)
    turn = bend * np.clip(x / 500, 0, 1)
    return np.column_stack([x * np.cos(turn) - y * np.sin(turn), x * np.sin(turn) + y * np.cos(turn)])


PAIR = AlignedPair(limb(0.0), limb(-1.1), True)
BOW = AlignedPair(limb(0.0), limb(0.0)[::-1].copy(), True)  # inside out: rigid cannot


def same_frames(one, other):
    pairs = zip(one.evaluate(TIMES), other.evaluate(TIMES), strict=True)
    return all(np.array_equal(p, q) for p, q in pairs)


@pytest.mark.parametrize("method", ["linear", "intrinsic", "rigid"])
def test_a_named_method_is_taken_without_a_reason(method):
    paths = solve_paths([PAIR], method, 0)
    assert (paths.method, paths.reason) == (method, "")
    assert same_frames(paths.plan, plan_drawing([PAIR], method=method))


def test_auto_takes_one_of_two_and_says_why():
    paths = solve_paths([PAIR], "auto", 0)
    assert paths.method in ("rigid", "intrinsic")
    assert paths.reason.startswith(f"auto chose {paths.method}")
    assert same_frames(paths.plan, plan_drawing([PAIR], method=paths.method))


def test_auto_takes_intrinsic_where_rigid_falls_back_and_names_the_fallback():
    paths = solve_paths([BOW], "auto", 0)
    assert paths.method == "intrinsic"
    assert "fell back" in paths.reason


def test_auto_decides_the_same_every_time():
    assert solve_paths([PAIR], "auto", 0).reason == solve_paths([PAIR], "auto", 0).reason


def test_outlines_that_grow_or_vanish_and_empty_drawings_are_decided_too():
    point = np.full_like(PAIR.left, 40.0)
    for pairs in ([], [AlignedPair(point, PAIR.right, True)], [PAIR, AlignedPair(PAIR.left, point, True)]):
        frames = solve_paths(pairs, "auto", 0).plan.evaluate(TIMES)
        assert all(np.isfinite(f).all() for f in frames)


def test_a_repaired_span_has_no_crossing_and_the_same_ends():
    ring = np.column_stack([np.cos(U), np.sin(U)]) * 100
    spiked = ring * np.where(np.arange(60) % 2, 1.0, 0.35)[:, None]
    turned = np.roll(spiked, 20, axis=0)
    pair = AlignedPair(spiked, turned, True)
    paths = solve_paths([pair], "linear", 0, repair=True)
    (frames,) = paths.plan.evaluate(np.array([0.0, 1.0]))
    assert np.array_equal(frames[0], spiked)
    assert np.array_equal(frames[1], turned)


def test_the_repair_is_stopped_by_its_caller():
    from core.errors import CancelledError

    pair = AlignedPair(PAIR.left, np.roll(PAIR.right, 30, axis=0), True)
    with pytest.raises(CancelledError):
        solve_paths([pair], "linear", 0, repair=True, cancelled=lambda: True)


def test_a_span_of_an_empty_keyframe_has_a_plan():
    before, after = Keyframe(1), Keyframe(9, Drawing((Outline(1, PAIR.left),)))
    plan = plan_span(before.drawing, after.drawing, Span())
    assert len(plan.picture(0.5).outlines) == 1
