"""From two keyframes to their in-betweens: matched once, planned once, evaluated often; in time: see motion.py."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from core.correspondence.drawings import pair_outlines
from core.correspondence.matching import match
from core.correspondence.pairing import Correspondence
from core.geometry.outline import FloatArray, locate, points_at
from core.methods.plan import AlignedPair, turn_of
from core.model.color import mix_colors
from core.model.document import Span
from core.model.drawing import WIDEST_STROKE, Drawing, Outline, Style
from core.model.pins import PlannedOutline, planned_pins
from core.model.solving import Paths, solve_paths


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """What one layer shows at one frame.

    Attributes
    ----------
    outlines : tuple of ((n, 2) float array, bool)
        Vertices in stage px, and whether the outline is closed.
    style : Style
    opacity : float
        Of the whole picture, 0 to 1: the layer's times the drawing's.
    """

    outlines: tuple[tuple[FloatArray, bool], ...]
    style: Style
    opacity: float = 1.0


Rows = tuple[FloatArray, FloatArray]


@dataclass(frozen=True, slots=True, eq=False)
class PairMatch:
    """Two outlines by id and their correspondence.

    Attributes
    ----------
    before, after : int
    correspondence : Correspondence
    rows : Rows or None
        Positions of the vertices of the in-between on both outlines, worked out before; they stay good while
        vertices are dragged, and taking them again is quicker than walking along both outlines at every step.
    """

    before: int
    after: int
    correspondence: Correspondence
    rows: Rows | None = None


@dataclass(frozen=True, slots=True, eq=False)
class SpanMatch:
    """Every correspondence of a span; outlines named nowhere here have no partner."""

    pairs: tuple[PairMatch, ...]

    def of(self, before: int, after: int) -> Correspondence | None:
        """Return the correspondence of these two outlines, if they are a pair."""
        return next((p.correspondence for p in self.pairs if (p.before, p.after) == (before, after)), None)


@dataclass(frozen=True, slots=True, eq=False)
class Link:
    """One outline of the in-between, and where its vertices come from.

    Attributes
    ----------
    before, after : int or None
        Ids of the outlines; None where it grows out of a point or shrinks into one.
    before_positions, after_positions : (k,) float array
        Of every vertex, on the two outlines; empty on the side that is a point.
    aligned : AlignedPair
        The same vertices in stage px at both ends.
    """

    before: int | None
    after: int | None
    before_positions: FloatArray
    after_positions: FloatArray
    aligned: AlignedPair


@dataclass(frozen=True, slots=True, eq=False)
class SpanPlan:
    """Everything about a span that does not depend on t."""

    links: tuple[Link, ...]
    paths: Paths
    styles: tuple[Style, Style]

    @property
    def natural_turn(self) -> float:
        """The turn of the drawing as a whole without extra turns, radians; see `core.methods.plan.turn_of`."""
        return turn_of([link.aligned for link in self.links])

    def picture(self, t: float) -> Picture:
        """Return the in-between at the eased t (0 and 1 give the keyframes' shapes)."""
        frames = self.paths.plan.evaluate(np.array([t]))
        closed = (link.aligned.closed for link in self.links)
        outlines = tuple((f[0], c) for f, c in zip(frames, closed, strict=True))
        return Picture(outlines, mix_styles(*self.styles, t))

    def frames(self, t: Sequence[float]) -> tuple[FloatArray, ...]:
        """Return one (T, k, 2) array an outline for all t at once."""
        return self.paths.plan.evaluate(np.asarray(t, dtype=np.float64))


def mix_styles(before: Style, after: Style, t: float) -> Style:
    """Return the style of an in-between: colours mixed in OKLab, width and opacity linear, in range."""
    if before == after:
        return before
    width = (1 - t) * before.width + t * after.width
    opacity = (1 - t) * before.opacity + t * after.opacity
    return Style(
        mix_colors(before.fill, after.fill, t),
        mix_colors(before.stroke, after.stroke, t),
        min(max(width, 0.0), WIDEST_STROKE),
        min(max(opacity, 0.0), 1.0),
    )


def paired_outlines(before: Drawing, after: Drawing, span: Span) -> tuple[tuple[int, int], ...]:
    """Return the ids of outlines that belong together: those of the artist first, then the likeliest pairs."""
    fixed = tuple((p.before, p.after) for p in span.pairs if before.has(p.before) and after.has(p.after))
    left, right = before.outlines, after.outlines
    if len(left) == len(right) == 1 and left[0].closed == right[0].closed:
        return ((left[0].id, right[0].id),)
    row = {o.id: i for i, o in enumerate(left)}, {o.id: j for j, o in enumerate(right)}
    found = pair_outlines(
        [(o.points, o.closed) for o in left],
        [(o.points, o.closed) for o in right],
        [(row[0][i], row[1][j]) for i, j in fixed],
    )
    return tuple((left[i].id, right[j].id) for i, j in found.pairs)


def match_span(before: Drawing, after: Drawing, span: Span) -> SpanMatch:
    """Solve every correspondence of a span: the slow part of a plan."""
    pairs = []
    for i, j in paired_outlines(before, after, span):
        a, b = before.outline(i), after.outline(j)
        made = span.pair_of(i, j)
        kept = made.correspondence if made else None
        anchors = made.held if made else ()
        closed = a.closed and b.closed
        pairs.append(PairMatch(i, j, kept or match(a.points, b.points, anchors, closed=closed)))
    return SpanMatch(tuple(pairs))


def plan_span(
    before: Drawing,
    after: Drawing,
    span: Span,
    matched: SpanMatch | None = None,
    *,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> SpanPlan:
    """Return the plan of a span; linear and intrinsic at once, the others and a repair may take their time.

    Parameters
    ----------
    before, after : Drawing
    span : Span
    matched : SpanMatch, optional
        Correspondences solved before, also for drawings whose vertices have moved since; solved when omitted.
    progress, cancelled
        Of the repair; see `core.repair.plan.repair_drawing`.

    Raises
    ------
    CancelledError
        When `cancelled` says so.
    CorrespondenceError
        If `matched` is of outlines with other vertex counts, or the anchors cross.
    """
    matched = matched or match_span(before, after, span)
    links = [_paired(before.outline(p.before), after.outline(p.after), p) for p in matched.pairs]
    partnered_before = {p.before for p in matched.pairs}
    partnered_after = {p.after for p in matched.pairs}
    links += [_shrinking(o, after) for o in before.outlines if o.id not in partnered_before]
    links += [_growing(o, before) for o in after.outlines if o.id not in partnered_after]
    pairs = [link.aligned for link in links]
    pins = planned_pins(span.pins, [_for_pins(link, before) for link in links]) if span.pins else ()
    paths = solve_paths(
        pairs,
        span.method,
        span.turns,
        pins=pins,
        placement=span.placement,
        repair=span.repair,
        progress=progress,
        cancelled=cancelled,
    )
    return SpanPlan(tuple(links), paths, (before.style, after.style))


def _for_pins(link: Link, before: Drawing) -> PlannedOutline:
    count = len(before.outline(link.before).points) if link.before is not None else 0
    return PlannedOutline(link.before, link.before_positions, count, link.aligned.closed)


def _paired(a: Outline, b: Outline, pair: PairMatch) -> Link:
    p, q = pair.rows or pair.correspondence.aligned_positions(a.points, b.points)
    closed = pair.correspondence.closed
    aligned = AlignedPair(points_at(a.points, p, closed=closed), points_at(b.points, q, closed=closed), closed)
    return Link(a.id, b.id, p, q, aligned)


def _shrinking(outline: Outline, other: Drawing) -> Link:
    end = np.broadcast_to(_nearest_point(outline, other), outline.points.shape).copy()
    aligned = AlignedPair(outline.points, end, outline.closed)
    return Link(outline.id, None, np.arange(len(end), dtype=np.float64), np.zeros(0), aligned)


def _growing(outline: Outline, other: Drawing) -> Link:
    start = np.broadcast_to(_nearest_point(outline, other), outline.points.shape).copy()
    aligned = AlignedPair(start, outline.points, outline.closed)
    return Link(None, outline.id, np.zeros(0), np.arange(len(start), dtype=np.float64), aligned)


def _nearest_point(outline: Outline, other: Drawing) -> FloatArray:
    """Return the point of the other drawing nearest to the outline's middle; without a drawing, the middle."""
    middle: FloatArray = outline.points.mean(axis=0)
    best: FloatArray = middle
    least = np.inf
    for candidate in other.outlines:
        position, distance = locate(candidate.points, middle, closed=candidate.closed)
        if distance[0] < least:
            best = points_at(candidate.points, position, closed=candidate.closed)[0]
            least = float(distance[0])
    return best
