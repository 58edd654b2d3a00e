"""Noise of one trial whose neighbouring samples resemble each other (first-order autoregressive, AR(1))."""

from __future__ import annotations

import numpy as np

from benchmark.fitting.curve import Array

LARGEST = 0.999


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
