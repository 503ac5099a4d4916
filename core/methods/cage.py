"""The few vertices of outlines that carry their interior: fine detail does not enter the mesh."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.methods.headings import ComplexArray
from core.methods.loops import crossing_edges, next_in_loops

FEW = 12
"""Drawings of at most so many vertices are their own cage."""

DOUBLED = 1e-7
"""Vertices nearer than this to the one before, for a drawing of area 1, cannot both be in a mesh."""

STRIP = 0.14
"""Longest edge of the mesh's boundary, for a drawing of area 1; less where the drawing is thin."""

EXTRA = 150
"""Vertices that may be added to divide long edges."""


@dataclass(frozen=True, eq=False)
class Cage:
    """The boundary of the mesh in both keyframes: chosen vertices, and points between them on long edges.

    Attributes
    ----------
    vertices : (k,) int array
        The chosen vertices of the drawing, outline after outline, each in its order (its first may be any).
    edges : tuple of slice
        The rows of each outline in `vertices`.
    places : (k,) int array
        Where they are on the boundary.
    before, after : (n,) complex array
        The boundary, with the points added.
    loops : tuple of slice
        The rows of each outline on the boundary.
    """

    vertices: IndexArray
    edges: tuple[slice, ...]
    places: IndexArray
    before: ComplexArray
    after: ComplexArray
    loops: tuple[slice, ...]


