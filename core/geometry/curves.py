"""Cubic curves drawn as polygons, with no more vertices than the eye needs."""

import numpy as np
import numpy.typing as npt

from core.geometry.outline import FloatArray

ComplexArray = npt.NDArray[np.complex128]
"""Points as x + iy: control points are then single numbers."""

MANY = 8
"""A curve of this many chords is cut in two, each half with as many as it needs: few where nearly straight."""

MOST_CUTS = 6


def flatten(curves: ComplexArray, straight: npt.NDArray[np.bool_], tolerance: float) -> FloatArray:
    """Return the vertices of a chain of cubic curves.

    Parameters
    ----------
    curves : (k, 4) complex array
        Control points in px; each curve begins where the one before it ends.
    straight : (k,) bool array
        Curves that are straight lines whatever their control points say.
    tolerance : float
        Largest distance in px between a curve and its chords, above 0.

    Returns
    -------
    (n, 2) float array
        From the start of the first curve to the end of the last; a straight line is one edge.

    Notes
    -----
    Equal steps of the parameter, as many as the second derivative asks for (Wang 1984).
    """
    if straight.all():
        corners = np.concatenate([curves[:1, 0], curves[:, 3]])
        return np.column_stack([corners.real, corners.imag])
    curves, counts = _cut(curves, straight, tolerance)
    ends = 1 + np.cumsum(counts)
    chain = np.zeros(ends[-1], dtype=np.complex128)
    chain[0] = curves[0, 0]
    for count in np.unique(counts).tolist():
        chosen = np.flatnonzero(counts == count)
        t = np.arange(1, count + 1) / count
        powers = np.stack([(1 - t) ** 3, 3 * (1 - t) ** 2 * t, 3 * (1 - t) * t * t, t**3])
        places = (ends[chosen] - count)[:, None] + np.arange(count)
        chain[places] = curves[chosen] @ powers
    chain[ends - 1] = curves[:, 3]
    return np.column_stack([chain.real, chain.imag])


def count_chords(curves: ComplexArray, straight: npt.NDArray[np.bool_], tolerance: float) -> int:
    """Return about how many edges `flatten` makes, before it makes them."""
    return len(curves) if straight.all() else int(_chord_counts(curves, straight, tolerance).sum())


def _cut(
    curves: ComplexArray, straight: npt.NDArray[np.bool_], tolerance: float
) -> tuple[ComplexArray, npt.NDArray[np.int64]]:
    """Return the curves, those that need many chords in pieces, and the chords of each."""
    for _ in range(MOST_CUTS):
        counts = _chord_counts(curves, straight, tolerance)
        many = counts >= MANY
        if not many.any():
            break
        a, b, c, d = curves.T
        ab, bc, cd = (a + b) / 2, (b + c) / 2, (c + d) / 2
        abc, bcd = (ab + bc) / 2, (bc + cd) / 2
        middle = (abc + bcd) / 2
        first = np.where(many[:, None], np.column_stack([a, ab, abc, middle]), curves)
        second = np.column_stack([middle, bcd, cd, d])[many]
        after = 1 + np.flatnonzero(many)
        curves = np.insert(first, after, second, axis=0)
        straight = np.insert(straight, after, False)
    return curves, _chord_counts(curves, straight, tolerance)


def _chord_counts(
    curves: ComplexArray, straight: npt.NDArray[np.bool_], tolerance: float
) -> npt.NDArray[np.int64]:
    a, b, c, d = curves.T
    bend = np.maximum(np.abs(a - 2 * b + c), np.abs(b - 2 * c + d))
    counts = np.ceil(np.sqrt(0.75 * bend / tolerance)).astype(np.int64)
    counts[straight | _hugs_chord(curves, tolerance / 4)] = 1
    at_least_one: npt.NDArray[np.int64] = np.maximum(counts, 1)
    return at_least_one


def _hugs_chord(curves: ComplexArray, tolerance: float) -> npt.NDArray[np.bool_]:
    """Whether the control points lie on the chord between its ends: a line that was saved as a curve."""
    a, b, c, d = curves.T
    chord = d - a
    length = np.abs(chord)
    unit = np.divide(chord, length, out=np.ones_like(chord), where=length > 0)
    near: npt.NDArray[np.bool_] = length > 0
    for control in (b, c):
        off = (control - a) * unit.conj()
        near &= (np.abs(off.imag) <= tolerance) & (off.real >= -tolerance) & (off.real <= length + tolerance)
    return near
