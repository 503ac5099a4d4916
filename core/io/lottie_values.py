"""Values of Lottie that may change in time: still, or with keyframes and an easing between them."""

import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import Any

import numpy as np

from core.errors import FileFormatError
from core.geometry.outline import FloatArray
from core.model.easing import Easing

MOST_KEYS = 100_000
FARTHEST = 1e7


@dataclass(frozen=True, slots=True)
class Key:
    """A value at a time, and how it goes on to the next one.

    Attributes
    ----------
    time : float
        Frames.
    value : object
        As it stands in the file.
    held : bool
        Whether it stays until the next one.
    easing : Easing
    """

    time: float
    value: Any
    held: bool
    easing: Easing


def keys_of(prop: Any) -> list[Key]:
    """Return the keyframes of a property; a still one has a single one, at time 0."""
    if prop is None:
        return []
    value = prop["k"]
    moving = isinstance(value, list) and value and isinstance(value[0], dict) and "t" in value[0]
    if not moving:
        return [Key(0.0, value, True, Easing())]
    if len(value) > MOST_KEYS:
        raise FileFormatError(f"a value has {len(value)} keyframes, at most {MOST_KEYS} can be read")
    keys: list[Key] = []
    end = None
    for entry in value:
        start = entry.get("s", end)
        if start is None:
            raise FileFormatError("a keyframe has no value")
        keys.append(Key(number(entry["t"]), start, bool(entry.get("h", 0)), _easing(entry)))
        end = entry.get("e", start)
    return sorted(keys, key=lambda k: k.time)


def number(value: Any) -> float:
    """Return a finite number, or the only one of a list; raises FileFormatError."""
    if isinstance(value, list) and value:
        value = value[0]
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise FileFormatError(f"{str(value)[:40]!r} stands where a number should")
    return float(value)


def numbers(value: Any, count: int) -> FloatArray:
    """Return `count` numbers; what is missing is 0."""
    given = value if isinstance(value, list) else [value]
    found = [number(v) for v in given[:count]]
    return np.array(found + [0.0] * (count - len(found)))


def _easing(entry: Any) -> Easing:
    """Return the easing to the next keyframe; handles that no easing can have are brought into its range."""
    try:
        out, into = entry["o"], entry["i"]
        x1, y1, x2, y2 = (number(v) for v in (out["x"], out["y"], into["x"], into["y"]))
    except (KeyError, TypeError, FileFormatError):
        return Easing()
    return Easing(min(max(x1, 0.0), 1.0), min(max(y1, -4.0), 5.0), min(max(x2, 0.0), 1.0), min(max(y2, -4.0), 5.0))


def share_at(keys: list[Key], time: float) -> tuple[int, float]:
    """Return the keyframe that a time follows and the eased share of the way to the next one."""
    if time <= keys[0].time or len(keys) == 1:
        return 0, 0.0
    index = bisect_right(keys, time, key=lambda k: k.time) - 1
    key = keys[index]
    if index == len(keys) - 1 or key.held:
        return index, 0.0
    ratio = (time - key.time) / (keys[index + 1].time - key.time)
    return index, float(key.easing.t_at(ratio))


def vector_at(keys: list[Key], time: float, count: int, default: float = 0.0) -> FloatArray:
    """Return `count` numbers at a time."""
    if not keys:
        return np.full(count, default)
    index, share = share_at(keys, time)
    here = numbers(keys[index].value, count)
    if share == 0:
        return here
    there = numbers(keys[index + 1].value, count)
    found: FloatArray = here + share * (there - here)
    return found
