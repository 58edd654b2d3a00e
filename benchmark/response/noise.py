"""First-order autoregressive (AR(1)) noise: its memory, the transform that whitens it, and what it leaves of n samples.

Rows may be means of raw samples: the variance of a mean and its covariance with the next mean follow in closed form
(G. E. P. Box and G. M. Jenkins, Time Series Analysis, section 2.1), and rows further apart are taken as a Markov chain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.response.force_curve import Array

MEMORIES = (0.0, 0.2, 0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.98, 0.99, 0.995, 0.998)
"""Correlations of neighbouring raw samples that are tried."""
MISSING = 1e6
"""Variance of a row without a sample, in those of a sample."""
LARGEST = 0.999
"""Lag-one autocorrelations are taken as no larger."""


@dataclass(frozen=True, eq=False)
class Whitener:
    """z_k = (e_k - back_k e_j) / scale_k for noise of unit standard deviation a raw sample; (n,) each.

    j = `before`_k is the row with samples before row k.
    """

    back: Array
    scale: Array
    before: NDArray[np.int64]

    def __call__(self, rows: Array) -> Array:
        """(n, ...) rows to white ones."""
        back, scale = (a.reshape(-1, *[1] * (rows.ndim - 1)) for a in (self.back, self.scale))
        return np.asarray((rows - back * rows[self.before]) / scale)


def whitener(count: Array, memory: float) -> Whitener:
    """For rows that hold `count` (n,) samples, neighbours correlated by `memory`; a row without any says nothing."""
    some = np.flatnonzero(count > 0.0)
    back, scale = np.zeros(count.size), np.full(count.size, np.sqrt(MISSING))
    before = np.arange(count.size)
    before[some[1:]] = some[:-1]
    back[some], scale[some] = _chain(count[some], memory)
    return Whitener(back, scale, before)


def _chain(count: Array, memory: float) -> tuple[Array, Array]:
    """`back` and `scale` of rows that follow one another and hold `count` (n,) samples each."""
    held = np.maximum(count, 1.0)
    if memory > 0.0:
        fade = memory**held
        variance = (1.0 + memory) / (1.0 - memory) / held - 2.0 * memory * (1.0 - fade) / (held * (1.0 - memory)) ** 2
        joint = memory * (1.0 - fade[1:]) * (1.0 - fade[:-1]) / (1.0 - memory) ** 2 / (held[1:] * held[:-1])
    else:
        variance, joint = 1.0 / held, np.zeros(max(held.size - 1, 0))
    share = np.clip(joint / np.sqrt(variance[1:] * variance[:-1]), 0.0, 0.9999)
    back = np.concatenate([[0.0], share * np.sqrt(variance[1:] / variance[:-1])])[: count.size]
    scale = np.sqrt(variance * np.concatenate([[1.0], 1.0 - share**2])[: count.size])
    return back, scale


def fit_memory(errors: Array | Sequence[Array], counts: Array | Sequence[Array]) -> float:
    """The memory of noise by maximum likelihood from R errors (n,), each trial with a scale of its own."""
    best, chosen = np.inf, 0.0
    for memory in MEMORIES:
        total = 0.0
        for error, count in zip(errors, counts, strict=True):
            some = count > 0.0
            if not some.any():
                continue
            use = whitener(count, memory)
            white = use(error)[some]
            total += white.size * np.log(np.mean(white**2) + 1e-300) + 2.0 * np.log(use.scale[some]).sum()
        if total < best:
            best, chosen = total, memory
    return chosen


def scales(errors: Array | Sequence[Array], counts: Array | Sequence[Array], memory: float) -> Array:
    """(R,) standard deviation of a raw sample in each trial; NaN in one without samples, such as one not filmed."""
    return np.array([_scale(error, count, memory) for error, count in zip(errors, counts, strict=True)])


def _scale(error: Array, count: Array, memory: float) -> float:
    some = count > 0.0
    return float(np.sqrt(np.mean(whitener(count, memory)(error)[some] ** 2))) if some.any() else np.nan


def lag_one(residual: Array, parameters: int = 1) -> float:
    """Lag-one autocorrelation of a residual (n,) left by a fit of `parameters`, between 0 and 0.999.

    The estimate is low by (1 + 3 rho) / n for a fitted mean (Marriott and Pope, Biometrika 41:390); that is
    undone once for each fitted parameter. Negative values count as 0: an interval is never narrowed.
    """
    n = len(residual)
    centred = residual - residual.mean()
    power = float(centred @ centred)
    if power == 0.0:
        return 0.0
    raw = float(centred[1:] @ centred[:-1]) / power
    share = min(parameters / n, 0.1)
    return float(np.clip((raw + share) / (1.0 - 3.0 * share), 0.0, LARGEST))


def effective_rows(rows: int, rho: float) -> float:
    """Return how many independent samples tell as much as `rows` of them: n (1 - rho) / (1 + rho)."""
    return rows * (1.0 - rho) / (1.0 + rho)


def whitened(columns: Array, rho: float) -> Array:
    """Rows (n - 1, c) of `columns` (n, c) less rho times the row before, which makes AR(1) noise white."""
    return np.asarray(columns[1:] - rho * columns[:-1])
