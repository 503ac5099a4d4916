"""What is to be seen on the canvas now: worked out once a change, then only painted and searched."""

import time
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.canvas.papers import AFTER, BEFORE, FILM, Paper, papers_for
from app.canvas.skins import OnionSkin, OutlineShapes, onion_skins
from app.preview.spans import SpanPreview
from app.session import OutlineRef, Session
from app.view import ViewOptions
from core.geometry.outline import FloatArray
from core.model.document import Document, Keyframe, Layer
from core.model.drawing import Outline
from core.model.inbetweens import Picture, SpanPlan
from core.model.motion import SpanMotion, drawing_picture
from core.model.timing import drawn_offsets

OTHERS_SECONDS = 0.02
"""So long spans of other layers that nobody has seen are matched at once; those left wait for the worker."""

FILM_TIMES = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
"""As in the figures of the papers on shape blending."""


@dataclass(frozen=True, slots=True, eq=False)
class Content:
    """Everything the canvas paints and the tools search.

    Attributes
    ----------
    before, after : Keyframe or None
        Of the span under the playhead in the active layer.
    plan : SpanPlan or None
    motion : SpanMotion or None
        The span in time; like the plan, None in a hold.
    waiting : bool
        The plan stands in for one that is being solved.
    t : float or None
        Eased t at the playhead; None outside every span.
    picture : Picture or None
        What the active layer shows at the playhead.
    others : tuple of (Picture, bool)
        The other visible layers, and whether each lies in front of the active one.
    films : dict from Paper to tuple of OutlineShapes
    """

    document: Document
    options: ViewOptions
    papers: tuple[Paper, ...]
    frame: int
    before: Keyframe | None
    after: Keyframe | None
    plan: SpanPlan | None
    motion: SpanMotion | None
    waiting: bool
    t: float | None
    picture: Picture | None
    others: tuple[tuple[Picture, bool], ...]
    onion: tuple[OnionSkin, ...]
    films: dict[Paper, tuple[OutlineShapes, ...]]

    def editable(self, side: str) -> Keyframe | None:
        """Return the keyframe of a side."""
        return self.before if side == BEFORE else self.after

    @property
    def is_held(self) -> bool:
        """Whether the drawing of a keyframe stays at the playhead until the next keyframe."""
        before, after = self.before, self.after
        spanned = before is not None and after is not None and before.frame < self.frame < after.frame
        return spanned and before.span.hold

    @property
    def drawing_words(self) -> str:
        """Which frame's drawing is held at the playhead, where it is not the frame's own."""
        if self.before is None or self.after is None:
            return ""
        offset = self.frame - self.before.frame
        begun = max(
            o for o in drawn_offsets(self.before.span, self.after.frame - self.before.frame) if o <= offset
        )
        return "" if begun == offset else f", drawing of {self.before.frame + begun}"

    def outlines(self) -> Iterator[tuple[Paper, str, OutlineRef, Outline]]:
        """Yield every outline that can be edited, on every paper that shows it; the current keyframe's first."""
        sides = (BEFORE, AFTER)
        if self.after is not None and self.frame == self.after.frame:
            sides = (AFTER, BEFORE)
        for paper in self.papers:
            for side in sides:
                keyframe = self.editable(side)
                if keyframe is not None and side in paper.shows:
                    for outline in keyframe.drawing.outlines:
                        yield paper, side, (keyframe.frame, outline.id), outline


def build_content(session: Session, preview: SpanPreview, options: ViewOptions) -> Content:
    """Work out what is to be seen."""
    document, layer, frame = session.document, session.layer, session.frame
    before, after = session.span_keyframes()
    motion = None
    if before is not None and after is not None and not before.span.hold:
        motion = preview.motions.of(document, layer, before, after)
    key = layer.keyframe_at(frame)
    if key is not None:
        picture = drawing_picture(key.drawing, layer.opacity)
    else:
        picture = preview.motions.picture(document, layer, frame)
    papers = papers_for("overlaid" if options.final else options.arrangement, document.stage)
    return Content(
        document,
        options,
        papers,
        frame,
        before,
        after,
        motion.shown_plan if motion is not None else None,
        motion,
        motion is not None and before is not None and preview.waiting(before, layer.id),
        float(motion.times([frame])[0]) if motion is not None else None,
        picture if session.shows(layer) or not options.final else None,
        _others(session, preview),
        onion_skins(session, preview, options) if options.onion and not options.final else (),
        _films(papers, session, preview),
    )


def _others(session: Session, preview: SpanPreview) -> tuple[tuple[Picture, bool], ...]:
    """Return the other layers' pictures; a keyframe for a while where matching would stop the playhead."""
    found = []
    in_front = False
    until = time.perf_counter() + OTHERS_SECONDS
    for layer in session.document.layers:
        if layer.id == session.layer.id:
            in_front = True
        elif session.shows(layer):
            before, after = layer.around(session.frame)
            if time.perf_counter() > until and not _at_hand(layer, before, after, preview):
                picture = drawing_picture(before.drawing, layer.opacity) if before is not None else None
            else:
                picture = preview.motions.picture(session.document, layer, session.frame)
            if picture is not None:
                found.append((picture, in_front))
    return tuple(found)


def _at_hand(layer: Layer, before: Keyframe | None, after: Keyframe | None, preview: SpanPreview) -> bool:
    """Whether a layer's picture costs no matching; a layer that follows another is not hurried."""
    nothing_to_match = before is None or after is None or layer.parent is not None
    return nothing_to_match or before.span.hold or preview.at_hand(before, after, layer.id)


def _films(
    papers: tuple[Paper, ...], session: Session, preview: SpanPreview
) -> dict[Paper, tuple[OutlineShapes, ...]]:
    before, after = session.span_keyframes()
    if before is None or after is None:
        return {}
    films = {}
    for paper in papers:
        if FILM in paper.shows:
            plan = preview.plan(before, after, session.layer.id, paper.method)
            frames = plan.frames(FILM_TIMES)
            closed = [link.aligned.closed for link in plan.links]
            films[paper] = tuple(
                tuple((f[i], c) for f, c in zip(frames, closed, strict=True)) for i in range(len(FILM_TIMES))
            )
    return films


def box_around(points: FloatArray) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom of points."""
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])
