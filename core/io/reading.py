"""From the structs of the project file to the document, with everything checked that the structs cannot tell."""

import itertools
from fractions import Fraction
from typing import Any

import msgspec
import numpy as np

from core.correspondence.pairing import Correspondence, ordered_anchors
from core.errors import FileFormatError
from core.geometry.outline import FloatArray
from core.io.format import (
    CorrespondenceFile,
    DrawingFile,
    KeyframeFile,
    KnotFile,
    LayerFile,
    OutlineFile,
    PairFile,
    PinFile,
    Point,
    ProjectFile,
    SpanFile,
)
from core.io.places import Budget, decoded_at, place
from core.model.document import Anchor, Document, Keyframe, Layer, OutlinePair, Reference, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import Easing, Knot
from core.model.pins import SpanPin

Outlines = dict[int, Outline]


def from_file(project: ProjectFile) -> Document:
    """Return the document; raises FileFormatError that names the place of what is wrong."""
    budget = Budget()
    with place("stage"):
        stage = Stage(project.stage.width, project.stage.height, project.stage.background)
    with place("rate"):
        if project.rate[1] < 1:
            raise FileFormatError("the lower number must be 1 or more")
        rate = Fraction(*project.rate)
    with place("layers"):
        budget.take("layers", len(project.layers))
    layers = tuple(_layer(x, f"layers[{i}]", budget) for i, x in enumerate(project.layers))
    with place(""):
        return Document(stage, rate, project.length, layers)


def _layer(layer: LayerFile, where: str, budget: Budget) -> Layer:
    with place(f"{where}.keyframes"):
        budget.take("keyframes", len(layer.keyframes))
    keyframes = [_keyframe(k, f"{where}.keyframes[{j}]", budget) for j, k in enumerate(layer.keyframes)]
    with place(where):
        own = layer.locked, layer.opacity, layer.color, layer.parent
        made = Layer(layer.id, layer.name, layer.visible, tuple(keyframes), *own)
    outlines = [{o.id: o for o in k.drawing.outlines} for k in keyframes]
    for j, (before, after) in enumerate(itertools.zip_longest(outlines, outlines[1:])):
        _check_span(keyframes[j].span, before, after, f"{where}.keyframes[{j}].span")
    return made


def _keyframe(keyframe: KeyframeFile, where: str, budget: Budget) -> Keyframe:
    drawing = _drawing(keyframe.drawing, f"{where}.drawing", budget)
    span = _span(keyframe.span, f"{where}.span", budget)
    with place(f"{where}.reference"):
        kept = keyframe.reference
        reference = Reference(kept.path, kept.opacity) if kept else None
    with place(where):
        return Keyframe(keyframe.frame, drawing, span, reference, keyframe.smooth)


def _drawing(drawing: DrawingFile, where: str, budget: Budget) -> Drawing:
    with place(f"{where}.outlines"):
        budget.take("outlines", len(drawing.outlines))
    outlines = tuple(_outline(o, f"{where}.outlines[{i}]", budget) for i, o in enumerate(drawing.outlines))
    with place(where):
        style = drawing.style
        return Drawing(outlines, Style(style.fill, style.stroke, style.width, style.opacity))


