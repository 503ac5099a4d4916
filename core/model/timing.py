"""Timing charts: which frames of a span show a new drawing, and for how long each is held."""

from bisect import bisect_right
from dataclasses import dataclass
from itertools import accumulate, pairwise, zip_longest

from core.model.document import Layer, Span


@dataclass(frozen=True, slots=True)
class Exposure:
    """One drawing that a layer shows, and for how long.

    Attributes
    ----------
    frame : int
        The first frame that shows it.
    count : int
        The number of frames that it is held.
    keyframe : bool
        Whether the artist made it; otherwise it is an in-between.
    """

    frame: int
    count: int
    keyframe: bool


def drawn_offsets(span: Span, length: int) -> tuple[int, ...]:
    """Return at which frames after the keyframe before a drawing of the span begins: 0 first, all below `length`.

    A hold has only the keyframe. A chart for another length is cut off, or its last drawing held longer.
    """
    if span.hold:
        return (0,)
    if not span.exposures:
        return tuple(range(0, length, span.step))
    return tuple(o for o in (0, *accumulate(span.exposures[:-1])) if o < length)


def exposures_in(span: Span, length: int) -> tuple[int, ...]:
    """Return how long each drawing of the span is held, the keyframe's own first; they add up to `length`."""
    return tuple(end - start for start, end in pairwise((*drawn_offsets(span, length), length)))


def drawn_ratio(span: Span, length: int, offset: float) -> float:
    """Return the linear time of the drawing that is shown `offset` frames after the keyframe before.

    On ones that is the offset's own, between frames too; else that of the frame at which the drawing began.
    """
    if span.step == 1 and not span.exposures and not span.hold:
        return offset / length
    starts = drawn_offsets(span, length)
    return starts[bisect_right(starts, offset) - 1] / length


def exposures_of(layer: Layer, first: int, last: int) -> tuple[Exposure, ...]:
    """Return every drawing that a layer shows from frame `first` to `last`, in order.

    The last keyframe's drawing is held to the end. A drawing that began before `first` is given from `first` on.
    """
    found = []
    for k, following in zip_longest(layer.keyframes, layer.keyframes[1:]):
        end = following.frame if following else max(last + 1, k.frame + 1)
        offsets = drawn_offsets(k.span, end - k.frame) if following else (0,)
        for start, stop in pairwise((*(k.frame + o for o in offsets), end)):
            if stop > first and start <= last:
                shown = max(start, first)
                found.append(Exposure(shown, min(stop, last + 1) - shown, start == k.frame))
    return tuple(found)


def fitted_exposures(span: Span, length: int, new: int) -> tuple[int, ...]:
    """Return the exposures of a chart for `length` frames spread over `new` frames, as evenly as may be.

    Every drawing keeps at least one frame; where there are not enough of them, the last drawings fall away. A span
    without a chart of its own keeps none: its `step` fits every length.
    """
    if not span.exposures:
        return ()
    held = exposures_in(span, length)[:new]
    starts = [0, *accumulate(held)]
    total = starts[-1]
    ends = [round(s * new / total) for s in starts]
    for i in range(1, len(ends)):
        ends[i] = max(ends[i], ends[i - 1] + 1)
    for i in range(len(ends) - 2, 0, -1):  # room for one frame each, from the back
        ends[i] = min(ends[i], new - (len(ends) - 1 - i))
    ends[-1] = new
    return tuple(b - a for a, b in pairwise(ends))
