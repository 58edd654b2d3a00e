"""The session's stiffness from its trials: the trial is the unit, never the sample."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import scipy

from benchmark.identification.elastic_law import NAMES, add_bounded, law_derivatives
from benchmark.identification.errors import FittingError
from benchmark.identification.trial_data import TrialData, reduced
from benchmark.identification.trial_features import ContactRange, shape_above_rest
from benchmark.identification.trial_fit import TrialFit
from benchmark.response.force_curve import Array

BETWEEN_TRIALS = "t interval of the mean logarithm, the trial as the unit"
LEAST_FREEDOM = 2.0
"""Degrees of freedom of a single trial count as no fewer."""
ONE_TRIAL = (
    "a single trial: interval from its own residual, effective sample size corrected for first-order "
    "autocorrelation; it says nothing about the scatter between trials"
)


@dataclass(frozen=True)
class PooledStiffness:
    """Stiffness factor of a session.

    Attributes
    ----------
    value, ci95_low, ci95_high : float
        Geometric mean of the trials and its 95 % interval.
    log_std : float or None
        Standard deviation (n - 1) of the trials' logarithms; None for a single trial.
    next_trial : (low, high) or None
        95 % interval for one more trial of the same kind.
    trials : int
    method : str
        How the interval was made.
    """

    value: float
    ci95_low: float
    ci95_high: float
    log_std: float | None
    next_trial: tuple[float, float] | None
    trials: int
    method: str

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        return {
            "value": self.value,
            "ci95": [self.ci95_low, self.ci95_high],
            "log_std_between_trials": self.log_std,
            "next_trial_ci95": None if self.next_trial is None else list(self.next_trial),
            "trials": self.trials,
            "interval": self.method,
        }


def pool(trials: Sequence[TrialFit]) -> PooledStiffness:
    """Pool the trials' stiffness factors by the mean of their logarithms.

    A single trial has the interval of its own fit; effective rows less three parameters, but at least
    two, are its degrees of freedom.

    Raises
    ------
    FittingError
        No trial.
    """
    if not trials:
        raise FittingError("no trial to pool a stiffness from")
    if len(trials) == 1:
        return _single(trials[0])
    logs = np.array([trial.log_stiffness for trial in trials])
    mean, half, std = mean_interval(logs)
    ahead = half * math.sqrt(len(logs) + 1)
    return PooledStiffness(
        math.exp(mean),
        math.exp(mean - half),
        math.exp(mean + half),
        std,
        (math.exp(mean - ahead), math.exp(mean + ahead)),
        len(logs),
        BETWEEN_TRIALS,
    )


def mean_interval(values: Sequence[float] | Array) -> tuple[float, float, float]:
    """Return mean, half-width of its 95 % t interval, standard deviation (n - 1) of two values or more."""
    sample = np.asarray(values, dtype=float)
    mean = math.fsum(sample) / len(sample)
    std = float(np.std(sample, ddof=1))
    half = float(scipy.stats.t.ppf(0.975, len(sample) - 1)) * std / math.sqrt(len(sample))
    return mean, half, std


def _single(trial: TrialFit) -> PooledStiffness:
    df = max(trial.effective_rows - len(NAMES), LEAST_FREEDOM)
    half = float(scipy.stats.t.ppf(0.975, df)) * trial.log_stiffness_stderr
    return PooledStiffness(
        trial.stiffness,
        math.exp(trial.log_stiffness - half),
        math.exp(trial.log_stiffness + half),
        None,
        None,
        1,
        ONE_TRIAL,
    )


TOTAL_ROWS = 20000
"""Rows of all trials together in the joint fit; longer trials are averaged further."""

Triples: TypeAlias = Sequence[tuple[TrialData, ContactRange, TrialFit]]


@dataclass(frozen=True)
class JointFit:
    """Stiffness factor of the joint fit, and whether it lies outside the pooled 95 % interval."""

    value: float
    differs: bool

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`."""
        return {"value": self.value, "outside_pooled_ci95": self.differs}


def fit_jointly(trials: Triples, pooled: PooledStiffness) -> JointFit:
    """Fit one stiffness factor with each trial's own rest force and onset to all trials by lmfit.

    Residuals are divided by the trial's peak and the root of its rows, so that each trial counts alike. Onset
    and rest force that come from a trial's loading alone, and what is at its bound, stay as fitted there.
    Samples are no unit of replication, so the result has no interval.

    Parameters
    ----------
    trials : sequence of (TrialData, ContactRange, TrialFit)
        The rows that were fitted, their range, and the single fits they gave.
    pooled : PooledStiffness
        Start and interval to compare with.
    """
    import lmfit

    most = max(50, TOTAL_ROWS // len(trials))
    rows = [(reduced(trial, most), allowed, fit) for trial, allowed, fit in trials]
    parameters = lmfit.Parameters()
    parameters.add("log_stiffness", value=math.log(pooled.value))
    for number, (_, allowed, fit) in enumerate(rows):
        _add_trial(parameters, number, allowed, fit)
    minimizer = lmfit.Minimizer(_residual, parameters, fcn_args=(rows,))
    result = minimizer.least_squares(jac=_jacobian, x_scale="jac")  # knows bounds, where leastsq creeps along them
    value = math.exp(result.params["log_stiffness"].value)
    return JointFit(value, not pooled.ci95_low <= value <= pooled.ci95_high)


def _add_trial(parameters: Any, number: int, allowed: ContactRange, fit: TrialFit) -> None:
    ranges = {
        "rest": (fit.rest, allowed.rest_low, allowed.rest_high),
        "onset": (fit.onset, allowed.low, allowed.high),
    }
    for name, (value, low, high) in ranges.items():
        if fit.contact_from_loading or value in (low, high):
            parameters.add(f"{name}_{number}", value=value, vary=False)
        else:
            add_bounded(parameters, f"{name}_{number}", value, low, high)


def _weight(trial: TrialData, fit: TrialFit) -> float:
    return 1.0 / (fit.peak * math.sqrt(trial.rows))


def _residual(parameters: Any, rows: Triples) -> Array:
    value = parameters.valuesdict()
    factor = math.exp(value["log_stiffness"])
    parts = []
    for number, (trial, allowed, fit) in enumerate(rows):
        model = value[f"rest_{number}"] + factor * shape_above_rest(trial, allowed, value[f"onset_{number}"])
        parts.append(_weight(trial, fit) * (model - trial.force))
    return np.concatenate(parts)


def _jacobian(parameters: Any, rows: Triples) -> Array:
    """Return the derivatives (n, p) by the parameters that vary, in lmfit's order."""
    value = parameters.valuesdict()
    column = {name: index for index, name in enumerate(n for n, each in parameters.items() if each.vary)}
    jacobian = np.zeros((sum(trial.rows for trial, _, _ in rows), len(column)))
    first = 0
    for number, (trial, allowed, fit) in enumerate(rows):
        block = jacobian[first : first + trial.rows]
        first += trial.rows
        derivatives = law_derivatives(trial, allowed, value["log_stiffness"], value[f"onset_{number}"])
        for name, derivative in derivatives.items():
            index = column.get(name, column.get(f"{name}_{number}"))
            if index is not None:
                block[:, index] = _weight(trial, fit) * derivative
    return jacobian
