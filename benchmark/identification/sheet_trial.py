"""One filmed trial fitted by lmfit: stiffness, contact, zero, tool axis; thickness or relaxation where asked."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmark.identification.sheet_model import (
    NONE,
    FilmedTrial,
    Relaxation,
    SheetState,
    sheet_force,
    sheet_markers,
)
from benchmark.identification.trial_features import contact_range
from benchmark.identification.trial_fit import TrialFit
from benchmark.response.force_curve import Array
from benchmark.response.noise import effective_rows, lag_one
from benchmark.response.ramp_table import RampTable

MM = 1e3
AXIS_LIMIT = 5.0
THICKNESS_LIMIT = math.log(2.0)
FIRST_FORCE, FIRST_MARKER = 0.01, 0.02e-3
"""Standard deviations to begin with: of the force over its peak, of a marker in m."""
LEAST_MARKER = 1e-7


@dataclass(frozen=True)
class Weights:
    """Standard deviations of the residuals, widened for autocorrelation: N and m."""

    force: float
    marker: float


@dataclass(frozen=True)
class SheetTrial:
    """A trial's fit.

    Attributes
    ----------
    state : SheetState
    stderr : mapping
        Of the free parameters, in the fit's units (mm for lengths).
    correlations, force_correlations : mapping
        Of the free parameters by "a, b": from force and markers, and from the force alone.
    force_rms : float
        N.
    marker_rms : float
        m, over both directions together (a distance).
    weights : Weights
    """

    name: str
    condition: str
    state: SheetState
    stderr: Mapping[str, float]
    correlations: Mapping[str, float]
    force_correlations: Mapping[str, float]
    force_rms: float
    marker_rms: float
    weights: Weights


def fit_sheet_trial(
    filmed: FilmedTrial,
    sheet: RampTable,
    start: TrialFit,
    free: Collection[str] = (),
    relaxation: Relaxation = NONE,
    known: SheetTrial | None = None,
) -> SheetTrial:
    """Fit a filmed trial.

    Parameters
    ----------
    filmed, sheet
        The data and the model.
    start : TrialFit
        Of the force alone.
    free : collection of str
        What is fitted besides stiffness, onset, zero and axis: "log_thickness", "share", "log_tau".
    relaxation : Relaxation
        Where it is not fitted; a start where it is.
    known : SheetTrial, optional
        A fit with fewer free parameters, whose values and weights are the start.
    """
    parameters = _parameters(filmed, start, free, relaxation)
    if known is None:
        result = _least_squares(parameters, filmed, sheet, Weights(FIRST_FORCE * start.peak, FIRST_MARKER))
        parameters, weights = result.params, _weights(filmed, sheet, _state(result.params), len(result.var_names))
    else:
        weights = known.weights
        _begin_at(parameters, known.state)
    result = _least_squares(parameters, filmed, sheet, weights)
    state = _state(result.params)
    force, marker = _residuals(filmed, sheet, state)
    jacobian = _jacobian(result.params, filmed, sheet, weights, result.var_names)
    covariance = _inverse(jacobian.T @ jacobian)
    of_force = [index for index, name in enumerate(result.var_names) if not name.startswith("axis")]
    alone = jacobian[: filmed.trial.rows, of_force]
    return SheetTrial(
        filmed.trial.name,
        filmed.trial.condition,
        state,
        dict(zip(result.var_names, np.sqrt(np.diag(covariance)).tolist(), strict=True)),
        _correlations(covariance, result.var_names),
        _correlations(_inverse(alone.T @ alone), [result.var_names[index] for index in of_force]),
        float(np.sqrt(np.mean(force**2))),
        rms_distance(marker),
        weights,
    )


def rms_distance(residual: Array) -> float:
    """Root mean square length of residuals (f, m, 2), NaN left out."""
    return float(np.sqrt(np.nanmean((residual**2).sum(axis=-1))))


def _parameters(filmed: FilmedTrial, start: TrialFit, free: Collection[str], relaxation: Relaxation) -> Any:
    import lmfit

    allowed = contact_range(filmed.trial.depth, filmed.trial.force)
    low, high = MM * allowed.low, MM * max(allowed.high, start.onset + 1e-6)
    parameters = lmfit.Parameters()
    parameters.add("log_stiffness", value=start.log_stiffness)
    parameters.add("onset", value=float(np.clip(MM * start.onset, low + 1e-3, high - 1e-4)), min=low, max=high + 0.2)
    parameters.add("zero", value=start.zero)
    for name in ("axis_x", "axis_y"):
        parameters.add(name, value=0.01, min=-AXIS_LIMIT, max=AXIS_LIMIT)
    limit = THICKNESS_LIMIT
    parameters.add("log_thickness", value=0.0, min=-limit, max=limit, vary="log_thickness" in free)
    share = relaxation.share or (0.05 if "share" in free else 0.0)
    parameters.add("share", value=share, min=0.0 if "share" in free else -1.0, max=0.95, vary="share" in free)
    parameters.add("log_tau", value=math.log(relaxation.tau), min=-7.0, max=9.0, vary="log_tau" in free)
    return parameters


def _begin_at(parameters: Any, state: SheetState) -> None:
    values = (state.log_stiffness, MM * state.onset, state.zero, MM * state.axis[0], MM * state.axis[1])
    for name, value in zip(("log_stiffness", "onset", "zero", "axis_x", "axis_y"), values, strict=True):
        parameters[name].set(value=value)


def _state(parameters: Any) -> SheetState:
    value = parameters.valuesdict()
    return SheetState(
        value["log_stiffness"],
        value["onset"] / MM,
        value["zero"],
        (value["axis_x"] / MM, value["axis_y"] / MM),
        value["log_thickness"],
        Relaxation(value["share"], math.exp(value["log_tau"])),
    )


def _residuals(filmed: FilmedTrial, sheet: RampTable, state: SheetState) -> tuple[Array, Array]:
    force = sheet_force(filmed, sheet, state) - filmed.trial.force
    return force, sheet_markers(filmed, sheet, state) - filmed.places


def _weighted(parameters: Any, filmed: FilmedTrial, sheet: RampTable, weights: Weights) -> Array:
    force, marker = _residuals(filmed, sheet, _state(parameters))
    flat = np.nan_to_num(marker.ravel() / weights.marker)
    return np.concatenate([force / weights.force, flat])


def _least_squares(parameters: Any, filmed: FilmedTrial, sheet: RampTable, weights: Weights) -> Any:
    import lmfit

    minimizer = lmfit.Minimizer(_weighted, parameters, fcn_args=(filmed, sheet, weights), calc_covar=False)
    return minimizer.least_squares(x_scale="jac")


def _weights(filmed: FilmedTrial, sheet: RampTable, state: SheetState, parameters: int) -> Weights:
    """Residual deviations; an error of the depth moves all markers of a frame, so that a frame counts as one."""
    force, marker = _residuals(filmed, sheet, state)
    rows = effective_rows(len(force), lag_one(force, parameters))
    sigma = float(np.sqrt(np.mean(force**2) * len(force) / max(rows, 2.0)))
    size = float(np.sqrt(np.nanmean(marker**2)))
    count = int(np.isfinite(marker).sum())
    frames = max(effective_rows(len(marker), lag_one(np.nanmean(marker[:, :, 0], axis=1), 1)), 2.0)
    return Weights(max(sigma, 1e-9), max(size * math.sqrt(count / (2.0 * frames)), LEAST_MARKER))


def _jacobian(parameters: Any, filmed: FilmedTrial, sheet: RampTable, weights: Weights, names: list[str]) -> Array:
    """Return central differences (n, p) by the free parameters, in their own units."""
    columns = []
    for name in names:
        value, step = parameters[name].value, 1e-4
        ends = []
        for sign in (1.0, -1.0):
            changed = parameters.copy()
            changed[name].set(value=value + sign * step, min=-np.inf, max=np.inf)
            ends.append(_weighted(changed, filmed, sheet, weights))
        columns.append((ends[0] - ends[1]) / (2.0 * step))
    return np.stack(columns, axis=1)


def _inverse(normal: Array) -> Array:
    """Inverse of the normal matrix; a large variance where the data say nothing."""
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-30))
    unit = normal / np.outer(scale, scale) + 1e-12 * np.eye(len(normal))
    return np.asarray(np.linalg.inv(unit) / np.outer(scale, scale))


def _correlations(covariance: Array, names: list[str]) -> dict[str, float]:
    std = np.sqrt(np.maximum(np.diag(covariance), 1e-30))
    unit = covariance / np.outer(std, std)
    return {f"{names[i]}, {names[j]}": float(unit[i, j]) for i in range(len(names)) for j in range(i + 1, len(names))}
