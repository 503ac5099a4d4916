"""Every edit of a document: a function from document to document that raises before anything changes.

An edit that changes nothing returns the very same document. Where vertices are added or taken away, the anchors
of the spans on both sides, and the pins of the span that begins there, stay at their places on the outline.
"""

from bisect import insort
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np
import numpy.typing as npt

from core.errors import DocumentError
from core.geometry.outline import FloatArray, points_at
from core.model.document import Document, Keyframe, Layer, OutlinePair, Reference, Span, Stage
from core.model.drawing import Drawing, Outline, Style
from core.model.easing import Easing
from core.model.layer_edits import (
    add_layer,
    delete_layer,
    duplicate_layer,
    move_layer,
    set_layer,
    set_parent,
)
from core.model.pair_edits import (
    add_anchor,
    choose_correspondence,
    clear_anchors,
    delete_anchor,
    move_anchor,
    pair_outlines_by_hand,
    set_muted,
    solve_again,
    store_answer,
)
from core.model.parts import keyframe_of, with_keyframe, with_keyframes
from core.model.pin_edits import (
    add_pin,
    change_pins,
    clear_pins,
    delete_pin,
    drop_pins_on,
    move_pin,
    set_pin_handles,
)
from core.model.positions import Positions, after_deletion, after_insertion, holding, same_build
from core.model.timing_edits import (
    delete_tick,
    divide_tick,
    hold_tick,
    move_tick,
    set_smooth,
    set_step,
)

Mine = Callable[[OutlinePair], int]
"""The side of a pair that an edit is about: its outline before or its outline after."""

__all__ = [
    "add_anchor",
    "add_layer",
    "add_outline",
    "add_pin",
    "choose_correspondence",
    "clear_anchors",
    "clear_pins",
    "delete_anchor",
    "delete_keyframe",
    "delete_layer",
    "delete_outline",
    "delete_pin",
    "delete_tick",
    "delete_vertices",
    "divide_tick",
    "duplicate_layer",
    "hold_tick",
    "insert_vertex",
    "move_anchor",
    "move_keyframe",
    "move_layer",
    "move_pin",
    "move_tick",
    "move_vertices",
    "pair_outlines_by_hand",
    "put_drawing",
    "set_layer",
    "set_length",
    "set_muted",
    "set_parent",
    "set_pin_handles",
    "set_rate",
    "set_reference",
    "set_smooth",
    "set_span",
    "set_stage",
    "set_step",
    "set_style",
    "solve_again",
    "store_answer",
]


def set_stage(document: Document, stage: Stage) -> Document:
    """Give the stage another size or colour; drawings stay where they are."""
    return document if stage == document.stage else replace(document, stage=stage)


def set_rate(document: Document, rate: Fraction) -> Document:
    """Set the frames a second."""
    return document if rate == document.rate else replace(document, rate=rate)


def set_length(document: Document, length: int) -> Document:
    """Set the number of frames; keyframes behind the end are kept."""
    return document if length == document.length else replace(document, length=length)


def put_drawing(document: Document, layer_id: int, frame: int, drawing: Drawing) -> Document:
    """Make `drawing` the keyframe at `frame`, new or in place of the one that is there.

    A new keyframe inside a span takes its method and easing; a film that is too short grows to the frame. Where
    an outline is gone or has another number of vertices, the anchors and pins on it go with it.
    """
    layer = document.layer(layer_id)
    old = layer.keyframe_at(frame)
    if old is not None:
        if old.drawing == drawing:
            return document
        document = with_keyframe(document, layer, replace(old, drawing=drawing))
        lost = {o.id for o in old.drawing.outlines if not same_build(o, drawing)}
        document = drop_pins_on(document, layer_id, frame, lost)
        return _in_both_spans(document, layer_id, frame, lambda pair, mine: None if mine(pair) in lost else pair)
    earlier = [k for k in layer.keyframes if k.frame < frame]
    neighbour = earlier[-1] if earlier else (layer.keyframes[0] if layer.keyframes else None)
    span = replace(neighbour.span, pairs=(), pins=(), turns=0) if neighbour else Span()
    keyframes = list(layer.keyframes)
    insort(keyframes, Keyframe(frame, drawing, span), key=lambda k: k.frame)
    document = with_keyframes(document, layer, keyframes)
    return set_length(document, max(document.length, frame))


def delete_keyframe(document: Document, layer_id: int, frame: int) -> Document:
    """Take a keyframe away; the spans on both sides become one."""
    layer = document.layer(layer_id)
    keyframe_of(layer, frame)
    return with_keyframes(document, layer, [k for k in layer.keyframes if k.frame != frame])


