"""The document: layers of keyframes on a stage. Immutable; edits make a new one (see edits.py)."""

import itertools
import math
import re
from bisect import bisect_right
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import NamedTuple

from core.correspondence.pairing import Correspondence
from core.errors import DocumentError
from core.methods.placement import PLACEMENTS
from core.methods.plan import METHODS
from core.model.drawing import Color, Drawing, as_color, check_id
from core.model.easing import Easing
from core.model.pins import SpanPin

LARGEST_STAGE = 16_384
LONGEST = 100_000
FASTEST = 1000
MOST_TURNS = 100
MOST_PINS = 200
LONGEST_STEP = 1000
LONGEST_NAME = 1000
AUTO = "auto"
"""Not a method of its own: the better one of rigid and intrinsic."""

LONGEST_PATH = 4096
FINEST_RATE = 2**31 - 1
"""Largest upper or lower number of a frame rate."""

RATE_PATTERN = re.compile(r"\d{1,12}(\.\d{0,12})?|\.\d{1,12}|\d{1,12}\s*/\s*\d{1,12}", re.ASCII)


class Anchor(NamedTuple):
    """One pair of points fixed by the artist: positions on the outlines before and after.

    A muted one is kept without effect, so that one can see what it does.
    """

    before: float
    after: float
    muted: bool = False

    @property
    def places(self) -> tuple[float, float]:
        """The two positions."""
        return self.before, self.after


@dataclass(frozen=True, slots=True)
class Reference:
    """A picture laid under the stage while one draws; it is never exported.

    Attributes
    ----------
    path : str
        The picture file.
    opacity : float
        0 to 1.
    """

    path: str
    opacity: float = 0.5

    def __post_init__(self) -> None:
        if not self.path or len(self.path) > LONGEST_PATH:
            raise DocumentError(f"a path of {len(self.path)} characters; it must have 1 to {LONGEST_PATH}")
        if not 0 <= self.opacity <= 1:
            raise DocumentError(f"the opacity of a reference picture is {self.opacity}; it must be 0 to 1")


@dataclass(frozen=True, slots=True)
class OutlinePair:
    """Two outlines of a span that belong together, by the artist's hand.

    Attributes
    ----------
    before, after : int
        Ids of the outlines in the keyframe before and the keyframe after.
    anchors : tuple of Anchor
        In the order they were made.
    correspondence : Correspondence or None
        A correspondence that is kept as it is; None: solved when needed.
    chosen : bool
        The artist chose the correspondence: it stays while vertices move. Otherwise it is an answer that was
        solved and stored, and is given up as soon as it may be another.
    """

    before: int
    after: int
    anchors: tuple[Anchor, ...] = ()
    correspondence: Correspondence | None = None
    chosen: bool = False

    @property
    def held(self) -> tuple[tuple[float, float], ...]:
        """The places of the anchors that are in effect."""
        return tuple(x.places for x in self.anchors if not x.muted)

    def __post_init__(self) -> None:
        for anchor in self.anchors:
            if not (math.isfinite(anchor.before) and math.isfinite(anchor.after)):
                raise DocumentError(f"an anchor of outlines {self.before} and {self.after} is not a finite number")


