"""Where straight paths are so tangled that another method should be repaired in their place."""

import numpy as np

from core.certificate import Certificate, certify_drawing
from core.geometry.outline import FloatArray, edge_lengths
from core.methods.pins import PinnedPaths
from core.methods.plan import DrawingPlan, plan_drawing
from core.model.document import Span
from core.model.inbetweens import SpanPlan
from core.repair.plan import RepairedDrawingPlan

BADLY = 0.04
"""Share of an outline that the largest loop cuts off at a crossing: coasts that tangle a little have less."""

FAR = 0.01
"""Sizes of the drawing, as a mean over time, that a repair may bend paths before another method is looked at."""


def advice(span: Span, plan: SpanPlan, times: FloatArray, certificate: Certificate) -> str:
    """Say in a sentence why intrinsic, repaired, does better than this span's straight paths; "" if it does not.

    Parameters
    ----------
    span : Span
    plan : SpanPlan
        Of it.
    times : (T,) float array
        Of its in-betweens.
    certificate : Certificate
        Of these.
    """
    if plan.paths.method != "linear" or not len(times):
        return ""
    made = plan.paths.plan
    if isinstance(made, RepairedDrawingPlan):
        share = _tangle_of(plan, made.drawing, times) if made.deviation > FAR else 0.0
        what = f"The repair bends the straight paths by {made.deviation:.1%} of the size"
    else:
        share = tangle(plan, certificate)
        what = f"The straight paths tangle {share:.0%} of an outline"
    if share <= BADLY:
        return ""
    other = _tangle_of(plan, _intrinsic(span, plan), times)
    if other > share / 2:
        return ""
    return f"{what}; intrinsic ones tangle {f'{other:.0%} of it' if other else 'nowhere'}."


def _intrinsic(span: Span, plan: SpanPlan) -> DrawingPlan:
    made = plan_drawing([link.aligned for link in plan.links], turns=span.turns, placement=span.placement)
    if plan.paths.pins is None:
        return made
    return DrawingPlan(made.pairs, PinnedPaths(made.paths, plan.paths.pins.held))


def _tangle_of(plan: SpanPlan, drawing: DrawingPlan, times: FloatArray) -> float:
    pairs = drawing.pairs
    certificate = certify_drawing(
        drawing.evaluate(times),
        [p.closed for p in pairs],
        [p.left for p in pairs],
        [p.right for p in pairs],
        times=times,
    )
    return tangle(plan, certificate)


def tangle(plan: SpanPlan, certificate: Certificate) -> float:
    """Return the largest share of an outline that lies between the edges of one of its crossings, 0 to 1/2.

    An outline that is turned inside out counts as half.
    """
    worst = 0.0
    for p in certificate.problems:
        if p.severity != "error":
            continue
        if p.kind == "inside out":
            return 0.5
        if p.kind == "crossing" and len(set(p.outlines)) == 1 and len(p.edges) == 2:
            worst = max(worst, _loop(plan, p.outlines[0], *sorted(p.edges)))
    return worst


def _loop(plan: SpanPlan, outline: int, first: int, last: int) -> float:
    """Share of an outline from one edge to another, the shorter way; a mean of both keyframes."""
    pair = plan.links[outline].aligned
    shares = []
    for points in (pair.left, pair.right):
        lengths = edge_lengths(points, closed=pair.closed)
        whole = float(lengths.sum())
        part = float(lengths[first + 1 : last].sum()) / whole if whole > 0 else 0.0
        shares.append(min(part, 1 - part) if pair.closed else part)
    return float(np.mean(shares))
