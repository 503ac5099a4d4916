"""Towards a wished frame as near as the barrier lets: Newton steps, each cut before anything meets."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse.linalg import splu

from core.geometry.boxes import IndexArray
from core.geometry.outline import FloatArray
from core.repair.barrier import REACH, WEIGHT, Barrier, Terms
from core.repair.chains import Chains, ComplexArray
from core.repair.contacts import ARRIVING, Pairs, clear_moves, free_share, near_pairs

LONGEST_STEP = 0.05
"""Sizes of the drawing a vertex may go in one Newton step: longer ones meet everything and are cut anyway."""

SMALLEST_STEP = 1e-5
"""Sizes of the drawing: a step below it is the end of the descent."""

FEW_TERMS = 300
"""Up to so many active pairs are put on top of the factored metric; more are factored with it."""


@dataclass(eq=False)
class Metric:
    """What being away from the wished frame costs: z'Qz, with Q (n, n) sparse, symmetric and positive.

    Factored once. Columns of the inverse are kept, since the same vertices touch again and again. Weighted means
    of the vertices that are `held` (k, n) never give way to the barrier: they go where they are wished.
    """

    matrix: Any
    held: FloatArray | None = None
    _rows: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))
    _place: IndexArray = field(default_factory=lambda: np.zeros(0, np.intp))

    @cached_property
    def _factors(self) -> Any:
        return splu(self.matrix.tocsc())

    def solve(self, z: ComplexArray) -> ComplexArray:
        """Return Q^-1 z (n,)."""
        both = self._factors.solve(np.stack([z.real, z.imag], axis=1))
        return np.asarray(both[:, 0] + 1j * both[:, 1], np.complex128)

    def replies(self, vertices: IndexArray) -> FloatArray:
        """Return the rows of Q^-1 that belong to the vertices, (k, n)."""
        n = self.matrix.shape[0]
        if not len(self._place):
            self._rows, self._place = np.zeros((0, n)), np.full(n, -1)
        missing = np.unique(vertices[self._place[vertices] < 0])
        if len(missing):
            units = np.zeros((n, len(missing)))
            units[missing, np.arange(len(missing))] = 1.0
            self._place[missing] = len(self._rows) + np.arange(len(missing))
            self._rows = np.concatenate([self._rows, self._without_held(self._factors.solve(units).T)])
        return self._rows[self._place[vertices]]

    @cached_property
    def _grip(self) -> tuple[FloatArray, FloatArray]:
        """What the held means answer to a pull at each of them, (k, n), and the inverse of how they do (k, k)."""
        pulled = self._factors.solve(np.ascontiguousarray(self.held.T)).T if self.held is not None else 0
        answers = np.asarray(pulled, np.float64)
        return answers, np.linalg.pinv(answers @ np.asarray(self.held).T, rcond=1e-12)

    def lift(self, lack: ComplexArray) -> ComplexArray:
        """Return the moves (n,) that cost least and move the held means by `lack` (k,)."""
        answers, back = self._grip
        return np.asarray((back @ lack) @ answers, np.complex128)

    def _without_held(self, rows: FloatArray) -> FloatArray:
        """Rows of the inverse on the vertices' moves that leave the held means where they are."""
        if self.held is None:
            return rows
        answers, back = self._grip
        return np.asarray(rows - (rows @ self.held.T) @ back @ answers, np.float64)

    def step(self, away: ComplexArray, terms: Terms, weight: float) -> ComplexArray:
        """Return the Newton step (n,) from a place `away` from the wished one, with the barrier's terms."""
        if not len(terms.slope):
            return -away
        if len(terms.slope) > FEW_TERMS:
            return self._factored_step(away, terms, weight)
        return self._added_step(away, terms, weight)

    def _added_step(self, away: ComplexArray, terms: Terms, weight: float) -> ComplexArray:
        """Woodbury's formula: the barrier's Hessian is of low rank, so that only small dense systems are left."""
        (v, u, w), (a, b, c) = terms.vertices.T, terms.shares.T
        reply = sum(k[:, None] * self.replies(x) for k, x in ((a, v), (b, u), (c, w)))  # C Q^-1, (k, n)
        reply = np.asarray(reply, np.float64)
        normal, root = terms.normal, np.sqrt(weight * terms.curvature)
        newton = away + _product(weight * terms.slope * normal, reply)
        inner = (reply[:, v] * a + reply[:, u] * b + reply[:, w] * c) * (normal[:, None] * normal.conj()).real
        inner *= root[:, None] * root
        inner[np.diag_indices(len(root))] += 1.0
        along = root * (normal.conj() * (a * newton[v] + b * newton[u] + c * newton[w])).real
        factor = cho_solve(cho_factor(inner, check_finite=False), along, check_finite=False)
        return _product(root * factor * normal, reply) - newton

    def _factored_step(self, away: ComplexArray, terms: Terms, weight: float) -> ComplexArray:
        n, count = len(away), len(terms.slope)
        shares = terms.shares * terms.normal[:, None]
        columns = np.concatenate([terms.vertices, terms.vertices + n], axis=1)
        values = np.concatenate([shares.real, shares.imag], axis=1)
        rows = np.repeat(np.arange(count), 6)
        slopes = sp.csr_matrix((values.ravel(), (rows, columns.ravel())), shape=(count, 2 * n))
        hessian = sp.block_diag([self.matrix, self.matrix]) + slopes.T @ (
            sp.diags(weight * terms.curvature) @ slopes
        )
        pull = self.matrix @ away
        gradient = np.concatenate([pull.real, pull.imag]) + slopes.T @ (weight * terms.slope)
        if self.held is not None:
            rows = sp.block_diag([self.held, self.held])
            lack = self.held @ away
            hessian = sp.block_array([[hessian, rows.T], [rows, -1e-12 * sp.eye_array(rows.shape[0])]])
            gradient = np.concatenate([gradient, lack.real, lack.imag])
        step = -splu(hessian.tocsc()).solve(gradient)
        return np.asarray(step[:n] + 1j * step[n:], np.complex128)

    def cost(self, away: ComplexArray) -> float:
        """Half of z'Qz."""
        return 0.5 * float((away.conj() @ (self.matrix @ away)).real)


