"""Creep of a stack whose layers relax each in its own way, one wavenumber at a time, and the few lags that all share.

Layer l has the stiffness K_l between its faces and the series g_lj, tau_lj. With the displacement q_lj that each
branch lags behind by, tau_lj q_lj' = u - q_lj,

    sum_l (1 + eta d/dt) K_l u - sum_lj g_lj K_l q_lj = f.

With K_l = R_l' R_l and y_lj = sqrt(g_lj tau_lj) R_l q_lj this is symmetric,

    y' = -D y + C u,    K u = f + C' y,    D = diag(1 / tau_lj),    C_lj = sqrt(g_lj / tau_lj) R_l,

so that the answer to f is what comes at once, K^-1, and lags whose rates are the eigenvalues of D - C K^-1 C'. Under
Kelvin-Voigt damping u is a state too and nothing comes at once. Shear and bulk modulus of a layer relax alike.

The rates of all wavenumbers are replaced by shared ones. A lag of rate lambda has the transform 1 / (1 + s / lambda).
As a function of x = ln lambda it is analytic in the strip |Im x| < pi / 2 for every s that a history can hold
(Re s >= 0), so polynomials in x through Chebyshev's points of an interval of half-width a converge like rho^-M with
rho = r + sqrt(1 + r^2), r = pi / (2 a) (L. N. Trefethen, Approximation Theory and Approximation Practice, chapter 8).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from wavemodel.arrays import FloatArray
from wavemodel.integrators.viscoelastic import Prony

TOLERANCE = 1e-13
SEPARATION = 0.7
"""Rates further apart than e^SEPARATION from their neighbours start an interval of their own."""
POINT = 1e-9
"""An interval narrower than this (in ln lambda) is one point."""


@dataclass(frozen=True)
class StackCreep:
    """Compliance of n wavenumbers as an instant part and m lags each.

    Attributes
    ----------
    instant
        (n, L, 2, 2) in m/Pa, as `Compliance.faces`.
    rate
        (n, m) of the lags, 1/s.
    faces
        (n, m, L, 2, 2) of the lags, m/Pa: instant and lags together are the compliance after a long time.
    """

    instant: FloatArray
    rate: FloatArray
    faces: FloatArray


def stack_creep(layers: FloatArray, base: str, series: Sequence[Prony], retardation: float) -> StackCreep:
    """Creep of a stack.

    Parameters
    ----------
    layers
        (n, L, 4, 4) stiffness of each layer between its faces, Pa/m.
    base
        "bonded" or "free".
    series
        L, from the surface down.
    retardation
        Kelvin-Voigt time, s.
    """
    roots = _roots(layers)
    stiffness = _assembled(layers, base)
    branch = _branches(roots, series, stiffness.shape[-1])
    rates = np.repeat(np.concatenate([one.ordered[1] for one in series]), 4)
    if retardation:
        system, readout = _damped(stiffness, branch, rates, retardation)
    else:
        readout = np.swapaxes(np.linalg.solve(stiffness, np.swapaxes(branch, -1, -2)), -1, -2)
        system = np.diag(rates) - branch @ np.swapaxes(readout, -1, -2)
    rate, shapes = np.linalg.eigh(0.5 * (system + np.swapaxes(system, -1, -2)))
    moved = np.swapaxes(shapes, -1, -2) @ readout
    tops = moved[..., : 2 * layers.shape[1]].reshape(*rate.shape, layers.shape[1], 2)
    instant = np.zeros_like(stiffness)
    if retardation == 0.0:
        instant[:] = np.linalg.inv(stiffness)
    return StackCreep(
        instant[:, : 2 * layers.shape[1], :2].reshape(-1, layers.shape[1], 2, 2),
        rate,
        tops[..., None] * (moved[..., :2] / rate[..., None])[:, :, None, None],
    )


def _roots(layers: FloatArray) -> FloatArray:
    """(n, L, 4, 4) R of K = R' R."""
    values, vectors = np.linalg.eigh(layers)
    roots: FloatArray = np.sqrt(np.maximum(values, 0.0))[..., None] * np.swapaxes(vectors, -1, -2)
    return roots


def _assembled(layers: FloatArray, base: str) -> FloatArray:
    """(n, d, d) stiffness of all faces that move."""
    count = layers.shape[1]
    out = np.zeros((layers.shape[0], 2 * count + 2, 2 * count + 2))
    for index in range(count):
        at = slice(2 * index, 2 * index + 4)
        out[:, at, at] += layers[:, index]
    kept = 2 * count + (2 if base == "free" else 0)
    return out[:, :kept, :kept]


def _branches(roots: FloatArray, series: Sequence[Prony], unknowns: int) -> FloatArray:
    """(n, 4 J, d) C, four rows a branch."""
    rows = []
    for index, one in enumerate(series):
        for strength, rate in zip(*one.ordered, strict=True):
            row = np.zeros((roots.shape[0], 4, 2 * roots.shape[1] + 2))
            row[:, :, 2 * index : 2 * index + 4] = np.sqrt(strength * rate) * roots[:, index]
            rows.append(row[..., :unknowns])
    return np.concatenate(rows, axis=1) if rows else np.zeros((roots.shape[0], 0, unknowns))


def _damped(
    stiffness: FloatArray, branch: FloatArray, rates: FloatArray, retardation: float
) -> tuple[FloatArray, FloatArray]:
    """System and readout with the faces as states: sqrt(eta) R u with K = R' R."""
    root = np.linalg.cholesky(stiffness)
    size = root.shape[-1]
    back = np.linalg.inv(root) / np.sqrt(retardation)
    across = -branch @ np.swapaxes(back, -1, -2)
    system = np.zeros((root.shape[0], size + rates.size, size + rates.size))
    system[:, :size, :size] = np.eye(size) / retardation
    system[:, size:, :size] = across
    system[:, :size, size:] = np.swapaxes(across, -1, -2)
    system[:, size:, size:] = np.diag(rates)
    readout = np.concatenate([back, np.zeros((root.shape[0], rates.size, size))], axis=1)
    return system, readout


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
