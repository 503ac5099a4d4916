"""An outline through all frames, with what is measured once."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.errors import GeometryError
from core.geometry.crossings import crossings
from core.geometry.outline import FloatArray, contains, edge_lengths, signed_area

SMALL = 1e-3
"""Sizes of the outline: nobody sees an edge below this collapse, or explode."""


@dataclass(frozen=True, eq=False)
class View:
    """An outline with what is measured once: `ends` (2, n, 2) are the keyframes."""

    index: int
    closed: bool
    frames: FloatArray
    ends: FloatArray
    finite: npt.NDArray[np.bool_]
    lengths: FloatArray
    end_lengths: FloatArray
    size: float
    name: str

    @property
    def area(self) -> FloatArray:
        """Signed areas (T,) in px^2."""
        return np.asarray(signed_area(self.frames), np.float64)

    def crosses(self) -> list[str]:
        """Which of the keyframes cross themselves."""
        names = ("before", "after")
        return [s for s, end in zip(names, self.ends, strict=True) if len(crossings(end, closed=self.closed))]


def views_of(
    frames: Sequence[npt.ArrayLike],
    closed: Sequence[bool],
    before: Sequence[npt.ArrayLike] | None,
    after: Sequence[npt.ArrayLike] | None,
) -> list[View]:
    """Check the arrays and measure the outlines; `GeometryError` where they do not fit each other."""
    if len(frames) != len(closed):
        raise GeometryError(f"there are {len(frames)} outlines, but {len(closed)} say whether they are closed")
    for name, ends in (("before", before), ("after", after)):
        if ends is not None and len(ends) != len(frames):
            raise GeometryError(f"{name} has {len(ends)} outlines, the frames have {len(frames)}")
    views = []
    for k, outline in enumerate(frames):
        p = np.asarray(outline, np.float64)
        if p.ndim != 3 or p.shape[2] != 2:
            raise GeometryError(f"frames of outline {k} have the shape {p.shape}; expected (T, n, 2)")
        if not len(p):
            raise GeometryError("there is no frame to certify")
        if len(p) != np.shape(frames[0])[0]:
            raise GeometryError(f"outline {k} has {len(p)} frames, outline 0 has {np.shape(frames[0])[0]}")
        sides = [p[i] if ends is None else ends[k] for ends, i in ((before, 0), (after, -1))]
        views.append(_view(k, bool(closed[k]), p, sides, f"outline {k}: " if len(frames) > 1 else ""))
    return views


def _view(index: int, closed: bool, p: FloatArray, sides: Sequence[npt.ArrayLike], name: str) -> View:
    ends = []
    for side, text in zip(sides, ("before", "after"), strict=True):
        q = np.asarray(side, np.float64)
        if q.shape != p.shape[1:]:
            raise GeometryError(f"{name}{text} has the shape {q.shape}, a frame {p.shape[1:]}")
        ends.append(q)
    finite = np.isfinite(p).all(axis=(1, 2))
    p = np.where(np.isfinite(p), p, 0.0)
    both = np.where(np.isfinite(ends), ends, 0.0)
    size = float(np.ptp(both, axis=1).max())
    lengths, end_lengths = (edge_lengths(q, closed=closed) for q in (p, both))
    return View(index, closed, p, both, np.asarray(finite), lengths, end_lengths, size, name)


def factors(lengths: FloatArray, end_lengths: FloatArray, times: FloatArray, size: float) -> FloatArray:
    """Factors (T, n) by which edges are longer than between the keyframes, all lengths with a floor."""
    s = np.clip(times, 0.0, 1.0)[:, None]
    between = (1 - s) * end_lengths[0] + s * end_lengths[1]
    floor = max(SMALL * size, np.finfo(np.float64).tiny)
    return np.asarray((lengths + floor) / (between + floor), np.float64)


def stretch_of(view: View, times: FloatArray) -> FloatArray:
    """Largest factor of an edge, longer or shorter, of every frame."""
    factor = factors(view.lengths, view.end_lengths, times, view.size)
    return np.asarray(np.maximum(factor, 1 / factor).max(axis=1), np.float64)


def winding(view: View, views: list[View]) -> int:
    """1 for an outline that fills, -1 for one that is a hole in the first keyframe in which it has an area."""
    k = 0 if np.ptp(view.ends[0], axis=0).max() > 0 else 1
    point = view.ends[k, 0]
    around = [v for v in views if v is not view and v.closed and contains(v.ends[k], point)[0]]
    return -1 if len(around) % 2 else 1