@dataclass(frozen=True, slots=True)
class Span:
    """How one keyframe becomes the next.

    Attributes
    ----------
    method : str
        How vertices travel; one of `core.METHODS`, or "auto": the better one of rigid and intrinsic.
    easing : Easing
    turns : int
        Extra whole turns, clockwise on the stage when positive.
    repair : bool
        Whether crossings of the in-betweens are bent away.
    pairs : tuple of OutlinePair
        Only what the artist fixed; the other outlines are paired automatically. Pairs whose outlines are gone
        are ignored.
    pins : tuple of SpanPin
        Points whose way the artist has drawn, in the order they were made.
    placement : str
        One of PLACEMENTS; without effect where pins decide.
    hold : bool
        There are no in-betweens: the drawing before stays until the keyframe after.
    step : int
        Frames that each drawing is held: 1 is on ones, 2 on twos.
    exposures : tuple of int
        A timing chart of its own: the frames that each drawing is held, the keyframe's first; empty: by `step`.
        In a span of another length the last one is held longer, or what is too much falls away.
    """

    method: str = AUTO
    easing: Easing = field(default_factory=Easing)
    turns: int = 0
    pairs: tuple[OutlinePair, ...] = ()
    repair: bool = False
    pins: tuple[SpanPin, ...] = ()
    placement: str = PLACEMENTS[0]
    hold: bool = False
    step: int = 1
    exposures: tuple[int, ...] = ()

    def __post_init__(self) -> None:
        if self.method not in (*METHODS, AUTO):
            raise DocumentError(f"unknown method {self.method!r}; known are {', '.join((*METHODS, AUTO))}")
        if abs(self.turns) > MOST_TURNS:
            raise DocumentError(f"{self.turns} extra turns; the limit is {MOST_TURNS}")
        if len(self.pins) > MOST_PINS:
            raise DocumentError(f"{len(self.pins)} pins in one span; the limit is {MOST_PINS}")
        if self.placement not in PLACEMENTS:
            raise DocumentError(f"unknown placement {self.placement!r}; known are {', '.join(PLACEMENTS)}")
        if not 1 <= self.step <= LONGEST_STEP:
            raise DocumentError(f"drawings held for {self.step} frames; it must be 1 to {LONGEST_STEP}")
        if not all(1 <= e <= LONGEST for e in self.exposures) or sum(self.exposures) > LONGEST:
            raise DocumentError(f"a timing chart's drawings are each held for 1 to {LONGEST} frames, together too")
        for side in ("before", "after"):
            ids = [getattr(p, side) for p in self.pairs]
            if len(set(ids)) < len(ids):
                raise DocumentError(f"an outline {side} is in two pairs of one span")

    def pair_of(self, before: int, after: int) -> OutlinePair | None:
        """Return the pair of these two outlines if the artist made one."""
        return next((p for p in self.pairs if (p.before, p.after) == (before, after)), None)


@dataclass(frozen=True, slots=True)
class Keyframe:
    """A drawing made by the artist at a frame, and the span that begins there.

    Attributes
    ----------
    frame : int
        From 1.
    drawing : Drawing
    span : Span
        To the next keyframe; without effect on the last one, yet kept, so that nothing is lost when keys move.
    reference : Reference or None
        Laid under the stage while this keyframe is drawn.
    smooth : bool
        The vertices go through this keyframe without a jump in their velocity; otherwise it is a sharp one.
    """

    frame: int
    drawing: Drawing = field(default_factory=Drawing)
    span: Span = field(default_factory=Span)
    reference: Reference | None = None
    smooth: bool = False

    def __post_init__(self) -> None:
        if not 1 <= self.frame <= LONGEST:
            raise DocumentError(f"a keyframe at frame {self.frame}; frames run from 1 to {LONGEST}")


@dataclass(frozen=True, slots=True)
class Layer:
    """Keyframes in order of frame.

    Attributes
    ----------
    id : int
        Unique in the document.
    name : str
    visible : bool
    keyframes : tuple of Keyframe
        Frames strictly rising.
    locked : bool
        Seen, but not changed on the canvas and the timeline.
    opacity : float
        0 to 1, times that of each drawing.
    color : Color or None
        Marks the layer in the window; it is never exported. None: one by the layer's id.
    parent : int or None
        Id of the layer whose motion this one follows.
    """

    id: int
    name: str = "Layer 1"
    visible: bool = True
    keyframes: tuple[Keyframe, ...] = ()
    locked: bool = False
    opacity: float = 1.0
    color: Color | None = None
    parent: int | None = None

    def __post_init__(self) -> None:
        check_id(self.id, name="a layer")
        if not 0 <= self.opacity <= 1:
            raise DocumentError(f"the opacity of layer {self.name!r} is {self.opacity}; it must be 0 to 1")
        if self.color is not None:
            object.__setattr__(self, "color", as_color(self.color, name="the layer's colour"))
        if len(self.name) > LONGEST_NAME:
            raise DocumentError(f"the layer's name has {len(self.name)} characters; the limit is {LONGEST_NAME}")
        if any(0xD800 <= ord(c) <= 0xDFFF for c in self.name):
            raise DocumentError("the layer's name has half a character in it, which no file can hold")
        frames = self.frames()
        for earlier, later in itertools.pairwise(frames):
            if later <= earlier:
                raise DocumentError(f"layer {self.name!r} has a keyframe at {later} after one at {earlier}")

    def frames(self) -> tuple[int, ...]:
        """Return the frames of the keyframes."""
        return tuple(k.frame for k in self.keyframes)

    def keyframe_at(self, frame: int) -> Keyframe | None:
        """Return the keyframe at exactly that frame."""
        return next((k for k in self.keyframes if k.frame == frame), None)

    def around(self, frame: float) -> tuple[Keyframe | None, Keyframe | None]:
        """Return the keyframes of the span that `frame` lies in.

        On a keyframe the span that begins there, but on the last one the span that ends there. Outside the
        keyframes only the nearest one is given: (last, None) behind them, (None, first) in front.
        """
        k = self.keyframes
        if not k:
            return None, None
        i = bisect_right(self.frames(), frame)
        if i == len(k) and frame == k[-1].frame and len(k) > 1:
            i -= 1
        return (k[i - 1] if i else None), (k[i] if i < len(k) else None)


