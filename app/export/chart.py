"""The timing chart that animators draw beside a keyframe: a ladder, a rung for every in-between."""

import numpy as np

from core.geometry.outline import FloatArray
from core.model.document import Document, Keyframe, Stage
from core.model.drawing import Style
from core.model.inbetweens import Picture
from core.model.timing import drawn_offsets

INK, MARK = "#202028", "#e0483a"
HIGH, WIDE, AWAY = 0.5, 0.02, 0.05
"""Shares of the stage's height, and of its width: length of the ladder, half a rung, room on the right."""

DIGITS = {
    "0": ((0, 0), (1, 0), (1, 2), (0, 2), (0, 0)),
    "1": ((0.1, 0.5), (0.6, 0), (0.6, 2)),
    "2": ((0, 0), (1, 0), (1, 1), (0, 1), (0, 2), (1, 2)),
    "3": ((0, 0), (1, 0), (0.4, 0.9), (1, 0.9), (1, 2), (0, 2)),
    "4": ((0.8, 2), (0.8, 0), (0, 1.3), (1, 1.3)),
    "5": ((1, 0), (0, 0), (0, 0.9), (1, 0.9), (1, 2), (0, 2)),
    "6": ((1, 0), (0, 0), (0, 2), (1, 2), (1, 1), (0, 1)),
    "7": ((0, 0), (1, 0), (0.4, 2)),
    "8": ((0, 0), (1, 0), (1, 2), (0, 2), (0, 0), (0, 1), (1, 1)),
    "9": ((1, 1), (0, 1), (0, 0), (1, 0), (1, 2), (0, 2)),
}
"""Strokes, one wide and two high: numbers without a font."""


def chart_pictures(document: Document, frame: float) -> tuple[Picture, ...]:
    """Return the chart of the span that `frame` lies in; nothing where no layer has a span there."""
    found = _span(document, frame)
    if found is None:
        return ()
    before, after = found
    ladder = _Ladder(document.stage)
    ink, mark = [ladder.line(0.0, 1.0)], []
    length = after.frame - before.frame
    drawn = (*drawn_offsets(before.span, length), length)
    shown = max(o for o in drawn if o <= frame - before.frame)
    for offset in drawn:
        t = float(before.span.easing.t_at(offset / length))
        (mark if offset == shown else ink).append(ladder.rung(t, 1.6 if offset in (0, length) else 1.0))
    ink += ladder.number(before.frame, 0.0) + ladder.number(after.frame, 1.0)
    return _picture(ink, INK, ladder.pen), _picture(mark, MARK, 1.6 * ladder.pen)


def _span(document: Document, frame: float) -> tuple[Keyframe, Keyframe] | None:
    """Return the first visible layer, from the front, with a span at `frame`."""
    for layer in reversed(document.layers):
        before, after = layer.around(frame)
        if layer.visible and before is not None and after is not None:
            return before, after
    return None


def _picture(lines: list[FloatArray], color: str, width: float) -> Picture:
    return Picture(tuple((points, False) for points in lines), Style(None, color, width))


class _Ladder:
    """Where the parts of the chart lie on a stage."""

    def __init__(self, stage: Stage) -> None:
        self._x = stage.width * (1 - AWAY) - 0.01 * stage.height
        self._top = stage.height * (1 - HIGH) / 2
        self._high = stage.height * HIGH
        self._rung = WIDE * stage.height
        self.pen = max(stage.height / 400, 0.5)

    def line(self, start: float, end: float) -> FloatArray:
        return np.array([[self._x, self._y(start)], [self._x, self._y(end)]])

    def rung(self, t: float, long: float) -> FloatArray:
        y, half = self._y(t), self._rung * long
        return np.array([[self._x - half, y], [self._x + half, y]])

    def number(self, value: int, t: float) -> list[FloatArray]:
        """Return the strokes of a number beside the end of the ladder."""
        high = 0.6 * self._rung
        left, top = self._x + 2 * self._rung, self._y(t) - high
        strokes = [np.add(DIGITS[c], (1.6 * i, 0)) for i, c in enumerate(str(value))]
        return [s * high * (0.9, 1.0) + (left, top) for s in strokes]

    def _y(self, t: float) -> float:
        return self._top + self._high * t
