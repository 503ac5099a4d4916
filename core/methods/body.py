"""One interior with its outlines: found once, then evaluated at any time."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from core.errors import GeometryError
from core.geometry.outline import FloatArray
from core.methods.bodies import signed_area
from core.methods.cage import Cage, cage
from core.methods.carry import Carried, carry
from core.methods.detail import Detail, attach
from core.methods.headings import ComplexArray, Headings
from core.methods.interior import Interior, travel
from core.methods.loops import crossing_edges
from core.methods.untangle import untangle

COARSE = "the interior is matched in the large only"
LOOSE = "fine detail leaves the interior so as not to cross itself"

LOOSENESS = (0.1, 0.3, 1.0, 3.0, 10.0)
"""How far along the outline detail may leave the cage, in sizes: the first with no crossings is taken."""

MANY = 800
"""Vertices from which on in-betweens are tested for crossings at 7 times and not at 15."""


@dataclass(frozen=True, eq=False)
class Level:
    """How closely the mesh follows the outlines.

    Attributes
    ----------
    tolerance, most : float, int
        Of the cage, see `cage`.
    steps : int
        Newton steps that may be spent to open folds.
    hopeless : float
        Share of folded triangles above which a coarser level is tried at once.
    note : str
    """

    tolerance: float
    most: int
    steps: int
    hopeless: float
    note: str = ""


LEVELS = (
    Level(0.003, 200, 10, 0.03),
    Level(0.01, 120, 15, 0.05),
    Level(0.025, 70, 20, 0.08, COARSE),
    Level(0.05, 40, 30, 0.15, COARSE),
    Level(0.1, 16, 60, 0.5, COARSE),
)


@dataclass(frozen=True, eq=False)
class Body:
    """The paths of the outlines of one interior, up to a shift.

    Attributes
    ----------
    interior : Interior
    detail : Detail
    backwards : bool
        Whether the mesh was made in the keyframe after.
    boundary : Cage
        The boundary of the mesh.
    spin : complex
        By which the mesh must be turned to lie as the drawing does.
    crossings : int
        Found at the times tested.
    note : str
        What is not as fine as it should be.
    """

    interior: Interior
    detail: Detail
    backwards: bool
    boundary: Cage
    spin: complex
    crossings: int = 0
    note: str = ""

    def forms(self, t: FloatArray) -> ComplexArray:
        """Vertices (T, n) at the times `t` (T,)."""
        u = 1 - t if self.backwards else t
        cage = self.interior.vertices(u)[self.boundary.places] * self.spin
        return self.detail.vertices(u, cage)


def plan_body(
    a: ComplexArray, b: ComplexArray, rows: Sequence[slice], outlines: Sequence[Headings]
) -> Body | None:
    """Plan an interior; None where the interiors cannot be matched.

    Parameters
    ----------
    a, b : (n,) complex array
        Vertices of its outlines, px.
    rows, outlines : sequences of slice and Headings
        Where each outline is, and how it turns; the outer one first.

    Notes
    -----
    The thinner drawing is meshed: a mesh of the fatter one would be pressed together and fold. Which that is does
    not depend on which keyframe comes first.
    """
    sizes = [np.sqrt(_area(p, rows)) for p in (a, b)]
    around = [sum(float(getattr(h, name).sum()) for h in outlines) for name in ("before", "after")]
    if min(sizes) <= 1e-9 * max(around):
        return None
    backwards = around[1] / sizes[1] > around[0] / sizes[0]
    if backwards:
        a, b, sizes = b, a, sizes[::-1]
        outlines = [_reversed(h) for h in outlines]
    found = _matched(a, b, rows, outlines, sizes)
    if found is None:
        return None
    boundary, carried, spin, note = found
    try:
        interior = travel(carried, *sizes)
    except (RuntimeError, ArithmeticError):  # a matrix that is singular to rounding
        return None
    turns = carried.rim_turn[boundary.places]
    return _fitted(interior, boundary, (outlines, rows, turns), backwards, spin, sum(sizes) / 2, note)


def _matched(
    a: ComplexArray,
    b: ComplexArray,
    rows: Sequence[slice],
    outlines: Sequence[Headings],
    sizes: Sequence[float],
) -> tuple[Cage, Carried, complex, str] | None:
    """Return the first level whose mesh can be carried over without folds."""
    m, o = ((p - p.mean()) / size for p, size in zip((a, b), sizes, strict=True))
    # the same mesh, to rounding, however the drawing lies: towards the vertex farthest out is x
    far = int((np.abs(m) ** 2 + np.abs(o) ** 2).argmax())
    spin = complex(m[far] / abs(m[far])) if m[far] != 0 else 1.0
    m, o = (np.round(p / spin, 12) for p in (m, o))
    means = [h.mean_turn() for h in outlines]
    for level in LEVELS:
        boundary = cage(m, o, rows, level.tolerance, level.most)
        if boundary is None:
            continue
        carried = _unfolded(boundary, means, level)
        if carried is not None:
            return boundary, carried, spin, level.note
    return None


def _unfolded(boundary: Cage, means: Sequence[float], level: Level) -> Carried | None:
    try:
        carried = carry(boundary, means)
        folded = (carried.maps().determinant < 0).mean()
        if not np.isfinite(carried.image).all() or folded > level.hopeless:
            return None
        image = untangle(carried, level.steps)
    except (GeometryError, RuntimeError):
        return None
    if image is None or not np.isfinite(image).all():
        return None
    return replace(carried, image=image)


def _fitted(
    interior: Interior,
    boundary: Cage,
    edges: tuple[Sequence[Headings], Sequence[slice], FloatArray],
    backwards: bool,
    spin: complex,
    size: float,
    note: str,
) -> Body | None:
    """Attach the detail as firmly as it can be without crossings at the times tested."""
    outlines, rows, turns = edges
    best: Body | None = None
    for loose in LOOSENESS:
        detail = attach(outlines, rows, boundary.vertices, turns, loose * size)
        body = Body(interior, detail, backwards, boundary, spin)
        frames = body.forms(tested(rows[-1].stop))
        if not np.isfinite(frames).all():
            return None
        crossings = len(crossing_edges(frames, rows))
        said = "; ".join(n for n in (note, LOOSE if loose > LOOSENESS[0] else "") if n)
        if best is None or crossings < best.crossings:
            best = Body(interior, detail, backwards, boundary, spin, crossings, said)
        if not crossings:
            break
    return best


def _area(p: ComplexArray, rows: Sequence[slice]) -> float:
    """Area of the first outline less that of its holes."""
    outer, *holes = (abs(signed_area(p[r])) for r in rows)
    return max(outer - sum(holes), 0.0)


def tested(count: int) -> FloatArray:
    """Times at which in-betweens of so many vertices are tested for crossings."""
    return np.linspace(0, 1, 9 if count >= MANY else 17)[1:-1]


def _reversed(h: Headings) -> Headings:
    """Return the edges with the keyframes exchanged."""
    return Headings(h.after, h.before, h.start + h.turn, -h.turn, h.known)
