"""What a layer shows at every frame: plans put into time, smoothed through keyframes, led by other layers."""

import math
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, pairwise
from typing import Any, Protocol

import numpy as np

from core.geometry.outline import FloatArray
from core.model.document import Document, Keyframe, Layer
from core.model.drawing import Drawing, Style
from core.model.easing import Easing
from core.model.follow import STANDING, Carry, carried, fit_carry, led_back, turned
from core.model.inbetweens import Picture, SpanPlan, mix_styles, plan_span
from core.model.smooth import STEEPEST, Bend, agreed, along_outlines, end_velocities, missing
from core.model.timing import drawn_ratio

MOST_KEPT = 1024


class PlanSource(Protocol):
    """Where plans come from: solved at once, or the best that is there while a better one is being solved."""

    def plan(self, before: Keyframe, after: Keyframe, layer: int = 0) -> SpanPlan:
        """Return the plan of the span between two neighbouring keyframes of the layer with that id."""
        ...


@dataclass(frozen=True, eq=False)
class SpanMotion:
    """A span in time: what is shown at each of its frames.

    Attributes
    ----------
    before, after : Keyframe
        As the artist drew them.
    plan : SpanPlan
        Where a parent carries the layer: with the keyframe after in the parent's pose at the keyframe before.
    bend : Bend
        What smooth keyframes at the ends ask for.
    parent : LayerMotion or None
    """

    before: Keyframe
    after: Keyframe
    plan: SpanPlan
    bend: Bend
    parent: "LayerMotion | None" = None

    @property
    def length(self) -> int:
        """Frames from the keyframe before to the one after."""
        return self.after.frame - self.before.frame

    @cached_property
    def easing(self) -> Easing:
        """The span's easing, not too steep where a smooth keyframe asks for a velocity."""
        bend = self.bend
        return self.before.span.easing.gentle(STEEPEST, first=bend.first is not None, last=bend.last is not None)

    def ratios(self, frames: Sequence[float]) -> FloatArray:
        """Return the linear time, 0 to 1, of the drawing that is shown at frames of the film."""
        span, first = self.before.span, self.before.frame
        return np.array([drawn_ratio(span, self.length, f - first) for f in frames], dtype=np.float64)

    def times(self, frames: Sequence[float]) -> FloatArray:
        """Return the eased t of the drawing that is shown at frames of the film."""
        return self.easing.t_at(self.ratios(frames))

    def frames(self, frames: Sequence[float]) -> tuple[FloatArray, ...]:
        """Return the vertices at T frames of the film: one (T, k, 2) array an outline, stage px."""
        return self.at(self.ratios(frames))

    def at(self, ratios: FloatArray) -> tuple[FloatArray, ...]:
        """Return the vertices at T linear times, held or not: one (T, k, 2) array an outline, stage px."""
        found = self.plan.frames(self.easing.t_at(ratios).tolist())
        if not self.bend.is_empty:
            found = tuple(f + self.bend.offsets(ratios, i) for i, f in enumerate(found))
        if self.parent is None:
            return found
        carries = [self.parent.carry(self.before.frame, self.before.frame + r * self.length) for r in ratios]
        return tuple(np.stack([carried(x, c) for x, c in zip(f, carries, strict=True)]) for f in found)

    def picture(self, frame: float, opacity: float = 1.0) -> Picture:
        """Return what is shown at a frame of the film, in a layer of that opacity."""
        closed = (link.aligned.closed for link in self.plan.links)
        outlines = tuple((f[0], c) for f, c in zip(self.frames([frame]), closed, strict=True))
        return _picture(outlines, mix_styles(*self.plan.styles, float(self.times([frame])[0])), opacity)

    @cached_property
    def shown_plan(self) -> SpanPlan:
        """The plan with both ends of its links where the keyframes are, for showing the correspondence."""
        if self.parent is None:
            return self.plan
        carry = self.parent.carry(self.before.frame, self.after.frame)
        links = tuple(
            replace(x, aligned=replace(x.aligned, right=carried(x.aligned.right, carry))) for x in self.plan.links
        )
        return replace(self.plan, links=links)


