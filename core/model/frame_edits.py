"""Edits of several keyframes at once, in time: move, stretch, copy, paste; frames put in and taken out.

Functions from document to document, as in edits.py. A keyframe is named by its layer and its frame. A span keeps
what ties its two drawings together (pairs, anchors, pins) as long as it still leads from the one to the other.
"""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import zip_longest

from core.errors import DocumentError
from core.model.document import Document, Keyframe, Layer, Span
from core.model.edits import set_length, set_span
from core.model.parts import check_open, keyframe_of, with_keyframe, with_keyframes
from core.model.timing import fitted_exposures
from core.model.timing_edits import set_smooth

KeyRef = tuple[int, int]
"""A layer's id and the frame of one of its keyframes."""


@dataclass(frozen=True, slots=True)
class CopiedKeyframe:
    """A keyframe that was copied, and where it was in the block of those copied with it.

    Attributes
    ----------
    row : int
        0 for the layer farthest in front, 1 for the next one behind it, and so on.
    offset : int
        Frames after the first keyframe of the block.
    keyframe : Keyframe
        As it was, its frame too.
    length : int or None
        Of its span; None for the last keyframe of a layer.
    whole : bool
        The keyframe that followed it was copied too.
    """

    row: int
    offset: int
    keyframe: Keyframe
    length: int | None
    whole: bool


# moving


def move_keyframes(document: Document, keys: Iterable[KeyRef], delta: int) -> Document:
    """Move keyframes by a number of frames, also past others; a film that is too short grows.

    Raises
    ------
    DocumentError
        If one would come to lie before frame 1 or on a keyframe that stays, or a layer is locked.
    """
    keys = tuple(keys)
    return _moved(document, keys, {frame: frame + delta for _, frame in keys})


def stretch_keyframes(document: Document, keys: Iterable[KeyRef], first: int, last: int) -> Document:
    """Spread keyframes over the frames `first` to `last` in proportion, each frame another one.

    Keyframes of several layers that lie at one frame stay together.

    Raises
    ------
    DocumentError
        If they are not at two frames at least, if there are too few frames for them, or as in `move_keyframes`.
    """
    keys = tuple(keys)
    return _moved(document, keys, stretched(sorted({frame for _, frame in keys}), first, last))


def stretched(frames: list[int], first: int, last: int) -> dict[int, int]:
    """Return where each of the rising `frames` comes to lie when all are spread over `first` to `last`."""
    if len(frames) < 2:
        raise DocumentError("only keyframes at two or more frames can be stretched")
    if last - first < len(frames) - 1:
        raise DocumentError(
            f"{len(frames)} drawings do not fit into frames {first} to {last}; each needs one of its own"
        )
    scale = (last - first) / (frames[-1] - frames[0])
    places = [first + round((f - frames[0]) * scale) for f in frames]
    for i in range(1, len(places)):
        places[i] = max(places[i], places[i - 1] + 1)
    for i in range(len(places)):  # room for one frame each, from the end
        places[i] = min(places[i], last - (len(places) - 1 - i))
    return dict(zip(frames, places, strict=True))


def _moved(document: Document, keys: Iterable[KeyRef], places: Mapping[int, int]) -> Document:
    """Put keyframes where `places` says, frame to frame."""
    furthest = 0
    for layer_id, frames in _by_layer(keys).items():
        layer = document.layer(layer_id)
        check_open(layer)
        staying = set(layer.frames()) - frames
        for frame in sorted(frames):
            keyframe_of(layer, frame)
            if places[frame] in staying:
                raise DocumentError(f"frame {places[frame]} of {layer.name!r} already holds a keyframe")
            furthest = max(furthest, places[frame])
        document = _shifted(document, layer, {f: places[f] for f in frames})
    return set_length(document, max(document.length, furthest))


