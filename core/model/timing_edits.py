"""Edits of timing: holds, smooth keyframes, and the timing chart, whose ticks are the drawings of a span.

Chart and curve are two views of one thing. The exposures say at which ratios drawings are made, the easing says
how far on, t, each of them is. Moving a tick leads the easing through it and through all others as they are.
"""

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import pairwise

from core.errors import DocumentError
from core.model.document import Document, Keyframe, Span
from core.model.easing import HIGHEST, LOWEST, through
from core.model.parts import keyframe_of, with_keyframe
from core.model.timing import drawn_offsets, exposures_in

Tick = tuple[int, float]
"""A drawing of a span: at how many frames after the keyframe before it begins, and its t."""


def ticks_of(span: Span, length: int) -> tuple[Tick, ...]:
    """Return the drawings of a span of `length` frames, that of the keyframe before first."""
    offsets = drawn_offsets(span, length)
    times = span.easing.t_at([o / length for o in offsets]).tolist()
    return tuple(zip(offsets, times, strict=True))


def set_smooth(document: Document, layer_id: int, frames: Iterable[int], smooth: bool) -> Document:
    """Let the motion go through keyframes without a jump in its velocity, or let them be sharp."""
    for frame in frames:
        layer = document.layer(layer_id)
        keyframe = keyframe_of(layer, frame)
        if keyframe.smooth != smooth:
            document = with_keyframe(document, layer, replace(keyframe, smooth=smooth))
    return document


def set_step(document: Document, layer_id: int, frame: int, step: int) -> Document:
    """Put a span on ones, twos, threes ...; the curve stays, a chart of its own is given up."""
    keyframe, _ = _span(document, layer_id, frame)
    return _with_span(document, layer_id, keyframe, replace(keyframe.span, step=step, exposures=()))


def move_tick(document: Document, layer_id: int, frame: int, index: int, t: float) -> Document:
    """Put the drawing number `index` (from 1) of a span at another t; all others stay as they are."""
    keyframe, length = _span(document, layer_id, frame)
    ticks = list(_ticks(keyframe, length, index))
    if index == 0:
        raise DocumentError("the keyframe itself cannot be moved along the chart")
    ticks[index] = (ticks[index][0], t)
    return _with_ticks(document, layer_id, keyframe, length, ticks)


def hold_tick(document: Document, layer_id: int, frame: int, index: int, exposure: int) -> Document:
    """Hold a drawing for `exposure` frames; the next one gives or takes them, and both keep their t.

    Raises
    ------
    DocumentError
        If it is the last one, or nothing would be left of the next one.
    """
    keyframe, length = _span(document, layer_id, frame)
    ticks = list(_ticks(keyframe, length, index))
    if index == len(ticks) - 1:
        raise DocumentError("the last drawing is held until the keyframe after; move that one instead")
    limit = (ticks[index + 2][0] if index + 2 < len(ticks) else length) - ticks[index][0] - 1
    if not 1 <= exposure <= limit:
        raise DocumentError(f"the drawing can be held for 1 to {limit} frames, not for {exposure}")
    ticks[index + 1] = (ticks[index][0] + exposure, ticks[index + 1][1])
    return _with_ticks(document, layer_id, keyframe, length, ticks)


def divide_tick(document: Document, layer_id: int, frame: int, index: int, parts: int) -> Document:
    """Add drawings between number `index` and the next one: a half for 2 parts, thirds for 3.

    They take their frames from the drawing before them, and lie evenly between the two.

    Raises
    ------
    DocumentError
        If that one is not held long enough.
    """
    keyframe, length = _span(document, layer_id, frame)
    ticks = list(_ticks(keyframe, length, index))
    start, low = ticks[index]
    end, high = ticks[index + 1] if index + 1 < len(ticks) else (length, 1.0)
    if end - start < parts:
        raise DocumentError(
            f"the drawing at frame {keyframe.frame + start} is held for {end - start} of the {parts} frames that "
            f"are needed; hold it longer or move the keyframe after"
        )
    made = [(start + round(k * (end - start) / parts), low + k * (high - low) / parts) for k in range(1, parts)]
    ticks[index + 1 : index + 1] = made
    return _with_ticks(document, layer_id, keyframe, length, ticks)


def delete_tick(document: Document, layer_id: int, frame: int, index: int) -> Document:
    """Take a drawing out of a span; the one before it is held in its place."""
    keyframe, length = _span(document, layer_id, frame)
    ticks = list(_ticks(keyframe, length, index))
    if index == 0:
        raise DocumentError("the keyframe itself cannot be taken out of the chart")
    del ticks[index]
    return _with_ticks(document, layer_id, keyframe, length, ticks)


def _span(document: Document, layer_id: int, frame: int) -> tuple[Keyframe, int]:
    """Return the keyframe that a span begins at, and the span's length."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    for before, after in pairwise(layer.keyframes):
        if before is keyframe:
            return keyframe, after.frame - before.frame
    raise DocumentError(f"no span begins at frame {frame}: it holds the last keyframe")


def _ticks(keyframe: Keyframe, length: int, index: int) -> tuple[Tick, ...]:
    if keyframe.span.hold:
        raise DocumentError("the span holds its keyframe; give up the hold to chart in-betweens")
    ticks = ticks_of(keyframe.span, length)
    if not 0 <= index < len(ticks):
        raise DocumentError(f"the span has {len(ticks)} drawings; there is no number {index}")
    return ticks


def _with_ticks(
    document: Document, layer_id: int, keyframe: Keyframe, length: int, ticks: Sequence[Tick]
) -> Document:
    if tuple(ticks) == ticks_of(keyframe.span, length):
        return document
    return _with_span(document, layer_id, keyframe, charted(keyframe.span, ticks, length))


def _with_span(document: Document, layer_id: int, keyframe: Keyframe, span: Span) -> Document:
    if span == keyframe.span:
        return document
    return with_keyframe(document, document.layer(layer_id), replace(keyframe, span=span))


def broken_span(span: Span, length: int, offset: int) -> tuple[Span, Span]:
    """Return the two spans that a span becomes where a keyframe is made of what it shows `offset` frames in.

    Both keep the pace of their part of the span, so the film looks the same; where the easing cannot be cut (it
    turns back), they keep it whole. Pairs, pins and extra turns are of the old drawings and are given up.
    """
    plain = replace(span, pairs=(), pins=(), turns=0, exposures=())
    if span.hold:
        return plain, plain
    if span.step == 1 and not span.exposures:
        easings = span.easing.cut(offset / length)
        return tuple(replace(plain, easing=e) for e in easings) if easings else (plain, plain)  # type: ignore[return-value]
    ticks = ticks_of(span, length)
    middle = next(t for o, t in reversed(ticks) if o <= offset)
    if not 0 <= middle < 1:
        middle = offset / length
    first = [(o, t / middle if middle else 0.0) for o, t in ticks if o < offset]
    second = [(0, 0.0), *((o - offset, (t - middle) / (1 - middle)) for o, t in ticks if o > offset)]
    return charted(plain, first, offset), charted(plain, second, length - offset)


def charted(span: Span, ticks: Sequence[Tick], length: int) -> Span:
    """Return a span of those drawings, with exposures of their own only where they follow no step."""
    exposures = tuple(b - a for a, b in pairwise((*(o for o, _ in ticks), length)))
    plain = replace(span, exposures=(), easing=through([(o / length, _in_range(t)) for o, t in ticks[1:]]))
    return plain if exposures == exposures_in(plain, length) else replace(plain, exposures=exposures)


def _in_range(t: float) -> float:
    return min(max(t, LOWEST), HIGHEST)
