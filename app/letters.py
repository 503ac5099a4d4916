"""The outlines of letters in any installed font."""

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QFont, QFontMetricsF, QPainterPath

from core.geometry.curves import flatten
from core.geometry.outline import SMALLEST_SIZE, FloatArray, size
from core.geometry.simplify import without_repeats
from core.geometry.winding import even_odd

LARGE = 1000
"""Pixels of the letters when they are taken from the font, so that no hinting bends them."""

TOLERANCE = 0.25
FINE = 4000
CURVE, CURVE_MORE, MOVE = (
    QPainterPath.ElementType.CurveToElement,
    QPainterPath.ElementType.CurveToDataElement,
    QPainterPath.ElementType.MoveToElement,
)


def letter_outlines(text: str, font: QFont, height: float, middle: tuple[float, float]) -> list[FloatArray]:
    """Return the closed outlines of a text, to be filled even-odd: holes are outlines of their own.

    `height` is the font's size in px of the stage, `middle` where the middle of the text goes. Several lines stand
    under each other, centred. What fonts draw as overlapping parts becomes one outline. No outline is left of
    spaces.
    """
    path = _path(text, font)
    scale = height / LARGE
    outlines = _outlines(path, scale)
    if not outlines:
        return []
    chosen = even_odd(outlines)
    if not chosen.exact:
        path.setFillRule(Qt.FillRule.WindingFill)
        outlines = _outlines(path.simplified(), scale)
    elif len(chosen.kept) < len(outlines):
        outlines = [outlines[i] for i in chosen.kept]
    every = np.concatenate(outlines)
    shift = np.array(middle) - (every.min(axis=0) + every.max(axis=0)) / 2
    return [o + shift for o in outlines]


def _path(text: str, font: QFont) -> QPainterPath:
    large = QFont(font)
    large.setPixelSize(LARGE)
    large.setHintingPreference(QFont.HintingPreference.PreferNoHinting)
    measure = QFontMetricsF(large)
    path = QPainterPath()
    for i, line in enumerate(text.splitlines()):
        path.addText(-measure.horizontalAdvance(line) / 2, i * measure.lineSpacing(), large, line)
    return path


def _outlines(path: QPainterPath, scale: float) -> list[FloatArray]:
    """Return the subpaths as polygons, curves as near as 0.25 px of the stage (nearer for small letters)."""
    tolerance = min(TOLERANCE, scale * LARGE / FINE * 4)
    found = []
    for curves, straight in _subpaths(path):
        points = flatten(scale * np.array(curves), np.array(straight), tolerance)
        points = without_repeats(np.concatenate([points, points[:1]]))[:-1]
        if len(points) >= 3 and size(points) > SMALLEST_SIZE:
            found.append(points)
    return found


def _subpaths(path: QPainterPath) -> list[tuple[list[list[complex]], list[bool]]]:
    """Return each subpath as cubic curves, and which of them are straight."""
    found: list[tuple[list[list[complex]], list[bool]]] = []
    at = 0j
    for i in range(path.elementCount()):
        element = path.elementAt(i)
        point = complex(element.x, element.y)
        if element.type == CURVE_MORE:
            found[-1][0][-1].append(point)
            at = point
        elif element.type == MOVE:
            found.append(([], []))
            at = point
        else:
            curved = element.type == CURVE
            found[-1][0].append([at, point] if curved else [at, at, point, point])
            found[-1][1].append(not curved)
            at = point
    return [subpath for subpath in found if subpath[0]]
