"""Long detours pulled back towards the wished path, as a string is pulled tight round a post."""

import numpy as np

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.repair.barrier import WEIGHT
from core.repair.chains import ComplexArray
from core.repair.contacts import clear_moves
from core.repair.descent import LONGEST_STEP, Field

SWEEPS = 4
"""Times that every place is pulled, every other one at a time."""

PULL = 0.9
"""Share of its neighbours' deviation that a place wishes to keep: 1 would only smooth."""

HALVINGS = 5
"""Of a pull that would make a move unclear, before it is given up."""


def tighten(field: Field, times: FloatArray, places: ComplexArray, wished: ComplexArray) -> ComplexArray:
    """Return places nearer to the wished ones, first and last the same, all moves between them clear.

    Parameters
    ----------
    field : Field
    times : (K,) float array
        When the places are passed.
    places, wished : (K, n) complex array
        The places, and where the method would have been at these times.
    """
    places = places.copy()
    inner = np.arange(1, len(places) - 1)
    for sweep in range(SWEEPS):
        chosen = inner[(inner + sweep) % 2 == 0]
        if not len(chosen):
            continue
        moves = np.array([_pull(field, times, places, wished, k) for k in chosen.tolist()])
        _take(field, places, chosen, moves)
    return places


def _pull(field: Field, times: FloatArray, places: ComplexArray, wished: ComplexArray, k: int) -> ComplexArray:
    """One Newton step of a place towards the wished one, off by most of what its neighbours are off."""
    field.checkpoint()
    whole = times[k + 1] - times[k - 1]
    s = (times[k] - times[k - 1]) / whole if whole > 0 else 0.5
    off = places[k - 1 : k + 2] - wished[k - 1 : k + 2]
    aim = wished[k] + PULL * ((1 - s) * off[0] + s * off[2])
    z = places[k]
    move = field.metric.step(z - aim, field.barrier.terms(z, field.pairs_near(z)), WEIGHT)
    return np.asarray(move * min(1.0, LONGEST_STEP / max(float(np.abs(move).max()), 1e-300)), np.complex128)


def _take(field: Field, places: ComplexArray, chosen: IndexArray, moves: ComplexArray) -> None:
    """Move places that are no neighbours, each as far as the ways from and to its neighbours stay clear."""
    for _ in range(HALVINGS):
        if not len(chosen):
            return
        tried = places[chosen] + moves
        clear = clear_moves(field.chains, places[chosen - 1], tried)
        clear &= clear_moves(field.chains, tried, places[chosen + 1])
        places[chosen[clear]] = tried[clear]
        chosen, moves = chosen[~clear], moves[~clear] / 2