def move_keyframe(document: Document, layer_id: int, frame: int, to: int) -> Document:
    """Move a keyframe to another, free frame, also past others."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    if to == frame:
        return document
    if layer.keyframe_at(to) is not None:
        raise DocumentError(f"frame {to} of {layer.name!r} already holds a keyframe")
    rest = [k for k in layer.keyframes if k.frame != frame]
    insort(rest, replace(keyframe, frame=to), key=lambda k: k.frame)
    document = with_keyframes(document, layer, rest, moved={to: frame})
    return set_length(document, max(document.length, to))


def add_outline(
    document: Document, layer_id: int, frame: int, points: npt.ArrayLike, *, closed: bool = True
) -> Document:
    """Add an outline to the drawing at `frame`; where no keyframe is, one is made.

    A new keyframe is painted like the nearest keyframe before it, else the one after it.
    """
    layer = document.layer(layer_id)
    keyframe = layer.keyframe_at(frame)
    if keyframe is None:
        drawing = Drawing(style=_style_near(layer, frame))
    else:
        drawing = keyframe.drawing
    outline = Outline(drawing.free_id(), np.asarray(points, dtype=np.float64), closed)
    return put_drawing(document, layer_id, frame, drawing.with_outline(outline))


def move_vertices(document: Document, layer_id: int, frame: int, points: Mapping[int, FloatArray]) -> Document:
    """Give outlines new vertex places, {outline id: (n, 2)}; vertex counts stay."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    drawing = keyframe.drawing
    for outline_id, moved in points.items():
        outline = drawing.outline(outline_id)
        if len(moved) != len(outline.points):
            raise DocumentError(
                f"outline {outline_id} has {len(outline.points)} vertices, the moved one has {len(moved)}"
            )
        if not np.array_equal(moved, outline.points):
            drawing = drawing.with_outline(replace(outline, points=moved))
    if drawing is keyframe.drawing:
        return document
    document = with_keyframe(document, layer, replace(keyframe, drawing=drawing))
    return _in_both_spans(document, layer_id, frame, lambda pair, mine: _unsolved(pair, mine(pair) in points))


def insert_vertex(document: Document, layer_id: int, frame: int, outline_id: int, position: float) -> Document:
    """Put a vertex on an outline at a position inside an edge; its shape stays."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    outline = keyframe.drawing.outline(outline_id)
    top = len(outline.points) if outline.closed else len(outline.points) - 1
    if not 0 <= position <= top:
        raise DocumentError(f"a vertex at {position:g} on outline {outline_id}, which ends at {top}")
    edge = int(position)
    if position == edge:
        return document
    place = points_at(outline.points, np.array([position]), closed=outline.closed)
    points = np.insert(outline.points, edge + 1, place, axis=0)

    drawing = keyframe.drawing.with_outline(replace(outline, points=points))
    return _with_changed_outline(
        document, layer, replace(keyframe, drawing=drawing), outline_id, after_insertion(position)
    )


def delete_vertices(
    document: Document, layer_id: int, frame: int, indices: Mapping[int, Iterable[int]]
) -> Document:
    """Take vertices away, {outline id: indices}; an outline left with too few goes as a whole."""
    for outline_id, gone in indices.items():
        layer = document.layer(layer_id)
        keyframe = keyframe_of(layer, frame)
        outline = keyframe.drawing.outline(outline_id)
        count = len(outline.points)
        lost = np.unique(np.fromiter(gone, dtype=np.intp))
        if len(lost) and not 0 <= lost[0] <= lost[-1] < count:
            raise DocumentError(f"outline {outline_id} has {count} vertices; there is no {lost[[0, -1]].tolist()}")
        keep = np.setdiff1d(np.arange(count), lost)
        if len(keep) == count:
            continue
        if len(keep) < (3 if outline.closed else 2):
            document = delete_outline(document, layer_id, frame, outline_id)
            continue
        changed = replace(
            keyframe, drawing=keyframe.drawing.with_outline(replace(outline, points=outline.points[keep]))
        )
        document = _with_changed_outline(document, layer, changed, outline_id, after_deletion(outline, keep))
    return document


def delete_outline(document: Document, layer_id: int, frame: int, outline_id: int) -> Document:
    """Take one outline out of a drawing; the last one takes the keyframe with it."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    drawing = keyframe.drawing.without_outline(outline_id)
    if not drawing.outlines:
        return delete_keyframe(document, layer_id, frame)
    document = with_keyframe(document, layer, replace(keyframe, drawing=drawing))
    document = drop_pins_on(document, layer_id, frame, {outline_id})
    return _in_both_spans(document, layer_id, frame, lambda pair, mine: None if mine(pair) == outline_id else pair)


