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

FIRM = 1.0
"""Looseness up to which no coarser cage is tried."""

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
    looseness : float
        One of `LOOSENESS`.
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
    looseness: float
    crossings: int
    note: str

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
    not depend on which keyframe comes first. The first level is taken whose mesh can be carried over without
    folds, and whose in-betweens do not cross themselves with the detail held fairly firmly; else the best one.
    """
    pair = _Pair.of(a, b, rows, outlines)
    best: Body | None = None
    for level in LEVELS:
        body = pair.at(level) if pair is not None else None
        if body is None:
            continue
        if best is None or (body.crossings, body.looseness) < (best.crossings, best.looseness):
            best = body
        if best.crossings == 0 and best.looseness <= FIRM:
            break
    return best


@dataclass(frozen=True, eq=False)
class _Pair:
    """An interior in both keyframes, the one to be meshed first.

    Attributes
    ----------
    rows, outlines : sequences of slice and Headings
    sizes : (2,) float array
        Roots of the areas, px.
    meshed, other : (n,) complex array
        Vertices for areas of 1.
    spin : complex
        By which these must be turned to lie as the drawing does.
    backwards : bool
        Whether the keyframe after comes first.
    """

    rows: Sequence[slice]
    outlines: Sequence[Headings]
    sizes: FloatArray
    meshed: ComplexArray
    other: ComplexArray
    spin: complex
    backwards: bool

    @classmethod
    def of(
        cls, a: ComplexArray, b: ComplexArray, rows: Sequence[slice], outlines: Sequence[Headings]
    ) -> "_Pair | None":
        """Order and scale the keyframes; None where one has all but no area."""
        sizes = np.sqrt([_area(p, rows) for p in (a, b)])
        around = np.array([sum(float(getattr(h, name).sum()) for h in outlines) for name in ("before", "after")])
        if sizes.min() <= 1e-9 * around.max():
            return None
        backwards = bool(around[1] / sizes[1] > around[0] / sizes[0])
        if backwards:
            a, b, sizes = b, a, sizes[::-1]
            outlines = [_reversed(h) for h in outlines]
        m, o = ((p - p.mean()) / size for p, size in zip((a, b), sizes, strict=True))
        # the same mesh, to rounding, however the drawing lies: towards the vertex farthest out is x
        far = int((np.abs(m) ** 2 + np.abs(o) ** 2).argmax())
        spin = complex(m[far] / abs(m[far])) if m[far] != 0 else 1.0
        return cls(rows, outlines, sizes, np.round(m / spin, 12), np.round(o / spin, 12), spin, backwards)

    def at(self, level: Level) -> Body | None:
        """Plan the interior with a cage as fine as the level says; None where it stays folded."""
        boundary = cage(self.meshed, self.other, self.rows, level.tolerance, level.most)
        if boundary is None:
            return None
        carried = _unfolded(boundary, [h.mean_turn() for h in self.outlines], level)
        if carried is None:
            return None
        try:
            interior = travel(carried, *self.sizes)
        except (RuntimeError, ArithmeticError):  # a matrix that is singular to rounding
            return None
        return self.fitted(interior, boundary, carried.rim_turn[boundary.places], level.note)

    def fitted(self, interior: Interior, boundary: Cage, turns: FloatArray, note: str) -> Body | None:
        """Attach the detail as firmly as it can be without crossings at the times tested."""
        best: Body | None = None
        for loose in LOOSENESS:
            reach = loose * float(self.sizes.mean())
            detail = attach(self.outlines, self.rows, boundary.vertices, turns, reach)
            said = "; ".join(n for n in (note, LOOSE if loose > LOOSENESS[0] else "") if n)
            body = Body(interior, detail, self.backwards, boundary, self.spin, loose, 0, said)
            frames = body.forms(tested(len(self.meshed)))
            if not np.isfinite(frames).all():
                return None
            crossings = len(crossing_edges(frames, self.rows))
            if best is None or crossings < best.crossings:
                best = replace(body, crossings=crossings)
            if not crossings:
                break
        return best


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
