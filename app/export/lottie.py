"""Lottie: every stretch of a layer is a shape layer whose paths have keyframes of vertices."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from app.export.film import Film
from app.export.shapes import Moment, ShapeLayer, Stretch, shape_layers
from app.export.svg import box_of
from app.export.whole import write_whole
from core.geometry.outline import FloatArray
from core.model.drawing import Color
from core.model.easing import Easing

VERSION = "5.7.0"
"""Of the player that all of this can be played with."""
ROUND = 2
EVEN_ODD = 2
DIGITS = 3
LINEAR = Easing()

Json = dict[str, Any]
Told = Callable[[object], object]
Asked = Callable[[], bool]


def write(film: Film, path: Path, told: Told, cancelled: Asked) -> bool:
    """Write the film; False if it was cancelled, and then there is no file."""
    made = lottie(film)
    if cancelled():
        return False
    write_whole(path, json.dumps(made, separators=(",", ":"), ensure_ascii=False).encode() + b"\n")
    for shot in film.shots():
        told(shot)
    return True


def lottie(film: Film) -> Json:
    """Return the animation as what JSON can hold."""
    width, height = film.settings.size
    count = film.settings.last - film.settings.first + 1
    layers = [_layer(film, x, s, count) for x in shape_layers(film) for s in x.stretches]
    if film.background is not None:
        layers.insert(0, _solid(film.background, (width, height), count))
    layers.reverse()  # Lottie names the one in front first
    return {
        "v": VERSION,
        "fr": _plain(float(film.document.rate)),
        "ip": 0,
        "op": count,
        "w": width,
        "h": height,
        "nm": film.settings.name,
        "ddd": 0,
        "assets": [],
        "layers": [layer | {"ind": i} for i, layer in enumerate(layers, start=1)],
    }


def _solid(color: Color, size: tuple[int, int], count: int) -> Json:
    return _head("background", 0, count, _transform(_alpha(color) * 100)) | {
        "ty": 1,
        "sw": size[0],
        "sh": size[1],
        "sc": color[:7],
    }


def _head(name: str, start: float, end: float, transform: Json) -> Json:
    times = {"ip": _plain(start), "op": _plain(end), "st": 0}
    return {"ddd": 0, "nm": name, "sr": 1, "ao": 0, "bm": 0, "ks": transform, **times}


def _transform(opacity: float, place: Sequence[float] = (0, 0, 0), scale: float = 100) -> Json:
    return {
        "o": _still(opacity),
        "r": _still(0),
        "p": _still(list(place)),
        "a": _still([0, 0, 0]),
        "s": _still([scale, scale, 100]),
    }


def _layer(film: Film, layer: ShapeLayer, stretch: Stretch, count: int) -> Json:
    """Return one stretch; the stage is fitted into the picture by the layer's transform."""
    x, y, wide, _ = box_of(film.document.stage, film.settings.size)
    scale = film.settings.size[0] / wide
    transform = _transform(100, (_plain(-x * scale), _plain(-y * scale), 0), _plain(100 * scale))
    transform["o"] = _animated(stretch, [[100 * m.picture.opacity] for m in stretch.moments])
    end = count if stretch.end >= count else stretch.end
    return _head(layer.name, stretch.start, end, transform) | {"ty": 4, "shapes": _groups(stretch)}


def _groups(stretch: Stretch) -> list[Json]:
    """Return the group of the open outlines and that of the closed ones, those in front first."""
    outlines = stretch.moments[0].picture.outlines
    closed = [i for i, (_, is_closed) in enumerate(outlines) if is_closed]
    opened = [i for i, (_, is_closed) in enumerate(outlines) if not is_closed]
    styles = [m.picture.style for m in stretch.moments]
    groups = []
    if opened:
        lines = [style.stroke or style.fill for style in styles]
        groups.append(_group("lines", _paths(stretch, opened) + _stroke(stretch, lines)))
    if closed:
        paints = _stroke(stretch, [s.stroke for s in styles]) + _fill(stretch, [s.fill for s in styles])
        groups.append(_group("shape", _paths(stretch, closed) + paints))
    return groups


def _group(name: str, items: list[Json]) -> Json:
    transform = _transform(100) | {"ty": "tr", "sk": _still(0), "sa": _still(0)}
    for part in ("p", "a", "s"):
        transform[part] = _still(transform[part]["k"][:2])
    return {"ty": "gr", "nm": name, "it": [*items, transform]}


def _paths(stretch: Stretch, indices: list[int]) -> list[Json]:
    found = []
    for i in indices:
        shapes = [_shape(*m.picture.outlines[i]) for m in stretch.moments]
        found.append({"ty": "sh", "nm": f"outline {i + 1}", "ks": _animated(stretch, [[s] for s in shapes])})
    return found


def _shape(points: FloatArray, closed: bool) -> Json:
    flat = [[0, 0]] * len(points)
    return {"i": flat, "o": flat, "v": (np.round(points, DIGITS) + 0.0).tolist(), "c": closed}


def _fill(stretch: Stretch, colors: list[Color | None]) -> list[Json]:
    if any(c is None for c in colors):
        return []
    return [{"ty": "fl", "nm": "fill", "r": EVEN_ODD, **_color(stretch, colors)}]


def _stroke(stretch: Stretch, colors: list[Color | None]) -> list[Json]:
    widths = [m.picture.style.width for m in stretch.moments]
    if any(c is None for c in colors) or not max(widths) > 0:
        return []
    width = _animated(stretch, [[_plain(w)] for w in widths])
    return [{"ty": "st", "nm": "stroke", "lc": ROUND, "lj": ROUND, "w": width, **_color(stretch, colors)}]


def _color(stretch: Stretch, colors: Sequence[Color | None]) -> Json:
    shades = [[round(c / 255, 5) for c in bytes.fromhex((color or "")[1:7])] + [1] for color in colors]
    alphas = [[_plain(100 * _alpha(color or ""))] for color in colors]
    return {"c": _animated(stretch, shades), "o": _animated(stretch, alphas)}


def _alpha(color: Color) -> float:
    return int(color[7:], 16) / 255 if len(color) == 9 else 1.0


def _still(value: object) -> Json:
    return {"a": 0, "k": value}


def _animated(stretch: Stretch, values: list[list[Any]]) -> Json:
    """Return a property: still if it never changes, otherwise with a keyframe a moment."""
    if all(v == values[0] for v in values):
        return _still(values[0] if isinstance(values[0][0], int | float) and len(values[0]) > 1 else values[0][0])
    easing = stretch.easing or LINEAR
    keys = [_key(m, v, held=stretch.held, easing=easing) for m, v in zip(stretch.moments, values, strict=True)]
    keys[-1] = {"t": keys[-1]["t"], "s": keys[-1]["s"]} | ({"h": 1} if stretch.held else {})
    return {"a": 1, "k": keys}


def _key(moment: Moment, value: list[Any], *, held: bool, easing: Easing) -> Json:
    key: Json = {"t": _plain(moment.time), "s": value}
    if held:
        return key | {"h": 1}
    out = {"x": [_plain(easing.x1)], "y": [_plain(easing.y1)]}
    into = {"x": [_plain(easing.x2)], "y": [_plain(easing.y2)]}
    return key | {"o": out, "i": into}


def _plain(value: float) -> float:
    """Return a number without a tail of nines, whole ones as whole."""
    short = round(float(value), 5)
    return int(short) if short == int(short) else short