@dataclass(frozen=True, slots=True, eq=False)
class LayerMotion:
    """A layer in time: how it carries those that follow it."""

    document: Document
    layer: Layer
    motions: "Motions"

    def carry(self, start: float, end: float) -> Carry:
        """Return how this layer's drawing turns and shifts from one frame to a later one.

        Span by span, each by the best fit of its own vertices; nothing moves in front of the first keyframe and
        behind the last. What this layer follows carries it, so that is in its vertices already; where it stands
        still itself it is carried as a whole.
        """
        total, done = STANDING, start
        for before, after in pairwise(self.layer.keyframes):
            low, high = max(start, before.frame), min(end, after.frame)
            if low < high:
                total = self._above(done, low).after(total)
                total = self._within(before, after, low, high).after(total)
                done = high
        return self._above(done, end).after(total)

    def _above(self, start: float, end: float) -> Carry:
        """Return the carry of this layer's own parent, outside its keyframes."""
        parent = self.motions.parent_of(self.document, self.layer)
        return parent.carry(start, end) if parent is not None and start < end else STANDING

    def _within(self, before: Keyframe, after: Keyframe, low: float, high: float) -> Carry:
        if before.span.hold and high < after.frame:
            return self._above(low, high)
        motion = self.motions.of(self.document, self.layer, before, after)
        whole = [i for i, x in enumerate(motion.plan.links) if x.before is not None and x.after is not None]
        if not whole:
            return self._above(low, high)
        return fit_carry(*(np.concatenate([self._vertices(motion, i, f) for i in whole]) for f in (low, high)))

    def _vertices(self, motion: SpanMotion, link: int, frame: float) -> FloatArray:
        """Return a link's vertices; on the keyframe after they are that one's, also behind a hold."""
        if frame == motion.after.frame:
            return motion.shown_plan.links[link].aligned.right
        if motion.before.span.hold:
            moved = self._above(motion.before.frame, frame)
            return carried(motion.plan.links[link].aligned.left, moved)
        vertices: FloatArray = motion.at(np.array([(frame - motion.before.frame) / motion.length]))[link][0]
        return vertices