@dataclass(frozen=True, slots=True)
class Stage:
    """The paper: its size in px and its colour (None: transparent)."""

    width: int = 1920
    height: int = 1080
    background: Color | None = None

    def __post_init__(self) -> None:
        for name, value in (("wide", self.width), ("high", self.height)):
            if not 1 <= value <= LARGEST_STAGE:
                raise DocumentError(f"the stage is {value} px {name}; it must be 1 to {LARGEST_STAGE}")
        if self.background is not None:
            object.__setattr__(self, "background", as_color(self.background, name="background"))


@dataclass(frozen=True, slots=True)
class Document:
    """Everything that is saved.

    Attributes
    ----------
    stage : Stage
    rate : Fraction
        Frames a second, above 0, at most 1000.
    length : int
        Number of frames; the film runs from frame 1 to `length`. Keyframes behind it are kept and not shown.
    layers : tuple of Layer
        From the back to the front; ids differ.
    """

    stage: Stage = field(default_factory=Stage)
    rate: Fraction = Fraction(24)
    length: int = 24
    layers: tuple[Layer, ...] = (Layer(1),)

    def __post_init__(self) -> None:
        if not 0 < self.rate <= FASTEST:
            raise DocumentError(f"the frame rate is {self.rate}; it must be above 0 and at most {FASTEST}")
        if max(self.rate.numerator, self.rate.denominator) > FINEST_RATE:
            raise DocumentError(f"the frame rate is {self.rate}; its two numbers must be at most {FINEST_RATE}")
        if not 1 <= self.length <= LONGEST:
            raise DocumentError(f"the film has {self.length} frames; it must have 1 to {LONGEST}")
        if not self.layers:
            raise DocumentError("the document has no layer; it needs at least one")
        ids = [layer.id for layer in self.layers]
        if len(set(ids)) < len(ids):
            raise DocumentError("two layers have the same id")
        self._check_parents()

    def _check_parents(self) -> None:
        parents = {layer.id: layer.parent for layer in self.layers}
        for layer in self.layers:
            seen, above = {layer.id}, layer.parent
            while above is not None:
                if above not in parents:
                    raise DocumentError(f"layer {layer.name!r} follows layer {above}, which is not there")
                if above in seen:
                    raise DocumentError(f"layer {layer.name!r} cannot follow a layer that follows it")
                seen.add(above)
                above = parents[above]

    def layer(self, layer_id: int) -> Layer:
        """Return the layer with that id, or raise DocumentError."""
        for layer in self.layers:
            if layer.id == layer_id:
                return layer
        raise DocumentError(f"the document has no layer {layer_id}")

    def with_layer(self, layer: Layer) -> "Document":
        """Return a document with `layer` in place of the one with its id; the same one if nothing changed."""
        if self.layer(layer.id) is layer:
            return self
        return replace(self, layers=tuple(layer if x.id == layer.id else x for x in self.layers))


def as_rate(text: str) -> Fraction:
    """Return a frame rate from "24", "23.976" or "24000/1001"; raises DocumentError with one sentence."""
    wrong = f"{text[:40]!r} is no frame rate; write 24, 29.97 or 30000/1001"
    if not RATE_PATTERN.fullmatch(text.strip()):  # an exponent could ask for a number that fills the memory
        raise DocumentError(wrong)
    try:
        rate = Fraction("".join(text.split())).limit_denominator(100_000)
    except ZeroDivisionError:
        raise DocumentError(wrong) from None
    if not 0 < rate <= FASTEST:
        raise DocumentError(f"the frame rate is {text.strip()}; it must be above 0 and at most {FASTEST}")
    return rate
