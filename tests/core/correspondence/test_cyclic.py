"""The sweep against a plain dynamic programme in loops."""

import numpy as np
import pytest

from core.correspondence.cyclic import MARGIN, REACH, STEPS, ends, sweep, trace


def plain(costs, start):
    """Cheapest path from (0, start) to every cell, by the definition."""
    _, rows, _, _, width = costs.shape
    best = np.full((rows, width), np.inf)
    best[0, start + width // 2] = 0
    for i in range(1, rows):
        for w in range(width):
            for k, (di, dj) in enumerate(STEPS):
                came = w + di - dj
                if i >= di and 0 <= came < width:
                    best[i, w] = min(best[i, w], best[i - di, came] + costs[k, i, 0, 0, w])
    return best


@pytest.mark.parametrize("seed", range(3))
def test_the_sweep_finds_what_the_definition_says(seed):
    costs = np.random.default_rng(seed).random((len(STEPS), 13, 1, 1, 9)).astype(np.float32)
    starts = np.array([-2, 0, 3])
    table = sweep(costs, starts)
    for s, start in enumerate(starts):
        want = plain(costs, start)
        reached = np.isfinite(want)
        got = table[REACH:, 0, s, MARGIN:-MARGIN]
        np.testing.assert_allclose(got[reached], want[reached], rtol=1e-5)
        assert (got[~reached] >= 1e8).all()


def test_the_traced_path_costs_what_the_table_says():
    costs = np.random.default_rng(5).random((len(STEPS), 30, 2, 1, 11)).astype(np.float32)
    starts = np.array([0, 1])
    table = sweep(costs, starts)
    which = (np.array([0, 0, 1, 1]), np.array([0, 1, 0, 1]))
    paths = trace(table, costs, which, starts[which[1]])
    for (rows, offsets), b, s in zip(paths, *which, strict=True):
        assert (rows[0], rows[-1], offsets[0], offsets[-1]) == (0, 29, starts[s], starts[s])
        steps = [(int(d), int(d + e)) for d, e in zip(np.diff(rows), np.diff(offsets), strict=True)]
        kinds = [STEPS.index(step) for step in steps]
        total = costs[kinds, rows[1:], b, 0, offsets[1:] + 5].sum()
        assert total == pytest.approx(ends(table, starts)[b, s], rel=1e-5)
