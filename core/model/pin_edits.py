"""Edits of pins: which points of a span have a way of their own, and which."""

from collections.abc import Callable
from dataclasses import replace

from core.errors import DocumentError
from core.model.document import Document
from core.model.parts import keyframe_of, span_of, with_keyframe
from core.model.pins import Point, SpanPin


def add_pin(document: Document, layer_id: int, frame: int, pin: SpanPin) -> Document:
    """Pin a point of the keyframe at `frame` for the span that begins there; a second pin there adds nothing.

    Raises
    ------
    DocumentError
        If no span begins there, or the pin is not on one of its outlines.
    """
    pins = span_of(document, layer_id, frame).pins
    if any(pin.same_place(x) for x in pins):
        return document
    _check(document, layer_id, frame, pin)
    return _with_pins(document, layer_id, frame, (*pins, pin))


def move_pin(document: Document, layer_id: int, frame: int, index: int, to: SpanPin) -> Document:
    """Put the pin number `index` where `to` is; it keeps its handles. Raises as `add_pin` does."""
    pins = list(_pins(document, layer_id, frame, index))
    if pins[index].same_place(to):
        return document
    if any(to.same_place(x) for x in pins):
        raise DocumentError("there is a pin already")
    pins[index] = replace(to, handles=pins[index].handles)
    _check(document, layer_id, frame, pins[index])
    return _with_pins(document, layer_id, frame, tuple(pins))


def set_pin_handles(
    document: Document, layer_id: int, frame: int, index: int, handles: tuple[Point, Point] | None
) -> Document:
    """Bend the way of a pin to an arc with these handles, or make it straight again (None)."""
    pins = list(_pins(document, layer_id, frame, index))
    if pins[index].handles == handles:
        return document
    pins[index] = replace(pins[index], handles=handles)
    return _with_pins(document, layer_id, frame, tuple(pins))


def delete_pin(document: Document, layer_id: int, frame: int, index: int) -> Document:
    """Let one point go its own way again."""
    pins = _pins(document, layer_id, frame, index)
    return _with_pins(document, layer_id, frame, pins[:index] + pins[index + 1 :])


def clear_pins(document: Document, layer_id: int, frame: int) -> Document:
    """Take every pin of a span away."""
    if not span_of(document, layer_id, frame).pins:
        return document
    return _with_pins(document, layer_id, frame, ())


def change_pins(
    document: Document, layer_id: int, frame: int, change: Callable[[SpanPin], SpanPin | None]
) -> Document:
    """Apply `change` to every pin of the span that begins at `frame`; None drops it."""
    pins = span_of(document, layer_id, frame).pins
    changed = tuple(p for p in map(change, pins) if p is not None)
    return document if changed == pins else _with_pins(document, layer_id, frame, changed)


def drop_pins_on(document: Document, layer_id: int, frame: int, outlines: set[int]) -> Document:
    """Take the pins away that sit on outlines of the keyframe at `frame` which are gone."""
    return change_pins(document, layer_id, frame, lambda pin: None if pin.outline in outlines else pin)


def _with_pins(document: Document, layer_id: int, frame: int, pins: tuple[SpanPin, ...]) -> Document:
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    return with_keyframe(document, layer, replace(keyframe, span=replace(keyframe.span, pins=pins)))


def _pins(document: Document, layer_id: int, frame: int, index: int) -> tuple[SpanPin, ...]:
    """Return the pins of a span, which must have one of that number."""
    pins = span_of(document, layer_id, frame).pins
    if not 0 <= index < len(pins):
        raise DocumentError(f"the span at frame {frame} has no pin {index}; it has {len(pins)}")
    return pins


def _check(document: Document, layer_id: int, frame: int, pin: SpanPin) -> None:
    """Refuse a pin where no span begins, or one that is not on its outline."""
    layer = document.layer(layer_id)
    if all(k.frame <= frame for k in layer.keyframes):
        raise DocumentError(f"no span begins at frame {frame}: it holds the last keyframe")
    pin.check_on(keyframe_of(layer, frame).drawing)