class Motions:
    """Motions of spans by what they were made of, and pictures; the longest unused is forgotten first."""

    def __init__(self, plans: PlanSource, capacity: int = MOST_KEPT) -> None:
        self._plans, self._capacity = plans, capacity
        self._made: OrderedDict[object, tuple[tuple[object, ...], SpanMotion]] = OrderedDict()
        self._led: OrderedDict[object, tuple[tuple[object, ...], tuple[Keyframe, Keyframe]]] = OrderedDict()

    def parent_of(self, document: Document, layer: Layer) -> LayerMotion | None:
        """Return the motion of the layer that this one follows, if it follows one that moves."""
        parent = document.layer(layer.parent) if layer.parent is not None else None
        moves = parent is not None and (len(parent.keyframes) > 1 or parent.parent is not None)
        return LayerMotion(document, parent, self) if parent is not None and moves else None

    def of(self, document: Document, layer: Layer, before: Keyframe, after: Keyframe) -> SpanMotion:
        """Return the motion of a span of a layer."""
        parent = self.parent_of(document, layer)
        i = layer.frames().index(before.frame)
        here = self._planned(layer, parent, i)
        left = self._planned(layer, parent, i - 1) if here.joins[0] else None
        right = self._planned(layer, parent, i + 1) if here.joins[1] else None
        spans = tuple((x.before, x.after, x.plan) if x else (None, None, None) for x in (here, left, right))
        parts = (*chain.from_iterable(spans), *_ancestors(document, layer))
        key = (here.carry, *map(id, parts))
        found = self._made.get(key)
        if found is None:
            motion = SpanMotion(before, after, here.plan, _bend(here, left, right), parent)
            found = self._made[key] = (parts, motion)  # the parts too: nothing else can take their ids
        _touch(self._made, key, self._capacity)
        return found[1]

    def picture(self, document: Document, layer: Layer, frame: float) -> Picture | None:
        """Return what a layer shows: nothing before its first keyframe, the last drawing after its last."""
        keyframe = layer.keyframe_at(int(frame)) if frame == int(frame) else None
        if keyframe is not None:
            return drawing_picture(keyframe.drawing, layer.opacity)
        before, after = layer.around(frame)
        if before is None:
            return None
        if after is None or before.span.hold:
            return self._held_picture(document, layer, before, frame)
        return self.of(document, layer, before, after).picture(frame, layer.opacity)

    def pictures(self, document: Document, frame: float) -> tuple[Picture, ...]:
        """Return the pictures of all visible layers, from the back to the front."""
        found = (self.picture(document, layer, frame) for layer in document.layers if layer.visible)
        return tuple(p for p in found if p is not None)

    def _held_picture(self, document: Document, layer: Layer, keyframe: Keyframe, frame: float) -> Picture:
        parent = self.parent_of(document, layer)
        if parent is None:
            return drawing_picture(keyframe.drawing, layer.opacity)
        carry = parent.carry(keyframe.frame, frame)
        outlines = tuple((carried(o.points, carry), o.closed) for o in keyframe.drawing.outlines)
        return _picture(outlines, keyframe.drawing.style, layer.opacity)

    def _planned(self, layer: Layer, parent: LayerMotion | None, i: int) -> "_Planned":
        """Return the span that begins at the keyframe number `i` of a layer."""
        before, after = layer.keyframes[i : i + 2]
        joins = _joins(layer, i)
        if parent is None:
            return _Planned(before, after, self._plans.plan(before, after, layer.id), STANDING, joins)
        carry = parent.carry(before.frame, after.frame)
        plan = self._plans.plan(*self._led_keyframes(before, after, carry), layer.id)
        return _Planned(before, after, plan, carry, joins)

    def _led_keyframes(self, before: Keyframe, after: Keyframe, carry: Carry) -> tuple[Keyframe, Keyframe]:
        """Return `led_back`, the same objects as long as nothing changes, so that their plan is found again."""
        key = id(before), id(after), carry
        found = self._led.get(key)
        if found is None:
            found = self._led[key] = ((before, after), led_back(before, after, carry))
        _touch(self._led, key, self._capacity)
        return found[1]


@dataclass(frozen=True, slots=True, eq=False)
class _Planned:
    """A span, its plan, how its parent carries it from start to end, and whether neighbours are joined to it."""

    before: Keyframe
    after: Keyframe
    plan: SpanPlan
    carry: Carry
    joins: tuple[bool, bool]

    @property
    def length(self) -> int:
        return self.after.frame - self.before.frame

    @property
    def stiff(self) -> bool:
        """Whether the span must not be bent: pins would leave their arcs, repaired vertices might cross."""
        return bool(self.before.span.pins) or self.before.span.repair

    def velocities(self, *, last: bool) -> tuple[FloatArray, ...]:
        """Return the links' velocities at one end, px a frame, as they are seen on the stage."""
        easing = self.before.span.easing
        if not self.stiff:
            easing = easing.gentle(STEEPEST, first=self.joins[0], last=self.joins[1])
        slope = easing.slopes()[last]
        if math.isinf(slope):  # of a span that is not bent: nothing can follow that
            slope = math.copysign(STEEPEST, slope)
        found = end_velocities(self.plan, slope, self.length, last=last)
        return tuple(turned(v, self.carry) for v in found) if last else found


def _bend(here: _Planned, left: _Planned | None, right: _Planned | None) -> Bend:
    if here.stiff:
        return Bend()
    first = _joined(left, here, own_is_last=False) if left is not None else None
    last = _joined(here, right, own_is_last=True) if right is not None else None
    return Bend(first, last)


