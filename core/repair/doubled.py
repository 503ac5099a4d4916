"""Vertices that share their place with the next one: they touch, so they are told apart before all else."""

import numpy as np

from core.repair.chains import Chains, ComplexArray

SPREAD = 1e-4
"""Sizes of the drawing over which doubled vertices are spread along the edge behind; at most a tenth of it."""


def spread(chains: Chains, z: ComplexArray) -> ComplexArray:
    """Return the moves (n,) that part doubled vertices of the frame z (n,) along its edges; mostly zeros.

    The drawing stays the same but for the places of these vertices on it.
    """
    moves = np.zeros_like(z)
    for row, closed in zip(chains.rows, chains.closed, strict=True):
        part = z[row]
        doubled = part == np.roll(part, -1)
        if doubled.any() and not doubled.all():
            moves[row] = _spread_closed(part) if closed else _spread_open(part)
    return moves


def _spread_closed(z: ComplexArray) -> ComplexArray:
    first = int(np.flatnonzero(z != np.roll(z, 1))[0])  # so that no run of equal vertices goes over the seam
    return np.roll(_spread_runs(np.roll(z, -first), z[first]), first)


def _spread_open(z: ComplexArray) -> ComplexArray:
    moves = _spread_runs(z, z[-1])
    last = int(np.flatnonzero(z != z[-1])[-1]) + 1  # the last run has no edge behind it: it goes back before it
    moves[last:] = _spread_runs(z[last - 1 :][::-1], z[-1])[:-1][::-1]
    return moves


def _spread_runs(z: ComplexArray, end: complex) -> ComplexArray:
    """Moves of every run of equal vertices towards the vertex behind it; behind the last one lies `end`."""
    starts = np.flatnonzero(np.append(True, z[1:] != z[:-1]))
    length = np.diff(np.append(starts, len(z)))
    edge = np.append(z[starts[1:]], end) - z[starts]
    reach = edge * np.minimum(0.1, SPREAD / np.maximum(np.abs(edge), 1e-300))
    rank = np.arange(len(z)) - np.repeat(starts, length)
    return np.asarray(np.repeat(reach / length, length) * rank, np.complex128)
