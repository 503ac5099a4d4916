"""Where the positions on an outline go when vertices are added or taken away, and which anchors still hold."""

from collections.abc import Callable, Sequence

import numpy as np
import numpy.typing as npt

from core.correspondence.pairing import ordered_anchors
from core.errors import CorrespondenceError
from core.geometry.outline import FloatArray, lengths_at
from core.model.document import Anchor
from core.model.drawing import Drawing, Outline

Positions = Callable[[float], float]


def after_insertion(position: float) -> Positions:
    """From a position to the same point when a vertex is put at `position`, inside an edge."""
    edge = int(position)
    share = position - edge

    def moved(at: float) -> float:
        if at <= edge:
            return at
        if at >= edge + 1:
            return at + 1
        along = at - edge
        return edge + along / share if along <= share else edge + 1 + (along - share) / (1 - share)

    return moved


def after_deletion(outline: Outline, keep: npt.NDArray[np.intp]) -> Positions:
    """From a position to the one at the same share of the way between the vertices kept."""
    n, closed = len(outline.points), outline.closed
    old = keep.astype(np.float64)
    new = np.arange(len(keep), dtype=np.float64)
    if closed:
        old, new = np.append(old, old[0] + n), np.append(new, len(keep))
    whole = float(lengths_at(outline.points, np.array([n if closed else n - 1]), closed=closed)[0])

    def length(at: FloatArray) -> FloatArray:
        rounds = np.floor(at / n) if closed else np.zeros_like(at)
        return lengths_at(outline.points, at - rounds * n, closed=closed) + rounds * whole

    marks = length(old)

    def moved(at: float) -> float:
        lifted = at + n if closed and at < old[0] else at
        exact = np.flatnonzero(old == lifted)
        if len(exact):
            place = float(new[exact[0]])
        else:
            place = float(np.interp(length(np.array([lifted])), marks, new)[0])
        return place % len(keep) if closed else place

    return moved


def same_build(outline: Outline, drawing: Drawing) -> bool:
    """Whether positions on `outline` mean the same on its namesake in `drawing`."""
    if not drawing.has(outline.id):
        return False
    other = drawing.outline(outline.id)
    return (other.closed, len(other.points)) == (outline.closed, len(outline.points))


def holding(anchors: Sequence[Anchor], counts: tuple[int, int], *, closed: bool) -> tuple[Anchor, ...]:
    """Return the anchors that can hold together, the earlier made before the later.

    Where vertices go, two anchors can fall together, or one onto an end of an open outline.
    """
    kept: tuple[Anchor, ...] = ()
    for anchor in anchors:
        try:
            ordered_anchors([x.places for x in (*kept, anchor)], counts, closed=closed)
        except CorrespondenceError:
            continue
        kept = (*kept, anchor)
    return kept
