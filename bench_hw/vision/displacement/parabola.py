"""A parabola for each marker and axis, with its coefficient of determination (the article's section 3.2.5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bench_hw.vision.displacement.tracks import FloatArray

_FEWEST = 4


@dataclass(frozen=True, eq=False, slots=True)
class ParabolaFits:
    """Parabolas a t^2 + b t + c.

    Parameters
    ----------
    a, b, c : ndarray, shape (...)
        Coefficients; NaN where there were fewer than four values.
    r2 : ndarray, shape (...)
        1 less the share of the variance that is left; NaN where the values do not vary.
    count : ndarray, shape (...)
        Values that were known.
    """

    a: FloatArray
    b: FloatArray
    c: FloatArray
    r2: FloatArray
    count: FloatArray


def fit_parabolas(t: FloatArray, values: FloatArray) -> ParabolaFits:
    """Fit a parabola over time (or frame numbers, as the article does) to each column.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Instants or frame numbers.
    values : ndarray, shape (n, ...)
        For instance displacements (n, m, 2); NaN where not known.

    Returns
    -------
    ParabolaFits
        Of shape (...).
    """
    columns = values.reshape(len(values), -1)
    fits = np.array([_fit(t, column) for column in columns.T]).reshape(-1, 5)
    shape = values.shape[1:]
    a, b, c, r2, count = (fits[:, index].reshape(shape) for index in range(5))
    return ParabolaFits(a, b, c, r2, count)


def _fit(t: FloatArray, values: FloatArray) -> tuple[float, float, float, float, int]:
    known = np.isfinite(values)
    count = int(known.sum())
    if count < _FEWEST:
        return np.nan, np.nan, np.nan, np.nan, count
    t, values = t[known], values[known]
    middle, reach = float(t.mean()), float(np.ptp(t)) / 2.0 or 1.0
    s = (t - middle) / reach
    basis = np.stack([s * s, s, np.ones_like(s)], axis=1)
    (a, b, c), *_ = np.linalg.lstsq(basis, values, rcond=None)
    left = values - basis @ np.array([a, b, c])
    total = float(((values - values.mean()) ** 2).sum())
    r2 = 1.0 - float((left**2).sum()) / total if total > 0.0 else np.nan
    a, b = a / reach**2, b / reach
    return float(a), float(b - 2.0 * a * middle), float(c - b * middle + a * middle**2), r2, count
