"""Finding and replacing parts of a document, for the edits."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import replace

from core.errors import DocumentError
from core.model.document import Document, Keyframe, Layer, Span
from core.model.timing import fitted_exposures

NOT_MOVED: Mapping[int, int] = {}


def check_open(layer: Layer) -> None:
    """Raise DocumentError if a layer is locked."""
    if layer.locked:
        raise DocumentError(f"layer {layer.name!r} is locked; unlock it to change it")


def keyframe_of(layer: Layer, frame: int) -> Keyframe:
    """Return the keyframe at `frame`, or raise DocumentError."""
    keyframe = layer.keyframe_at(frame)
    if keyframe is None:
        raise DocumentError(f"layer {layer.name!r} has no keyframe at frame {frame}")
    return keyframe


def span_of(document: Document, layer_id: int, frame: int) -> Span:
    """Return the span that begins at `frame`, or raise DocumentError."""
    return keyframe_of(document.layer(layer_id), frame).span


def with_keyframe(document: Document, layer: Layer, keyframe: Keyframe, *, even_locked: bool = False) -> Document:
    """Return the document with `keyframe` in place of the one at its frame; a locked layer refuses."""
    if not even_locked:
        check_open(layer)
    keyframes = tuple(keyframe if k.frame == keyframe.frame else k for k in layer.keyframes)
    return document.with_layer(replace(layer, keyframes=keyframes))


def with_keyframes(
    document: Document, layer: Layer, keyframes: Sequence[Keyframe], *, moved: Mapping[int, int] = NOT_MOVED
) -> Document:
    """Set all keyframes of a layer; a locked one refuses.

    A span whose keyframe after is another one now forgets its pairs and arcs, and a timing chart is fitted to the
    span's new length. `moved` tells the frame that a keyframe came from. Drawings cannot tell: several keyframes
    may share one.
    """
    check_open(layer)
    followers = {a.frame: b for a, b in itertools.pairwise(layer.keyframes)}
    renewed = []
    for k, following in itertools.zip_longest(keyframes, keyframes[1:]):
        origin = moved.get(k.frame, k.frame)
        renewed.append(_renewed(k, following, origin, followers.get(origin)))
    return document.with_layer(replace(layer, keyframes=tuple(renewed)))


def _renewed(k: Keyframe, following: Keyframe | None, origin: int, old: Keyframe | None) -> Keyframe:
    span = k.span
    if (span.pairs or span.pins) and (old and old.drawing) is not (following and following.drawing):
        pins = tuple(replace(p, handles=None) for p in span.pins) if following else ()
        span = replace(span, pairs=(), pins=pins)
    if span.exposures and old is not None and following is not None:
        length, new = old.frame - origin, following.frame - k.frame
        if length != new:
            span = replace(span, exposures=fitted_exposures(span, length, new))
    return k if span is k.span else replace(k, span=span)
