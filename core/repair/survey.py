"""Where a path is sound, and where it must be repaired."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.repair.chains import BoolArray, Chains, ComplexArray
from core.repair.contacts import clear_moves, roomy

COARSE = 32
"""Stretches into which a span is cut at first; those in doubt are halved."""

HALVINGS = 2
"""How often: the finest stretch is a 128th of the span."""

TICKS = COARSE << HALVINGS
"""Times are counted in finest stretches."""

BEND = 1.3
"""Safety on how far a path leaves its chord, measured at the middle, where a parabola leaves it farthest."""

Path = Callable[[FloatArray], ComplexArray]
"""Wished frames (T, n) at the times (T,)."""


@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of the span, from one tick to another, of one kind.

    Attributes
    ----------
    first, last : int
        Ticks.
    kind : str
        "path": the path itself is clear there. "chord": only the straight move from its first to its last frame
        is. "bad": neither.
    """

    first: int
    last: int
    kind: str


def survey(chains: Chains, path: Path, checkpoint: Callable[[], None] = lambda: None) -> list[Stretch]:
    """Return the stretches of a path in order.

    A stretch is clear when the straight moves between its ends are, kept apart by more than the path bends away
    from them. Every stretch stands for itself: what follows a bad one may be clear and yet crossed all along.
    """
    found: list[Stretch] = []
    todo = [Stretch(k << HALVINGS, (k + 1) << HALVINGS, "") for k in range(COARSE)]
    while todo:
        checkpoint()
        kinds = _kinds(chains, path, todo)
        width = todo[0].last - todo[0].first
        done = [Stretch(s.first, s.last, kind) for s, kind in zip(todo, kinds, strict=True)]
        found += [s for s in done if s.kind == "path" or width == 1]
        todo = [
            Stretch(s.first + k, s.first + k + width // 2, "")
            for s in done
            if s.kind != "path" and width > 1
            for k in (0, width // 2)
        ]
    return sorted(found, key=lambda s: s.first)


def _kinds(chains: Chains, path: Path, stretches: list[Stretch]) -> list[str]:
    first, last = (np.array([getattr(s, end) for s in stretches]) for end in ("first", "last"))
    starts, ends, middles = (path(t / TICKS) for t in (first, last, (first + last) / 2))
    bends = BEND * (middles - (starts + ends) / 2)
    straight = float(np.abs(bends).max(initial=0.0)) < 1e-12
    clear = clear_moves(chains, starts, ends, None if straight else bends)
    kinds = np.where(clear, "path", "bad").astype(object)
    rest = np.flatnonzero(~clear)
    if not straight and len(rest) and stretches[0].last - stretches[0].first == 1:
        kinds[rest[clear_moves(chains, starts[rest], ends[rest])]] = "chord"
    return [str(kind) for kind in kinds]


@dataclass(frozen=True, eq=False)
class Terrain:
    """What is known of the wished frames at every tick.

    Attributes
    ----------
    frames : (TICKS + 1, n) complex array
    sound : (TICKS + 1,) bool array
        Simple, the same way round as the keyframes, and nowhere so narrow that rounding might decide.
    bad : (TICKS,) bool array
        The moves from tick to tick that are not clear, or lead from or to a frame that is not sound.
    """

    frames: ComplexArray
    sound: BoolArray
    bad: BoolArray


def terrain(chains: Chains, path: Path, stretches: list[Stretch]) -> Terrain:
    """Look at every tick of a path of which some stretch is bad."""
    frames = path(np.arange(TICKS + 1) / TICKS)
    sound = chains.simple(frames)
    sound &= (chains.signs(frames) == chains.signs(frames[:1])).all(axis=1)
    sound &= roomy(chains, frames)
    bad = ~(sound[:-1] & sound[1:])
    for s in stretches:
        bad[s.first : s.last] |= s.kind == "bad"
    return Terrain(frames, sound, bad)


def runs(bad: BoolArray, *, apart: int = 3) -> list[tuple[int, int]]:
    """First and last tick of every run of bad moves; runs with less than `apart` moves between them are one."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], bad.astype(np.int8), [0]])))
    found: list[tuple[int, int]] = []
    for first, last in edges.reshape(-1, 2).tolist():
        if found and first - found[-1][1] < apart:
            first = found.pop()[0]
        found.append((first, last))
    return found
