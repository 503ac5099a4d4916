"""Drawings of several outlines: which outline becomes which."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from core.correspondence.ring import ring
from core.errors import CorrespondenceError
from core.geometry.outline import FloatArray, as_points, contains, perimeter, resample

Outline = tuple[npt.ArrayLike, bool]
"""Vertices, and whether they are closed."""

SAMPLES = 64

SIZE, SHAPE = 0.5, 1.0
"""Weights beside the squared distance in the drawing: of the squared logarithm of the sizes, of the form."""

NEVER = 1e6
"""Cost of what cannot pair: closed with open, a hole with what is no hole."""


@dataclass(frozen=True)
class OutlinePairs:
    """Which outline of a drawing becomes which of another.

    Attributes
    ----------
    pairs : tuple of (int, int)
        Indices before and after, by the one before.
    alone_before, alone_after : tuple of int
        Outlines without a partner: they shrink away, they grow.
    """

    pairs: tuple[tuple[int, int], ...]
    alone_before: tuple[int, ...]
    alone_after: tuple[int, ...]


def pair_outlines(
    before: Sequence[Outline], after: Sequence[Outline], fixed: Sequence[tuple[int, int]] = ()
) -> OutlinePairs:
    """Pair the outlines of two drawings so that place in the drawing, size and form differ least in sum.

    Holes go with holes, closed outlines with closed ones. As many pairs are made as these rules allow.

    Parameters
    ----------
    before, after : sequence of (points, closed)
        Outlines in px, in any order; a hole is an outline inside an odd number of others.
    fixed : sequence of (int, int)
        Pairs that the artist has made; a hole may go with a solid here.

    Returns
    -------
    OutlinePairs

    Raises
    ------
    GeometryError
        If an outline cannot be drawn.
    CorrespondenceError
        If a fixed pair names an outline that is not there, or one twice, or closed with open.

    Notes
    -----
    The assignment of least cost (Kuhn 1955); the form is told by the magnitudes of Fourier descriptors (Zahn and
    Roskies 1972), which know neither start nor turn.
    """
    drawings = [_checked(d, name) for d, name in ((before, "before"), (after, "after"))]
    _check_fixed(fixed, *drawings)
    costs = _costs(*(_traits(d) for d in drawings))
    for i, j in fixed:
        costs[i, :], costs[:, j] = NEVER, NEVER
    for i, j in fixed:
        costs[i, j] = -NEVER
    # imported late: it takes longer than all the rest of the package, and one outline needs no pairing
    from scipy.optimize import linear_sum_assignment

    rows, columns = linear_sum_assignment(costs) if costs.size else (np.zeros(0, int), np.zeros(0, int))
    pairs = tuple((int(i), int(j)) for i, j in zip(rows, columns, strict=True) if costs[i, j] < NEVER)
    left, right = {i for i, _ in pairs}, {j for _, j in pairs}
    return OutlinePairs(
        pairs,
        tuple(i for i in range(len(before)) if i not in left),
        tuple(j for j in range(len(after)) if j not in right),
    )


def _checked(drawing: Sequence[Outline], name: str) -> list[tuple[FloatArray, bool]]:
    return [
        (as_points(p, name=f"outline {k} {name}", closed=closed), closed) for k, (p, closed) in enumerate(drawing)
    ]


def _check_fixed(
    fixed: Sequence[tuple[int, int]], before: list[tuple[FloatArray, bool]], after: list[tuple[FloatArray, bool]]
) -> None:
    for side, drawing, name in ((0, before, "before"), (1, after, "after")):
        used = [pair[side] for pair in fixed]
        for k in used:
            if not 0 <= k < len(drawing):
                raise CorrespondenceError(f"there is no outline {k} {name}; it has {len(drawing)} outlines")
        if len(set(used)) < len(used):
            raise CorrespondenceError(f"an outline {name} is paired twice by hand; it can have one partner")
    for i, j in fixed:
        if before[i][1] != after[j][1]:
            raise CorrespondenceError(f"outline {i} before and outline {j} after: one is closed, the other open")


@dataclass(frozen=True, eq=False)
class _Traits:
    """What outlines are paired by: (k,) kind, (k, 2) place, (k,) size in the drawing, (k, f) form."""

    kind: npt.NDArray[np.intp]
    place: FloatArray
    size: FloatArray
    form: FloatArray


def _traits(drawing: list[tuple[FloatArray, bool]]) -> _Traits:
    k = len(drawing)
    if not k:
        return _Traits(np.zeros(0, np.intp), np.zeros((0, 2)), np.zeros(0), np.zeros((0, SAMPLES // 2 - 1)))
    samples = np.array([resample(p, SAMPLES, closed=closed) for p, closed in drawing])
    lengths = np.array([perimeter(p, closed=closed) for p, closed in drawing])
    centres = samples.mean(axis=1)
    # weighted by length, so that a dot more or less hardly moves the whole
    middle = np.average(centres, axis=0, weights=lengths)
    radius = np.sqrt(np.average(((samples - middle) ** 2).sum(axis=2).mean(axis=1), weights=lengths))
    kinds = [2 if not closed else _depth(drawing, i) % 2 for i, (_, closed) in enumerate(drawing)]
    form = np.array([_form(p, closed) for p, closed in drawing])
    return _Traits(np.array(kinds, np.intp), (centres - middle) / radius, np.log(lengths / radius), form)


def _form(points: FloatArray, closed: bool) -> FloatArray:
    """Magnitudes of the Fourier descriptors of the outline, both directions of turning added."""
    r = ring(points, closed=closed)
    at = np.arange(SAMPLES) / (SAMPLES if closed else SAMPLES - 1)
    magnitudes = np.abs(np.fft.fft(r.at(at))) / SAMPLES
    # a drawing against the direction exchanges the harmonics k and -k
    half = SAMPLES // 2
    return np.asarray(np.hypot(magnitudes[1:half], magnitudes[:-half:-1]))


def _depth(drawing: list[tuple[FloatArray, bool]], i: int) -> int:
    """Number of closed outlines that contain most of outline `i`."""
    probes = resample(drawing[i][0], 8)
    others = [p for k, (p, closed) in enumerate(drawing) if k != i and closed]
    return sum(bool(contains(p, probes).mean() > 0.5) for p in others)


def _costs(a: _Traits, b: _Traits) -> FloatArray:
    place = ((a.place[:, None] - b.place) ** 2).sum(axis=2)
    size = (a.size[:, None] - b.size) ** 2
    form = ((a.form[:, None] - b.form) ** 2).sum(axis=2)
    costs = place + SIZE * size + SHAPE * form
    return np.asarray(np.where(a.kind[:, None] == b.kind, np.minimum(costs, NEVER / 2), NEVER))
