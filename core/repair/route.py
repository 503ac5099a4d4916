"""The whole way from one keyframe to the other: along the wished path, and round what is in the way."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.repair.chains import BoolArray, ComplexArray
from core.repair.contacts import clear_moves
from core.repair.descent import Field, descend
from core.repair.join import Sketch, join
from core.repair.march import March, best_change, distance, march
from core.repair.pinned import Grip
from core.repair.survey import TICKS, Path, Terrain, runs, survey, terrain
from core.repair.tighten import tighten
from core.repair.timing import FILLED, MOST_JUMP, durations, jumps, move_lengths, speed_limit

OPENING = 1 / 4096
"""Time in which doubled vertices part."""

WORTH = 0.01
"""Sizes of the drawing: a detour that deviates less on the whole is not pulled tighter."""

PULLS = 3
"""Times that detours are pulled tight and timed anew."""

MARGIN = 2
"""Ticks by which a run of bad moves is widened at most to reach frames that feel no barrier."""


@dataclass(frozen=True, eq=False)
class Detour:
    """Places from one time to another, with straight moves between them.

    Attributes
    ----------
    times : (K,) float array
        Growing, in [0, 1].
    places : (K, n) complex array
    """

    times: FloatArray
    places: ComplexArray

    def at(self, times: FloatArray) -> ComplexArray:
        """Places (T, n) at the times (T,), all within the detour's own."""
        k = np.clip(np.searchsorted(self.times, times, side="right") - 1, 0, len(self.times) - 2)
        step = self.times[k + 1] - self.times[k]
        s = ((times - self.times[k]) / np.where(step > 0, step, 1.0))[:, None]
        between: ComplexArray = (1 - s) * self.places[k] + s * self.places[k + 1]
        return between


@dataclass(frozen=True, eq=False)
class Route:
    """Detours from a path, apart from each other and in order.

    Attributes
    ----------
    detours : tuple of Detour
    whole : bool
        Whether the path with its detours leads from keyframe to keyframe without a crossing.
    """

    detours: tuple[Detour, ...]
    whole: bool = True

    @property
    def bent(self) -> bool:
        """Whether there is any detour."""
        return len(self.detours) > 0

    def at(self, times: FloatArray) -> tuple[IndexArray, ComplexArray]:
        """Return which of the times (T,) lie strictly within a detour, and the places there, none or (k, n)."""
        if not self.detours:
            return np.zeros(0, np.intp), np.zeros((0, 0), np.complex128)
        rows, places = [], []
        for detour in self.detours:
            inside = np.flatnonzero((times > detour.times[0]) & (times < detour.times[-1]))
            rows.append(inside)
            places.append(detour.at(times[inside]))
        return np.concatenate(rows), np.concatenate(places)


@dataclass(frozen=True, eq=False)
class Course:
    """A route in px, for keyframes of which vertices may have been doubled.

    Attributes
    ----------
    route : Route
        In sizes of the drawing.
    path : callable
        The path from which the route takes its detours, in sizes, doubled vertices told apart.
    ends : (2, n) complex array
        The keyframes themselves, in sizes.
    doubled : bool
        Whether any vertex was told apart. The outlines then leave the keyframes by a straight move of `OPENING`.
    origin, scale
        To px.
    grip : Grip, optional
        Pins to be met.
    """

    route: Route
    path: Path
    ends: ComplexArray
    doubled: bool
    origin: complex
    scale: float
    grip: Grip | None = None

    def at(self, times: FloatArray) -> tuple[IndexArray, ComplexArray]:
        """Return which of the times (T,) are not the method's own, and the places there in px."""
        rows, places = self._opened(times) if self.doubled else self.route.at(times)
        if self.grip is not None and len(rows):
            places = self.grip.onto(places, times[rows])
        return rows, places * self.scale + self.origin

    def _opened(self, times: FloatArray) -> tuple[IndexArray, ComplexArray]:
        inside = np.flatnonzero((times > 0) & (times < 1))
        t = times[inside]
        held = np.clip(t, OPENING, 1 - OPENING)
        places = self.path(held)
        rows, bent = self.route.at(held)
        if len(rows):
            places[rows] = bent
        for end, share in ((self.ends[0], t / OPENING), (self.ends[1], (1 - t) / OPENING)):
            near = share < 1
            s = share[near, None]
            places[near] = (1 - s) * end + s * places[near]
        return inside, places


