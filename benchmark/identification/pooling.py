"""The session's stiffness from its trials: the trial is the unit, never the sample."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, TypeAlias

import numpy as np
import scipy

from benchmark.identification.elastic_law import NAMES, Weights, inside, law_derivatives, law_force, weights_of
from benchmark.identification.trial_data import FittingError, TrialData, reduced
from benchmark.identification.trial_features import ContactRange
from benchmark.identification.trial_fit import TrialFit
from benchmark.response.force_curve import Array
from benchmark.response.least_squares import EXACT, least_squares
from benchmark.response.trials_model import TrialColumns, TrialsEvaluation

BETWEEN_TRIALS = "t interval of the mean logarithm, the trial as the unit"
OF_CURVE = ", and {share:.2g} % by the model's own error over depth, alike in all"
LEAST_FREEDOM = 2.0
"""Degrees of freedom of a single trial count as no fewer."""
NORMAL_95 = 1.96
"""Standard errors on either side of a normal 95 % interval."""
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

    What the curve's own error leaves is alike in all trials, and in no scatter of theirs: it is in the interval beside
    that, by squares of half-widths. A single trial has the interval of its own fit; effective rows less three
    parameters, but at least two, are its degrees of freedom.

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
    mean, scattered, std = mean_interval(logs)
    share = shared([trial.of_curve[0] for trial in trials])
    half, ahead = math.hypot(scattered, share), math.hypot(scattered * math.sqrt(len(logs) + 1), share)
    return PooledStiffness(
        math.exp(mean),
        math.exp(mean - half),
        math.exp(mean + half),
        std,
        (math.exp(mean - ahead), math.exp(mean + ahead)),
        len(logs),
        f"{BETWEEN_TRIALS}{OF_CURVE.format(share=100.0 * share) if share else ''}",
    )


def shared(deviations: Sequence[float]) -> float:
    """Half-width of a 95 % interval by what has these standard deviations and is alike in all trials."""
    return NORMAL_95 * math.fsum(deviations) / len(deviations)


def widened(found: PooledStiffness, shares: Mapping[str, float]) -> PooledStiffness:
    """The same stiffness with the interval that independent further causes leave of it.

    Half-widths add by their squares, the causes' being 1.96 times their uncertainty: for few trials more than Welch and
    Satterthwaite's (JCGM 100:2008, G.4.1), by which three trials' interval gets narrower as a cause is added.

    Parameters
    ----------
    found : PooledStiffness
    shares : mapping of str to float
        By which standard uncertainty, a share of the stiffness, each cause moves it.
    """
    further = NORMAL_95 * math.sqrt(math.fsum(share**2 for share in shares.values()))
    ratios = found.value / found.ci95_low, found.ci95_high / found.value
    low, high = (math.exp(math.hypot(math.log(ratio), further)) for ratio in ratios)
    by = ", ".join(f"{key} {100 * share:.2g} %" for key, share in sorted(shares.items(), key=lambda one: -one[1]))
    return replace(
        found,
        ci95_low=found.value / low,
        ci95_high=found.value * high,
        next_trial=None,
        method=f"the trials' scatter, the model's own error, and standard uncertainties of the set-up as told: {by}",
    )


def mean_interval(values: Sequence[float] | Array) -> tuple[float, float, float]:
    """Return mean, half-width of its 95 % t interval, standard deviation (n - 1) of two values or more."""
    sample = np.asarray(values, dtype=float)
    mean = math.fsum(sample) / len(sample)
    std = math.sqrt(math.fsum((sample - mean) ** 2) / (len(sample) - 1))  # in any order the same, as the mean is
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


APART = 1.25
"""Fold between the mean stiffness of conditions from which on one stiffness is said not to follow them."""
CHANCE = 1e-3
"""P of an F test below which conditions differ by more than their trials scatter."""
LEAST_WITHIN = 1e-3
"""Relative scatter within conditions that counts as no less."""


def fold_between(groups: Sequence[Sequence[float]]) -> float | None:
    """How many times the largest group's mean is the smallest's; None within `APART`, or where it may be chance.

    Parameters
    ----------
    groups : sequence of sequences of float
        Logarithms, of two groups or more that hold two trials more than there are groups.
    """
    count, freedom = len(groups), sum(len(group) for group in groups) - len(groups)
    if count < 2 or freedom < 2:
        return None
    means = np.array([math.fsum(group) / len(group) for group in groups])
    sizes = np.array([len(group) for group in groups])
    inside = sum(float(np.sum((np.array(group) - mean) ** 2)) for group, mean in zip(groups, means, strict=True))
    within = max(inside / freedom, LEAST_WITHIN**2)
    between = float(np.sum(sizes * (means - np.average(means, weights=sizes)) ** 2)) / (count - 1)
    fold = math.exp(float(np.ptp(means)))
    chance = float(scipy.stats.f.sf(between / within, count - 1, freedom))
    return fold if fold > APART and chance < CHANCE else None


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
    """Fit one stiffness factor with each trial's own rest force and onset to all trials.

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
    most = max(50, TOTAL_ROWS // len(trials))
    rows = tuple((reduced(trial, most), allowed, fit) for trial, allowed, fit in trials)
    model = _CommonStiffness(rows, tuple(_weights(trial, fit) for trial, _, fit in rows))
    own = np.clip([[fit.rest, fit.onset] for _, _, fit in trials], *inside(*model.trial_bounds))
    fitted = least_squares(model, np.array([math.log(pooled.value)]), own, search=EXACT)
    value = math.exp(fitted.vector[0])
    return JointFit(value, not pooled.ci95_low <= value <= pooled.ci95_high)


@dataclass(frozen=True, eq=False)
class _CommonStiffness:
    """One stiffness factor, by its logarithm, and the rest force and onset of each trial as nuisances in their range.

    A `benchmark.response.trials_model.TrialsModel`.
    """

    trials: tuple[tuple[TrialData, ContactRange, TrialFit], ...]
    weights: tuple[Weights, ...]

    @property
    def bounds(self) -> tuple[Array, Array]:
        """None on the stiffness."""
        return np.array([-np.inf]), np.array([np.inf])

    @property
    def trial_precision(self) -> Array:
        """No priors."""
        return np.zeros(2)

    @cached_property
    def trial_bounds(self) -> tuple[Array, Array]:
        """(R, 2) ranges of rest force, N, and onset, m; both ends alike for what stays."""
        low = np.array([[allowed.rest_low, allowed.low] for _, allowed, _ in self.trials])
        high = np.array([[allowed.rest_high, allowed.high] for _, allowed, _ in self.trials])
        known = np.array([[fit.rest, fit.onset] for _, _, fit in self.trials])
        loading = np.array([[fit.contact_from_loading] for _, _, fit in self.trials])
        stays = loading | (known == low) | (known == high)
        return np.where(stays, known, low), np.where(stays, known, high)

    def prior(self, start: Array) -> tuple[Array, Array]:
        """None."""
        return np.zeros_like(start), np.zeros_like(start)

    def evaluated(self, vector: Array, nuisance: Array) -> TrialsEvaluation:
        """Weighted residuals of all trials."""
        residuals = [
            _weight(trial, fit) * weights.white(trial.force - law_force(trial, allowed, vector[0], *own))
            for (trial, allowed, fit), own, weights in zip(self.trials, nuisance, self.weights, strict=True)
        ]
        return TrialsEvaluation(vector, nuisance, [], residuals)

    def columns(self, at: TrialsEvaluation, warm: TrialColumns | None = None) -> TrialColumns:  # noqa: ARG002
        """By the stiffness, and by rest force and onset."""
        each = [
            _weight(trial, fit) * weights.white(law_derivatives(trial, allowed, at.vector[0], own[1]))
            for (trial, allowed, fit), own, weights in zip(self.trials, at.nuisance, self.weights, strict=True)
        ]
        return TrialColumns([one[:, :1] for one in each], [one[:, 1:] for one in each])

    def nuisance_columns(self, at: TrialsEvaluation) -> list[Array]:
        """By rest force and onset."""
        return self.columns(at).nuisance


def _weight(trial: TrialData, fit: TrialFit) -> float:
    return 1.0 / (fit.peak * math.sqrt(trial.rows))


def _weights(trial: TrialData, fit: TrialFit) -> Weights:
    """Those of the trial's own fit, for as few rows as are left."""
    noise = fit.row_noise * math.sqrt(trial.rows / fit.rows_fitted)
    return weights_of(trial, np.array([fit.log_stiffness, fit.rest, fit.onset]), noise)


def counted_trials(number: int) -> str:
    """A number of trials in words."""
    return "1 trial" if number == 1 else f"{number} trials"