def set_style(document: Document, layer_id: int, frame: int, style: Style) -> Document:
    """Paint the drawing at `frame` differently."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    if keyframe.drawing.style == style:
        return document
    return with_keyframe(document, layer, replace(keyframe, drawing=replace(keyframe.drawing, style=style)))


def set_span(
    document: Document,
    layer_id: int,
    frame: int,
    *,
    method: str | None = None,
    easing: Easing | None = None,
    turns: int | None = None,
    repair: bool | None = None,
    placement: str | None = None,
    hold: bool | None = None,
) -> Document:
    """Change how the span that begins at `frame` moves; its timing chart is changed in timing_edits.py."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    span = keyframe.span
    changed = replace(
        span,
        method=span.method if method is None else method,
        easing=span.easing if easing is None else easing,
        turns=span.turns if turns is None else turns,
        repair=span.repair if repair is None else repair,
        placement=span.placement if placement is None else placement,
        hold=span.hold if hold is None else hold,
    )
    return document if changed == span else with_keyframe(document, layer, replace(keyframe, span=changed))


def set_reference(document: Document, layer_id: int, frame: int, reference: Reference | None) -> Document:
    """Lay a picture under the stage at a keyframe, or take it away."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    if keyframe.reference == reference:
        return document
    return with_keyframe(document, layer, replace(keyframe, reference=reference))


def _style_near(layer: Layer, frame: int) -> Style:
    before, after = layer.around(frame)
    near = before or after
    return near.drawing.style if near else Style()


def _with_changed_outline(
    document: Document, layer: Layer, keyframe: Keyframe, outline_id: int, moved: Positions
) -> Document:
    """Set a keyframe in which one outline got other vertices, and carry the anchors and pins on it along."""
    document = with_keyframe(document, layer, keyframe)
    count = len(keyframe.drawing.outline(outline_id).points)
    here = layer.frames().index(keyframe.frame)

    def carried(pair: OutlinePair, mine: Mine) -> OutlinePair | None:
        if mine(pair) != outline_id:
            return pair
        before = mine is _before_id
        drawing = layer.keyframes[here + 1 if before else here - 1].drawing
        partner_id = pair.after if before else pair.before
        if not drawing.has(partner_id):
            return None
        partner = drawing.outline(partner_id)
        counts = (count, len(partner.points)) if before else (len(partner.points), count)
        if before:
            anchors = [x._replace(before=moved(x.before)) for x in pair.anchors]
        else:
            anchors = [x._replace(after=moved(x.after)) for x in pair.anchors]
        return replace(
            pair, anchors=holding(anchors, counts, closed=partner.closed), correspondence=None, chosen=False
        )

    document = _in_both_spans(document, layer.id, keyframe.frame, carried)
    return change_pins(
        document,
        layer.id,
        keyframe.frame,
        lambda pin: replace(pin, position=moved(pin.position)) if pin.outline == outline_id else pin,
    )


def _unsolved(pair: OutlinePair, moved: bool) -> OutlinePair | None:
    """Give up a stored answer of the solver; of a pair that holds nothing else nothing is left."""
    if not moved or pair.chosen or pair.correspondence is None:
        return pair
    return replace(pair, correspondence=None) if pair.anchors else None


def _before_id(pair: OutlinePair) -> int:
    return pair.before


def _after_id(pair: OutlinePair) -> int:
    return pair.after


def _in_both_spans(
    document: Document,
    layer_id: int,
    frame: int,
    change: Callable[[OutlinePair, Mine], OutlinePair | None],
) -> Document:
    """Apply `change` to the pairs of the span that begins at `frame` and of the one that ends there."""
    layer = document.layer(layer_id)
    here = layer.frames().index(frame)
    for i, mine in ((here, _before_id), (here - 1, _after_id)):
        if not 0 <= i < len(layer.keyframes) - 1 or not layer.keyframes[i].span.pairs:
            continue
        keyframe = layer.keyframes[i]
        pairs = tuple(p for p in (change(pair, mine) for pair in keyframe.span.pairs) if p is not None)
        if pairs != keyframe.span.pairs:
            document = with_keyframe(document, layer, replace(keyframe, span=replace(keyframe.span, pairs=pairs)))
            layer = document.layer(layer_id)
    return document
