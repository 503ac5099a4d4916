"""From the document to the structs of the project file."""

from collections.abc import Iterable
from typing import Any

import msgspec

from core.io.format import (
    FORMAT,
    OPAQUE,
    VERSION,
    CorrespondenceFile,
    DrawingFile,
    KeyframeFile,
    LayerFile,
    OutlineFile,
    PairFile,
    PinFile,
    ProjectFile,
    ReferenceFile,
    SpanFile,
    StageFile,
    StyleFile,
)
from core.io.places import Budget
from core.model.document import Document, Keyframe, Layer, OutlinePair, Span
from core.model.drawing import Drawing
from core.model.pins import SpanPin


def to_file(document: Document) -> ProjectFile:
    """Return the structs; raises FileFormatError if the document has more than could be read again.

    Every number is a plain one: equal documents give equal bytes, and the writer knows no NumPy scalars.
    """
    budget = Budget()
    stage = StageFile(int(document.stage.width), int(document.stage.height), document.stage.background)
    budget.take("layers", len(document.layers))
    layers = [_layer(layer, budget) for layer in document.layers]
    rate = (int(document.rate.numerator), int(document.rate.denominator))
    return ProjectFile(FORMAT, VERSION, stage, rate, int(document.length), layers)


def _layer(layer: Layer, budget: Budget) -> LayerFile:
    budget.take("keyframes", len(layer.keyframes))
    keyframes = [_keyframe(k, budget) for k in layer.keyframes]
    return LayerFile(
        int(layer.id),
        layer.name,
        bool(layer.visible),
        keyframes,
        bool(layer.locked),
        _opacity(layer.opacity),
        layer.color,
        None if layer.parent is None else int(layer.parent),
    )


def _opacity(opacity: float) -> float:
    return OPAQUE if opacity == OPAQUE else float(opacity)


def _keyframe(keyframe: Keyframe, budget: Budget) -> KeyframeFile:
    kept = keyframe.reference
    return KeyframeFile(
        int(keyframe.frame),
        _drawing(keyframe.drawing, budget),
        _span(keyframe.span, budget),
        ReferenceFile(kept.path, float(kept.opacity)) if kept else None,
        bool(keyframe.smooth),
    )


def _drawing(drawing: Drawing, budget: Budget) -> DrawingFile:
    budget.take("outlines", len(drawing.outlines))
    budget.take("vertices", sum(len(o.points) for o in drawing.outlines))
    style = drawing.style
    outlines = [OutlineFile(int(o.id), bool(o.closed), _raw(o.points.tolist())) for o in drawing.outlines]
    kept = StyleFile(style.fill, style.stroke, float(style.width), _opacity(style.opacity))
    return DrawingFile(kept, outlines)


def _span(span: Span, budget: Budget) -> SpanFile:
    easing = span.easing
    budget.take("knots", len(easing.knots))
    budget.take("exposures", len(span.exposures))
    return SpanFile(
        span.method,
        (float(easing.x1), float(easing.y1), float(easing.x2), float(easing.y2)),
        int(span.turns),
        [_pair(p, budget) for p in span.pairs],
        bool(span.repair),
        [_pin(p) for p in span.pins],
        _raw_or_unset(tuple(map(float, k)) for k in easing.knots),
        span.placement,
        bool(span.hold),
        int(span.step),
        _raw_or_unset(map(int, span.exposures)),
    )


def _pair(pair: OutlinePair, budget: Budget) -> PairFile:
    c = pair.correspondence
    kept = None
    budget.take("anchors", len(pair.anchors))
    if c is not None:
        budget.take("positions", len(c.before))
        counts = (int(c.counts[0]), int(c.counts[1]))
        before, after = _raw(c.before.tolist()), _raw(c.after.tolist())
        kept = CorrespondenceFile(before, after, counts, bool(c.closed), bool(c.flipped))
    anchors = _raw_or_unset((float(x.before), float(x.after)) for x in pair.anchors)
    muted = _raw_or_unset(i for i, x in enumerate(pair.anchors) if x.muted)
    return PairFile(int(pair.before), int(pair.after), anchors, muted, kept, bool(pair.chosen))


def _pin(pin: SpanPin) -> PinFile:
    return PinFile(pin.outline, None if pin.outline is None else pin.position, pin.place, pin.handles)


def _raw(values: list[Any]) -> msgspec.Raw:
    return msgspec.Raw(msgspec.json.encode(values))


def _raw_or_unset(values: Iterable[Any]) -> msgspec.Raw | msgspec.UnsetType:
    """Leave an empty list out of the file."""
    listed = list(values)
    return _raw(listed) if listed else msgspec.UNSET
