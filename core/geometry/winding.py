"""How often outlines run round a place, and the same area under another rule of filling."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray, edge_vectors, signed_area, size

CELLS = 2_000_000
"""Places times edges looked at in one go."""

MOST_SAMPLES = 96
BESIDE = 1e-4
"""Distance from an edge at which both its sides are looked at, as a share of the size."""


@dataclass(frozen=True, slots=True)
class EvenOdd:
    """Outlines to be filled even-odd in place of others that were filled nonzero.

    Attributes
    ----------
    kept : tuple of int
        Which of the outlines bound the area.
    exact : bool
        False where outlines cross themselves or each other, so that some area looks different.
    """

    kept: tuple[int, ...]
    exact: bool


def winding(points: FloatArray, places: FloatArray) -> npt.NDArray[np.int64]:
    """Return how often a closed outline runs round each place, (k, 2) -> (k,).

    Positive where it turns from x to y.
    """
    found = np.zeros(len(places), dtype=np.int64)
    step = max(1, CELLS // len(points))
    for first in range(0, len(places), step):
        found[first : first + step] = _winding(points, places[first : first + step])
    return found


def even_odd(outlines: list[FloatArray]) -> EvenOdd:
    """Choose the closed outlines that, filled even-odd, cover what all of them cover when filled nonzero.

    An outline inside another one that runs the same way bounds nothing and is left out; one that runs the other
    way is a hole and stays.

    Notes
    -----
    Exact for outlines that do not cross. Whether they do shows on both sides of 96 places of them.
    """
    boxes = np.array([(o.min(axis=0), o.max(axis=0)) for o in outlines])
    places = _beside_edges(outlines)
    rounds = [winding(o, places) for o in outlines]
    filled = np.sum(rounds, axis=0) != 0
    best = EvenOdd(tuple(range(len(outlines))), exact=False)
    least = len(places) + 1
    for kept in (best.kept, tuple(i for i in best.kept if _bounds(i, outlines, boxes))):
        wrong = int((filled != (np.sum([rounds[i] for i in kept], axis=0) % 2 == 1)).sum()) if kept else least
        if wrong < least:
            best, least = EvenOdd(kept, exact=wrong == 0), wrong
    return best


def _bounds(index: int, outlines: list[FloatArray], boxes: FloatArray) -> bool:
    """Whether one side of an outline is filled and the other is not."""
    own = outlines[index]
    place = (own[:1] + own[1:2]) / 2
    around = np.all((boxes[:, 0] <= place) & (place <= boxes[:, 1]), axis=1)
    around[index] = False
    outside = sum(int(winding(outlines[i], place)[0]) for i in np.flatnonzero(around))
    inside = outside + (1 if signed_area(own) > 0 else -1)
    return (outside == 0) != (inside == 0)


def _winding(points: FloatArray, places: FloatArray) -> npt.NDArray[np.int64]:
    x, y = points.T
    dx, dy = edge_vectors(points).T
    px, py = places[:, :1], places[:, 1:]
    starts_above, ends_above = y <= py, y + dy <= py
    side = dx * (py - y) - dy * (px - x)
    ahead = starts_above & ~ends_above & (side < 0)
    back = ~starts_above & ends_above & (side > 0)
    found: npt.NDArray[np.int64] = back.sum(axis=1) - ahead.sum(axis=1)
    return found


def _beside_edges(outlines: list[FloatArray]) -> FloatArray:
    """Return places on both sides of the outlines, evenly spread along them."""
    starts = np.concatenate(outlines)
    vectors = np.concatenate([edge_vectors(o) for o in outlines])
    lengths = np.hypot(vectors[:, 0], vectors[:, 1])
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    count = min(MOST_SAMPLES, max(8, 10 * CELLS // len(starts)))
    spots = (np.arange(count) + 0.5) / count * along[-1]
    edge = np.clip(np.searchsorted(along, spots, side="right") - 1, 0, len(starts) - 1)
    edge = edge[lengths[edge] > 0]
    unit = vectors[edge] / lengths[edge, None]
    places = starts[edge] + unit * np.clip(spots[: len(edge)] - along[edge], 0, lengths[edge])[:, None]
    off = np.column_stack([-unit[:, 1], unit[:, 0]]) * min(BESIDE * size(starts), float(lengths[edge].min()) / 4)
    return np.concatenate([places + off, places - off])
