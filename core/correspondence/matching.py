"""The automatic correspondence: even arc length between anchors, from the best start."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from core.correspondence.pairing import Anchor, Correspondence, ordered_anchors
from core.geometry.outline import FloatArray, as_points, perimeter, positions_at_lengths, resample, signed_area

SAMPLES = 256


def match(
    a: npt.ArrayLike, b: npt.ArrayLike, anchors: Sequence[Anchor] = (), *, closed: bool = True
) -> Correspondence:
    """Return the correspondence of two outlines that keeps every anchor.

    Parameters
    ----------
    a, b : (n, 2), (m, 2) array_like
        The outlines before and after, in px; any vertex counts.
    anchors : sequence of (float, float)
        Pairs of positions that must correspond.
    closed : bool
        Whether the outlines are closed (both) or open (both).

    Returns
    -------
    Correspondence

    Raises
    ------
    GeometryError
        If an outline cannot be drawn.
    CorrespondenceError
        If the anchors cross.
    """
    p, q = as_points(a, name="before", closed=closed), as_points(b, name="after", closed=closed)
    counts = (len(p), len(q))
    before, after, flipped = ordered_anchors(anchors, counts, closed=closed)
    if not closed:
        flipped = _nearer_backwards(p, q) if flipped is None else flipped
        inner = (before > 0) & (before < counts[0] - 1)
        ends = (counts[1] - 1.0, 0.0) if flipped else (0.0, counts[1] - 1.0)
        before = np.concatenate([[0.0], before[inner], [counts[0] - 1.0]])
        after = np.concatenate([[ends[0]], after[inner], [ends[1]]])
        return Correspondence(before, after, counts, closed=False, flipped=flipped)
    if flipped is None:
        flipped = bool(signed_area(p) * signed_area(q) < 0)
    if not len(before):
        before, after = np.zeros(1), _best_start(p, q, flipped)
    return Correspondence(before, after, counts, flipped=flipped)


def _nearer_backwards(p: FloatArray, q: FloatArray) -> bool:
    a, b = resample(p, 64, closed=False), resample(q, 64, closed=False)
    a, b = a - a.mean(axis=0), b - b.mean(axis=0)
    return bool(((a - b[::-1]) ** 2).sum() < ((a - b) ** 2).sum())


def _best_start(p: FloatArray, q: FloatArray, flipped: bool) -> FloatArray:
    """Position on `q` for vertex 0 of `p`: the shift of even samples with the least sum of squared distances."""
    a, b = (resample(x, SAMPLES) for x in (p, q))
    z, w = (x[:, 0] - x[:, 0].mean() + 1j * (x[:, 1] - x[:, 1].mean()) for x in (a, b))
    if flipped:
        w = np.roll(w[::-1], 1)
    likeness = np.fft.ifft(np.conj(np.fft.fft(z)) * np.fft.fft(w)).real
    shift = int(likeness.argmax()) / SAMPLES * perimeter(q)
    return np.atleast_1d(positions_at_lengths(q, -shift if flipped else shift))