@dataclass(frozen=True, eq=False)
class _Repair:
    """Places round a run of bad moves, and how long each move between them would last if nothing were in the way.

    `first` and `last` are ticks; the places there are those of the path.
    """

    first: int
    last: int
    places: ComplexArray
    wished: FloatArray

    def widened(self, frames: ComplexArray, low: int, high: int, limit: float) -> "_Repair":
        """Take in parts of the path on both sides until there is time enough for every move, if there can be."""
        first, last = self.first, self.last
        need = float(move_lengths(self.places).sum())
        while need > FILLED * limit * (last - first) / TICKS and (first > low or last < high):
            for step in (-1, 1):
                at = first if step < 0 else last
                if (first > low) if step < 0 else (last < high):
                    need += float(np.abs(frames[at] - frames[at + step]).max())
                    first, last = first - (step < 0), last + (step > 0)
        before, after = frames[first : self.first], frames[self.last + 1 : last + 1]
        wished = [np.full(len(before), 1 / TICKS), self.wished, np.full(len(after), 1 / TICKS)]
        return _Repair(first, last, np.concatenate([before, self.places, after]), np.concatenate(wished))

    def tightened(self, field: Field, path: Path, limit: float) -> "_Repair":
        """Pull the places towards the path, as it is when they are passed, as long as that brings them nearer."""
        best, off = self, self.deviation(path, limit)
        for _ in range(PULLS):
            if off < WORTH:
                break
            times = best.detour(limit).times
            pulled = replace(best, places=tighten(field, times, best.places, path(times)), wished=np.diff(times))
            now = pulled.deviation(path, limit)
            if now >= off:
                break
            best, off = pulled, now
        return best

    def deviation(self, path: Path, limit: float) -> float:
        """Root mean square distance from the path, in sizes."""
        times = np.linspace(self.first, self.last, 4 * (self.last - self.first) + 1) / TICKS
        return float(np.sqrt((distance(self.detour(limit).at(times), path(times)) ** 2).mean()))

    def detour(self, limit: float) -> Detour:
        """Say when to be where."""
        whole = (self.last - self.first) / TICKS
        taken = durations(self.wished, move_lengths(self.places), whole, limit)
        times = self.first / TICKS + np.concatenate([[0.0], np.cumsum(taken)])
        times[-1] = self.last / TICKS
        return Detour(times, self.places)


def route(
    field: Field, path: Path, sketches: tuple[Sketch, ...], tell: Callable[[float], None] = lambda share: None
) -> Route:
    """Return the detours that a path needs.

    Parameters
    ----------
    field : Field
        Of keyframes that are simple and run the same way round.
    path : callable
        The wished path.
    sketches : tuple of callables
        Other methods, from which a way between two frames may be made.
    tell : callable
        Called with the share of the work done.
    """
    stretches = survey(field.chains, path, field.checkpoint)
    chords = [(s.first, s.last) for s in stretches if s.kind == "chord"]
    if all(s.kind != "bad" for s in stretches):
        ends = [(path(np.array([i, j]) / TICKS), i, j) for i, j in chords]
        return Route(tuple(Detour(np.array([i, j]) / TICKS, z) for z, i, j in ends))
    ground = terrain(field.chains, path, stretches)
    easy = _easy(field, ground)
    spans = _with_margins(runs(ground.bad), easy)
    found = Route((), whole=False)
    for tried in (spans, [(0, TICKS)]):  # if the parts cannot be mended, perhaps the whole can
        if found.whole:
            break
        told = tell if tried is spans else lambda share: None  # progress never falls back
        found = _mended(field, path, ground, easy, tried, chords, sketches, told)
    return found


def _mended(
    field: Field,
    path: Path,
    ground: Terrain,
    easy: BoolArray,
    spans: list[tuple[int, int]],
    chords: list[tuple[int, int]],
    sketches: tuple[Sketch, ...],
    tell: Callable[[float], None],
) -> Route:
    """Go round each of the spans, and straight along the chords outside of them."""
    repairs = []
    done, work = 0, 2 * sum(last - first for first, last in spans)

    def tick() -> None:
        nonlocal done
        done += 1
        tell(0.1 + 0.8 * done / work)

    for first, last in spans:
        found = _round(field, ground.frames[first : last + 1], easy[first : last + 1], sketches, tick)
        if found is None:
            return Route((), whole=False)
        repairs.append(_Repair(first, last, *found))
    detours = _timed(field, path, repairs, ground.frames)
    detours += [_chord(ground, i, j) for i, j in chords if not any(_within(d, i, j) for d in detours)]
    sound = all(clear_moves(field.chains, d.places[:-1], d.places[1:]).all() for d in detours)
    return Route(tuple(sorted(detours, key=lambda d: float(d.times[0]))), whole=sound)


def _chord(ground: Terrain, first: int, last: int) -> Detour:
    return Detour(np.array([first, last]) / TICKS, ground.frames[[first, last]])


def _within(detour: Detour, first: int, last: int) -> bool:
    return bool(detour.times[0] <= first / TICKS and last / TICKS <= detour.times[-1])


def _easy(field: Field, ground: Terrain) -> BoolArray:
    """Frames that can be taken as they are: sound, and nothing within the barrier's reach."""
    easy = ground.sound.copy()
    near = np.zeros(TICKS + 1, np.bool_)
    for first, last in runs(ground.bad):
        near[max(first - MARGIN, 0) : last + MARGIN + 1] = True
    for k in np.flatnonzero(easy & near):
        z = ground.frames[k]
        easy[k] = not field.barrier.touches(z, field.pairs_near(z))
    easy[[0, -1]] = True
    return easy


