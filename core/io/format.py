"""The project file as it is now: one struct an object, and the limits of reading.

What each field means is in docs/file-format.md, and docs/file-format.schema.json is made from these. Long lists of
numbers stay raw JSON until they are wanted: as Python objects they would take twenty times the memory of the file.
"""

from typing import Annotated, Any, Final, Literal

import msgspec

from core.methods.placement import PLACEMENTS
from core.model.document import LONGEST_NAME, LONGEST_PATH
from core.model.drawing import LARGEST_ID

FORMAT: Final = "inkbetween"
VERSION: Final = 2
SUFFIX: Final = ".inkb"

LARGEST_FILE: Final = 128 * 1024 * 1024
MOST_OBJECTS: Final = 500_000
"""JSON objects in a file; each becomes one of Python's."""

MOST_VERTICES: Final = 2_000_000
MOST_OUTLINES: Final = 50_000
MOST_KEYFRAMES: Final = 50_000
MOST_LAYERS: Final = 1000
MOST_ANCHORS: Final = 100_000
MOST_KNOTS: Final = 100_000
MOST_EXPOSURES: Final = 1_000_000
LIMITS: Final = {
    "vertices": MOST_VERTICES,
    "outlines": MOST_OUTLINES,
    "keyframes": MOST_KEYFRAMES,
    "layers": MOST_LAYERS,
    "anchors": MOST_ANCHORS,
    "knots": MOST_KNOTS,
    "exposures": MOST_EXPOSURES,
    "positions": MOST_VERTICES,
}
"""Of a whole document, by what is counted; `positions` are those of correspondences, each pair once."""

OPAQUE: Final = 1.0
"""Left out of the file, which the writer does by identity."""

Number = float
Point = tuple[Number, Number]
KnotFile = tuple[Number, Number, Number, Number, Number, Number]
Word = Annotated[str, msgspec.Meta(max_length=100)]
Id = Annotated[int, msgspec.Meta(ge=1, le=LARGEST_ID)]
Count = Annotated[int, msgspec.Meta(ge=2, le=LARGEST_ID)]

_POINT: dict[str, Any] = {
    "type": "array",
    "prefixItems": [{"type": "number"}, {"type": "number"}],
    "minItems": 2,
    "maxItems": 2,
}


def _listed(items: dict[str, Any], **more: int) -> msgspec.Meta:
    return msgspec.Meta(extra_json_schema={"type": "array", "items": items, **more})


Points = Annotated[msgspec.Raw, _listed(_POINT, minItems=2)]
Knots = Annotated[
    msgspec.Raw, _listed({"type": "array", "items": {"type": "number"}, "minItems": 6, "maxItems": 6})
]
Exposures = Annotated[msgspec.Raw, _listed({"type": "integer", "minimum": 1})]
Numbers = Annotated[msgspec.Raw, _listed({"type": "number"}, minItems=1)]
Anchors = Annotated[msgspec.Raw, _listed(_POINT)]
Indices = Annotated[msgspec.Raw, _listed({"type": "integer", "minimum": 0})]


class Struct(msgspec.Struct, forbid_unknown_fields=True):
    """A part of the file: unknown fields are errors."""


class CorrespondenceFile(Struct):
    """A whole pairing of two outlines, kept as it is."""

    before: Numbers
    after: Numbers
    counts: tuple[Count, Count]
    closed: bool
    flipped: bool


class PairFile(Struct, omit_defaults=True):
    """Two outlines of a span that belong together."""

    before: Id
    after: Id
    anchors: Anchors | msgspec.UnsetType = msgspec.UNSET
    muted: Indices | msgspec.UnsetType = msgspec.UNSET
    correspondence: CorrespondenceFile | None = None
    chosen: bool = False


class PinFile(Struct, omit_defaults=True):
    """A point whose way is drawn: on an outline, or inside."""

    outline: Id | None = None
    position: Number | None = None
    place: Point | None = None
    handles: tuple[Point, Point] | None = None


class SpanFile(Struct, omit_defaults=True):
    """The way from a keyframe to the next one."""

    method: Word
    easing: tuple[Number, Number, Number, Number]
    turns: int
    pairs: list[PairFile]
    repair: bool = False
    pins: list[PinFile] = []
    knots: Knots | msgspec.UnsetType = msgspec.UNSET
    placement: Word = PLACEMENTS[0]
    hold: bool = False
    step: int = 1
    exposures: Exposures | msgspec.UnsetType = msgspec.UNSET


class OutlineFile(Struct):
    """One closed polygon or open polyline."""

    id: Id
    closed: bool
    points: Points


class StyleFile(Struct, omit_defaults=True):
    """How a drawing is painted."""

    fill: Word | None
    stroke: Word | None
    width: Number
    opacity: Number = OPAQUE


class DrawingFile(Struct):
    """The outlines of one keyframe."""

    style: StyleFile
    outlines: list[OutlineFile]


class ReferenceFile(Struct):
    """A picture laid under the stage."""

    path: Annotated[str, msgspec.Meta(min_length=1, max_length=LONGEST_PATH)]
    opacity: Number


class KeyframeFile(Struct, omit_defaults=True):
    """A drawing made by the artist at a frame."""

    frame: int
    drawing: DrawingFile
    span: SpanFile
    reference: ReferenceFile | None = None
    smooth: bool = False


class LayerFile(Struct, omit_defaults=True):
    """Keyframes in order of frame."""

    id: Id
    name: Annotated[str, msgspec.Meta(max_length=LONGEST_NAME)]
    visible: bool
    keyframes: list[KeyframeFile]
    locked: bool = False
    opacity: Number = OPAQUE
    color: Word | None = None
    parent: Id | None = None


class StageFile(Struct):
    """The paper."""

    width: int
    height: int
    background: Word | None


class ProjectFile(Struct):
    """One document."""

    format: Literal["inkbetween"]
    version: Literal[2]
    stage: StageFile
    rate: tuple[int, int]
    length: int
    layers: list[LayerFile]


class Head(msgspec.Struct):
    """Just enough to tell a foreign file and a newer version from a broken one."""

    format: str = ""
    version: int = 0
