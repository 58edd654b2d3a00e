"""Least squares of the elastic law of one trial.

force = rest + stiffness factor x (curve(depth - onset) - curve(reference - onset)), where `rest` is the force at the
reference depth, at which the trial is least deep: what the data say of it bounds it. The force without contact,
the zero, follows from it.

Touch, zero and stiffness of a trial are nearly the same to the force: over a press from the touch on a bend of the
curve of 0.2 % moves the stiffness by 2 %. So rows are weighted by the noise and by the slope and the bend that the
curve's own error may have over depth, a random course as in fits of free parameters (Kennedy and O'Hagan 2001, Journal
of the Royal Statistical Society B 63:425): generalised least squares, noise and weights in turn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchmark.identification.model_error import functions
from benchmark.identification.trial_data import TrialData
from benchmark.identification.trial_features import ContactRange, Start, shape_above_rest
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import TrialsFit, fit_record
from benchmark.response.noise import effective_rows, lag_one
from benchmark.response.trials_model import RecordModel

AT_BOUND = 1e-3
"""An onset or rest force within this fraction of its range from an end of it is put at that end."""
NAMES = ("log_stiffness", "rest", "onset")
LEAST_EFFECTIVE = float(len(NAMES))
"""Effective rows count as no fewer: a residual that is all misfit tells little, yet something."""
PLACES = 201
"""Depths at which the functions of the curve's own error are kept."""
TURNS = 2
"""Fits with weights from the noise that the one before leaves."""
LEAST_NOISE = 1e-4
"""Noise counts as no less, a share of the largest force: below it the curve's own error is all there is."""


@dataclass(frozen=True, eq=False)
class Weights:
    """Of a trial's rows: what the curve's own error may add to them (n, m), in the rows' noise, by its singular values.

    Attributes
    ----------
    noise : float
        Standard deviation of a row, N, widened for autocorrelation.
    basis : (n, r) array
    sizes : (r,) array
        In the rows' noise.
    """

    noise: float
    basis: Array
    sizes: Array

    def white(self, rows: Array) -> Array:
        """Rows (n, ...) in N so that noise and error together are as noise alone, independent."""
        return np.asarray(rows - self.basis @ ((1.0 - 1.0 / np.hypot(1.0, self.sizes)) * (self.basis.T @ rows).T).T)

    def noise_of(self, residual: Array) -> Array:
        """(n,) N that is left of a residual (n,) without the likeliest error of the curve."""
        share = self.sizes**2 / (1.0 + self.sizes**2)
        return np.asarray(residual - self.basis @ (share * (self.basis.T @ residual)))

    def moved(self, white: Array, free: NDArray[np.bool_]) -> Array:
        """(p, p) covariance that the error leaves in parameters with white columns (n, p), some of them free."""
        moves = np.zeros((free.size, self.sizes.size))
        error = self.basis * (self.noise * self.sizes / np.hypot(1.0, self.sizes))
        moves[free] = np.linalg.pinv(white[:, free]) @ error
        return np.asarray(moves @ moves.T)


def _even(trial: TrialData) -> Weights:
    return Weights(0.0, np.zeros((trial.rows, 0)), np.zeros(0))


def weights_of(trial: TrialData, vector: Array, noise: float) -> Weights:
    """Weights of a trial's rows where a fit has come to a vector (3,) by `NAMES`, with noise in N.

    Of the curve's error slope and bend count: an error of its size is one of the stiffness.
    """
    if trial.error is None:
        return _even(trial)
    below = trial.depth - vector[2]
    force = np.exp(vector[0]) * trial.curve(below)
    places = np.linspace(0.0, 1.0, PLACES) * max(float(below.max()), 1e-300)
    known = zip(trial.error.deviations[1:], functions(PLACES)[1:], strict=True)
    courses = [size * np.interp(below, places, one) for size, one in known]
    least = max(noise, LEAST_NOISE * float(np.abs(force).max()), 1e-300)
    basis, sizes, _ = np.linalg.svd(force[:, None] * np.column_stack(courses) / least, full_matrices=False)
    return Weights(least, basis, sizes)


@dataclass(frozen=True)
class LawFit:
    """What least squares found, SI.

    Attributes
    ----------
    log_stiffness, rest, zero, onset : float
        -, N, N, m.
    log_stiffness_stderr, zero_stderr, onset_stderr : float
        Widened by sqrt(n / effective rows); 0 for what was fixed.
    correlations : mapping
        Of the free parameters, by "a, b".
    lag_one, effective_rows : float
        Autocorrelation rho of the residual, and n (1 - rho) / (1 + rho) but at least 3.
    row_noise : float
        Standard deviation of the residual without the likeliest error of the curve, widened likewise, N.
    of_curve : (float, float, float)
        Standard deviations that the curve's own error leaves of log stiffness, zero (N) and onset (m); in the errors.
    """

    log_stiffness: float
    rest: float
    zero: float
    onset: float
    log_stiffness_stderr: float
    zero_stderr: float
    onset_stderr: float
    correlations: Mapping[str, float]
    lag_one: float
    effective_rows: float
    row_noise: float
    of_curve: tuple[float, float, float]

    @property
    def start(self) -> Start:
        """The same as a start for another fit."""
        return Start(float(np.exp(self.log_stiffness)), self.rest, self.onset, np.inf)


