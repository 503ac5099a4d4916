"""Edits of an exposure sheet: a drawing is held for a number of frames, whatever kind of drawing it is."""

from dataclasses import replace

from core.errors import DocumentError
from core.model.document import Document, Keyframe
from core.model.edits import move_keyframe
from core.model.parts import keyframe_of, with_keyframe
from core.model.timing import drawn_offsets
from core.model.timing_edits import charted, hold_tick, ticks_of


def hold_over(document: Document, layer_id: int, frame: int, index: int, exposure: int) -> Document:
    """Hold drawing number `index` of the span at `frame` longer or shorter, over whatever drawings follow it.

    A following in-between that is wholly held over goes; the next one begins later, or, when the drawing is held
    for less, earlier. All that stay keep their t.

    Raises
    ------
    DocumentError
        If it would reach beyond the keyframe after, or is the last drawing in front of it.
    """
    layer = document.layer(layer_id)
    before, after = _span(document, layer_id, frame)
    length = after.frame - before.frame
    offsets = drawn_offsets(before.span, length)
    if before.span.hold or not 0 <= index < len(offsets) - 1:
        return hold_tick(document, layer_id, frame, index, exposure)  # says why it cannot be
    end = offsets[index] + exposure
    if end == offsets[index + 1]:
        return document
    if exposure < 1 or end > length:
        most = length - offsets[index]
        raise DocumentError(
            f"the drawing can be held for 1 to {most} frames, until the keyframe at {after.frame}, "
            f"not for {exposure}"
        )
    ticks = ticks_of(before.span, length)
    behind = [x for x in ticks[index + 1 :] if x[0] >= end]
    covered = [x for x in ticks[index + 1 :] if x[0] < end]
    runs_on = covered and (behind[0][0] if behind else length) > end
    moved = [(end, covered[-1][1])] if runs_on else []
    if not covered:
        moved, behind = [(end, behind[0][1])], behind[1:]
    chart = charted(before.span, [*ticks[: index + 1], *moved, *behind], length)
    return with_keyframe(document, layer, replace(before, span=chart))


def expose_drawing(document: Document, layer_id: int, frame: int, exposure: int) -> Document:
    """Hold the drawing that a layer shows at `frame` for `exposure` frames.

    The last drawing in front of a keyframe pushes it, or draws it near; the spacing of the drawings stays. Others
    as `hold_over` does.

    Raises
    ------
    DocumentError
        If no drawing is there, if it is the layer's last, or if another keyframe is in the way.
    """
    layer = document.layer(layer_id)
    before, after = layer.around(frame)
    if before is None:
        raise DocumentError(f"layer {layer.name!r} shows nothing at frame {frame}")
    if after is None or after.frame == frame:
        raise DocumentError("the last keyframe is held to the end of the film; change the film's length instead")
    length = after.frame - before.frame
    offsets = drawn_offsets(before.span, length)
    index = max(i for i, o in enumerate(offsets) if before.frame + o <= frame)
    if index < len(offsets) - 1:
        return hold_over(document, layer_id, before.frame, index, exposure)
    if exposure < 1:
        raise DocumentError(f"a drawing held for {exposure} frames; the least is 1")
    return _with_after_at(document, layer_id, before, after, before.frame + offsets[index] + exposure)


def _with_after_at(document: Document, layer_id: int, before: Keyframe, after: Keyframe, to: int) -> Document:
    """Move the keyframe after so that only the last drawing in front of it is held for longer or less."""
    layer = document.layer(layer_id)
    following = next((k for k in layer.keyframes if k.frame > after.frame), None)
    if following is not None and to >= following.frame:
        raise DocumentError(f"the keyframe at {following.frame} is in the way; move it first")
    if to == after.frame:
        return document
    ticks = ticks_of(before.span, after.frame - before.frame)
    document = move_keyframe(document, layer_id, after.frame, to)
    moved = keyframe_of(document.layer(layer_id), before.frame)
    if moved.span.hold:
        return document
    span = charted(moved.span, ticks, to - before.frame)
    return with_keyframe(document, document.layer(layer_id), replace(moved, span=span))


def _span(document: Document, layer_id: int, frame: int) -> tuple[Keyframe, Keyframe]:
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    following = next((k for k in layer.keyframes if k.frame > frame), None)
    if following is None:
        raise DocumentError(f"no span begins at frame {frame}: it holds the last keyframe")
    return keyframe, following
