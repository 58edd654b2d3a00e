"""What the fit of one trial gives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from benchmark.files.sessions.doubts import EITHER_WAY
from benchmark.identification.elastic_law import LawFit, minimise
from benchmark.identification.trial_data import (
    LEAST_ROWS,
    FittingError,
    NoContactError,
    TrialData,
    reduced,
    rows_of,
    up_to_depth,
)
from benchmark.identification.trial_features import (
    LEAST_EVIDENCE,
    LEAST_TRAVEL,
    ContactRange,
    Hold,
    Start,
    contact_range,
    find_start,
    largest_creep,
    largest_decay,
    travel,
    without_spikes,
)
from benchmark.response.force_curve import Array


@dataclass(frozen=True)
class TrialFit:
    """Result for one trial, SI.

    Attributes
    ----------
    name, condition : str
    rows, rows_fitted : int
        Measured rows, and rows after averaging and leaving out what the curve does not reach.
    log_stiffness, log_stiffness_stderr : float
        Natural logarithm of the stiffness factor; standard error widened for autocorrelation.
    zero, zero_stderr : float
        Force without contact, N.
    rest : float
        Force where the trial is least deep, N; the zero unless the trial starts in contact.
    onset, onset_stderr : float
        Depth at first contact, m; standard error 0 where the onset is at its bound.
    onset_range : (low, high)
        What the data allow, m.
    peak : float
        Largest force above the zero, N; of a long trial, of its averaged rows.
    residual_rms, residual_max : float
        N, over all measured rows that the curve reaches.
    lag_one, effective_rows : float
        Autocorrelation of the residual and the number of independent samples it leaves.
    hold : Hold or None
        The loaded hold in which the force falls most.
    contact_from_loading : bool
        Whether onset and zero come from the rows up to the largest force only.
    correlations : mapping
        Between the fitted parameters, by "a, b".
    notes : tuple of str
    of_curve : (float, float, float)
        Standard deviations that the curve's own error, alike in all trials, leaves of log stiffness, zero and onset (N,
        m); within the standard errors.
    row_noise : float
        Standard deviation of a fitted row, widened for autocorrelation, N; by it and that error rows were weighted.
    creep_percent : float
        By how much the depth grows while a force is held, slowing down, in % of the depth; 0 where it does not.
    """

    name: str
    condition: str
    rows: int
    rows_fitted: int
    log_stiffness: float
    log_stiffness_stderr: float
    zero: float
    zero_stderr: float
    rest: float
    onset: float
    onset_stderr: float
    onset_range: tuple[float, float]
    peak: float
    residual_rms: float
    residual_max: float
    lag_one: float
    effective_rows: float
    hold: Hold | None
    contact_from_loading: bool
    correlations: Mapping[str, float]
    notes: tuple[str, ...]
    of_curve: tuple[float, float, float] = (0.0, 0.0, 0.0)
    row_noise: float = 0.0
    creep_percent: float = 0.0

    @property
    def key(self) -> tuple[str, str]:
        """Condition and name."""
        return self.condition, self.name

    @property
    def stiffness(self) -> float:
        """Stiffness factor of this trial alone."""
        return float(np.exp(self.log_stiffness))

    @property
    def residual_percent(self) -> float:
        """Root-mean-square residual in % of the peak."""
        return 100.0 * self.residual_rms / self.peak

    @property
    def onset_at_bound(self) -> bool:
        """Whether the data only bound the onset."""
        low, high = self.onset_range
        return self.onset in (low, high)

    @property
    def time_dependent(self) -> bool:
        """Whether the force falls in a hold, beyond the noise."""
        return self.hold is not None and self.hold.seen

    def to_dict(self) -> dict[str, Any]:
        """Entry of `fit.json`, with units in the keys."""
        return {
            "name": self.name,
            "condition": self.condition,
            "rows": self.rows,
            "rows_fitted": self.rows_fitted,
            "stiffness_factor": self.stiffness,
            "log_stiffness_factor": self.log_stiffness,
            "log_stiffness_factor_stderr": self.log_stiffness_stderr,
            "zero_N": self.zero,
            "zero_stderr_N": self.zero_stderr,
            "rest_N": self.rest,
            "onset_mm": 1e3 * self.onset,
            "onset_stderr_mm": 1e3 * self.onset_stderr,
            "onset_range_mm": [1e3 * end for end in self.onset_range],
            "onset_at_bound": self.onset_at_bound,
            "peak_N": self.peak,
            "residual_rms_N": self.residual_rms,
            "residual_rms_percent_of_peak": self.residual_percent,
            "residual_max_percent_of_peak": 100.0 * self.residual_max / self.peak,
            "residual_lag_one": self.lag_one,
            "effective_rows": self.effective_rows,
            "hold_decay_percent": None if self.hold is None else self.hold.decay_percent,
            "hold": None if self.hold is None else self.hold.to_dict(),
            "creep_percent": self.creep_percent,
            "correlations": dict(self.correlations),
            "notes": list(self.notes),
        }


MOST_ROWS = 2000
"""A longer trial is averaged down to this many rows for the fit."""


def fit_trial(trial: TrialData) -> TrialFit:
    """Fit stiffness factor, zero and contact onset of one trial (least squares in N).

    Raises
    ------
    NoContactError
        The depth does not change, or no force rises over the noise.
    FittingError
        The force curve ends too early for the trial.
    """
    averaged = _averaged(trial)
    fitted, allowed, notes = prepare_rows(trial, averaged)
    start = find_start(fitted, allowed)
    if start.stiffness <= 0.0 or not start.evidence >= LEAST_EVIDENCE:
        raise NoContactError(_no_contact(trial, start))
    hold = largest_decay(averaged)
    contact = _contact_from_loading(fitted, allowed) if hold is not None and hold.seen else None
    if contact is None:
        contact = whole = minimise(fitted, allowed, start)
    else:
        whole = minimise(fitted, allowed, contact.start, contact_fixed=True)
        notes.append("the force falls in a hold: onset and zero come from the rows up to the largest force")
    return _result(trial, averaged, fitted.rows, allowed, hold, contact, whole, notes)


def _averaged(trial: TrialData) -> TrialData:
    """The trial in at most `MOST_ROWS` rows; raises NoContactError where its depth does not change."""
    if travel(trial.depth) < LEAST_TRAVEL:
        raise NoContactError(f"{trial.label}: the depth changes by less than {1e3 * LEAST_TRAVEL:g} mm: no motion")
    return reduced(trial, MOST_ROWS)


def prepare_rows(trial: TrialData, averaged: TrialData | None = None) -> tuple[TrialData, ContactRange, list[str]]:
    """Return the rows to fit, the range of the onset, and what was left out or averaged.

    `averaged` is the trial in at most `MOST_ROWS` rows, where that is there already.

    Raises
    ------
    NoContactError, FittingError
        As `fit_trial`.
    """
    notes = []
    fitted = _averaged(trial) if averaged is None else averaged
    if fitted.rows < trial.rows:
        notes.append(f"{trial.rows} rows averaged in groups to {fitted.rows} for the fit")
    allowed = contact_range(fitted.depth, fitted.force)
    shallowest = float(fitted.depth.max()) - trial.curve.reach
    if shallowest <= 0.5 * (allowed.low + allowed.high):
        return fitted, replace(allowed, low=max(allowed.low, shallowest)), notes
    reached = up_to_depth(fitted, allowed.low + trial.curve.reach)
    if reached is None:
        raise FittingError(
            f"{trial.label}: the force curve ends at {1e3 * trial.curve.depth[-1]:.6g} mm, too early for a "
            f"trial that presses {1e3 * (float(fitted.depth.max()) - allowed.high):.6g} mm deep"
        )
    notes.append(f"{fitted.rows - reached.rows} of {fitted.rows} rows are beyond the force curve, left out")
    return reached, allowed, notes


def _no_contact(trial: TrialData, start: Start) -> str:
    return (
        f"{trial.label}: no force rises with depth over the noise (t = {start.evidence:.3g}, at least "
        f"{LEAST_EVIDENCE:g} is needed); was there contact, and is press positive in force and depth? "
        f"Where pressing is negative, {EITHER_WAY}"
    )


def _contact_from_loading(trial: TrialData, allowed: ContactRange) -> LawFit | None:
    """Fit the rows up to the largest force; None where they are too few or do not rise."""
    rows = int(np.argmax(without_spikes(trial.force))) + 1
    if rows < LEAST_ROWS:
        return None
    loading = rows_of(trial, slice(0, rows))
    start = find_start(loading, allowed)
    return minimise(loading, allowed, start) if start.stiffness > 0.0 else None


def _result(
    trial: TrialData,
    averaged: TrialData,
    rows_fitted: int,
    allowed: ContactRange,
    hold: Hold | None,
    contact: LawFit,
    whole: LawFit,
    notes: list[str],
) -> TrialFit:
    """Put the parts together; residuals over all measured rows that the curve reaches."""
    residual = _residual(trial, whole)
    found = TrialFit(
        name=trial.name,
        condition=trial.condition,
        rows=trial.rows,
        rows_fitted=rows_fitted,
        log_stiffness=whole.log_stiffness,
        log_stiffness_stderr=whole.log_stiffness_stderr,
        zero=whole.zero,
        zero_stderr=contact.zero_stderr,
        rest=whole.rest,
        onset=whole.onset,
        onset_stderr=contact.onset_stderr,
        onset_range=(allowed.low, allowed.high),
        peak=float(averaged.force.max()) - whole.zero,
        residual_rms=float(np.sqrt(np.mean(residual**2))),
        residual_max=float(np.abs(residual).max()),
        lag_one=whole.lag_one,
        effective_rows=whole.effective_rows,
        hold=hold,
        contact_from_loading=contact is not whole,
        correlations=contact.correlations,
        notes=tuple(notes),
        row_noise=whole.row_noise,
        of_curve=(max(whole.of_curve[0], contact.of_curve[0]), *contact.of_curve[1:]),
        creep_percent=largest_creep(averaged),
    )
    if found.onset_at_bound:
        return replace(found, notes=(*notes, "the contact onset is at an end of the range the data allow"))
    return found


def _residual(trial: TrialData, law: LawFit) -> Array:
    below = trial.depth - law.onset
    reached = below <= trial.curve.reach
    model = law.zero + np.exp(law.log_stiffness) * trial.curve(below[reached])
    return np.asarray(trial.force[reached] - model)
