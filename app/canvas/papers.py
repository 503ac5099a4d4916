"""The papers in the view: one with everything on it, or several beside each other."""

from dataclasses import dataclass

from PySide6.QtCore import QRectF

from core.methods.plan import METHODS
from core.model.document import Stage

GAP = 0.06
"""Space between two papers, as a share of the stage's width."""

BEFORE, AFTER, INBETWEEN, FILM = "before", "after", "in-between", "film"


@dataclass(frozen=True, slots=True)
class Paper:
    """One copy of the stage.

    Attributes
    ----------
    offset : float
        Its left edge in stage px.
    shows : frozenset of str
        Of BEFORE, AFTER, INBETWEEN and FILM (t = 0, 0.2 ... 1 overlaid).
    method : str or None
        The method of its in-betweens; None: the span's own.
    title : str
        Said on the paper before anything else.
    """

    offset: float
    shows: frozenset[str]
    method: str | None = None
    title: str = ""

    def rect(self, stage: Stage) -> QRectF:
        return QRectF(self.offset, 0, stage.width, stage.height)


def papers_for(arrangement: str, stage: Stage) -> tuple[Paper, ...]:
    """Return the papers of an arrangement, from left to right."""
    step = stage.width * (1 + GAP)
    if arrangement == "side by side":
        return (
            Paper(0, frozenset({BEFORE})),
            Paper(step, frozenset({INBETWEEN})),
            Paper(2 * step, frozenset({AFTER})),
        )
    if arrangement == "compare":
        shown = frozenset({BEFORE, AFTER, FILM})
        return tuple(Paper(i * step, shown, method, method) for i, method in enumerate(METHODS[:2]))
    return (Paper(0, frozenset({BEFORE, AFTER, INBETWEEN})),)


def whole_area(papers: tuple[Paper, ...], stage: Stage) -> QRectF:
    """Return the rectangle around all papers, in stage px."""
    area = QRectF()
    for paper in papers:
        area = area.united(paper.rect(stage))
    return area


def paper_at(papers: tuple[Paper, ...], stage: Stage, x: float) -> Paper:
    """Return the paper under, or nearest to, a place `x` px from the left edge of the first."""
    return min(papers, key=lambda p: max(p.offset - x, x - p.offset - stage.width, 0.0))