def _product(z: ComplexArray, rows: FloatArray) -> ComplexArray:
    """Return z @ rows without turning the rows into complex numbers."""
    real, imag = np.stack([z.real, z.imag]) @ rows
    return np.asarray(real + 1j * imag, np.complex128)


@dataclass(frozen=True, eq=False)
class Field:
    """What every descent of one drawing shares: its chains, the barrier, the metric of wishes.

    Attributes
    ----------
    checkpoint : callable
        Called before every step; raises `CancelledError` when the work is no longer wanted.
    held : (k, n) float array, optional
        Weights of the vertices whose means are pinned.
    """

    chains: Chains
    barrier: Barrier
    mass: FloatArray
    springs: Any
    checkpoint: Callable[[], None]
    held: FloatArray | None = None

    @property
    def many_held(self) -> bool:
        """Whether more pins are held than a similarity can bring back to their places."""
        return self.held is not None and len(self.held) > 2

    @cached_property
    def metric(self) -> Metric:
        """Mass, and springs that spread a deviation over a twentieth of the perimeter."""
        return Metric(sp.diags(self.mass) + 0.05**2 * self.springs, self.held)

    def pairs_near(self, z: ComplexArray) -> Pairs:
        """Pairs within the barrier's widest reach of each other."""
        return near_pairs(self.chains, z[None], np.zeros((1, len(z)), np.complex128), REACH)

    def may_go(self, z: ComplexArray, target: ComplexArray) -> bool:
        """Whether the straight move from z to the target is clear by the margin of moves to be made."""
        return bool(clear_moves(self.chains, z[None], target[None], gap=ARRIVING)[0])


def descend(
    field: Field,
    z: ComplexArray,
    target: ComplexArray,
    *,
    metric: Metric,
    weight: float = WEIGHT,
    steps: int = 12,
    smallest: float = SMALLEST_STEP,
) -> list[ComplexArray]:
    """Return the places passed on the way from z towards the target, z left out; every move between them is clear.

    Minimises half of (x - target)' Q (x - target) plus `weight` times the barrier.
    """
    places: list[ComplexArray] = []
    pairs = field.pairs_near(z)
    for _ in range(steps):
        field.checkpoint()
        move = metric.step(z - target, field.barrier.terms(z, pairs), weight)
        longest = float(np.abs(move).max())
        if longest < smallest:
            break
        move *= min(1.0, LONGEST_STEP / longest)
        before = metric.cost(z - target) + weight * field.barrier.value(z, pairs)
        pairs = near_pairs(field.chains, z[None], move[None], REACH)
        share = free_share(z, move, pairs)
        while share * longest > smallest:
            trial = z + share * move
            if metric.cost(trial - target) + weight * field.barrier.value(trial, pairs) < before:
                break
            share /= 2
        else:
            break
        z = trial
        places.append(z)
    return places