def _with_margins(spans: list[tuple[int, int]], easy: BoolArray) -> list[tuple[int, int]]:
    """Each span from an easy frame to an easy one, where there is one near; never into its neighbour."""
    found: list[tuple[int, int]] = []
    for k, (first, last) in enumerate(spans):
        low = max(first - MARGIN, found[-1][1] if found else 0)
        high = min(last + MARGIN, spans[k + 1][0] if k + 1 < len(spans) else TICKS)
        before = [i for i in range(first, low - 1, -1) if easy[i]]
        after = [i for i in range(last, high + 1) if easy[i]]
        found.append((before[0] if before else first, after[0] if after else last))
    return found


def _round(
    field: Field,
    wished: ComplexArray,
    easy: BoolArray,
    sketches: tuple[Sketch, ...],
    tick: Callable[[], None],
) -> tuple[ComplexArray, FloatArray] | None:
    """Places round a run of bad moves from its first frame to its last, and their wished durations."""
    forth = march(field, wished, easy, tick)
    back = march(field, wished[::-1], easy[::-1], tick)
    last = len(wished) - 1
    change = best_change(forth.reached, back.reached[::-1], wished)
    x, y = forth.reached[change], back.reached[last - change]
    between = [x, y] if np.array_equal(x, y) else join(field, x, y, sketches)
    if between is None:
        return None
    start, first_durations = _timed_legs(forth, change)
    end, last_durations = _timed_legs(back, last - change)
    middle = between[1:-1] if len(between) > 2 else []
    gap = [0.0] * (len(middle) + 1)
    places = np.array([*start, *middle, *end[::-1]])
    return places, np.array([*first_durations, *gap, *last_durations[::-1]])


def _timed_legs(walked: March, last: int) -> tuple[list[ComplexArray], list[float]]:
    """Places of a march up to one of its wished frames, each leg a tick long."""
    places, taken = [walked.reached[0]], list[float]()
    for leg in walked.legs[1 : last + 1]:
        leg = leg or [places[-1]]
        lengths = move_lengths(np.array([places[-1], *leg]))
        whole = float(lengths.sum())
        shares = lengths / whole if whole > 0 else np.full(len(leg), 1 / len(leg))
        taken += (shares / TICKS).tolist()
        places += leg
    return places, taken


def _timed(field: Field, path: Path, repairs: Sequence[_Repair], frames: ComplexArray) -> list[Detour]:
    """Give every repair its time: as much of its neighbourhood as it needs, up to the repair next to it."""
    limit = speed_limit(frames)
    found: list[_Repair] = []
    for k, repair in enumerate(repairs):
        low = found[-1].last if found else 0
        high = repairs[k + 1].first if k + 1 < len(repairs) else TICKS
        found.append(repair.widened(frames, low, high, limit))
    found = [repair.tightened(field, path, limit) for repair in found]
    detours = [_held(field, path, repair.detour(limit)) for repair in found]
    if jumps(lambda t: _mixed(detours, frames, t)) <= MOST_JUMP:
        return detours
    return [_held(field, path, _evenly(found, frames))]


def _mixed(detours: list[Detour], frames: ComplexArray, times: FloatArray) -> ComplexArray:
    """Places at the times (T,), the frames between the detours taken as straight moves."""
    places = Detour(np.arange(TICKS + 1) / TICKS, frames).at(times)
    rows, bent = Route(tuple(detours)).at(times)
    places[rows] = bent
    return places


def _held(field: Field, path: Path, detour: Detour) -> Detour:
    """The detour with the pins, if there are any, at every place where the path has them when it is passed."""
    if field.held is None or not field.many_held:
        return detour
    wished = path(detour.times)
    places = detour.places.copy()
    for k in range(1, len(places) - 1):
        z = places[k]
        target = z + field.metric.lift(field.held @ (wished[k] - z))
        places[k] = [z, *descend(field, z, target, metric=field.metric)][-1]
    clear = clear_moves(field.chains, places[:-1], places[1:]).all()
    return Detour(detour.times, places) if clear else detour


def _evenly(repairs: list[_Repair], frames: ComplexArray) -> Detour:
    """All of the way at one speed: detours so long that nothing but that keeps a vertex from jumping."""
    places, at = [], 0
    for repair in repairs:
        places += [*frames[at : repair.first], *repair.places]
        at = repair.last + 1
    whole = np.array([*places, *frames[at:]])
    times = np.cumsum(np.append(0.0, durations(np.zeros(len(whole) - 1), move_lengths(whole), 1.0, 0.0)))
    return Detour(np.append(times[:-1], 1.0), whole)