def _shifted(document: Document, layer: Layer, places: Mapping[int, int]) -> Document:
    """Give some keyframes of a layer another frame."""
    if all(a == b for a, b in places.items()):
        return document
    keyframes = [replace(k, frame=places[k.frame]) if k.frame in places else k for k in layer.keyframes]
    keyframes.sort(key=lambda k: k.frame)
    return with_keyframes(document, layer, keyframes, moved={b: a for a, b in places.items()})


def _by_layer(keys: Iterable[KeyRef]) -> dict[int, set[int]]:
    found: dict[int, set[int]] = defaultdict(set)
    for layer_id, frame in keys:
        found[layer_id].add(frame)
    return found


# frames put in and taken out


def insert_frames(document: Document, after: int, count: int = 1, layers: Iterable[int] | None = None) -> Document:
    """Let what is behind frame `after` come `count` frames later, in some layers or, without `layers`, in all.

    In all layers the film gets longer by as much; in some, only if their keyframes need it.
    """
    if count < 0:
        raise DocumentError(f"{count} frames cannot be put in")
    ids = _ids(document, layers)
    shown = [k.frame for i in ids for k in document.layer(i).keyframes if after < k.frame <= document.length]
    length = document.length + count if layers is None else max(shown, default=0) + count
    for layer_id in ids:
        layer = document.layer(layer_id)
        document = _shifted(document, layer, {f: f + count for f in layer.frames() if f > after})
    return set_length(document, max(document.length, length))


def remove_frames(document: Document, first: int, last: int, layers: Iterable[int] | None = None) -> Document:
    """Take the frames `first` to `last` out, with the keyframes on them, in some layers or in all.

    What is behind them comes so much earlier. In all layers the film gets shorter, but keeps one frame.
    """
    if last < first:
        raise DocumentError(f"there is no frame from {first} to {last}")
    count = last - first + 1
    for layer_id in _ids(document, layers):
        frames = document.layer(layer_id).frames()
        document = delete_keyframes(document, [(layer_id, f) for f in frames if first <= f <= last])
        document = _shifted(document, document.layer(layer_id), {f: f - count for f in frames if f > last})
    if layers is not None:
        return document
    taken = max(0, min(last, document.length) - first + 1)
    return set_length(document, max(1, document.length - taken))


def _ids(document: Document, layers: Iterable[int] | None) -> tuple[int, ...]:
    return tuple(x.id for x in document.layers) if layers is None else tuple(dict.fromkeys(layers))


# several keyframes at once


def delete_keyframes(document: Document, keys: Iterable[KeyRef]) -> Document:
    """Take keyframes away; the spans on both sides of each become one."""
    for layer_id, frames in _by_layer(keys).items():
        layer = document.layer(layer_id)
        for frame in frames:
            keyframe_of(layer, frame)
        document = with_keyframes(document, layer, [k for k in layer.keyframes if k.frame not in frames])
    return document


def hold_keyframes(document: Document, keys: Iterable[KeyRef], hold: bool) -> Document:
    """Let each keyframe stay until the next one, without in-betweens, or give that up."""
    for layer_id, frame in keys:
        document = set_span(document, layer_id, frame, hold=hold)
    return document


def smooth_keyframes(document: Document, keys: Iterable[KeyRef], smooth: bool) -> Document:
    """Let the motion go through keyframes without a jump in its velocity, or let them be sharp."""
    for layer_id, frames in _by_layer(keys).items():
        document = set_smooth(document, layer_id, sorted(frames), smooth)
    return document


# copying


def copy_keyframes(document: Document, keys: Iterable[KeyRef]) -> tuple[CopiedKeyframe, ...]:
    """Return keyframes to be pasted, with everything that belongs to them."""
    chosen = _by_layer(keys)
    if not chosen:
        raise DocumentError("no keyframe is selected that could be copied")
    start = min(min(frames) for frames in chosen.values())
    rows = [x for x in reversed(document.layers) if x.id in chosen]
    top = document.layers.index(rows[0])
    return tuple(
        copied
        for layer in rows
        for copied in _copies(layer, chosen[layer.id], top - document.layers.index(layer), start)
    )


