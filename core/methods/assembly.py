"""The outlines of a drawing over one span, ready for a method: their headings, and how they hang together."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.methods.bridges import Bridge, connect
from core.methods.headings import TURN, ComplexArray, Headings, headings, joined, shortest
from core.methods.placement import Placement, place


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
    pairs: Sequence[tuple[FloatArray, FloatArray, bool]], *, turns: int = 0, bodies: Sequence[int] | None = None
) -> Assembly:
    """Return the outlines (left (k, 2), right (k, 2), closed), `turns` added to the shortest turn.

    Outlines with the same number in `bodies` hang together first.
    """
    a = _complex([left for left, _, _ in pairs])
    b = _complex([right for _, right, _ in pairs])
    rows = in_a_row([len(left) for left, _, _ in pairs])
    closed = tuple(c for _, _, c in pairs)
    found = [headings(a[r], b[r], closed=c) for r, c in zip(rows, closed, strict=True)]
    found, bridges = connect(a, b, rows, found, bodies)
    mean = joined(found).mean_turn()
    extra = shortest(mean) + TURN * turns
    return Assembly(
        a,
        b,
        rows,
        closed,
        tuple(h.turned(extra) for h in found),
        tuple(bridge.turned(extra) for bridge in bridges),
        place(a, b, _vertex_shares(found), mean + extra),
    )


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