def minimise(trial: TrialData, allowed: ContactRange, start: Start, contact_fixed: bool = False) -> LawFit:
    """Fit one trial from a start, within the range; rest force and onset stay put with `contact_fixed`.

    What ends at a bound is fixed there, so that the other standard errors stay defined.
    """
    vector = np.array([np.log(start.stiffness), start.rest, start.onset])
    low = np.array([-np.inf, allowed.rest_low, allowed.low])
    high = np.array([np.inf, allowed.rest_high, allowed.high])
    if contact_fixed:
        low[1:] = high[1:] = vector[1:]
    found, vector = _within(trial, allowed, vector, (low, high), _even(trial))
    for _ in range(TURNS if trial.error is not None else 0):
        found, vector = _within(trial, allowed, vector, (low, high), weights_of(trial, vector, found.row_noise))
    return found


def _within(
    trial: TrialData, allowed: ContactRange, vector: Array, bounds: tuple[Array, Array], weights: Weights
) -> tuple[LawFit, Array]:
    """Fit with some weights from a vector (3,); what ends at a bound is fixed there."""
    low, high = (one.copy() for one in bounds)
    vector = np.append(vector[0], np.clip(vector[1:], *inside(low[1:], high[1:])))
    fitted = fit_record(_record(trial, allowed, low, high, weights), vector)
    ends = np.array([at_end(*each) for each in zip(fitted.vector, low, high, strict=True)])
    fixed = np.isfinite(ends) & (low < high)
    if fixed.any():
        low[fixed] = high[fixed] = ends[fixed]
        fitted = fit_record(_record(trial, allowed, low, high, weights), fitted.vector)
    return _law_fit(fitted, trial, allowed, low < high, weights), fitted.vector


def inside(low: Array, high: Array) -> tuple[Array, Array]:
    """Ends of ranges (k,) a little within them, where a fit may begin."""
    return low + AT_BOUND * (high - low), high - AT_BOUND * (high - low)


def at_end(value: float, low: float, high: float) -> float:
    """The end of a range at which a value lies; NaN within."""
    near = [end for end in (low, high) if np.isfinite(end) and abs(value - end) <= AT_BOUND * (high - low)]
    return near[0] if near else np.nan


def _record(trial: TrialData, allowed: ContactRange, low: Array, high: Array, weights: Weights) -> RecordModel:
    def residual(vector: Array) -> Array:
        return weights.white(trial.force - law_force(trial, allowed, *vector))

    def derivative(vector: Array) -> Array:
        return weights.white(law_derivatives(trial, allowed, vector[0], vector[2]))

    return RecordModel(residual, derivative, (low, high))


def law_force(trial: TrialData, allowed: ContactRange, log_stiffness: float, rest: float, onset: float) -> Array:
    """(n,) N of the law."""
    return np.asarray(rest + np.exp(log_stiffness) * shape_above_rest(trial, allowed, onset))


def law_derivatives(trial: TrialData, allowed: ContactRange, log_stiffness: float, onset: float) -> Array:
    """(n, 3) derivatives of the law's force by `NAMES`."""
    factor = np.exp(log_stiffness)
    slope = trial.curve.slope(trial.depth - onset) - trial.curve.slope(np.array([allowed.reference - onset]))
    return np.column_stack([factor * shape_above_rest(trial, allowed, onset), np.ones(trial.rows), -factor * slope])


def _law_fit(
    fitted: TrialsFit[RecordModel],
    trial: TrialData,
    allowed: ContactRange,
    free: NDArray[np.bool_],
    weights: Weights,
) -> LawFit:
    log_stiffness, rest, onset = fitted.vector.tolist()
    residual, parameters = weights.noise_of(trial.force - law_force(trial, allowed, *fitted.vector)), int(free.sum())
    rho = lag_one(residual, parameters)
    effective = max(effective_rows(trial.rows, rho), LEAST_EFFECTIVE)
    row_noise = float(np.sqrt(residual @ residual / (trial.rows - parameters) * trial.rows / effective))
    moved = weights.moved(fitted.columns.vector[0], free)
    moved[0, 0] += 0.0 if trial.error is None else float(trial.error.size) ** 2
    covariance = _covariance(fitted, free) * max(row_noise, weights.noise) ** 2
    covariance[0, 0] += 0.0 if trial.error is None else float(trial.error.size) ** 2
    above = np.array([allowed.reference - onset])
    factor = np.exp(log_stiffness)
    preload, slope = factor * float(trial.curve(above)[0]), factor * float(trial.curve.slope(above)[0])
    to_zero = np.array([-preload, 1.0, slope])
    return LawFit(
        log_stiffness,
        rest,
        rest - preload,
        onset,
        float(np.sqrt(covariance[0, 0])),
        float(np.sqrt(max(to_zero @ covariance @ to_zero, 0.0))),
        float(np.sqrt(covariance[2, 2])),
        _correlations(covariance),
        rho,
        effective,
        row_noise,
        (float(np.sqrt(moved[0, 0])), float(np.sqrt(to_zero @ moved @ to_zero)), float(np.sqrt(moved[2, 2]))),
    )


def _covariance(fitted: TrialsFit[RecordModel], free: NDArray[np.bool_]) -> Array:
    """(3, 3) for residuals of unit variance, zeros for what was fixed."""
    normal = fitted.blocks.matrix[0]
    covariance: Array = np.zeros_like(normal)
    scale = np.sqrt(np.maximum(np.diag(normal)[free], 1e-300))
    unit = normal[np.ix_(free, free)] / np.outer(scale, scale)
    covariance[np.ix_(free, free)] = np.linalg.pinv(unit, hermitian=True) / np.outer(scale, scale)
    return covariance


def _correlations(covariance: Array) -> dict[str, float]:
    std = np.sqrt(np.diag(covariance))
    return {
        f"{NAMES[i]}, {NAMES[j]}": float(covariance[i, j] / (std[i] * std[j]))
        for i, j in ((0, 1), (0, 2), (1, 2))
        if std[i] > 0.0 and std[j] > 0.0
    }
