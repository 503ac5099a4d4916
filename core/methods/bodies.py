"""Which outlines of a drawing have one interior: each outer one with the holes in it."""

from collections.abc import Sequence

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.assembly import Assembly
from core.methods.headings import ComplexArray

PROBES = 12
"""Vertices of an outline that tell whether it lies inside another one."""

THIN = 1e-9
"""Area, over the squared perimeter, below which an outline encloses nothing."""


def bodies(assembly: Assembly) -> list[list[int]]:
    """Return the outlines of every interior, the outer one first; outlines with none of their own are in no list.

    An outline lies in another one if it does in both keyframes (even-odd: in a hole there are islands again).
    Left out are open outlines and those whose direction differs between the keyframes.
    """
    solid = [k for k in range(len(assembly.rows)) if _encloses(assembly, k)]
    if len(solid) < 2:
        return [solid] if solid else []
    inside = _insides([assembly.a[assembly.rows[k]] for k in solid])
    inside &= _insides([assembly.b[assembly.rows[k]] for k in solid])
    depth = inside.sum(axis=1)
    found = {k: [solid[k]] for k in np.flatnonzero(depth % 2 == 0).tolist()}
    for hole in np.flatnonzero(depth % 2 == 1).tolist():
        parents = np.flatnonzero(inside[hole] & (depth == depth[hole] - 1))
        if len(parents) and int(parents[0]) in found:
            found[int(parents[0])].append(solid[hole])
        else:  # nested differently in the two keyframes
            found[hole] = [solid[hole]]
    return list(found.values())


def signed_area(p: ComplexArray) -> float:
    """Area inside a closed outline, px^2, positive where x turns towards y."""
    q = p - p[0]
    return float((q.conj() * np.roll(q, -1)).imag.sum() / 2)


def _encloses(assembly: Assembly, k: int) -> bool:
    row, headings = assembly.rows[k], assembly.outlines[k]
    before, after = signed_area(assembly.a[row]), signed_area(assembly.b[row])
    if not assembly.closed[k] or not headings.known or before * after <= 0:
        return False
    around = float(headings.before.sum()), float(headings.after.sum())
    return abs(before) > THIN * around[0] ** 2 and abs(after) > THIN * around[1] ** 2


def _insides(outlines: Sequence[ComplexArray]) -> np.ndarray:
    """Whether each outline lies wholly inside each other one, (k, k)."""
    inside = np.zeros((len(outlines), len(outlines)), dtype=bool)
    boxes = np.array([[p.real.min(), p.imag.min(), p.real.max(), p.imag.max()] for p in outlines])
    within = (boxes[:, None, :2] > boxes[None, :, :2]).all(axis=2)
    within &= (boxes[:, None, 2:] < boxes[None, :, 2:]).all(axis=2)
    for i, j in np.argwhere(within):
        probes = outlines[i][np.linspace(0, len(outlines[i]) - 1, PROBES).astype(np.intp)]
        inside[i, j] = bool((_windings(outlines[j], probes) % 2 == 1).all())
    return inside


def _windings(p: ComplexArray, probes: ComplexArray) -> FloatArray:
    """How many edges of the outline a ray from each probe crosses, (k,)."""
    q = np.roll(p, -1)
    y = probes.imag[:, None]
    spans = (p.imag <= y) != (q.imag <= y)
    run = np.divide(q.real - p.real, q.imag - p.imag, out=np.zeros(len(p)), where=q.imag != p.imag)
    return np.asarray((spans & (p.real + (y - p.imag) * run > probes.real[:, None])).sum(axis=1))
