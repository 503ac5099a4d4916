"""Dynamic programming: the cheapest monotone paths through a grid of nodes, many at a time.

Rows are nodes of the one outline. A cell is told by its row i and its offset w = j - i, j being the node of
the other outline; the current guess is the diagonal w = 0, so a band round it is a plain rectangle. Every step
goes forward on both outlines (Sederberg and Greenwood 1992 allow standing still, which glues vertices), so a
row needs only earlier rows and is swept at once for all offsets, starts and candidates.
"""

import numpy as np
import numpy.typing as npt

Float32Array = npt.NDArray[np.float32]
IntArray = npt.NDArray[np.intp]

STEPS = ((1, 1), (1, 2), (2, 1), (1, 3), (3, 1), (2, 3), (3, 2), (1, 5), (5, 1), (1, 8), (8, 1))
"""Nodes that one step goes forward on the two outlines. The long ones let the cap of a thin letter become that
of a bold one."""

REACH = 8
"""Longest step, in rows."""

MARGIN = 7
"""Largest change of the offset in one step."""

BARRED = np.float32(1e9)
"""Cost of what is not allowed: finite, so that no sum of two is NaN."""


def sweep(costs: Float32Array, starts: IntArray) -> Float32Array:
    """Return the cost of the cheapest path to every cell.

    Parameters
    ----------
    costs : (K, R + 1, B, S or 1, 2 W + 1) float32 array
        Cost of ending the K-th of `STEPS` in a cell, for B candidates (and S starts, if they differ).
    starts : (S,) int array
        Offset in row 0 at which the paths of each start begin.

    Returns
    -------
    (R + 1 + REACH, B, S, 2 W + 1 + 2 MARGIN) float32 array
        The table with its barred border.
    """
    _, rows, batch, _, width = costs.shape
    table = np.full((rows + REACH, batch, len(starts), width + 2 * MARGIN), BARRED, dtype=np.float32)
    middle = MARGIN + width // 2
    table[REACH, :, np.arange(len(starts)), middle + starts] = 0.0
    sources = _sources(table.shape)
    flat = table.reshape(-1)
    stride = table[0].size
    arrivals = np.zeros((len(STEPS), batch, len(starts), width), dtype=np.float32)
    for i in range(1, rows):
        flat[i * stride :].take(sources, out=arrivals, mode="clip")
        np.add(arrivals, costs[:, i], out=arrivals)
        arrivals.min(axis=0, out=table[i + REACH, :, :, MARGIN:-MARGIN])
    return table


def _sources(shape: tuple[int, ...]) -> IntArray:
    """Where each step comes from, as an index counted from the row `REACH` above: the same for every row."""
    _, batch, starts, padded = shape
    stride = batch * starts * padded
    cells = np.arange(stride).reshape(batch, starts, padded)[:, :, MARGIN:-MARGIN]
    shift = np.array([(REACH - di) * stride + di - dj for di, dj in STEPS])
    return np.asarray(shift[:, None, None, None] + cells, dtype=np.intp)


def ends(table: Float32Array, starts: IntArray) -> Float32Array:
    """Return what the paths cost that end at the offset where they began: (B, S)."""
    middle = table.shape[-1] // 2
    return np.asarray(table[-1, :, np.arange(len(starts)), middle + starts].T)


def trace(
    table: Float32Array, costs: Float32Array, chosen: tuple[IntArray, IntArray], offsets: IntArray
) -> list[tuple[IntArray, IntArray]]:
    """Follow the cheapest paths back from the last row.

    Parameters
    ----------
    table, costs
        As of `sweep`.
    chosen : (P,), (P,) int arrays
        Candidate and start of every path wanted.
    offsets : (P,) int array
        Offset in the last row.

    Returns
    -------
    list of (rows, offsets)
        The cells of every path, from row 0 on.
    """
    candidate, start = chosen
    shared = start * (costs.shape[3] > 1)
    stride, padded = table[0].size, table.shape[-1]
    half = costs.shape[-1] // 2
    di, dj = np.array(STEPS).T
    back, change = -di * stride + di - dj, di - dj
    flat = table.reshape(-1)
    row, offset = np.full(len(candidate), costs.shape[1] - 1), np.array(offsets)
    lane = (candidate * table.shape[2] + start) * padded + half + MARGIN
    visited = [(row, offset)]
    while row.any():
        at = (row + REACH) * stride + lane + offset
        came = flat.take(at[:, None] + back) + costs[:, row, candidate, shared, offset + half].T
        step = came.argmin(axis=1)
        moving = row > 0
        row, offset = np.maximum(row - di[step], 0), offset + change[step] * moving
        visited.append((row, offset))
    rows, columns = (np.array(x)[::-1] for x in zip(*visited, strict=True))
    return [_one_path(rows[:, p], columns[:, p]) for p in range(rows.shape[1])]


def _one_path(rows: IntArray, offsets: IntArray) -> tuple[IntArray, IntArray]:
    """Drop the repeats of row 0 of a path that was done before the others."""
    first = int(np.count_nonzero(rows == 0)) - 1
    return rows[first:], offsets[first:]
