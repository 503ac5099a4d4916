"""What a Lottie animation is painted of while it is read: paths, the transforms they lie in, their paints."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from core.geometry.outline import FloatArray
from core.io.lottie_values import Key, keys_of, number, vector_at
from core.io.svg_notes import Notes
from core.model.document import LONGEST


@dataclass(frozen=True, slots=True)
class Placing:
    """A transform that may move: place, anchor, scale, turn."""

    place: list[Key]
    anchor: list[Key]
    scale: list[Key]
    turn: list[Key]

    @classmethod
    def of(cls, ks: Any, notes: Notes) -> "Placing":
        """Return the transform of a layer or group; what of it cannot be followed is noted."""
        place = ks.get("p")
        if isinstance(place, dict) and "k" not in place:
            parts = [keys_of(place[axis]) for axis in ("x", "y")]
            if any(len(p) > 1 for p in parts):
                notes("place that changes in separate numbers")
            place = {"k": [number(p[0].value) for p in parts]}
        if keys_of(ks.get("sk")) and number(keys_of(ks["sk"])[0].value):
            notes("skew")
        return cls(*(keys_of(v) for v in (place, ks.get("a"), ks.get("s"), ks.get("r"))))

    def times(self) -> set[float]:
        """Return the times at which something changes; every frame while it turns."""
        found = {k.time for keys in (self.place, self.anchor, self.scale) if len(keys) > 1 for k in keys}
        if len(self.turn) > 1:
            first, last = math.ceil(self.turn[0].time), math.floor(self.turn[-1].time)
            found |= {float(t) for t in range(max(first, -LONGEST), min(last, LONGEST) + 1)}
        return found

    def matrix(self, time: float) -> FloatArray:
        """Return the (3, 3) matrix at a time."""
        x, y = vector_at(self.place, time, 2)
        ax, ay = vector_at(self.anchor, time, 2)
        sx, sy = vector_at(self.scale, time, 2, 100.0) / 100
        a = math.radians(float(vector_at(self.turn, time, 1)[0]))
        turn = np.array([[math.cos(a) * sx, -math.sin(a) * sy], [math.sin(a) * sx, math.cos(a) * sy]])
        whole = np.eye(3)
        whole[:2, :2] = turn
        whole[:2, 2] = np.array([x, y]) - turn @ (ax, ay)
        return whole


@dataclass(slots=True)
class ShapePath:
    """A path and the transforms it lies in, the outermost first."""

    item: Any
    placings: tuple[Placing, ...]
    keys: dict[str, list[Key]] = field(default_factory=dict)


@dataclass(slots=True)
class Shape:
    """Paths painted alike."""

    paths: list[ShapePath]
    fill: Any = None
    stroke: Any = None
    opacity: float = 1.0
    name: str = ""


def all_keys(shape: Shape) -> Iterator[list[Key]]:
    """Yield everything of a shape that may move."""
    for path in shape.paths:
        yield from path.keys.values()
    for placing in {id(x): x for p in shape.paths for x in p.placings}.values():
        yield from (placing.place, placing.anchor, placing.scale, placing.turn)


def matrix_at(placings: tuple[Placing, ...], time: float) -> FloatArray:
    """Return the (3, 3) matrix of transforms inside each other, the outermost first."""
    whole = np.eye(3)
    for placing in placings:
        whole = whole @ placing.matrix(time)
    return whole


def growth(shape: Shape, time: float) -> float:
    """Return how much wider strokes become by the transforms."""
    return math.sqrt(abs(float(np.linalg.det(matrix_at(shape.paths[0].placings, time)[:2, :2]))))
