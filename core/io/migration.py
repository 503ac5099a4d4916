"""From earlier versions of the project file to the present one, one step a version."""

from core.io import format_1 as v1
from core.io.format import (
    FORMAT,
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
from core.io.places import decoded


def project_of(content: bytes, version: int) -> ProjectFile:
    """Return the structs of the present version; raises FileFormatError that names the place."""
    if version == 1:
        return _from_1(decoded(content, v1.Project1))
    return decoded(content, ProjectFile)


def _from_1(old: v1.Project1) -> ProjectFile:
    """Version 2 only added fields; each is what version 1 did."""
    stage = StageFile(old.stage.width, old.stage.height, old.stage.background)
    layers = [LayerFile(x.id, x.name, x.visible, [_keyframe_from_1(k) for k in x.keyframes]) for x in old.layers]
    return ProjectFile(FORMAT, VERSION, stage, old.rate, old.length, layers)


def _keyframe_from_1(old: v1.Keyframe1) -> KeyframeFile:
    style = old.drawing.style
    outlines = [OutlineFile(o.id, o.closed, o.points) for o in old.drawing.outlines]
    drawing = DrawingFile(StyleFile(style.fill, style.stroke, style.width), outlines)
    kept = old.reference
    reference = ReferenceFile(kept.path, kept.opacity) if kept else None
    return KeyframeFile(old.frame, drawing, _span_from_1(old.span), reference)


def _span_from_1(old: v1.Span1) -> SpanFile:
    pairs = [_pair_from_1(p) for p in old.pairs]
    pins = [PinFile(p.outline, p.position, p.place, p.handles) for p in old.pins]
    return SpanFile(old.method, old.easing, old.turns, pairs, old.repair, pins)


def _pair_from_1(old: v1.Pair1) -> PairFile:
    c = old.correspondence
    kept = CorrespondenceFile(c.before, c.after, c.counts, c.closed, c.flipped) if c else None
    return PairFile(old.before, old.after, old.anchors, old.muted, kept, old.chosen)
