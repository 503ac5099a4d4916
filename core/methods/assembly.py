"""The outlines of a drawing over one span, ready for a method: their headings, and how they hang together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.bridges import Bridge, connect
from core.methods.headings import TURN, ComplexArray, Headings, headings, joined, shortest
from core.methods.placement import Placement, centre, place


@dataclass(frozen=True, eq=False)
class Assembly:
    """All outlines of a drawing, one after the other in a row of vertices.

    Attributes
    ----------
    a, b : (n,) complex array
        Vertices before and after, px.
    rows : tuple of slice
    closed : tuple of bool
    outlines : tuple of Headings
        The turns are those meant: of all outlines together, and extra ones added.
    bridges : tuple of Bridge
    placement : Placement
    """

    a: ComplexArray
    b: ComplexArray
    rows: tuple[slice, ...]
    closed: tuple[bool, ...]
    outlines: tuple[Headings, ...]
    bridges: tuple[Bridge, ...]
    placement: Placement


def assemble(
    pairs: Sequence[tuple[FloatArray, FloatArray, bool]],
    *,
    turns: int = 0,
    bodies: Sequence[int] | None = None,
    placement: str = "still",
) -> Assembly:
    """Return the outlines (left (k, 2), right (k, 2), closed), `turns` added to the shortest turn.

    Outlines with the same number in `bodies` hang together first. `placement` is one of `PLACEMENTS`.
    """
    a, b, rows, found, bridges = _connected(pairs, bodies)
    closed = tuple(c for _, _, c in pairs)
    mean = joined(found).mean_turn()
    extra = shortest(mean) + TURN * turns
    shares = _vertex_shares(found)
    return Assembly(
        a,
        b,
        rows,
        closed,
        tuple(h.turned(extra) for h in found),
        tuple(bridge.turned(extra) for bridge in bridges),
        centre(a, b, rows, closed, shares) if placement == "centroid" else place(a, b, shares, mean + extra),
    )


def natural_turn(pairs: Sequence[tuple[FloatArray, FloatArray, bool]]) -> float:
    """Turn of the drawing as a whole without extra turns, radians in (-pi, pi]: the mean over its edges."""
    if not pairs:
        return 0.0
    mean = joined(_connected(pairs, None)[3]).mean_turn()
    return mean + shortest(mean)


def _connected(
    pairs: Sequence[tuple[FloatArray, FloatArray, bool]], bodies: Sequence[int] | None
) -> tuple[ComplexArray, ComplexArray, tuple[slice, ...], list[Headings], list[Bridge]]:
    """Return all vertices before and after, and how the outlines turn and hang together."""
    a = _complex([left for left, _, _ in pairs])
    b = _complex([right for _, right, _ in pairs])
    rows = in_a_row([len(left) for left, _, _ in pairs])
    found = [headings(a[r], b[r], closed=c) for r, (_, _, c) in zip(rows, pairs, strict=True)]
    return a, b, rows, *connect(a, b, rows, found, bodies)


def in_a_row(counts: Sequence[int]) -> tuple[slice, ...]:
    """Return the rows of parts with so many vertices each, one after the other."""
    stops = np.cumsum(counts).tolist()
    return tuple(slice(stop - count, stop) for stop, count in zip(stops, counts, strict=True))


def _complex(outlines: list[FloatArray]) -> ComplexArray:
    p = np.concatenate(outlines)
    z: ComplexArray = p[:, 0] + 1j * p[:, 1]
    return z


def _vertex_shares(outlines: Sequence[Headings]) -> FloatArray:
    """How much of the drawing each vertex stands for, 1 in all."""
    shares = np.concatenate([h.vertex_shares() * h.perimeters for h in outlines])
    return shares / shares.sum() if shares.any() else np.full(len(shares), 1 / len(shares))
