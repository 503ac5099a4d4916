"""Finding and replacing parts of a document, for the edits."""

from dataclasses import replace

from core.errors import DocumentError
from core.model.document import Document, Keyframe, Layer, Span


def keyframe_of(layer: Layer, frame: int) -> Keyframe:
    """Return the keyframe at `frame`, or raise DocumentError."""
    keyframe = layer.keyframe_at(frame)
    if keyframe is None:
        raise DocumentError(f"layer {layer.name!r} has no keyframe at frame {frame}")
    return keyframe


def span_of(document: Document, layer_id: int, frame: int) -> Span:
    """Return the span that begins at `frame`, or raise DocumentError."""
    return keyframe_of(document.layer(layer_id), frame).span


def with_keyframe(document: Document, layer: Layer, keyframe: Keyframe) -> Document:
    """Return the document with `keyframe` in place of the one at its frame."""
    keyframes = tuple(keyframe if k.frame == keyframe.frame else k for k in layer.keyframes)
    return document.with_layer(replace(layer, keyframes=keyframes))
