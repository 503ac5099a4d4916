"""Breakdowns: a keyframe made of an in-between, with a film that looks as before."""

from dataclasses import replace

import numpy as np

from core.correspondence.pairing import Correspondence
from core.errors import CorrespondenceError
from core.geometry.outline import FloatArray, size
from core.model.document import Document, Keyframe, OutlinePair
from core.model.drawing import Drawing, Outline
from core.model.edits import put_drawing
from core.model.inbetweens import Link
from core.model.motion import SpanMotion
from core.model.parts import keyframe_of, with_keyframe
from core.model.timing_edits import broken_span


def add_breakdown(document: Document, layer_id: int, frame: int, motion: SpanMotion) -> Document:
    """Make a keyframe of exactly what a span shows at a frame inside it.

    Both new spans keep the pace and the correspondences of their part of the old one: every vertex of the
    breakdown knows where it came from. Anchors turn into those correspondences.

    Parameters
    ----------
    motion : SpanMotion
        Of the span that `frame` lies in.
    """
    drawing, kept = _drawing(motion, frame)
    document = put_drawing(document, layer_id, frame, drawing)
    before, after = motion.before, motion.after
    spans = broken_span(before.span, motion.length, frame - before.frame)
    smooth = before.smooth or after.smooth
    for at, span, side in ((before.frame, spans[0], "before"), (frame, spans[1], "after")):
        layer = document.layer(layer_id)
        pairs = tuple(p for p in (_pair(outline, link, motion, side) for outline, link in kept) if p is not None)
        keyframe: Keyframe = replace(keyframe_of(layer, at), span=replace(span, pairs=pairs))
        document = with_keyframe(document, layer, replace(keyframe, smooth=smooth) if at == frame else keyframe)
    return document


def _drawing(motion: SpanMotion, frame: int) -> tuple[Drawing, list[tuple[Outline, Link]]]:
    """Return what is shown as a drawing, and the link of each of its outlines; one that is a point is left out."""
    picture = motion.picture(frame)
    made = [
        (Outline(i, np.array(points), closed), link)
        for i, ((points, closed), link) in enumerate(zip(picture.outlines, motion.plan.links, strict=True), 1)
        if size(points) > 0
    ]
    return Drawing(tuple(outline for outline, _ in made), picture.style), made


def _pair(outline: Outline, link: Link, motion: SpanMotion, side: str) -> OutlinePair | None:
    """Return the pair of a breakdown's outline with the one before, or after; None where a new match must do."""
    if link.before is None or link.after is None:
        return None
    own = np.arange(len(outline.points), dtype=np.float64)
    there = motion.before if side == "before" else motion.after
    count = len(there.drawing.outline(link.before if side == "before" else link.after).points)
    try:
        if side == "before":
            kept = _correspondence(link.before_positions, own, (count, len(own)), outline.closed)
            return OutlinePair(link.before, outline.id, (), kept, chosen=True)
        kept = _correspondence(own, link.after_positions, (len(own), count), outline.closed)
        return OutlinePair(outline.id, link.after, (), kept, chosen=True)
    except CorrespondenceError:  # vertices on top of each other
        return None


def _correspondence(
    before: FloatArray, after: FloatArray, counts: tuple[int, int], closed: bool
) -> Correspondence:
    steps = np.diff(after)
    flipped = int(np.count_nonzero(steps < 0)) > int(np.count_nonzero(steps > 0))
    return Correspondence(before, after, counts, closed, flipped)
