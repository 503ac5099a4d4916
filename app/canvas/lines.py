"""The lines of the correspondence: which are drawn, which one lies under the pointer, where it all begins."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from PySide6.QtCore import QPointF
from PySide6.QtGui import QPolygonF

from app.canvas.camera import Camera
from app.canvas.content import Content
from app.canvas.papers import AFTER, BEFORE, Paper
from core.correspondence.by_hand import directions
from core.geometry.outline import FloatArray, arc_lengths
from core.model.inbetweens import Link

HUE_PIECES = 28
MOST_LINES = 40
MOST_LOOKED_AT = 1000
LINE_REACH = 6.0


@dataclass(frozen=True, slots=True, eq=False)
class LineHit:
    """A line of the correspondence: the ids of its outlines and its places on them."""

    before: int
    after: int
    places: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class StartMark:
    """Where a correspondence begins on one of its outlines, and the direction it runs in; in stage px."""

    side: str
    place: FloatArray
    direction: FloatArray


def line_papers(content: Content) -> list[tuple[Paper, Paper]]:
    """Return from which paper to which the correspondence is drawn."""
    starts = [p for p in content.papers if BEFORE in p.shows]
    ends = [p for p in content.papers if AFTER in p.shows]
    return [(p, p) for p in starts if p in ends] or list(zip(starts, ends, strict=False))


def shown_rows(link: Link) -> npt.NDArray[np.intp]:
    """Return which rows of a link are drawn as lines."""
    return spread_rows(link.aligned.left, link.aligned.right, link.aligned.closed)


def spread_rows(left: FloatArray, right: FloatArray, closed: bool) -> FloatArray:
    """Return the indices of at most MOST_LINES rows, evenly spread along both outlines."""
    if len(left) <= MOST_LINES:
        return np.arange(len(left))
    step = -(-len(left) // MOST_LOOKED_AT)
    lengths = [arc_lengths(side[::step], closed=closed) for side in (left, right)]
    along = sum(s[: len(left[::step])] / max(float(s[-1]), 1e-12) for s in lengths)
    rows = np.searchsorted(along, np.linspace(0, float(along[-1]), MOST_LINES)).clip(0, len(along) - 1)
    return step * np.unique(rows)


def hue_pieces(link: Link) -> list[npt.NDArray[np.intp]]:
    """Cut the rows of a link into pieces of even length, each ending where the next one begins."""
    left, right, closed = link.aligned.left, link.aligned.right, link.aligned.closed
    lengths = [arc_lengths(side, closed=closed) for side in (left, right)]
    along = sum(s / max(float(s[-1]), 1e-12) for s in lengths) / 2
    rows = np.arange(len(along)) % len(left)  # of a closed outline the last row is the first one again
    cuts = np.searchsorted(along, np.arange(HUE_PIECES + 1) / HUE_PIECES).clip(0, len(along) - 1)
    return [rows[a : b + 1] for a, b in pairwise(cuts.tolist())]


def line_under(content: Content, camera: Camera, at: QPointF) -> LineHit | None:
    """Return the drawn line under the pointer, away from its ends."""
    best, least = None, LINE_REACH
    here = np.array([at.x(), at.y()])
    for link in content.plan.links if content.plan else ():
        if link.before is None or link.after is None:
            continue
        rows = shown_rows(link)
        for start, end in line_papers(content):
            p = camera.to_view(link.aligned.left[rows], start.offset)
            d = camera.to_view(link.aligned.right[rows], end.offset) - p
            along = ((here - p) * d).sum(axis=1) / np.maximum((d * d).sum(axis=1), 1e-9)
            gaps = np.hypot(*(here - p - along[:, None] * d).T)
            gaps[(along < 0) | (along > 1)] = np.inf
            i = int(gaps.argmin())
            if gaps[i] < least:
                row = int(rows[i])
                places = float(link.before_positions[row]), float(link.after_positions[row])
                best, least = LineHit(link.before, link.after, places), float(gaps[i])
    return best


def start_marks(content: Content) -> list[StartMark]:
    """Return where every correspondence of the span begins: at the first vertex before, and at its image."""
    if content.plan is None or content.before is None or content.after is None:
        return []
    marks = []
    for link in content.plan.links:
        if link.before is None or link.after is None:
            continue
        a = content.before.drawing.outline(link.before)
        b = content.after.drawing.outline(link.after)
        runs_back = _runs_back(link.after_positions, len(b.points))
        for side, outline, position, back in (
            (BEFORE, a, link.before_positions[:1], False),
            (AFTER, b, link.after_positions[:1], runs_back),
        ):
            if back and outline.closed is False and position[0] == len(outline.points) - 1:
                position = position - 1e-6
            way = directions(outline.points, position, closed=outline.closed)[0]
            row = link.aligned.left[0] if side == BEFORE else link.aligned.right[0]
            marks.append(StartMark(side, row, -way if back else way))
    return marks


def _runs_back(positions: FloatArray, count: int) -> bool:
    """Whether positions fall along the rows (the outline was drawn the other way round)."""
    steps = np.diff(positions)
    return int(np.count_nonzero(steps < 0)) > int(np.count_nonzero(steps > 0))


def arrow(at: QPointF, direction: FloatArray, size: float) -> QPolygonF:
    """Return a small triangle that points in a direction."""
    x, y = (float(v) for v in direction)
    tip = at + QPointF(x, y) * size
    side = QPointF(-y, x) * (size * 0.6)
    back = at - QPointF(x, y) * (size * 0.5)
    return QPolygonF([tip, back + side, back - side])
