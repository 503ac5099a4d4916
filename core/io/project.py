"""The project file, `.inkb`: UTF-8 JSON with a version, read strictly and written atomically.

What each field means is in docs/file-format.md. The structs here are the file; the classes of core.model are the
document. They are kept apart so that either can change without the other.
"""

import contextlib
import itertools
import os
import stat
import tempfile
from fractions import Fraction
from pathlib import Path
from typing import Annotated, Final, Literal

import msgspec
import numpy as np

from core.correspondence.pairing import Correspondence, ordered_anchors
from core.errors import FileFormatError, InkbetweenError, StorageError
from core.model.document import (
    LONGEST_NAME,
    LONGEST_PATH,
    PLACEMENTS,
    Anchor,
    Document,
    Keyframe,
    Layer,
    OutlinePair,
    Reference,
    Span,
    Stage,
)
from core.model.drawing import LARGEST_ID, Drawing, Outline, Style
from core.model.easing import Easing, Knot
from core.model.pins import SpanPin

FORMAT: Final = "inkbetween"
VERSION = 2
SUFFIX = ".inkb"
OPAQUE = 1.0
"""Left out of the file, which the writer does by identity."""

LARGEST_FILE = 512 * 1024 * 1024

Number = float
Point = tuple[Number, Number]
Id = Annotated[int, msgspec.Meta(ge=1, le=LARGEST_ID)]
Count = Annotated[int, msgspec.Meta(ge=2, le=LARGEST_ID)]


_Knot = tuple[Number, Number, Number, Number, Number, Number]


class _Struct(msgspec.Struct, forbid_unknown_fields=True):
    """A part of the file: unknown fields are errors."""


class _Correspondence(_Struct):
    before: Annotated[list[Number], msgspec.Meta(min_length=1)]
    after: Annotated[list[Number], msgspec.Meta(min_length=1)]
    counts: tuple[Count, Count]
    closed: bool
    flipped: bool


class _Pair(_Struct, omit_defaults=True):
    before: Id
    after: Id
    anchors: list[Point] = []
    muted: list[int] = []
    correspondence: _Correspondence | None = None
    chosen: bool = False


class _Pin(_Struct, omit_defaults=True):
    outline: Id | None = None
    position: Number | None = None
    place: Point | None = None
    handles: tuple[Point, Point] | None = None


class _Span(_Struct, omit_defaults=True):
    method: str
    easing: tuple[Number, Number, Number, Number]
    turns: int
    pairs: list[_Pair]
    repair: bool = False
    pins: list[_Pin] = []
    knots: list[_Knot] = []
    placement: str = PLACEMENTS[0]
    hold: bool = False
    step: int = 1
    exposures: list[int] = []


class _Outline(_Struct):
    id: Id
    closed: bool
    points: list[Point]


class _Style(_Struct, omit_defaults=True):
    fill: str | None
    stroke: str | None
    width: Number
    opacity: Number = OPAQUE


class _Drawing(_Struct):
    style: _Style
    outlines: list[_Outline]


class _Reference(_Struct):
    path: Annotated[str, msgspec.Meta(min_length=1, max_length=LONGEST_PATH)]
    opacity: Number


class _Keyframe(_Struct, omit_defaults=True):
    frame: int
    drawing: _Drawing
    span: _Span
    reference: _Reference | None = None
    smooth: bool = False


class _Layer(_Struct, omit_defaults=True):
    id: Id
    name: Annotated[str, msgspec.Meta(max_length=LONGEST_NAME)]
    visible: bool
    keyframes: list[_Keyframe]
    locked: bool = False
    opacity: Number = OPAQUE
    color: str | None = None
    parent: Id | None = None


class _Stage(_Struct):
    width: int
    height: int
    background: str | None


class _Project(_Struct):
    format: Literal["inkbetween"]
    version: int
    stage: _Stage
    rate: tuple[int, int]
    length: int
    layers: list[_Layer]


class _Head(msgspec.Struct):
    """Just enough to tell a foreign file and a newer version from a broken one."""

    format: str = ""
    version: int = 0


def load(path: str | os.PathLike[str]) -> Document:
    """Read a project file.

    Raises
    ------
    StorageError
        If the file cannot be read.
    FileFormatError
        If it is no project, is damaged, or was written by a newer version; the message names the place.
    """
    file = Path(path)
    try:
        status = file.stat()
        if not stat.S_ISREG(status.st_mode):
            raise StorageError(f"cannot read {file}: it is no file")  # a device might never end
        if status.st_size > LARGEST_FILE:
            raise FileFormatError(f"{file.name} is larger than {LARGEST_FILE // 2**20} MB: no project of ours")
        content = file.read_bytes()
    except OSError as e:
        raise StorageError(f"cannot read {file}: {_reason(e)}") from e
    try:
        return decode(content)
    except FileFormatError as e:
        raise FileFormatError(f"cannot open {file.name}: {e}") from None