def cage(a: ComplexArray, b: ComplexArray, loops: Sequence[slice], tolerance: float, most: int) -> Cage | None:
    """Choose vertices so that both simplified drawings stay within `tolerance`, and are simple.

    Parameters
    ----------
    a, b : (n,) complex array
        Vertices of all closed outlines of a drawing, with area 1 and middle 0.
    loops : sequence of slice
        The outlines.
    tolerance : float
        Distance in the four dimensions of both keyframes together, so that the vertices correspond too.
    most : int
        Vertices at which to stop.

    Returns
    -------
    Cage or None
        None where outlines cross or have fewer than three places.

    Notes
    -----
    Douglas and Peucker 1973, all segments at once, from a vertex farthest from the middle: the choice depends on
    no start vertex, direction, or order of the keyframes.
    """
    both = np.stack([a.real, a.imag, b.real, b.imag], axis=1)
    usable = ~_doubled(a, b, loops)
    if any(np.count_nonzero(usable[loop]) < 3 for loop in loops):
        return None
    row = _Row.of(both, usable, loops)
    if len(a) <= FEW:
        row.kept |= row.usable
    else:
        row.refine(tolerance, most)
    if not row.untie(a, b, most + most // 2 + FEW):
        return None
    chosen = row.chosen()
    return _divided(a, b, chosen)


def _doubled(a: ComplexArray, b: ComplexArray, loops: Sequence[slice]) -> np.ndarray:
    """Vertices that coincide with the one before them in a keyframe."""
    after = next_in_loops(loops)
    short = np.minimum(np.abs(a[after] - a), np.abs(b[after] - b)) < DOUBLED
    doubled = np.zeros(len(a), dtype=bool)
    doubled[after] = short
    return doubled


class _Row:
    """All outlines in one row, each from its farthest vertex round to that vertex again, and which are kept."""

    def __init__(self, points: FloatArray, index: IndexArray, usable: np.ndarray, ends: IndexArray) -> None:
        self.points, self.index, self.usable, self.ends = points, index, usable, ends
        self.kept = np.zeros(len(points), dtype=bool)
        self.kept[ends] = True

    @classmethod
    def of(cls, points: FloatArray, usable: np.ndarray, loops: Sequence[slice]) -> "_Row":
        far = np.where(usable, (points**2).sum(axis=1), -1.0)
        index = []
        for loop in loops:
            count = loop.stop - loop.start
            first = int(far[loop].argmax())
            index.append(loop.start + (first + np.arange(count + 1)) % count)
        stops = np.cumsum([len(i) for i in index])
        ends = np.concatenate([stops - [len(i) for i in index], stops - 1])
        order = np.concatenate(index)
        usable = usable[order]
        usable[ends] = True
        return cls(points[order], order, usable, ends)

    def gaps(self) -> tuple[IndexArray, FloatArray, IndexArray]:
        """Of every segment between kept vertices that has others: its number, widest gap and where it is."""
        kept = np.flatnonzero(self.kept)
        segment = np.cumsum(self.kept) - 1
        start, stop = kept[segment], kept[np.minimum(segment + 1, len(kept) - 1)]
        chord = self.points[stop] - self.points[start]
        offset = self.points - self.points[start]
        squared = (chord * chord).sum(axis=1)
        part = np.divide((offset * chord).sum(axis=1), squared, out=np.zeros(len(squared)), where=squared > 0)
        gap = np.sqrt(((offset - np.clip(part, 0, 1)[:, None] * chord) ** 2).sum(axis=1))
        gap[self.kept | ~self.usable] = -1.0
        widest = np.maximum.reduceat(gap, kept)
        at = np.flatnonzero((gap == widest[segment]) & (gap >= 0))
        numbers, once = np.unique(segment[at], return_index=True)
        return numbers, widest[numbers], at[once]

    def refine(self, tolerance: float, most: int) -> None:
        """Keep the worst vertex of every segment too far off; of every segment at all in the first two rounds."""
        most = max(most, 6 * (len(self.ends) // 2))
        for round_ in range(64):
            _, widest, at = self.gaps()
            wanted = at if round_ < 2 else at[widest > tolerance]
            room = most - np.count_nonzero(self.kept) + len(self.ends) // 2
            if not len(wanted) or room <= 0:
                return
            if len(wanted) > room:
                wanted = at[np.argsort(-widest, kind="stable")[:room]]
            self.kept[wanted] = True

    def untie(self, a: ComplexArray, b: ComplexArray, most: int) -> bool:
        """Keep more vertices where edges cross in a keyframe; return whether none cross at last."""
        for _ in range(64):
            chosen = self.chosen()
            vertices, loops = np.concatenate(chosen), _rows([len(c) for c in chosen])
            ties = np.unique(crossing_edges(np.stack([a[vertices], b[vertices]]), loops)[:, 1:])
            if not len(ties):
                return True
            numbers, _, at = self.gaps()
            # a segment's number counts the closing vertex of every outline before it
            tied = ties + np.searchsorted([r.stop for r in loops], ties, side="right")
            wanted = at[np.isin(numbers, tied)]
            if not len(wanted) or len(vertices) + len(wanted) > most:
                return False
            self.kept[wanted] = True
        return False

    def chosen(self) -> list[IndexArray]:
        """Kept vertices of every outline, each once."""
        stops = np.sort(self.ends)
        pairs = zip(stops[::2], stops[1::2], strict=True)
        return [self.index[first:last][self.kept[first:last]] for first, last in pairs]


def _divided(a: ComplexArray, b: ComplexArray, chosen: list[IndexArray]) -> Cage | None:
    """Divide long edges evenly, the same in both keyframes."""
    vertices = np.concatenate(chosen)
    edges = _rows([len(c) for c in chosen])
    after = vertices[next_in_loops(edges)]
    lengths = np.maximum(np.abs(a[after] - a[vertices]), np.abs(b[after] - b[vertices]))
    parts = _parts(lengths)
    places = np.cumsum(parts) - parts
    owner = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(owner)) - places[owner]) / parts[owner]
    before, behind = (p[vertices][owner] * (1 - share) + p[after][owner] * share for p in (a, b))
    loops = _rows([int(parts[e].sum()) for e in edges])
    return Cage(vertices, edges, places, before, behind, loops)


def _parts(lengths: FloatArray) -> IndexArray:
    """Into how many parts each edge is divided: a thin drawing, about 2 / perimeter wide, into short ones."""
    step = min(STRIP, 2 / float(lengths.sum()))
    for _ in range(64):
        parts = np.ceil(lengths / step).astype(np.intp)
        parts = np.maximum(parts, 1)
        if (parts - 1).sum() <= EXTRA:
            break
        step *= 1.1
    return parts


def _rows(counts: Sequence[int]) -> tuple[slice, ...]:
    stops = np.cumsum(counts).tolist()
    return tuple(slice(stop - count, stop) for stop, count in zip(stops, counts, strict=True))
