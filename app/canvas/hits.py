"""What lies under the pointer, found with numpy in view px."""

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF

from app.canvas.camera import Camera
from app.canvas.content import Content
from app.canvas.papers import AFTER, BEFORE, Paper
from app.session import AnchorRef, OutlineRef
from core.geometry.outline import FloatArray, contains, locate, points_at

VERTEX_REACH = 9.0
EDGE_REACH = 7.0
ANCHOR_REACH = 10.0


@dataclass(frozen=True, slots=True)
class OutlineHit:
    """A place on an outline.

    `position` counts edges; it is whole, and `vertex` set, where a vertex is meant. `distance` is in view px.
    """

    paper: Paper
    side: str
    ref: OutlineRef
    position: float
    vertex: int | None
    distance: float


@dataclass(frozen=True, slots=True)
class AnchorHit:
    """One end of an anchor."""

    paper: Paper
    side: str
    ref: AnchorRef


def outline_under(
    content: Content,
    camera: Camera,
    at: QPointF,
    *,
    vertices_first: bool = True,
    reach: float = EDGE_REACH,
    side: str | None = None,
    paper: Paper | None = None,
) -> OutlineHit | None:
    """Return the nearest vertex within reach, else the nearest edge, else None."""
    vertex: OutlineHit | None = None
    edge: OutlineHit | None = None
    for where, which, ref, outline in content.outlines():
        if (side is not None and which != side) or (paper is not None and where != paper):
            continue
        points = camera.to_view(outline.points, where.offset) - np.array([at.x(), at.y()])
        gaps = np.hypot(points[:, 0], points[:, 1])
        i = int(gaps.argmin())
        if gaps[i] <= VERTEX_REACH and (vertex is None or gaps[i] < vertex.distance - 0.5):
            vertex = OutlineHit(where, which, ref, float(i), i, float(gaps[i]))
        (position,), (gap,) = locate(points, (0.0, 0.0), closed=outline.closed)
        if gap <= reach and (edge is None or gap < edge.distance - 0.5):
            edge = OutlineHit(where, which, ref, float(position), None, float(gap))
    return vertex if vertex is not None and vertices_first else edge


def outline_around(
    content: Content, camera: Camera, at: QPointF, *, only: str | None = None
) -> tuple[Paper, str, OutlineRef] | None:
    """Return the closed outline that the pointer is inside of; the smallest one where several are."""
    best = None
    least = np.inf
    for paper, side, ref, outline in content.outlines():
        if not outline.closed or only not in (None, side):
            continue
        x, y = camera.to_stage(at, paper.offset)
        area = abs(float(np.ptp(outline.points[:, 0]) * np.ptp(outline.points[:, 1])))
        if area < least and contains(outline.points, (x, y))[0]:
            best, least = (paper, side, ref), area
    return best


def anchor_places(content: Content) -> list[tuple[AnchorRef, FloatArray, FloatArray]]:
    """Return every anchor of the span with its two ends in stage px."""
    before, after = content.before, content.after
    if before is None or after is None:
        return []
    found = []
    for pair in before.span.pairs:
        if not (before.drawing.has(pair.before) and after.drawing.has(pair.after)):
            continue
        a, b = before.drawing.outline(pair.before), after.drawing.outline(pair.after)
        for index, anchor in enumerate(pair.anchors):
            start = points_at(a.points, np.array([anchor.before]), closed=a.closed)[0]
            end = points_at(b.points, np.array([anchor.after]), closed=b.closed)[0]
            found.append((AnchorRef(before.frame, pair.before, pair.after, index), start, end))
    return found


def is_muted(content: Content, ref: AnchorRef) -> bool:
    """Whether an anchor is without effect."""
    pair = content.before.span.pair_of(ref.before, ref.after) if content.before else None
    return pair is not None and pair.anchors[ref.index].muted


def anchor_under(content: Content, camera: Camera, at: QPointF) -> AnchorHit | None:
    """Return the anchor's end under the pointer."""
    best, least = None, ANCHOR_REACH
    for ref, start, end in anchor_places(content):
        for paper in content.papers:
            for side, place in ((BEFORE, start), (AFTER, end)):
                if side in paper.shows:
                    x, y = camera.to_view(place, paper.offset)
                    gap = float(np.hypot(x - at.x(), y - at.y()))
                    if gap < least:
                        best, least = AnchorHit(paper, side, ref), gap
    return best