def _copies(layer: Layer, frames: set[int], row: int, start: int) -> list[CopiedKeyframe]:
    made = []
    following = dict(zip(layer.frames(), layer.frames()[1:], strict=False))
    for frame in sorted(frames):
        after = following.get(frame)
        length = None if after is None else after - frame
        made.append(CopiedKeyframe(row, frame - start, keyframe_of(layer, frame), length, after in frames))
    return made


def paste_keyframes(
    document: Document, copied: Iterable[CopiedKeyframe], layer_id: int, frame: int
) -> tuple[Document, tuple[KeyRef, ...]]:
    """Put copied keyframes into the layer and those behind it, the first one at `frame`.

    A keyframe that is there already is replaced. Method, easing, chart, hold and smoothness come along; pairs,
    anchors, pins and extra turns only where the keyframe that followed does too and is the next one here as well.

    Returns
    -------
    Document
    tuple of KeyRef
        The keyframes that were pasted.

    Raises
    ------
    DocumentError
        If there are not enough layers behind that one, or a layer is locked.
    """
    copied = tuple(copied)
    index = document.layers.index(document.layer(layer_id))
    depth = max((c.row for c in copied), default=0)
    if depth > index:
        raise DocumentError(
            f"the copied keyframes are of {depth + 1} layers; from {document.layers[index].name!r} down "
            f"there are {index + 1}"
        )
    made = tuple((document.layers[index - c.row].id, frame + c.offset) for c in copied)
    for row in sorted({c.row for c in copied}):
        layer = document.layers[index - row]
        document = _pasted(document, layer, {frame + c.offset: c for c in copied if c.row == row})
    return set_length(document, max((document.length, *(f for _, f in made)))), made


def _pasted(document: Document, layer: Layer, places: Mapping[int, CopiedKeyframe]) -> Document:
    kept = {k.frame: k for k in layer.keyframes}
    loose = {f: replace(c.keyframe, frame=f, span=_loose(c)) for f, c in places.items()}
    frames = sorted(kept | loose)
    document = with_keyframes(document, layer, [loose.get(f) or kept[f] for f in frames])
    for f, following in zip_longest(frames, frames[1:]):
        copy = places.get(f)
        if copy is None:
            continue
        keyframe = keyframe_of(document.layer(layer.id), f)
        length = None if following is None else following - f
        together = copy.whole and following in places and length == copy.length
        span = copy.keyframe.span if together else _fitted(copy, length)
        document = with_keyframe(document, document.layer(layer.id), replace(keyframe, span=span))
    return document


def _fitted(copy: CopiedKeyframe, length: int | None) -> Span:
    span = _loose(copy)
    if copy.length is None or length is None:
        return span
    return replace(span, exposures=fitted_exposures(span, copy.length, length))


def _loose(copy: CopiedKeyframe) -> Span:
    return replace(copy.keyframe.span, pairs=(), pins=(), turns=0)


def duplicate_keyframes(document: Document, keys: Iterable[KeyRef]) -> tuple[Document, tuple[KeyRef, ...]]:
    """Put copies of keyframes behind the last of them, at the first frames where none is in the way.

    Returns
    -------
    Document
    tuple of KeyRef
        The copies.
    """
    keys = tuple(keys)
    copied = copy_keyframes(document, keys)
    first, last = min(f for _, f in keys), max(f for _, f in keys)
    taken = {(i, k.frame) for i in _by_layer(keys) for k in document.layer(i).keyframes}
    shift = last - first + 1
    while any((i, f + shift) in taken for i, f in keys):
        shift += 1
    front = next(x.id for x in reversed(document.layers) if x.id in _by_layer(keys))
    return paste_keyframes(document, copied, front, first + shift)
