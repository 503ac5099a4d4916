"""Version 1 of the project file, frozen: what is written here must never change, or old files open no more."""

from typing import Annotated, Literal

import msgspec

Number = float
Point = tuple[Number, Number]
Word = Annotated[str, msgspec.Meta(max_length=100)]
Id = Annotated[int, msgspec.Meta(ge=1, le=2**31 - 1)]
Count = Annotated[int, msgspec.Meta(ge=2, le=2**31 - 1)]


class Struct(msgspec.Struct, forbid_unknown_fields=True):
    """A part of the file: unknown fields are errors."""


class Correspondence1(Struct):
    """A whole pairing of two outlines, kept as it is."""

    before: msgspec.Raw
    after: msgspec.Raw
    counts: tuple[Count, Count]
    closed: bool
    flipped: bool


class Pair1(Struct, omit_defaults=True):
    """Two outlines of a span that belong together."""

    before: Id
    after: Id
    anchors: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET
    muted: msgspec.Raw | msgspec.UnsetType = msgspec.UNSET
    correspondence: Correspondence1 | None = None
    chosen: bool = False


class Pin1(Struct, omit_defaults=True):
    """A point whose way is drawn: on an outline, or inside."""

    outline: Id | None = None
    position: Number | None = None
    place: Point | None = None
    handles: tuple[Point, Point] | None = None


class Span1(Struct, omit_defaults=True):
    """The way from a keyframe to the next one."""

    method: Word
    easing: tuple[Number, Number, Number, Number]
    turns: int
    pairs: list[Pair1]
    repair: bool = False
    pins: list[Pin1] = []


class Outline1(Struct):
    """One closed polygon or open polyline."""

    id: Id
    closed: bool
    points: msgspec.Raw


class Style1(Struct):
    """How a drawing is painted."""

    fill: Word | None
    stroke: Word | None
    width: Number


class Drawing1(Struct):
    """The outlines of one keyframe."""

    style: Style1
    outlines: list[Outline1]


class Reference1(Struct):
    """A picture laid under the stage."""

    path: Annotated[str, msgspec.Meta(min_length=1, max_length=4096)]
    opacity: Number


class Keyframe1(Struct, omit_defaults=True):
    """A drawing made by the artist at a frame."""

    frame: int
    drawing: Drawing1
    span: Span1
    reference: Reference1 | None = None


class Layer1(Struct):
    """Keyframes in order of frame."""

    id: Id
    name: Annotated[str, msgspec.Meta(max_length=1000)]
    visible: bool
    keyframes: list[Keyframe1]


class Stage1(Struct):
    """The paper."""

    width: int
    height: int
    background: Word | None


class Project1(Struct):
    """One document."""

    format: Literal["inkbetween"]
    version: Literal[1]
    stage: Stage1
    rate: tuple[int, int]
    length: int
    layers: list[Layer1]