def _outline(outline: OutlineFile, where: str, budget: Budget) -> Outline:
    with place(f"{where}.points"):
        budget.take("vertices", (_commas(outline.points) + 1) // 2)
    points = decoded_at(outline.points, list[Point], f"{where}.points")
    with place(where):
        return Outline(outline.id, np.array(points, dtype=np.float64).reshape(-1, 2), outline.closed)


def _span(span: SpanFile, where: str, budget: Budget) -> Span:
    pairs = tuple(_pair(p, f"{where}.pairs[{i}]", budget) for i, p in enumerate(span.pairs))
    pins = tuple(_pin(p, f"{where}.pins[{i}]") for i, p in enumerate(span.pins))
    knots = _listed(span.knots, KnotFile, "knots", 6, where, budget)
    exposures = _listed(span.exposures, int, "exposures", 1, where, budget)
    with place(where):
        easing = Easing(*span.easing, tuple(Knot(*k) for k in knots))
        timing = span.placement, span.hold, span.step, tuple(exposures)
        return Span(span.method, easing, span.turns, pairs, span.repair, pins, *timing)


def _listed(
    raw: msgspec.Raw | msgspec.UnsetType, kind: Any, what: str, numbers: int, where: str, budget: Budget
) -> list[Any]:
    """Return a list that may be left out, of things of so many `numbers`, which are counted as `what`."""
    if raw is msgspec.UNSET:
        return []
    with place(f"{where}.{what}"):
        budget.take(what, (_commas(raw) + 1) // numbers)
    listed: list[Any] = decoded_at(raw, list[kind], f"{where}.{what}")
    return listed


def _pair(pair: PairFile, where: str, budget: Budget) -> OutlinePair:
    points = _listed(pair.anchors, Point, "anchors", 2, where, budget)
    muted: list[int] = []
    if pair.muted is not msgspec.UNSET:
        with place(f"{where}.muted"):
            if _commas(pair.muted) >= len(points):
                raise FileFormatError(f"there are {len(points)} anchors; more are muted")
        muted = decoded_at(pair.muted, list[int], f"{where}.muted")
    kept = _correspondence(pair.correspondence, f"{where}.correspondence", budget) if pair.correspondence else None
    with place(where):
        if any(not 0 <= i < len(points) for i in muted):
            raise FileFormatError(f"there are {len(points)} anchors; muted are {muted[:20]}")
        silent = frozenset(muted)
        anchors = tuple(Anchor(a, b, i in silent) for i, (a, b) in enumerate(points))
        return OutlinePair(pair.before, pair.after, anchors, kept, pair.chosen)


def _correspondence(kept: CorrespondenceFile, where: str, budget: Budget) -> Correspondence:
    before = _numbers(kept.before, f"{where}.before", budget)
    after = _numbers(kept.after, f"{where}.after")
    with place(where):
        return Correspondence(before, after, kept.counts, kept.closed, kept.flipped)


def _numbers(raw: msgspec.Raw, where: str, budget: Budget | None = None) -> FloatArray:
    """Return a list of numbers; `budget` counts them where their number is not given by another list."""
    with place(where):
        (budget or Budget()).take("positions", _commas(raw) + 1)
    return np.array(decoded_at(raw, list[float], where), dtype=np.float64)


def _commas(raw: msgspec.Raw) -> int:
    """Return how many commas stand in a raw list, before anything is made of it."""
    return bytes(raw).count(b",")


def _pin(pin: PinFile, where: str) -> SpanPin:
    with place(where):
        if (pin.outline is None) != (pin.position is None):
            raise FileFormatError("a pin on an outline has both `outline` and `position`, one inside neither")
        return SpanPin(pin.outline, pin.position or 0.0, pin.place, pin.handles)


def _check_span(span: Span, before: Outlines, after: Outlines | None, where: str) -> None:
    """Refuse pins and pairs that name no outline of the two keyframes, and anchors that cannot hold."""
    for i, pin in enumerate(span.pins):
        with place(f"{where}.pins[{i}]"):
            if after is None:
                raise FileFormatError("a pin in the span of the last keyframe")
            if pin.outline is not None:
                pin.check_on(Drawing((_found(before, pin.outline),)))
    for i, pair in enumerate(span.pairs):
        with place(f"{where}.pairs[{i}]"):
            if after is None:
                raise FileFormatError("a pair of outlines in the span of the last keyframe")
            _check_pair(pair, _found(before, pair.before), _found(after, pair.after))


def _check_pair(pair: OutlinePair, a: Outline, b: Outline) -> None:
    counts = (len(a.points), len(b.points))
    if a.closed != b.closed:
        raise FileFormatError("a closed outline is paired with an open one")
    if pair.anchors:
        ordered_anchors(pair.held, counts, closed=a.closed)
    c = pair.correspondence
    if c is not None and (c.counts, c.closed) != (counts, a.closed):
        raise FileFormatError(f"a correspondence of {c.counts} vertices for outlines with {counts}")


def _found(outlines: Outlines, outline_id: int) -> Outline:
    if outline_id not in outlines:
        raise FileFormatError(f"the drawing has no outline {outline_id}")
    return outlines[outline_id]
