"""How each neighbourhood of one outline turns and moves to become its counterpart: local rigid frames.

With a correspondence given, the neighbourhood of every node has a best rotation and shift. At the widest
scale it is the rigid motion of the whole, at a narrower one a bent limb has its own. The residual says how
badly the correspondence explains the second outline by rigid parts.
"""

from dataclasses import dataclass

import numpy as np

from core.correspondence.cost import Grid, square_distances
from core.correspondence.ring import ComplexArray
from core.geometry.outline import FloatArray

REACH = 0.5
"""Width of a neighbourhood, in root-mean-square radii; the other scale is the whole."""

RESIDUAL_FLOOR = 1e-3
"""Added to the residuals, else one lucky frame would take all the weight."""


@dataclass(frozen=True, eq=False)
class Frames:
    """The rigid frames of B candidates at S scales round M nodes.

    Attributes
    ----------
    z, y : (B, M) complex array
        Nodes, scaled to a common size.
    headings : (S, B, M) complex array
        Unit numbers: the rotation from before to after round each node.
    forward, backward : (S, B, M) complex array
        Where the frame of a node carries the node itself, z to after and y to before.
    residuals : (S, B) float array
        Mean square of what the frames leave.
    trust : (S, B) float array
        Share of each scale; the smaller its residual, the larger.
    """

    z: ComplexArray
    y: ComplexArray
    headings: ComplexArray
    forward: ComplexArray
    backward: ComplexArray
    residuals: FloatArray
    trust: FloatArray

    @property
    def heading(self) -> ComplexArray:
        """Rotation round each node, (B, M), over all scales."""
        return np.asarray((self.trust[:, :, None] * self.headings).sum(axis=0))

    @property
    def whole_turn(self) -> FloatArray:
        """Angle by which the whole turns, (B,), in radians from -pi to pi."""
        return np.asarray(np.angle(self.headings[0, :, 0]))


def frames(g: Grid, reach: float = REACH) -> Frames:
    """Return the frames of a grid's candidates, of the whole and within `reach`; node i is matched to i."""
    z, y = g.z, g.y
    apart = np.maximum(
        square_distances(z[:, :, None], z[:, None, :]), square_distances(y[:, :, None], y[:, None, :])
    )
    lengths = _node_weights(g)
    kernels = [lengths[:, None, :] * _falloff(apart, r) for r in (np.inf, reach)]
    kernels = [k / k.sum(axis=2, keepdims=True) for k in kernels]
    z, y = _same_size(z, y, kernels[-1], lengths)
    fits = [_fit(z, y, k) for k in kernels]
    headings, forward, backward = (np.stack(x) for x in zip(*fits, strict=True))
    residuals = (square_distances(forward, y) * lengths).sum(axis=2)
    trust = 1 / (residuals + RESIDUAL_FLOOR)
    return Frames(z, y, headings, forward, backward, residuals, trust / trust.sum(axis=0))


def _falloff(apart: FloatArray, reach: float) -> FloatArray:
    return np.ones_like(apart) if np.isinf(reach) else np.exp(apart * (-0.5 / reach**2))


def _node_weights(g: Grid) -> FloatArray:
    """Mean share of the two outlines that each node stands for; (B, M), sums to 1."""
    steps = np.diff(g.u, axis=1) + np.diff(g.v, axis=1)
    if g.closed:
        weights = steps + np.roll(steps, 1, axis=1)
    else:
        weights = np.pad(steps, ((0, 0), (0, 1))) + np.pad(steps, ((0, 0), (1, 0)))
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _mean(kernel: FloatArray, x: ComplexArray) -> ComplexArray:
    """Weighted means round every node. Real kernel, complex numbers: two real products in one."""
    parts = kernel @ np.stack([x.real, x.imag], axis=2)
    return np.asarray(parts[:, :, 0] + 1j * parts[:, :, 1])


def _same_size(
    z: ComplexArray, y: ComplexArray, kernel: FloatArray, lengths: FloatArray
) -> tuple[ComplexArray, ComplexArray]:
    """Scale both to equal local spreads: a measure that neither bending nor a wiggly boundary changes."""
    spread = [
        (lengths * (_mean(kernel, np.abs(x) ** 2 + 0j).real - np.abs(_mean(kernel, x)) ** 2)).sum(axis=1)
        for x in (z, y)
    ]
    tiny = np.finfo(float).tiny
    factor = (np.maximum(spread[1], tiny) / np.maximum(spread[0], tiny)) ** 0.25
    factor = np.clip(factor, 1 / 3, 3)[:, None]
    return z * factor, y / factor


def _fit(z: ComplexArray, y: ComplexArray, kernel: FloatArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Best rotation round every node (complex Procrustes), and where it carries the nodes, both ways."""
    cz, cy = _mean(kernel, z), _mean(kernel, y)
    e = _mean(kernel, np.conj(z) * y) - np.conj(cz) * cy
    size = np.abs(e)
    e = np.divide(e, size, out=np.ones_like(e), where=size > 0)
    return e, cy + e * (z - cz), cz + np.conj(e) * (y - cy)
