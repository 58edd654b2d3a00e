"""The session's stiffness from its trials: the trial is the unit, never the sample."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from benchmark.fitting.curve import Array
from benchmark.fitting.elastic_law import NAMES
from benchmark.fitting.errors import FittingError
from benchmark.fitting.trial_result import TrialFit

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
