"""A clear way between two simple frames that no straight move joins."""

from collections.abc import Callable, Iterator

import numpy as np
import scipy.sparse as sp
from scipy.optimize import linprog

from core.geometry.outline import signed_area
from core.repair.chains import BoolArray, ComplexArray, as_points
from core.repair.contacts import clear_moves
from core.repair.descent import Field, Metric, descend
from core.repair.march import march, shortened

Sketch = Callable[[ComplexArray, ComplexArray], ComplexArray]
"""Wished frames (K, n) of some method from one frame to another."""

MOST_FLOW = 60
"""Rounds of flow before giving up; four steps each. Every pair tried so far needed fewer than 25."""

MOST_FLOW_HELD = 5
"""The same where many pins are held, which no smoothing can move out of the way."""

MARCH_AT = (0, 2, 4, 7, 12, 20, 32)
"""Rounds at which marches are tried: they cost more than flowing on."""

STAR_STEPS = 24
"""Moves into which a link of star shapes is cut at first."""

STIFFNESS = 1.0
"""Weight of the barrier against the springs of the flow, which pull harder than the wishes of a march."""


def join(
    field: Field, x: ComplexArray, y: ComplexArray, sketches: tuple[Sketch, ...]
) -> list[ComplexArray] | None:
    """Return places from x to y, both included, with clear moves between them; None if none was found.

    Both ends are made simpler, step by step, until a straight move, a march or a link of two star shapes joins
    them. Only one closed outline can be made simpler; several, or an open one, must be joined as they are.
    """
    left, right = Simplification(field, x), Simplification(field, y)
    for depth in range(MOST_FLOW_HELD if field.many_held else MOST_FLOW):
        between = _direct(field, left.place, right.place, sketches if depth in MARCH_AT else ())
        if between is not None:
            return [*left.places, *between, *right.places[::-1]]
        if not field.chains.ring:
            return None
        stars = [side.centre() for side in (left, right)]
        if stars[0] is not None and stars[1] is not None:
            between = star_link(field, left.place, right.place, stars[0], stars[1])
            if between is not None:
                return [*left.places, *between, *right.places[::-1]]
        for side, star in zip((left, right), stars, strict=True):
            if star is None:
                side.flow(4)
    return None


def _direct(
    field: Field, x: ComplexArray, y: ComplexArray, sketches: tuple[Sketch, ...]
) -> list[ComplexArray] | None:
    """Places strictly between x and y, if a straight move or a march joins them."""
    if clear_moves(field.chains, x[None], y[None])[0]:
        return []
    for wished in (s(x, y) for s in sketches):
        if not np.isfinite(wished).all():
            continue
        easy = _easy(field, wished)
        for frames, free, order in ((wished, easy, 1), (wished[::-1], easy[::-1], -1)):
            places = march(field, frames, free).forth(len(frames) - 1)
            if clear_moves(field.chains, places[-1][None], frames[-1][None])[0]:
                return places[1:][::order]
    return None


def _easy(field: Field, frames: ComplexArray) -> BoolArray:
    fine = field.chains.simple(frames)
    fine &= (field.chains.signs(frames) == field.chains.signs(frames[:1])).all(axis=1)
    return fine


class Simplification:
    """A closed outline on its way to a star shape: smoothed as heat spreads, kept simple, kept at its area.

    Heat keeps the relative lengths of edges, limbs melt into the body, and all stays near the old outline.
    """

    def __init__(self, field: Field, z: ComplexArray) -> None:
        self._field = field
        self._duration = 3e-6
        self.places = [z]

    @property
    def place(self) -> ComplexArray:
        """Where it has come."""
        return self.places[-1]

    def centre(self) -> complex | None:
        """Return the centre of the widest disc from which all of the outline is seen, None if there is none."""
        return star_centre(self.place)

    def flow(self, steps: int) -> None:
        """Take so many implicit steps, longer ones while nothing blocks."""
        for _ in range(steps):
            self._step()

    def _step(self) -> None:
        field, z = self._field, self.place
        held = field.held if field.many_held else None
        metric = Metric(field.springs * self._duration + sp.diags(field.mass), held)
        aim = metric.solve(field.mass * z)
        weight = self._duration * STIFFNESS
        places = descend(field, z, aim, metric=metric, weight=weight, steps=6, smallest=1e-8)
        if not places:
            self._duration /= 1.5
            return
        arrived = float(np.abs(places[-1] - aim).max()) < 0.5 * float(np.abs(z - aim).max())
        self._duration = min(self._duration * 1.3, 0.03) if arrived else self._duration / 1.5
        places = shortened(field, z, places)
        if held is not None:  # growing again would take the pins away from their places
            self.places += places
            return
        middle = places[-1].mean()
        scale = np.sqrt(_area(z) / _area(places[-1]))
        self.places += [*places, middle + scale * (places[-1] - middle)]


def _area(z: ComplexArray) -> float:
    return float(abs(signed_area(as_points(z))))


def star_centre(z: ComplexArray) -> complex | None:
    """Return the centre of the widest disc in the kernel of a closed outline, None where it is not star-shaped."""
    points = as_points(z)
    low, size = points.min(axis=0), float(np.ptp(points, axis=0).max())
    p = (points - low) / size  # the solver's tolerances are absolute
    edge = np.roll(p, -1, axis=0) - p
    length = np.hypot(*edge.T)
    solid = length > 1e-12
    outward = np.stack([edge[:, 1], -edge[:, 0]], axis=1)[solid] / length[solid, None]
    outward *= np.sign(signed_area(p))
    bound = (outward * p[solid]).sum(axis=1)
    rows = np.concatenate([outward, np.ones((len(bound), 1))], axis=1)
    found = linprog([0, 0, -1], A_ub=rows, b_ub=bound, bounds=[(None, None), (None, None), (None, 1)])
    if not found.success or found.x[2] < 1e-4:
        return None
    return complex(*(found.x[:2] * size + low))


def star_link(
    field: Field, x: ComplexArray, y: ComplexArray, centre: complex, other: complex
) -> list[ComplexArray] | None:
    """Places strictly between two star shapes: radius and angle of every vertex about the centre go straight.

    Angles grow along both outlines, so they grow along every mixture: all of them are star-shaped.
    """
    polar = [(np.abs(z - c), np.unwrap(np.angle(z - c))) for z, c in ((x, centre), (y, other))]
    (r0, a0), (r1, a1) = polar
    a1 = a1 + 2 * np.pi * np.round((a0 - a1).mean() / (2 * np.pi))

    def at(s: float) -> ComplexArray:
        place = (1 - s) * centre + s * other
        mixed: ComplexArray = place + ((1 - s) * r0 + s * r1) * np.exp(1j * ((1 - s) * a0 + s * a1))
        return mixed

    places = [x]
    for end in _spaced(field, at, x, y):
        if end is None:
            return None
        places.append(end)
    return places[1:-1]


def _spaced(
    field: Field, at: Callable[[float], ComplexArray], x: ComplexArray, y: ComplexArray
) -> Iterator[ComplexArray | None]:
    """Places along a path, near enough to each other for clear straight moves; None where that fails."""
    todo = [(k + 1) / STAR_STEPS for k in range(STAR_STEPS)][::-1]
    here, z = 0.0, x
    while todo:
        s = todo[-1]
        target = y if s == 1 else at(s)
        if clear_moves(field.chains, z[None], target[None])[0]:
            here, z = todo.pop(), target
            yield z
        elif s - here < 1e-4:
            yield None
            return
        else:
            todo.append((here + s) / 2)