def save(document: Document, path: str | os.PathLike[str]) -> None:
    """Write a project file: whole, or not at all.

    The bytes go to a temporary file in the same folder, are forced to the disk, and take the old file's place in
    one step; until then the old file is untouched.

    Raises
    ------
    StorageError
        If the folder cannot be written or the disk is full; the old file is as it was.
    """
    write_atomically(Path(path), encode(document))


def write_atomically(path: Path, content: bytes) -> None:
    """Put `content` into `path` in one step; raises StorageError and leaves the old file if it cannot."""
    temporary: Path | None = None
    try:
        target = path.resolve()  # a link stays a link, its target is replaced
        mode = target.stat().st_mode & 0o777 if target.exists() else 0o666 & ~_umask()
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name[:50]}.", suffix=".part")
        temporary = Path(name)
        with os.fdopen(handle, "wb") as file:
            file.write(content)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, mode)
        os.replace(temporary, target)
    except (OSError, RuntimeError) as e:  # RuntimeError: a loop of links, before Python 3.13
        raise StorageError(f"cannot write {path}: {_reason(e)}") from e
    finally:
        if temporary is not None:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
    _sync_folder(target.parent)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _sync_folder(folder: Path) -> None:
    """Make the renaming itself survive a power cut, where the system can; the file is whole either way."""
    if os.name != "posix":
        return
    with contextlib.suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def _reason(error: OSError | RuntimeError) -> str:
    return (getattr(error, "strerror", None) or str(error)).lower()


def encode(document: Document) -> bytes:
    """Return the bytes of the project file; the same document gives the same bytes."""
    return msgspec.json.encode(_to_file(document)) + b"\n"


def decode(content: bytes) -> Document:
    """Return the document in the bytes of a project file; raises FileFormatError that names the place."""
    try:
        head = msgspec.json.decode(content, type=_Head)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        raise FileFormatError("it is no Inkbetween project, or it is damaged") from None
    if head.format != FORMAT:
        raise FileFormatError("it is no Inkbetween project")
    if head.version > VERSION:
        raise FileFormatError(
            f"it was written by a newer Inkbetween (file version {head.version}, this one reads up to {VERSION}); "
            "update Inkbetween to open it"
        )
    if head.version < 1:
        raise FileFormatError(f"its version is {head.version}; the first one is 1")
    try:
        project = msgspec.json.decode(content, type=_Project)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as e:
        raise FileFormatError(str(e)) from None
    return _from_file(project)


def _to_file(document: Document) -> _Project:
    """Every number as a plain one: equal documents give equal bytes, and the writer knows no NumPy scalars."""
    stage = _Stage(int(document.stage.width), int(document.stage.height), document.stage.background)
    layers = [_layer_to_file(layer) for layer in document.layers]
    rate = (int(document.rate.numerator), int(document.rate.denominator))
    return _Project(FORMAT, VERSION, stage, rate, int(document.length), layers)


def _layer_to_file(layer: Layer) -> _Layer:
    return _Layer(
        int(layer.id),
        layer.name,
        bool(layer.visible),
        [_keyframe_to_file(k) for k in layer.keyframes],
        bool(layer.locked),
        _opacity(layer.opacity),
        layer.color,
        None if layer.parent is None else int(layer.parent),
    )


def _opacity(opacity: float) -> float:
    return OPAQUE if opacity == OPAQUE else float(opacity)


def _keyframe_to_file(keyframe: Keyframe) -> _Keyframe:
    drawing, style, span = keyframe.drawing, keyframe.drawing.style, keyframe.span
    outlines = [_Outline(int(o.id), bool(o.closed), o.points.tolist()) for o in drawing.outlines]
    easing = span.easing
    return _Keyframe(
        int(keyframe.frame),
        _Drawing(_Style(style.fill, style.stroke, float(style.width), _opacity(style.opacity)), outlines),
        _Span(
            span.method,
            (float(easing.x1), float(easing.y1), float(easing.x2), float(easing.y2)),
            int(span.turns),
            [_pair_to_file(p) for p in span.pairs],
            bool(span.repair),
            [_pin_to_file(p) for p in span.pins],
            [_knot_to_file(k) for k in easing.knots],
            span.placement,
            bool(span.hold),
            int(span.step),
            [int(e) for e in span.exposures],
        ),
        _Reference(keyframe.reference.path, float(keyframe.reference.opacity)) if keyframe.reference else None,
        bool(keyframe.smooth),
    )


def _knot_to_file(knot: Knot) -> _Knot:
    x, y, in_x, in_y, out_x, out_y = map(float, knot)
    return x, y, in_x, in_y, out_x, out_y


def _pair_to_file(pair: OutlinePair) -> _Pair:
    c = pair.correspondence
    kept = None
    if c is not None:
        counts = (int(c.counts[0]), int(c.counts[1]))
        kept = _Correspondence(c.before.tolist(), c.after.tolist(), counts, bool(c.closed), bool(c.flipped))
    anchors = [(float(x.before), float(x.after)) for x in pair.anchors]
    muted = [i for i, x in enumerate(pair.anchors) if x.muted]
    return _Pair(int(pair.before), int(pair.after), anchors, muted, kept, bool(pair.chosen))


