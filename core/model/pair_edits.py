"""Edits of which point goes where: anchors, and correspondences chosen by hand."""

from dataclasses import replace

from core.correspondence.pairing import Correspondence, ordered_anchors
from core.errors import CorrespondenceError, DocumentError
from core.model.document import Anchor, Document, OutlinePair
from core.model.drawing import Outline
from core.model.parts import keyframe_of, span_of, with_keyframe


def add_anchor(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, anchor: Anchor
) -> Document:
    """Fix a pair of points in the span that begins at `frame`.

    An anchor that starts or ends at the same point as an old one takes its place. If either outline was paired
    with another one, that pair is given up.

    Raises
    ------
    CorrespondenceError
        If it crosses another anchor.
    """
    old = span_of(document, layer_id, frame).pair_of(before_id, after_id)
    if old and anchor in old.anchors:
        return document
    kept = tuple(x for x in old.anchors if x.before != anchor.before and x.after != anchor.after) if old else ()
    return _set_anchors(document, layer_id, frame, before_id, after_id, (*kept, anchor))


def move_anchor(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, index: int, anchor: Anchor
) -> Document:
    """Put the anchor number `index` of a pair elsewhere on the two outlines; raises as `add_anchor` does."""
    anchors = list(_anchors(document, layer_id, frame, before_id, after_id, index))
    if anchors[index] == anchor:
        return document
    anchors[index] = anchor
    return _set_anchors(document, layer_id, frame, before_id, after_id, tuple(anchors))


def delete_anchor(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, index: int
) -> Document:
    """Take one anchor away; the pair of outlines stays."""
    anchors = _anchors(document, layer_id, frame, before_id, after_id, index)
    rest = anchors[:index] + anchors[index + 1 :]
    return _set_anchors(document, layer_id, frame, before_id, after_id, rest)


def clear_anchors(document: Document, layer_id: int, frame: int) -> Document:
    """Forget every anchor and hand-made pair of a span."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    if not keyframe.span.pairs:
        return document
    return with_keyframe(document, layer, replace(keyframe, span=replace(keyframe.span, pairs=())))


def _anchors(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, index: int
) -> tuple[Anchor, ...]:
    """Return the anchors of a pair, which must have one of that number."""
    pair = span_of(document, layer_id, frame).pair_of(before_id, after_id)
    if pair is None or not 0 <= index < len(pair.anchors):
        raise DocumentError(
            f"outlines {before_id} and {after_id} have no anchor {index} in the span at frame {frame}"
        )
    return pair.anchors


def _set_anchors(
    document: Document,
    layer_id: int,
    frame: int,
    before_id: int,
    after_id: int,
    anchors: tuple[Anchor, ...],
) -> Document:
    a, b = _outlines(document, layer_id, frame, before_id, after_id)
    ordered_anchors([x.places for x in anchors if not x.muted], (len(a.points), len(b.points)), closed=a.closed)
    return _with_pair(document, layer_id, frame, OutlinePair(before_id, after_id, anchors))


def _outlines(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int
) -> tuple[Outline, Outline]:
    """Return two outlines that can be a pair in the span that begins at `frame`."""
    layer = document.layer(layer_id)
    following = [k for k in layer.keyframes if k.frame > frame]
    if not following:
        raise DocumentError(f"no span begins at frame {frame}: it holds the last keyframe")
    a = keyframe_of(layer, frame).drawing.outline(before_id)
    b = following[0].drawing.outline(after_id)
    if a.closed != b.closed:
        raise CorrespondenceError("a closed outline cannot correspond to an open one")
    return a, b


def _with_pair(
    document: Document, layer_id: int, frame: int, pair: OutlinePair, *, even_locked: bool = False
) -> Document:
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    others = tuple(p for p in keyframe.span.pairs if p.before != pair.before and p.after != pair.after)
    changed = replace(keyframe, span=replace(keyframe.span, pairs=(*others, pair)))
    return with_keyframe(document, layer, changed, even_locked=even_locked)


def set_muted(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, index: int, muted: bool
) -> Document:
    """Let an anchor be without effect for a while, or take effect again."""
    anchors = list(_anchors(document, layer_id, frame, before_id, after_id, index))
    if anchors[index].muted == muted:
        return document
    anchors[index] = anchors[index]._replace(muted=muted)
    return _set_anchors(document, layer_id, frame, before_id, after_id, tuple(anchors))


def choose_correspondence(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, correspondence: Correspondence
) -> Document:
    """Keep a correspondence that the artist chose; it stays while vertices are moved.

    Raises
    ------
    CorrespondenceError
        If it is of outlines with other vertex counts.
    """
    a, b = _outlines(document, layer_id, frame, before_id, after_id)
    if correspondence.counts != (len(a.points), len(b.points)):
        raise CorrespondenceError(
            f"the correspondence is of outlines with {correspondence.counts[0]} and {correspondence.counts[1]} "
            f"vertices; these have {len(a.points)} and {len(b.points)}"
        )
    old = span_of(document, layer_id, frame).pair_of(before_id, after_id)
    if old and old.chosen and old.correspondence == correspondence:
        return document
    anchors = old.anchors if old else ()
    pair = OutlinePair(before_id, after_id, anchors, correspondence, chosen=True)
    return _with_pair(document, layer_id, frame, pair)


def store_answer(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int, correspondence: Correspondence
) -> Document:
    """Store what the solver answered; it is given up as soon as an outline or an anchor of the pair changes."""
    old = span_of(document, layer_id, frame).pair_of(before_id, after_id)
    if old and old.correspondence is not None:
        return document
    _outlines(document, layer_id, frame, before_id, after_id)
    pair = OutlinePair(before_id, after_id, old.anchors if old else (), correspondence)
    return _with_pair(document, layer_id, frame, pair, even_locked=True)


def pair_outlines_by_hand(
    document: Document, layer_id: int, frame: int, before_id: int, after_id: int
) -> Document:
    """Say that two outlines belong together; pairs that either had are given up."""
    if span_of(document, layer_id, frame).pair_of(before_id, after_id):
        return document
    _outlines(document, layer_id, frame, before_id, after_id)
    return _with_pair(document, layer_id, frame, OutlinePair(before_id, after_id))


def solve_again(document: Document, layer_id: int, frame: int) -> Document:
    """Give up every kept correspondence of a span; anchors and pairs stay."""
    layer = document.layer(layer_id)
    keyframe = keyframe_of(layer, frame)
    pairs = tuple(replace(p, correspondence=None, chosen=False) for p in keyframe.span.pairs)
    if pairs == keyframe.span.pairs:
        return document
    return with_keyframe(document, layer, replace(keyframe, span=replace(keyframe.span, pairs=pairs)))
