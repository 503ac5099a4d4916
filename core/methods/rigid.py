"""Rigid vertex paths: the interior turns and stretches as little as it must, and carries its outlines.

See docs/decisions/0005-rigid.md for what was measured.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.methods.assembly import Assembly, assemble, in_a_row
from core.methods.bending import BentBody, bend
from core.methods.bodies import bodies
from core.methods.body import Body, plan_body, tested
from core.methods.bridges import Bridge
from core.methods.headings import BoolArray, ComplexArray, Headings
from core.methods.intrinsic import IntrinsicPaths
from core.methods.loops import as_pairs, crossing_edges
from core.methods.placement import Placement

FELL_BACK = "fell back to intrinsic: the interiors cannot be matched"

CELLS = 1 << 14
"""Vertices times frames computed in one go: few enough for the work arrays to stay in the cache."""


@dataclass(frozen=True, eq=False)
class Part:
    """Some outlines that move as one.

    Attributes
    ----------
    rows : (n,) int array
        Their vertices in the drawing.
    paths : Body or IntrinsicPaths
    source : (n,) int array
        The vertex of the paths that each of them is; doubled vertices are only one there.
    """

    rows: IndexArray
    paths: Body | IntrinsicPaths
    source: IndexArray

    def forms(self, t: FloatArray) -> ComplexArray:
        """Vertices (T, n) at the times `t` (T,), up to a shift."""
        return self.paths.forms(t)[:, self.source]

    def gathered(self, weights: FloatArray) -> FloatArray:
        """Weights (k, all vertices of the drawing) as those of the vertices of the paths."""
        out = np.zeros((len(weights), int(self.source.max()) + 1))
        np.add.at(out.T, self.source, weights[:, self.rows].T)
        return out


@dataclass(frozen=True, eq=False)
class RigidBending:
    """How the interiors of a drawing give way to its pins.

    Attributes
    ----------
    paths : RigidPaths
    bent : tuple of (number of the part, numbers of its pins, BentBody)
    """

    paths: "RigidPaths"
    bent: tuple[tuple[int, IndexArray, BentBody], ...]

    @classmethod
    def of(cls, paths: "RigidPaths", weights: FloatArray) -> "RigidBending":
        """Prepare for pins that are means of the vertices of the drawing with `weights` (k, n)."""
        bent = []
        for number, part in enumerate(paths.parts):
            own = np.flatnonzero(np.isclose(weights[:, part.rows].sum(axis=1), 1.0))
            if len(own) and isinstance(part.paths, Body):
                bent.append((number, own, bend(part.paths, part.gathered(weights[own]))))
        return cls(paths, tuple(bent))

    def near(self, t: FloatArray, frames: ComplexArray, wanted: ComplexArray) -> ComplexArray:
        """Return `frames` (T, n) with the interiors joined again, their pins where they are `wanted` (T, k)."""
        frames = frames.copy()
        done = set()
        for number, own, body in self.bent:
            part = self.paths.parts[number]
            frames[:, part.rows] = body.forms(t, wanted[:, own])[:, part.source]
            done.add(number)
        for number, bridge, rows in self.paths.moves:
            if number not in done:
                frames[:, rows] += bridge.shift(frames, t)[:, None]
        return frames


@dataclass(frozen=True, eq=False)
class RigidPaths:
    """The paths of all vertices of a drawing.

    Attributes
    ----------
    count : int
        Vertices.
    parts : tuple of Part
    moves : tuple of (int, Bridge, (k,) int array)
        Part, bridge to it and its vertices, in the order in which parts must be moved.
    placement : Placement
    """

    count: int
    parts: tuple[Part, ...]
    moves: tuple[tuple[int, Bridge, IndexArray], ...]
    placement: Placement

    def evaluate(self, t: FloatArray) -> FloatArray:
        """Vertices at the times `t` (T,), as (T, n, 2) in px."""
        frames = np.zeros((len(t), self.count), np.complex128)
        step = max(1, CELLS // self.count)
        for k in range(0, len(t), step):
            self._fill(frames[k : k + step], t[k : k + step])
        return frames.view(np.float64).reshape(*frames.shape, 2)

    def _fill(self, frames: ComplexArray, t: FloatArray) -> None:
        for part in self.parts:
            frames[:, part.rows] = part.forms(t)
        for _, bridge, rows in self.moves:
            frames[:, rows] += bridge.shift(frames, t)[:, None]
        frames += self.placement.shift(frames, t)[:, None]


def rigid_paths(
    pairs: Sequence[tuple[FloatArray, FloatArray, bool]], *, turns: int = 0, placement: str = "still"
) -> tuple[RigidPaths | IntrinsicPaths, str]:
    """Plan the paths of outlines (left (k, 2), right (k, 2), closed), and say what could not be done as it should.

    Parameters
    ----------
    pairs : sequence
        As of `AlignedPair`. Each outer outline moves with its holes; open outlines move by their headings.
    turns : int
        Whole turns added to the shortest one.
    placement : str
        One of `PLACEMENTS`.

    Returns
    -------
    paths : RigidPaths or IntrinsicPaths
        The latter where no interior can be matched.
    note : str
        Empty when all is well.
    """
    plain = assemble(pairs, turns=turns, placement=placement)
    interiors = bodies(plain)
    if not interiors:
        return IntrinsicPaths.of(plain), FELL_BACK if any(plain.closed) else ""
    assembly = plain
    if max(map(len, interiors)) > 1:
        assembly = assemble(pairs, turns=turns, bodies=_numbers(interiors, len(pairs)), placement=placement)
    planned = [_planned(assembly, own) for own in interiors]
    note = _note(planned, sum(plain.closed) - sum(map(len, interiors)))
    found = [(own, body) for own, body in zip(interiors, planned, strict=True) if body is not None]
    if not found:
        return IntrinsicPaths.of(plain), note
    return _joined(assembly, found), note


def _planned(assembly: Assembly, own: list[int]) -> Body | None:
    """Plan one interior; None also where the intrinsic method has fewer crossings."""
    outlines = [assembly.outlines[k].only(_single(assembly.outlines[k])) for k in own]
    kept = np.concatenate([assembly.rows[k].start + np.flatnonzero(_single(assembly.outlines[k])) for k in own])
    a, b = assembly.a[kept], assembly.b[kept]
    local = in_a_row([len(h.turn) for h in outlines])
    body = plan_body(a, b, local, outlines)
    if body is None or not body.crossings:
        return body
    plain = IntrinsicPaths.of(assemble([(as_pairs(a[r]), as_pairs(b[r]), True) for r in local]))
    points = plain.evaluate(tested(len(a)))
    frames = points[..., 0] + 1j * points[..., 1]
    return None if len(crossing_edges(frames, local)) < body.crossings else body


def _joined(assembly: Assembly, found: list[tuple[list[int], Body]]) -> RigidPaths:
    """Make a part of every interior and of every outline left over, and keep the bridges between parts."""
    parts: list[Part] = []
    part_of = np.full(len(assembly.rows), -1)
    for own, body in found:
        part_of[own] = len(parts)
        parts.append(Part(_indices(assembly.rows, own), body, _sources([assembly.outlines[k] for k in own])))
    for k in np.flatnonzero(part_of < 0).tolist():
        part_of[k] = len(parts)
        rows = _indices(assembly.rows, [k])
        parts.append(Part(rows, IntrinsicPaths.of(_alone(assembly, k)), rows - rows[0]))
    of_row = {row.start: int(part) for row, part in zip(assembly.rows, part_of, strict=True)}
    moves = [
        (of_row[bridge.carried.start], bridge, parts[of_row[bridge.carried.start]].rows)
        for bridge in assembly.bridges
        if of_row[bridge.carried.start] != of_row[bridge.carrier.start]
    ]
    return RigidPaths(len(assembly.a), tuple(parts), tuple(moves), assembly.placement)


def _single(outline: Headings) -> BoolArray:
    """Which vertices of a closed outline are not the very next one too."""
    return (outline.before > 0) | (outline.after > 0)


def _sources(outlines: Sequence[Headings]) -> IndexArray:
    """Number of each vertex among the single ones, that of the next one where it is doubled."""
    found, first = [], 0
    for outline in outlines:
        single = _single(outline)
        count = int(single.sum())
        found.append(first + (np.cumsum(single) - single) % count)
        first += count
    return np.concatenate(found)


def _alone(assembly: Assembly, k: int) -> Assembly:
    """Return one outline of a drawing with the turn that it has there."""
    row = assembly.rows[k]
    only = in_a_row([row.stop - row.start])
    closed, outline = (assembly.closed[k],), (assembly.outlines[k],)
    return Assembly(assembly.a[row], assembly.b[row], only, closed, outline, (), assembly.placement)


def _note(planned: list[Body | None], left_over: int) -> str:
    """Say what is not as it should be, each thing once."""
    failed = sum(body is None for body in planned) + left_over
    notes = list(dict.fromkeys(body.note for body in planned if body is not None and body.note))
    if failed == len(planned) + left_over:
        return FELL_BACK
    if failed:
        notes.insert(0, f"{failed} of {len(planned) + left_over} parts {FELL_BACK}")
    return "; ".join(notes)


def _numbers(interiors: list[list[int]], count: int) -> list[int]:
    """Number of the body of every outline; outlines in none have one of their own."""
    numbers = list(range(count))
    for own in interiors:
        for k in own:
            numbers[k] = own[0]
    return numbers


def _indices(rows: Sequence[slice], own: list[int]) -> IndexArray:
    return np.concatenate([np.arange(rows[k].start, rows[k].stop) for k in own])
