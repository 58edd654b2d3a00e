"""One common stiffness factor for all trials at once: a cross-check of the pooled value."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np

from benchmark.fitting.contact import ContactRange, shape_above_rest
from benchmark.fitting.curve import Array
from benchmark.fitting.elastic_law import add_bounded, law_derivatives
from benchmark.fitting.pooling import PooledStiffness
from benchmark.fitting.trial import TrialData, reduced
from benchmark.fitting.trial_result import TrialFit

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
