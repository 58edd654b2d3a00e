"""Least squares of the elastic law of one trial by lmfit.

force = rest + stiffness factor x (curve(depth - onset) - curve(reference - onset)), where `rest` is the force at the
reference depth, at which the trial is least deep: what the data say of it bounds it. The force without contact,
the zero, follows from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.identification.trial_data import TrialData
from benchmark.identification.trial_features import ContactRange, Start, shape_above_rest
from benchmark.response.force_curve import Array
from benchmark.response.noise import effective_rows, lag_one

AT_BOUND = 1e-3
"""An onset or rest force within this fraction of its range from an end of it is put at that end."""
NAMES = ("log_stiffness", "rest", "onset")
LEAST_EFFECTIVE = float(len(NAMES))
"""Effective rows count as no fewer: a residual that is all misfit tells little, yet something."""


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

    @property
    def start(self) -> Start:
        """The same as a start for another fit."""
        return Start(float(np.exp(self.log_stiffness)), self.rest, self.onset, np.inf)


def minimise(trial: TrialData, allowed: ContactRange, start: Start, contact_fixed: bool = False) -> LawFit:
    """Fit one trial from a start, within the range; rest force and onset stay put with `contact_fixed`.

    What ends at a bound is fixed there, so that the other standard errors stay defined.
    """
    parameters = _parameters(allowed, start, contact_fixed)
    result = _leastsq(parameters, trial, allowed)
    free = [result.params[name] for name in ("rest", "onset") if result.params[name].vary]
    fixed = [fix_at_bound(parameter) for parameter in free]
    if any(fixed):
        result = _leastsq(result.params, trial, allowed)
    return _law_fit(result, trial, allowed)


def add_bounded(parameters: Any, name: str, value: float, low: float, high: float) -> None:
    """Add a bounded parameter, its start inside: at a bound lmfit's variables would have no gradient."""
    inner = AT_BOUND * (high - low)
    parameters.add(name, value=float(np.clip(value, low + inner, high - inner)), min=low, max=high)


def fix_at_bound(parameter: Any) -> bool:
    """Fix a parameter that lies at an end of its range there, and say whether it was fixed."""
    inner = AT_BOUND * (parameter.max - parameter.min)
    for end in (parameter.min, parameter.max):
        if abs(parameter.value - end) <= inner:
            parameter.set(value=end, vary=False)
            return True
    return False


def _parameters(allowed: ContactRange, start: Start, contact_fixed: bool) -> Any:
    import lmfit

    parameters = lmfit.Parameters()
    parameters.add("log_stiffness", value=float(np.log(start.stiffness)))
    if contact_fixed:
        parameters.add("rest", value=start.rest, vary=False)
        parameters.add("onset", value=start.onset, vary=False)
    else:
        add_bounded(parameters, "rest", start.rest, allowed.rest_low, allowed.rest_high)
        add_bounded(parameters, "onset", start.onset, allowed.low, allowed.high)
    return parameters


def _leastsq(parameters: Any, trial: TrialData, allowed: ContactRange) -> Any:
    import lmfit

    return lmfit.Minimizer(_residual, parameters, fcn_args=(trial, allowed)).leastsq(Dfun=_jacobian)


def _residual(parameters: Any, trial: TrialData, allowed: ContactRange) -> Array:
    value = parameters.valuesdict()
    shape = shape_above_rest(trial, allowed, value["onset"])
    return np.asarray(value["rest"] + np.exp(value["log_stiffness"]) * shape - trial.force)


def _jacobian(parameters: Any, trial: TrialData, allowed: ContactRange) -> Array:
    """Return the derivatives (n, p) by the parameters that vary, in lmfit's order."""
    value = parameters.valuesdict()
    columns = law_derivatives(trial, allowed, value["log_stiffness"], value["onset"])
    return np.column_stack([columns[name] for name, each in parameters.items() if each.vary])


def law_derivatives(trial: TrialData, allowed: ContactRange, log_stiffness: float, onset: float) -> dict[str, Array]:
    """Return the derivatives (n,) of the law's force by `log_stiffness`, `rest` (N) and `onset` (m)."""
    factor = np.exp(log_stiffness)
    slope = trial.curve.slope(trial.depth - onset) - trial.curve.slope(np.array([allowed.reference - onset]))
    return {
        "log_stiffness": factor * shape_above_rest(trial, allowed, onset),
        "rest": np.ones(trial.rows),
        "onset": -factor * slope,
    }


def _law_fit(result: Any, trial: TrialData, allowed: ContactRange) -> LawFit:
    value = result.params.valuesdict()
    rho = lag_one(result.residual, result.nvarys)
    effective = max(effective_rows(trial.rows, rho), LEAST_EFFECTIVE)
    covariance = _covariance(result) * trial.rows / effective
    above = np.array([allowed.reference - value["onset"]])
    factor = np.exp(value["log_stiffness"])
    preload, slope = factor * float(trial.curve(above)[0]), factor * float(trial.curve.slope(above)[0])
    to_zero = np.array([-preload, 1.0, slope])
    return LawFit(
        value["log_stiffness"],
        value["rest"],
        value["rest"] - preload,
        value["onset"],
        float(np.sqrt(covariance[0, 0])),
        float(np.sqrt(max(to_zero @ covariance @ to_zero, 0.0))),
        float(np.sqrt(covariance[2, 2])),
        _correlations(covariance),
        rho,
        effective,
    )


def _covariance(result: Any) -> Array:
    """Return lmfit's covariance as (3, 3) in the order of NAMES, zeros for what was fixed."""
    covariance = np.zeros((len(NAMES), len(NAMES)))
    if result.covar is not None:
        free = [NAMES.index(name) for name in result.var_names]
        covariance[np.ix_(free, free)] = result.covar
    return covariance


def _correlations(covariance: Array) -> dict[str, float]:
    std = np.sqrt(np.diag(covariance))
    return {
        f"{NAMES[i]}, {NAMES[j]}": float(covariance[i, j] / (std[i] * std[j]))
        for i, j in ((0, 1), (0, 2), (1, 2))
        if std[i] > 0.0 and std[j] > 0.0
    }
