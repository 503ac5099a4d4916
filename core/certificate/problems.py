"""Findings, and the book in which they are noted."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray

SEVERITIES = ("error", "warning", "info")
"""From the worst on."""

LISTED = 8
"""Problems of one kind told for one outline and frame, the worst first; all are counted."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One finding.

    Attributes
    ----------
    kind : str
        "crossing", "inside out", "fold", "collapse", "explosion", "closure", "area", "keyframe", "number" or
        "fallback".
    severity : str
        One of `SEVERITIES`.
    frame : int or None
        Which of the frames; None for the whole span.
    t : float or None
        Its time in the span.
    place : (float, float) or None
        Where to look, in stage px.
    edges : tuple of int
        The edges concerned; edge i runs from vertex i to the next one.
    outlines : tuple of int
        The outline of each of them, or the one concerned.
    value : float
        How bad: for edges and areas the share of the keyframes', for folds the turning angle in degrees, for
        keyframes the distance in px; else the number of findings of this kind in the frame.
    text : str
        One sentence for people.
    """

    kind: str
    severity: str
    frame: int | None
    t: float | None
    place: tuple[float, float] | None
    edges: tuple[int, ...]
    outlines: tuple[int, ...]
    value: float
    text: str


@dataclass(frozen=True)
class Log:
    """All problems found so far, and how many of each kind every frame has."""

    times: FloatArray
    problems: list[Problem]
    counts: dict[str, IndexArray]

    def add(
        self,
        kind: str,
        severity: str,
        frame: int,
        place: npt.ArrayLike,
        text: str,
        *,
        edges: Sequence[int] = (),
        outlines: Sequence[int] = (),
        value: float,
    ) -> None:
        """Note one problem of a frame."""
        t = float(self.times[frame])
        x, y = np.asarray(place, np.float64).tolist()
        sentence = f"frame at t {t:.3g}: {text}"
        numbers = tuple(int(e) for e in edges)
        self.problems.append(
            Problem(kind, severity, frame, t, (x, y), numbers, tuple(outlines), float(value), sentence)
        )

    def count(self, kind: str, frames: IndexArray) -> None:
        """Count findings, each given by its frame, whether they are noted or not."""
        known = self.counts.setdefault(kind, np.zeros(len(self.times), np.intp))
        known += np.bincount(frames, minlength=len(known))


def worst_first(frames: IndexArray, worst: FloatArray) -> Iterator[tuple[int, IndexArray, int]]:
    """For every frame its `LISTED` worst findings (least first), and how many it has: (frame, rows, count)."""
    order = np.lexsort((worst, frames))
    cuts = np.flatnonzero(np.diff(frames[order])) + 1
    for rows in np.split(order, cuts):
        if len(rows):
            yield int(frames[rows[0]]), rows[:LISTED], len(rows)