def _joined(left: _Planned, right: _Planned, *, own_is_last: bool) -> tuple[FloatArray, ...]:
    """Return what the span that ends (or begins) at the keyframe between two spans lacks there, in px a span."""
    drawing: Drawing = right.before.drawing
    ends = left.velocities(last=True), right.velocities(last=False)
    ways = (
        along_outlines(left.plan.links, ends[0], drawing, last=True),
        along_outlines(right.plan.links, ends[1], drawing, last=False),
    )
    own, found = (left, ends[0]) if own_is_last else (right, ends[1])
    other_is_stiff = right.stiff if own_is_last else left.stiff
    wanted = ways[own_is_last] if other_is_stiff else agreed(*ways)
    lacking = missing(own.plan.links, found, wanted, drawing, own.length, last=own_is_last)
    return tuple(turned(v, own.carry.back()) for v in lacking) if own_is_last else lacking


def _joins(layer: Layer, i: int) -> tuple[bool, bool]:
    """Whether smooth keyframes join a span to the one before and the one after; a hold joins nothing."""
    keys = layer.keyframes

    def runs(j: int) -> bool:
        return 0 <= j < len(keys) - 1 and not keys[j].span.hold

    return keys[i].smooth and runs(i - 1), keys[i + 1].smooth and runs(i + 1)


def drawing_picture(drawing: Drawing, opacity: float = 1.0) -> Picture:
    """Return the picture of a drawing itself, in a layer of that opacity."""
    return _picture(tuple((o.points, o.closed) for o in drawing.outlines), drawing.style, opacity)


def _picture(outlines: tuple[tuple[FloatArray, bool], ...], style: Style, opacity: float) -> Picture:
    return Picture(outlines, style, opacity * style.opacity)


def _ancestors(document: Document, layer: Layer) -> list[Layer]:
    found = []
    while layer.parent is not None:
        layer = document.layer(layer.parent)
        found.append(layer)
    return found


def _touch(kept: OrderedDict[Any, Any], key: object, capacity: int) -> None:
    kept.move_to_end(key)
    while len(kept) > capacity:
        kept.popitem(last=False)


class PlanCache:
    """Plans by what they were made of, solved when they are first asked for, and the motions that follow.

    Documents share their parts, so an edit leaves the drawings of all other spans the very same objects, and
    their plans are found here again, the longest unused forgotten first. `solved` counts how many were made.
    """

    def __init__(self, capacity: int = 512) -> None:
        self.capacity = capacity
        self.solved = 0
        self.motions = Motions(self)
        self._plans: OrderedDict[tuple[object, ...], tuple[Keyframe, Keyframe, SpanPlan]] = OrderedDict()

    def plan(self, before: Keyframe, after: Keyframe, layer: int = 0) -> SpanPlan:
        """Return the plan of the span between two neighbouring keyframes; it is the same in every layer."""
        span = before.span
        kept = span.method, span.turns, span.repair, span.placement, span.pins
        key = id(before.drawing), id(after.drawing), *map(id, span.pairs), kept
        found = self._plans.get(key)
        if found is None:
            self.solved += 1
            plan = plan_span(before.drawing, after.drawing, span)
            # the keyframes are kept too, so that no other object can take the ids of their parts
            found = self._plans[key] = (before, after, plan)
        _touch(self._plans, key, self.capacity)
        return found[2]


class HasMotions(Protocol):
    """Whoever plans for a document."""

    @property
    def motions(self) -> Motions:
        """The motions made of those plans."""
        ...


def picture_at(document: Document, layer: Layer, frame: float, plans: HasMotions) -> Picture | None:
    """Return what a layer shows at a frame; see `Motions.picture`."""
    return plans.motions.picture(document, layer, frame)


def pictures_at(document: Document, frame: float, plans: HasMotions) -> tuple[Picture, ...]:
    """Return what all visible layers show at a frame; see `Motions.pictures`."""
    return plans.motions.pictures(document, frame)
