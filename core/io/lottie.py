"""Reading Lottie: shape layers become layers, their keyframes keyframes; the rest is named.

A path keeps its vertices from keyframe to keyframe, so they are paired one to one and travel straight, as in the
player. Where a group or layer turns, every frame becomes a keyframe: straight ways would not turn.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from core.correspondence.pairing import Correspondence
from core.errors import FileFormatError, InkbetweenError
from core.geometry.outline import FloatArray
from core.io.film import ImportedFilm, ImportedLayer
from core.io.lottie_parts import Placing, Shape, ShapePath, all_keys, growth, matrix_at
from core.io.lottie_shapes import beziers, ellipse, polygons, rectangle
from core.io.lottie_values import keys_of, number, vector_at
from core.io.storage import read_whole
from core.io.svg_notes import Notes
from core.model.document import LONGEST, Keyframe, OutlinePair, Span
from core.model.drawing import WIDEST_STROKE, Drawing, Outline, Style
from core.model.easing import Easing

HELD = Span("linear", hold=True)
"""The drawing stays until the next keyframe."""

LARGEST_FILE = 64 * 1024 * 1024
MOST_VERTICES = 5_000_000
DEEPEST = 50

LAYERS = {0: "composition inside", 1: "plain colour layer", 2: "picture", 5: "text", 6: "sound", 13: "camera"}
ITEMS = {
    "tm": "trimmed path",
    "rp": "repeater",
    "mm": "merged path",
    "sr": "star",
    "rd": "rounded corner",
    "pb": "pucker and bloat",
    "zz": "zig zag",
    "tw": "twist",
    "op": "offset path",
}


def read_lottie(content: bytes | Path | str) -> ImportedFilm:
    """Return the shape layers of a Lottie animation.

    Parameters
    ----------
    content : bytes or path
        The file itself, or where it lies.

    Returns
    -------
    ImportedFilm
        A layer for every group that is painted, and the names of what was left out.

    Raises
    ------
    FileFormatError
        No Lottie animation, a damaged one, or one without shapes; one sentence.
    StorageError
        The file cannot be read.
    """
    name = "" if isinstance(content, bytes) else Path(content).name
    body = content if isinstance(content, bytes) else read_whole(Path(content), LARGEST_FILE)
    try:
        return _Reader(_decoded(body)).read()
    except InkbetweenError as e:
        raise FileFormatError(f"cannot import {name}: {e}" if name else str(e)) from None
    except (KeyError, TypeError, AttributeError, IndexError, ValueError, OverflowError, RecursionError):
        what = "it is no Lottie animation, or it is damaged"
        raise FileFormatError(f"cannot import {name}: {what}" if name else what) from None


def _decoded(body: bytes) -> Any:
    try:
        found = msgspec.json.decode(body)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        raise FileFormatError("it is no Lottie animation, or it is damaged") from None
    if not isinstance(found, dict) or not isinstance(found.get("layers"), list) or "fr" not in found:
        raise FileFormatError("it is no Lottie animation")
    return found


class _Reader:
    """Walks one animation."""

    def __init__(self, data: Any) -> None:
        self._data = data
        self._notes = Notes()
        self._first, self._last = number(data.get("ip", 0)), number(data["op"])
        self._size = (max(number(data["w"]), 1.0), max(number(data["h"]), 1.0))
        self._by_index = {x["ind"]: x for x in data["layers"] if isinstance(x, dict) and "ind" in x}
        self._vertices = 0
        self.background: str | None = None

    def read(self) -> ImportedFilm:
        length = round(self._last - self._first)
        if not 1 <= length <= LONGEST:
            raise FileFormatError(f"it has {length} frames; 1 to {LONGEST} can be read")
        found: list[ImportedLayer] = []
        for layer in reversed(self._data["layers"]):
            found += self._layer(layer)
        joined = _joined(found)
        if not joined:
            rest = f" (only {', '.join(self._notes.names())})" if self._notes.names() else ""
            raise FileFormatError("there is no shape in it that could be drawn" + rest)
        rate = Fraction(number(self._data["fr"])).limit_denominator(100_000)
        rate = min(max(rate, Fraction(1, 100)), Fraction(1000))
        return ImportedFilm(tuple(joined), self._size, length, rate, self.background, self._notes.names())

    # layers

    def _layer(self, layer: Any) -> Iterator[ImportedLayer]:
        kind = layer.get("ty")
        if layer.get("hd"):
            return
        if kind == 1 and self._is_background(layer):
            alpha = round(float(vector_at(keys_of(layer["ks"].get("o")), 0, 1, 100.0)[0]) * 255 / 100)
            self.background = str(layer["sc"])[:7].lower() + ("" if alpha >= 255 else f"{max(alpha, 0):02x}")
            return
        if kind != 4:
            if kind != 3:  # an empty one only leads others
                self._notes(LAYERS.get(kind, "unknown layer"))
            return
        for key, word in (("masksProperties", "mask"), ("tt", "matte"), ("ef", "effect")):
            if layer.get(key):
                self._notes(word)
        shapes = list(self._walk(layer.get("shapes", []), self._placings(layer), 0, str(layer.get("nm", ""))))
        opacity = self._opacity(layer["ks"].get("o"))
        shift = number(layer.get("st", 0))
        for shape in reversed(shapes):
            shape.opacity *= opacity
            keyframes = self._keyframes(shape, number(layer["ip"]), number(layer["op"]), shift)
            if keyframes:
                yield ImportedLayer(shape.name, keyframes)

    def _is_background(self, layer: Any) -> bool:
        large = number(layer.get("sw", 0)) >= self._size[0] and number(layer.get("sh", 0)) >= self._size[1]
        color = str(layer.get("sc", ""))
        return large and layer is self._data["layers"][-1] and len(color) == 7 and color.startswith("#")

    def _placings(self, layer: Any) -> tuple[Placing, ...]:
        """Return the transforms from the outermost leader to the layer itself."""
        chain, seen = [layer], {id(layer)}
        while "parent" in chain[-1]:
            leader = self._by_index.get(chain[-1]["parent"])
            if leader is None or id(leader) in seen:
                break
            seen.add(id(leader))
            chain.append(leader)
        return tuple(Placing.of(x["ks"], self._notes) for x in reversed(chain))

    def _opacity(self, prop: Any) -> float:
        keys = keys_of(prop)
        if len(keys) > 1:
            self._notes("changing opacity")
        return min(max(float(vector_at(keys, keys[0].time if keys else 0, 1, 100.0)[0]) / 100, 0.0), 1.0)

    # shapes

    def _walk(self, items: Any, placings: tuple[Placing, ...], depth: int, name: str) -> Iterator[Shape]:
        """Yield what is painted in a group, from the front to the back; paints take the paths before them."""
        if depth > DEEPEST:
            raise FileFormatError(f"its groups lie more than {DEEPEST} deep in each other")
        for item in items:
            if item.get("ty") == "tr":
                placings = (*placings, Placing.of(item, self._notes))
        faded = [self._opacity(x.get("o")) for x in items if x.get("ty") == "tr"]
        paths: list[ShapePath] = []
        painted = Shape([], opacity=faded[0] if faded else 1.0, name=name)
        for item in items:
            kind = item.get("ty")
            if item.get("hd"):
                continue
            if kind in ("sh", "rc", "el"):
                paths.append(self._path(item, placings))
            elif kind == "gr":
                for inner in self._walk(item.get("it", []), placings, depth + 1, name):
                    inner.opacity *= painted.opacity
                    if inner.fill is None and inner.stroke is None:
                        paths += inner.paths
                    else:
                        yield inner
            elif kind in ("fl", "gf"):
                painted.fill = painted.fill or self._paint(item, kind == "gf")
                painted.paths = list(paths)
            elif kind in ("st", "gs"):
                painted.stroke = painted.stroke or self._paint(item, kind == "gs")
                painted.paths = list(paths)
            elif kind in ITEMS:
                self._notes(ITEMS[kind])
        if paths:
            painted.paths = painted.paths or paths
            yield painted

    def _paint(self, item: Any, gradient: bool) -> Any:
        if gradient:
            self._notes("gradient")
            first = vector_at(keys_of(item["g"]["k"]), 0, 4)[1:]
            return {**item, "c": {"k": [float(c) for c in first]}}
        return item

    def _path(self, item: Any, placings: tuple[Placing, ...]) -> ShapePath:
        names = ("ks",) if item["ty"] == "sh" else ("p", "s", "r")
        return ShapePath(item, placings, {n: keys_of(item.get(n)) for n in names})

    # keyframes

    def _keyframes(self, shape: Shape, start: float, end: float, shift: float) -> tuple[Keyframe, ...]:
        """Return the keyframes of what is painted alike, empty where the layer is not seen."""
        if shape.fill is None and shape.stroke is None:
            return ()
        start, end = max(start, self._first), min(end, self._last)
        if not shape.paths or end <= start:
            return ()
        times = self._times(shape, start - shift, end - shift)
        spans = [self._span(shape, a, b) for a, b in pairwise(times)]
        drawings = self._drawings(shape, times)
        if drawings is None:
            return ()
        pairs = _pairs(drawings[0])
        keyframes = [
            Keyframe(round(t + shift - self._first) + 1, d, replace(s, pairs=() if s is HELD else pairs))
            for t, d, s in zip(times, drawings, [*spans, HELD], strict=True)
        ]
        return self._closed_off(keyframes, end)

    def _closed_off(self, keyframes: list[Keyframe], end: float) -> tuple[Keyframe, ...]:
        """Return the keyframes with an empty one where the layer ends before the film does."""
        last = round(end - self._first) + 1
        if end < self._last:
            keyframes = [k for k in keyframes if k.frame < last]
            keyframes[-1] = replace(keyframes[-1], span=HELD)
            keyframes.append(Keyframe(last, Drawing(), HELD))
        return tuple(keyframes)

    def _times(self, shape: Shape, start: float, end: float) -> list[float]:
        """Return the times of the keyframes, each in another frame."""
        found = {k.time for p in shape.paths for keys in p.keys.values() if len(keys) > 1 for k in keys}
        for placing in {id(x): x for p in shape.paths for x in p.placings}.values():
            found |= placing.times()
        inside = sorted(t for t in found if start < t < end)
        beyond = min((t for t in found if t >= end), default=None)
        times = [start, *inside]
        if beyond is not None and end - 1 > times[-1]:
            times.append(end - 1)
        return [
            t
            for t, before in zip(times, [None, *times], strict=False)
            if before is None or round(t) > round(before)
        ]

    def _span(self, shape: Shape, start: float, end: float) -> Span:
        """Return how one keyframe becomes the next: held, or straight with the easing all agree on."""
        moving = [keys for keys in all_keys(shape) if len(keys) > 1]
        here = [k for keys in moving for k, n in pairwise(keys) if k.time <= start and n.time >= end]
        if all(k.held for k in here):
            return HELD
        easings = {k.easing for keys in moving for k, n in pairwise(keys) if (k.time, n.time) == (start, end)}
        return Span("linear", easings.pop() if len(easings) == 1 and len(here) == 1 else Easing())

    def _drawings(self, shape: Shape, times: list[float]) -> list[Drawing] | None:
        """Return a drawing for every time, None if none of the paths can be drawn."""
        outlines: list[list[Outline]] = [[] for _ in times]
        for path in shape.paths:
            try:
                moved, closed = self._moved(path, times)
                made = [Outline(len(outlines[0]) + 1, points, closed) for points in moved]
            except InkbetweenError:
                self._notes("path with a mistake")
                continue
            for row, outline in zip(outlines, made, strict=True):
                row.append(outline)
        if not outlines[0]:
            return None
        self._vertices += sum(len(o.points) for row in outlines for o in row)
        if self._vertices > MOST_VERTICES:
            raise FileFormatError(f"it would become more than {MOST_VERTICES} vertices; simplify it first")
        style = self._style(shape, growth(shape, times[0]))
        return [Drawing(tuple(row), style) for row in outlines]

    def _moved(self, path: ShapePath, times: list[float]) -> tuple[list[FloatArray], bool]:
        if path.item["ty"] == "sh":
            shapes = beziers(path.keys["ks"], times)
        else:
            shapes = (rectangle if path.item["ty"] == "rc" else ellipse)(times, path.keys)
        matrices = [matrix_at(path.placings, t) for t in times]
        scale = max(math.sqrt(abs(np.linalg.det(m[:2, :2]))) for m in matrices)
        flat = polygons(shapes, scale)
        return [p @ m[:2, :2].T + m[:2, 2] for p, m in zip(flat, matrices, strict=True)], shapes[0].closed

    def _style(self, shape: Shape, scale: float) -> Style:
        fill, stroke = (self._color(p, shape.opacity) if p else None for p in (shape.fill, shape.stroke))
        width = Style().width
        if shape.stroke:
            keys = keys_of(shape.stroke.get("w"))
            if len(keys) > 1:
                self._notes("changing width")
            width = min(max(float(vector_at(keys, 0, 1, 1.0)[0]) * scale, 0.0), WIDEST_STROKE)
            if shape.stroke.get("d"):
                self._notes("dashed stroke")
        return Style(fill, stroke, width)

    def _color(self, paint: Any, opacity: float) -> str:
        keys = keys_of(paint["c"])
        if len(keys) > 1:
            self._notes("changing colour")
        shade = vector_at(keys, keys[0].time, 3)
        alpha = self._opacity(paint.get("o")) * opacity
        channels = [round(255 * min(max(float(c), 0.0), 1.0)) for c in (*shade, alpha)]
        return "#" + bytes(channels[:3] if channels[3] == 255 else channels).hex()


def _pairs(drawing: Drawing) -> tuple[OutlinePair, ...]:
    """Return every outline paired with itself, vertex by vertex."""
    found = []
    for outline in drawing.outlines:
        count = len(outline.points)
        places = np.arange(count, dtype=np.float64)
        same = Correspondence(places, places, (count, count), outline.closed)
        found.append(OutlinePair(outline.id, outline.id, (), same, chosen=True))
    return tuple(found)


def _joined(layers: list[ImportedLayer]) -> list[ImportedLayer]:
    """Join layers of one name that follow each other in time: one layer that had to be cut into stretches."""
    found: list[ImportedLayer] = []
    for layer in sorted(layers, key=lambda x: x.keyframes[0].frame) if _is_chain(layers) else layers:
        last = found[-1] if found else None
        if last is not None and last.name == layer.name and _follows(last, layer):
            found[-1] = ImportedLayer(layer.name, (*last.keyframes[:-1], *layer.keyframes))
        else:
            found.append(layer)
    return found


def _is_chain(layers: list[ImportedLayer]) -> bool:
    return len({x.name for x in layers}) == 1


def _follows(before: ImportedLayer, after: ImportedLayer) -> bool:
    end = before.keyframes[-1]
    return not end.drawing.outlines and end.frame == after.keyframes[0].frame
