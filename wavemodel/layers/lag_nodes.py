"""A few lags that stand for many: the rates of all wavenumbers are replaced by shared ones.

A lag of rate lambda has the transform 1 / (1 + s / lambda). As a function of x = ln lambda it is analytic in the strip
|Im x| < pi / 2 for every s that a history can hold (Re s >= 0), so polynomials in x through Chebyshev's points of an
interval of half-width a converge like rho^-M with rho = r + sqrt(1 + r^2), r = pi / (2 a) (L. N. Trefethen,
Approximation Theory and Approximation Practice, chapter 8).
"""

from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray

TOLERANCE = 1e-13
SEPARATION = 0.7
"""Rates further apart than e^SEPARATION from their neighbours start an interval of their own."""
POINT = 1e-9
"""An interval narrower than this (in ln lambda) is one point."""


@dataclass(frozen=True)
class LagNodes:
    """M shared rates in separate intervals.

    Attributes
    ----------
    groups
        Nodes of each interval, 1/s.
    edges
        (intervals - 1,) borders between the intervals.
    """

    groups: tuple[FloatArray, ...]
    edges: FloatArray

    @property
    def rate(self) -> FloatArray:
        """(M,) in 1/s."""
        return np.concatenate(self.groups)

    def share(self, rate: FloatArray) -> FloatArray:
        """(..., M) weights of the shared lags that stand for lags of the rates (...)."""
        group, x = np.searchsorted(self.edges, rate), np.log(rate)
        parts = []
        for index, nodes in enumerate(np.log(one) for one in self.groups):
            inside = group == index
            parts.append(_lagrange(np.where(inside, x, nodes[0]), nodes) * inside[..., None])
        return np.concatenate(parts, axis=-1)


def lag_nodes(rate: FloatArray) -> LagNodes:
    """Shared rates for all of `rate` (any shape, 1/s)."""
    x = np.sort(np.log(rate.ravel()))
    cuts = np.flatnonzero(np.diff(x) > SEPARATION)
    first, last = np.concatenate([[0], cuts + 1]), np.concatenate([cuts, [x.size - 1]])
    groups = tuple(_chebyshev(x[a], x[b]) for a, b in zip(first, last, strict=True))
    return LagNodes(groups, np.exp(0.5 * (x[cuts] + x[cuts + 1])))


def _chebyshev(low: float, high: float) -> FloatArray:
    half = 0.5 * (high - low)
    if half < POINT:
        return np.exp([0.5 * (low + high)])
    ratio = 0.5 * np.pi / half
    count = int(np.ceil(-np.log(TOLERANCE) / np.arcsinh(ratio))) + 1
    points = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return np.asarray(np.exp(0.5 * (low + high) + half * points))


def _lagrange(x: FloatArray, nodes: FloatArray) -> FloatArray:
    """(..., m) Lagrange's polynomials of Chebyshev's points (m,) at x (...), by the barycentric formula."""
    if nodes.size == 1:
        return np.ones((*x.shape, 1))
    count = nodes.size
    signs = (-1.0) ** np.arange(count) * np.sin(np.pi * (np.arange(count) + 0.5) / count)
    apart = x[..., None] - nodes
    hit = apart == 0.0
    terms = signs / np.where(hit, 1.0, apart)
    out = terms / terms.sum(axis=-1, keepdims=True)
    return np.asarray(np.where(hit.any(axis=-1, keepdims=True), hit.astype(np.float64), out))
