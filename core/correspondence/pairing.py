"""The correspondence of two outlines: pairs of positions, and the outlines aligned by it."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from core.errors import CorrespondenceError
from core.geometry.outline import FloatArray, arc_lengths, as_points, points_at, positions_at_lengths

Anchor = tuple[float, float]
"""One pair of points fixed by the artist: a position on the outline before, a position on the one after."""

SNAP = 1e-9
"""A position this near a vertex, or an image this near another (share of the perimeter), is taken as the same.
Wider than what adding up lengths loses, far finer than any screen shows."""


@dataclass(frozen=True, eq=False)
class Correspondence:
    """A strictly monotone map between two outlines, given by pairs of positions and even arc length between.

    It stays usable while vertices are dragged, because positions are told by edge and fraction, not by place.

    Attributes
    ----------
    before, after : (k,) float array
        Paired positions. `before` rises; `after` rises too, once round from where it starts (it may wrap),
        or falls when `flipped`. Open outlines: the first and the last pair are ends.
    counts : (int, int)
        Numbers of vertices of the two outlines that it was made for.
    closed : bool
    flipped : bool
        The outlines were drawn in opposite directions.
    """

    before: FloatArray
    after: FloatArray
    counts: tuple[int, int]
    closed: bool = True
    flipped: bool = False

    def __post_init__(self) -> None:
        n, m = self.counts
        before = _snapped(np.asarray(self.before, dtype=np.float64), n, self.closed)
        after = _snapped(np.asarray(self.after, dtype=np.float64), m, self.closed)
        if before.ndim != 1 or before.shape != after.shape or len(before) < (1 if self.closed else 2):
            raise CorrespondenceError(
                f"a correspondence needs as many positions before as after, "
                f"got {np.size(before)} and {np.size(after)}"
            )
        if not (np.isfinite(before).all() and np.isfinite(after).all()):
            raise CorrespondenceError("a position of the correspondence is not a finite number")
        order = np.argsort(before, kind="stable")
        before, after = before[order], after[order]
        turned = -after if self.flipped else after
        if not _rises(before, n if self.closed else None) or not _rises(turned, m if self.closed else None):
            raise CorrespondenceError("the pairs of the correspondence cross or meet")
        if not self.closed:
            ends = (m - 1.0, 0.0) if self.flipped else (0.0, m - 1.0)
            if (before[0], before[-1]) != (0.0, n - 1.0) or (after[0], after[-1]) != ends:
                raise CorrespondenceError("the ends of open outlines must correspond to ends")
        before.setflags(write=False)
        after.setflags(write=False)
        object.__setattr__(self, "before", before)
        object.__setattr__(self, "after", after)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Correspondence):
            return NotImplemented
        return (
            (self.counts, self.closed, self.flipped) == (other.counts, other.closed, other.flipped)
            and np.array_equal(self.before, other.before)
            and np.array_equal(self.after, other.after)
        )

    def __hash__(self) -> int:
        return hash((self.before.tobytes(), self.after.tobytes(), self.counts, self.closed, self.flipped))

    @cached_property
    def inverse(self) -> "Correspondence":
        """The same pairs with before and after exchanged."""
        return Correspondence(self.after, self.before, self.counts[::-1], self.closed, self.flipped)

    def align(self, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return both outlines with the image of every vertex of the other inserted.

        Parameters
        ----------
        a, b : (n, 2), (m, 2) float array
            The outlines, in px; with the vertex counts that the correspondence was made for.

        Returns
        -------
        left, right : (k, 2) float array
            left[i] corresponds to right[i]; `left` begins with a[0] and runs as `a` does. Every vertex of `a`
            is a row of `left`, every vertex of `b` a row of `right`, bit for bit; so the outlines are unchanged.

        Raises
        ------
        CorrespondenceError
            If the vertex counts are others than `counts`.
        """
        p, q = self.aligned_positions(a, b)
        return points_at(a, p, closed=self.closed), points_at(b, q, closed=self.closed)

    def aligned_positions(self, a: FloatArray, b: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the positions (k,), (k,) of the rows of `align(a, b)` on the two outlines."""
        a = as_points(a, name="before", closed=self.closed)
        b = as_points(b, name="after", closed=self.closed)
        if (len(a), len(b)) != self.counts:
            raise CorrespondenceError(
                f"the correspondence is of outlines with {self.counts[0]} and {self.counts[1]} vertices; "
                f"before has {len(a)}, after has {len(b)}"
            )
        walk = _Walk(self, a, b)
        p, q = walk.rows()
        first = int(np.flatnonzero(p == 0.0)[0])
        return (np.roll(p, -first), np.roll(q, -first)) if self.closed else (p, q)

    def images(self, a: FloatArray, b: FloatArray, positions: FloatArray) -> FloatArray:
        """Return the positions on `b` that correspond to `positions` (k,) on `a`."""
        return _Walk(self, a, b).images(np.asarray(positions, dtype=np.float64))


class _Walk:
    """Both outlines unrolled into lengths from the first pair on: x along `a`, y along `b`, both rising."""

    def __init__(self, c: Correspondence, a: FloatArray, b: FloatArray) -> None:
        self.c, self.a, self.b = c, a, b
        self.sa, self.sb = arc_lengths(a, closed=c.closed), arc_lengths(b, closed=c.closed)
        x, y = self._x(c.before), self._y(c.after)
        if c.closed:
            # the first pair opens the walk and closes it a whole round later
            self.x = np.append(x, float(self.sa[-1]))
            self.y = np.append(y, float(self.sb[-1]))
        else:
            self.x, self.y = x, y

    def _x(self, positions: FloatArray) -> FloatArray:
        whole = float(self.sa[-1])
        at: FloatArray = np.interp(positions, np.arange(len(self.sa)), self.sa)
        if not self.c.closed:
            return at
        first = float(np.interp(self.c.before[0], np.arange(len(self.sa)), self.sa))
        return np.where(positions >= self.c.before[0], at - first, at - first + whole)

    def _y(self, positions: FloatArray) -> FloatArray:
        whole = float(self.sb[-1])
        at: FloatArray = np.interp(positions, np.arange(len(self.sb)), self.sb)
        if not self.c.closed:
            return whole - at if self.c.flipped else at
        start = self.c.after[0]
        first = float(np.interp(start, np.arange(len(self.sb)), self.sb))
        if self.c.flipped:
            return np.where(positions <= start, first - at, first - at + whole)
        return np.where(positions >= start, at - first, at - first + whole)

    def _before(self, x: FloatArray) -> FloatArray:
        if not self.c.closed:
            return positions_at_lengths(self.a, x, closed=False)
        first = float(np.interp(self.c.before[0], np.arange(len(self.sa)), self.sa))
        return positions_at_lengths(self.a, first + x)

    def _after(self, y: FloatArray) -> FloatArray:
        if not self.c.closed:
            return positions_at_lengths(self.b, float(self.sb[-1]) - y if self.c.flipped else y, closed=False)
        first = float(np.interp(self.c.after[0], np.arange(len(self.sb)), self.sb))
        return positions_at_lengths(self.b, first - y if self.c.flipped else first + y)

    def images(self, positions: FloatArray) -> FloatArray:
        return self._after(np.interp(self._x(positions), self.x, self.y))

    def rows(self) -> tuple[FloatArray, FloatArray]:
        """Positions of the pairs, of every other vertex of `a` and of `b`, in walking order."""
        c = self.c
        i = np.setdiff1d(np.arange(len(self.a), dtype=np.float64), c.before)
        j = np.setdiff1d(np.arange(len(self.b), dtype=np.float64), c.after)
        x_i, y_j = self._x(i), self._y(j)
        y_i, x_j = np.interp(x_i, self.x, self.y), np.interp(y_j, self.y, self.x)
        k = len(c.before)
        p = np.concatenate([c.before, i, self._before(x_j)])
        q = np.concatenate([c.after, self._after(y_i), j])
        kind = np.repeat([0, 1, 2], [k, len(i), len(j)])
        # x + y rises strictly along the walk, also where one of the outlines has a doubled vertex
        along = np.concatenate([self.x[:k], x_i, x_j]) / float(self.sa[-1])
        along += np.concatenate([self.y[:k], y_i, y_j]) / float(self.sb[-1])
        order = np.lexsort((_walk_rank(p, c.before[0], c.closed), along))
        p, q, kind, along = p[order], q[order], kind[order], along[order]
        return _merged(p, q, kind, along)


def _walk_rank(p: FloatArray, start: float, closed: bool) -> FloatArray:
    """Ties of length (doubled vertices) keep the order of their indices."""
    return np.where(p >= start, p, p + len(p)) if closed else p


def _merged(p: FloatArray, q: FloatArray, kind: FloatArray, along: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Join a vertex of `a` and the vertex of `b` right beside it into one row, else a sliver edge remains."""
    near = (np.diff(along) <= SNAP) & (kind[1:] + kind[:-1] == 3)
    if not near.any():
        return p, q
    p, q = p.copy(), q.copy()
    keep = np.ones(len(p), dtype=bool)
    for r in np.flatnonzero(near):
        if not keep[r]:
            continue
        vertex_a, vertex_b = (r, r + 1) if kind[r] == 1 else (r + 1, r)
        p[r], q[r] = p[vertex_a], q[vertex_b]
        keep[r + 1] = False
    return p[keep], q[keep]


def _snapped(positions: FloatArray, count: int, closed: bool) -> FloatArray:
    nearest = np.rint(positions)
    s = np.where(np.abs(positions - nearest) <= SNAP, nearest, positions)
    return np.mod(s, count) if closed else s


def _rises(s: FloatArray, whole: int | None) -> bool:
    """Whether the numbers rise strictly; given a `whole`, cyclically: once round at most."""
    d = np.diff(s)
    if whole is None:
        return bool((d > 0).all())
    if len(s) == 1:
        return True
    d = np.append(d, s[0] - s[-1])
    return bool((d != 0).all()) and int(np.count_nonzero(d < 0)) == 1


def ordered_anchors(
    anchors: Sequence[Anchor], counts: tuple[int, int], *, closed: bool = True
) -> tuple[FloatArray, FloatArray, bool | None]:
    """Check that anchors can hold together, and say which direction they ask for.

    Parameters
    ----------
    anchors : sequence of (float, float)
        Positions on the outlines before and after, in any order.
    counts : (int, int)
        Numbers of vertices of the outlines.

    Returns
    -------
    before, after : (k,) float array
        Sorted by `before`.
    flipped : bool or None
        None where the anchors allow both directions (fewer than 3 on a closed outline).

    Raises
    ------
    CorrespondenceError
        If a position is off its outline, or two anchors share a point, or no direction suits them all.
    """
    if not len(anchors):
        return np.zeros(0), np.zeros(0), None
    pairs = np.asarray(anchors, dtype=np.float64)
    if pairs.ndim != 2 or pairs.shape[1] != 2 or not np.isfinite(pairs).all():
        raise CorrespondenceError("anchors must be pairs of positions: (before, after)")
    for column, (count, side) in enumerate(zip(counts, ("before", "after"), strict=True)):
        top = count if closed else count - 1
        off = (pairs[:, column] < 0) | (pairs[:, column] > top)
        if off.any():
            k = int(off.argmax())
            raise CorrespondenceError(
                f"anchor {k} is at {pairs[k, column]:g} on the outline {side}, which ends at {top}"
            )
    before = _snapped(pairs[:, 0], counts[0], closed)
    after = _snapped(pairs[:, 1], counts[1], closed)
    order = np.argsort(before, kind="stable")
    before, after = before[order], after[order]
    for s in (before, np.sort(after)):
        if (np.diff(s) == 0).any():
            raise CorrespondenceError("two anchors share a point; move one of them or delete it")
    whole = counts[1] if closed else None
    directions = [f for f in (False, True) if _rises(-after if f else after, whole)]
    if not closed:
        directions = [f for f in directions if _ends_agree(before, after, counts, f)]
    if not directions:
        raise CorrespondenceError("the anchors cross: no order along the outlines suits them all")
    return before, after, directions[0] if len(directions) == 1 else None


def _ends_agree(before: FloatArray, after: FloatArray, counts: tuple[int, int], flipped: bool) -> bool:
    """An end of an open outline may be anchored only to the end that the direction gives it."""
    n, m = counts
    first, last = (m - 1, 0) if flipped else (0, m - 1)
    at_first, at_last = before == 0, before == n - 1
    return bool(((after == first) == at_first).all() and ((after == last) == at_last).all())
