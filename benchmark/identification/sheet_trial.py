"""One filmed trial fitted: stiffness, contact, zero, tool axis; thickness or relaxation where asked."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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
from benchmark.response.least_squares import TrialsFit, fit_record
from benchmark.response.noise import effective_rows, lag_one
from benchmark.response.ramp_table import RampTable
from benchmark.response.trials_model import RecordModel, differences

MM = 1e3
CONTACT = ("log_stiffness", "onset", "zero", "axis_x", "axis_y")
NAMES = (*CONTACT, "log_thickness", "share", "log_tau")
"""Parameters in the order of the fit's vector; lengths in mm."""
STEP = 1e-4
"""By which a parameter is changed to differentiate."""
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
    vector, bounds = _start(filmed, start, free, relaxation)
    if known is None:
        first = Weights(FIRST_FORCE * start.peak, FIRST_MARKER)
        vector = fit_record(_record(filmed, sheet, first, bounds), vector).vector
        weights = _weights(filmed, sheet, _state(vector), _free(bounds).size)
    else:
        weights = known.weights
        vector[: len(CONTACT)] = _vector(known.state)[: len(CONTACT)]
    return _sheet_trial(filmed, sheet, weights, fit_record(_record(filmed, sheet, weights, bounds), vector))


def _sheet_trial(filmed: FilmedTrial, sheet: RampTable, weights: Weights, fitted: TrialsFit[RecordModel]) -> SheetTrial:
    """Put the parts together."""
    state, free = _state(fitted.vector), _free(fitted.model.bounds)
    names = [NAMES[k] for k in free]
    force, marker = _residuals(filmed, sheet, state)
    jacobian = fitted.columns.vector[0][:, free]
    covariance = _inverse(jacobian.T @ jacobian)
    of_force = [index for index, name in enumerate(names) if not name.startswith("axis")]
    alone = jacobian[: filmed.trial.rows, of_force]
    return SheetTrial(
        filmed.trial.name,
        filmed.trial.condition,
        state,
        dict(zip(names, np.sqrt(np.diag(covariance)).tolist(), strict=True)),
        _correlations(covariance, names),
        _correlations(_inverse(alone.T @ alone), [names[index] for index in of_force]),
        float(np.sqrt(np.mean(force**2))),
        rms_distance(marker),
        weights,
    )


def rms_distance(residual: Array) -> float:
    """Root mean square length of residuals (f, m, 2), NaN left out."""
    return float(np.sqrt(np.nanmean((residual**2).sum(axis=-1))))


def _start(
    filmed: FilmedTrial, start: TrialFit, free: Collection[str], relaxation: Relaxation
) -> tuple[Array, tuple[Array, Array]]:
    """Vector (8,) by `NAMES` to begin with, and its bounds; what is not fitted has equal ones."""
    allowed = contact_range(filmed.trial.depth, filmed.trial.force)
    onset_low, onset_high = MM * allowed.low, MM * max(allowed.high, start.onset + 1e-6)
    onset = float(np.clip(MM * start.onset, onset_low + 1e-3, onset_high - 1e-4))
    share = relaxation.share or (0.05 if "share" in free else 0.0)
    vector = np.array([start.log_stiffness, onset, start.zero, 0.01, 0.01, 0.0, share, math.log(relaxation.tau)])
    low = np.array([-np.inf, onset_low, -np.inf, -AXIS_LIMIT, -AXIS_LIMIT, -THICKNESS_LIMIT, 0.0, -7.0])
    high = np.array([np.inf, onset_high + 0.2, np.inf, AXIS_LIMIT, AXIS_LIMIT, THICKNESS_LIMIT, 0.95, 9.0])
    fixed = np.array([name not in CONTACT and name not in free for name in NAMES])
    return vector, (np.where(fixed, vector, low), np.where(fixed, vector, high))


def _free(bounds: tuple[Array, Array]) -> NDArray[np.int64]:
    """Numbers of the parameters that are fitted."""
    return np.flatnonzero(bounds[0] < bounds[1])


def _vector(state: SheetState) -> Array:
    relaxation = state.relaxation
    contact = (state.log_stiffness, MM * state.onset, state.zero, MM * state.axis[0], MM * state.axis[1])
    return np.array([*contact, state.log_thickness, relaxation.share, math.log(relaxation.tau)])


def _state(vector: Array) -> SheetState:
    log_stiffness, onset, zero, axis_x, axis_y, log_thickness, share, log_tau = vector.tolist()
    axis, relaxation = (axis_x / MM, axis_y / MM), Relaxation(share, math.exp(log_tau))
    return SheetState(log_stiffness, onset / MM, zero, axis, log_thickness, relaxation)


def _residuals(filmed: FilmedTrial, sheet: RampTable, state: SheetState) -> tuple[Array, Array]:
    force = sheet_force(filmed, sheet, state) - filmed.trial.force
    return force, sheet_markers(filmed, sheet, state) - filmed.places


def _record(filmed: FilmedTrial, sheet: RampTable, weights: Weights, bounds: tuple[Array, Array]) -> RecordModel:
    def residual(vector: Array) -> Array:
        force, marker = _residuals(filmed, sheet, _state(vector))
        return -np.concatenate([force / weights.force, np.nan_to_num(marker.ravel() / weights.marker)])

    return RecordModel(residual, lambda vector: differences(residual, vector, STEP, bounds), bounds)


def _weights(filmed: FilmedTrial, sheet: RampTable, state: SheetState, parameters: int) -> Weights:
    """Residual deviations; an error of the depth moves all markers of a frame, so that a frame counts as one."""
    force, marker = _residuals(filmed, sheet, state)
    rows = effective_rows(len(force), lag_one(force, parameters))
    sigma = float(np.sqrt(np.mean(force**2) * len(force) / max(rows, 2.0)))
    size = float(np.sqrt(np.nanmean(marker**2)))
    count = int(np.isfinite(marker).sum())
    frames = max(effective_rows(len(marker), lag_one(np.nanmean(marker[:, :, 0], axis=1), 1)), 2.0)
    return Weights(max(sigma, 1e-9), max(size * math.sqrt(count / (2.0 * frames)), LEAST_MARKER))


def _inverse(normal: Array) -> Array:
    """Inverse of the normal matrix; a large variance where the data say nothing."""
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-30))
    unit = normal / np.outer(scale, scale) + 1e-12 * np.eye(len(normal))
    return np.asarray(np.linalg.inv(unit) / np.outer(scale, scale))


def _correlations(covariance: Array, names: list[str]) -> dict[str, float]:
    std = np.sqrt(np.maximum(np.diag(covariance), 1e-30))
    unit = covariance / np.outer(std, std)
    return {f"{names[i]}, {names[j]}": float(unit[i, j]) for i in range(len(names)) for j in range(i + 1, len(names))}