def _pin_to_file(pin: SpanPin) -> _Pin:
    return _Pin(pin.outline, None if pin.outline is None else pin.position, pin.place, pin.handles)


def _from_file(project: _Project) -> Document:
    with _place("stage"):
        stage = Stage(project.stage.width, project.stage.height, project.stage.background)
    with _place("rate"):
        if project.rate[1] < 1:
            raise FileFormatError("the lower number must be 1 or more")
        rate = Fraction(*project.rate)
    layers = []
    for i, layer in enumerate(project.layers):
        keyframes = tuple(
            _keyframe_from_file(k, f"layers[{i}].keyframes[{j}]") for j, k in enumerate(layer.keyframes)
        )
        with _place(f"layers[{i}]"):
            layers.append(
                Layer(
                    layer.id,
                    layer.name,
                    layer.visible,
                    keyframes,
                    layer.locked,
                    layer.opacity,
                    layer.color,
                    layer.parent,
                )
            )
        _check_span(layers[-1], f"layers[{i}]")
    with _place(""):
        return Document(stage, rate, project.length, tuple(layers))


def _keyframe_from_file(keyframe: _Keyframe, where: str) -> Keyframe:
    outlines = []
    for i, o in enumerate(keyframe.drawing.outlines):
        with _place(f"{where}.drawing.outlines[{i}]"):
            points = np.array(o.points, dtype=np.float64).reshape(-1, 2)
            outlines.append(Outline(o.id, points, o.closed))
    with _place(f"{where}.drawing"):
        style = keyframe.drawing.style
        drawing = Drawing(tuple(outlines), Style(style.fill, style.stroke, style.width, style.opacity))
    pairs = [_pair_from_file(p, f"{where}.span.pairs[{i}]") for i, p in enumerate(keyframe.span.pairs)]
    pins = [_pin_from_file(p, f"{where}.span.pins[{i}]") for i, p in enumerate(keyframe.span.pins)]
    with _place(f"{where}.span"):
        s = keyframe.span
        easing = Easing(*s.easing, tuple(Knot(*k) for k in s.knots))
        timing = s.placement, s.hold, s.step, tuple(s.exposures)
        span = Span(s.method, easing, s.turns, tuple(pairs), s.repair, tuple(pins), *timing)
    with _place(f"{where}.reference"):
        kept = keyframe.reference
        reference = Reference(kept.path, kept.opacity) if kept else None
    with _place(where):
        return Keyframe(keyframe.frame, drawing, span, reference, keyframe.smooth)


def _pair_from_file(pair: _Pair, where: str) -> OutlinePair:
    c = pair.correspondence
    with _place(where):
        kept = None
        if c is not None:
            kept = Correspondence(np.array(c.before), np.array(c.after), c.counts, c.closed, c.flipped)
        if any(not 0 <= i < len(pair.anchors) for i in pair.muted):
            raise FileFormatError(f"there are {len(pair.anchors)} anchors; muted are {pair.muted}")
        anchors = tuple(Anchor(*p, i in pair.muted) for i, p in enumerate(pair.anchors))
        return OutlinePair(pair.before, pair.after, anchors, kept, pair.chosen)


def _pin_from_file(pin: _Pin, where: str) -> SpanPin:
    with _place(where):
        if (pin.outline is None) != (pin.position is None):
            raise FileFormatError("a pin on an outline has both `outline` and `position`, one inside neither")
        return SpanPin(pin.outline, pin.position or 0.0, pin.place, pin.handles)


def _check_span(layer: Layer, where: str) -> None:
    """Refuse pins and pairs that name no outline of the two keyframes, and anchors that cannot hold."""
    for j, (k, following) in enumerate(itertools.zip_longest(layer.keyframes, layer.keyframes[1:])):
        for i, pin in enumerate(k.span.pins):
            with _place(f"{where}.keyframes[{j}].span.pins[{i}]"):
                if following is None:
                    raise FileFormatError("a pin in the span of the last keyframe")
                pin.check_on(k.drawing)
        for i, pair in enumerate(k.span.pairs):
            with _place(f"{where}.keyframes[{j}].span.pairs[{i}]"):
                if following is None:
                    raise FileFormatError("a pair of outlines in the span of the last keyframe")
                a, b = k.drawing.outline(pair.before), following.drawing.outline(pair.after)
                counts = (len(a.points), len(b.points))
                if a.closed != b.closed:
                    raise FileFormatError("a closed outline is paired with an open one")
                ordered_anchors(pair.held, counts, closed=a.closed)
                c = pair.correspondence
                if c is not None and (c.counts, c.closed) != (counts, a.closed):
                    raise FileFormatError(f"a correspondence of {c.counts} vertices for outlines with {counts}")


class _place:
    """Put the place in the file in front of what is wrong there."""

    def __init__(self, where: str) -> None:
        self.where = where

    def __enter__(self) -> None:
        return None

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, InkbetweenError):
            path = f" - at `$.{self.where}`" if self.where else ""
            raise FileFormatError(f"{error}{path}") from None
