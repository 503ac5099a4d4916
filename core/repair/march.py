"""Along a path of wished frames, as near to them as can be without a crossing."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from core.geometry.outline import FloatArray
from core.repair.chains import BoolArray, ComplexArray
from core.repair.contacts import clear_moves
from core.repair.descent import Field, descend


@dataclass(frozen=True, eq=False)
class March:
    """The places reached, one for each wished frame, and all that was passed between them.

    Attributes
    ----------
    reached : (K, n) complex array
    legs : list of lists of (n,) complex arrays
        legs[k] leads from reached[k - 1] to reached[k], the last of it included; legs[0] is empty.
    """

    reached: ComplexArray
    legs: list[list[ComplexArray]]

    def forth(self, last: int) -> list[ComplexArray]:
        """All places from the first one to reached[last]."""
        return [self.reached[0]] + [z for leg in self.legs[1 : last + 1] for z in leg]


def march(
    field: Field,
    wished: ComplexArray,
    easy: BoolArray,
    tick: Callable[[], None] = lambda: None,
) -> March:
    """Start at wished[0], which must be simple, and follow the wished frames (K, n).

    Where a wished frame is `easy` (simple, the right way round, nothing within the barrier's reach) and the way
    to it free, it is taken as it is. Otherwise the nearest place by `descend`.
    """
    reached, legs = [wished[0]], [[]]  # type: tuple[list[ComplexArray], list[list[ComplexArray]]]
    for k in range(1, len(wished)):
        z = reached[-1]
        if easy[k] and field.may_go(z, wished[k]):
            leg = [wished[k]]
        else:
            leg = shortened(field, z, descend(field, z, wished[k], metric=field.metric))
        legs.append(leg)
        reached.append(leg[-1] if leg else z)
        tick()
    return March(np.array(reached), legs)


def shortened(field: Field, z: ComplexArray, places: list[ComplexArray]) -> list[ComplexArray]:
    """The way from z over the places without those between, if the straight one is clear."""
    if len(places) > 1 and clear_moves(field.chains, z[None], places[-1][None])[0]:
        return places[-1:]
    return places


def distance(x: ComplexArray, y: ComplexArray) -> FloatArray:
    """Root mean square distance of the vertices of frames (..., n)."""
    return np.asarray(np.sqrt((np.abs(x - y) ** 2).mean(axis=-1)), np.float64)


def best_change(forth: ComplexArray, back: ComplexArray, wished: ComplexArray) -> int:
    """Return where to change from the march forth to the one back: least deviation, and least between them."""
    left, right = distance(forth, wished), distance(back, wished)
    after = np.cumsum(right[::-1])[::-1]
    return int((np.cumsum(left) + after + len(wished) / 6 * distance(forth, back)).argmin())
