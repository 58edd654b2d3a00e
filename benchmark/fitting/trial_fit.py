"""The elastic fit of one trial: force = zero + stiffness factor x curve(depth - contact onset).

An elastic law cannot follow a force that falls while the depth is held. Where that is seen, the contact
onset and the zero come from the rows up to the largest force, and only the stiffness factor from the whole
trial; else a fit would trade the onset and the zero for the missing time dependence.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.fitting.contact import (
    LEAST_EVIDENCE,
    LEAST_TRAVEL,
    ContactRange,
    Start,
    contact_range,
    find_start,
    travel,
    without_spikes,
)
from benchmark.fitting.curve import Array
from benchmark.fitting.elastic_law import LawFit, minimise
from benchmark.fitting.errors import FittingError, NoContactError
from benchmark.fitting.holds import Hold, largest_decay
from benchmark.fitting.trial import LEAST_ROWS, TrialData, reduced, rows_of, up_to_depth
from benchmark.fitting.trial_result import TrialFit

MOST_ROWS = 2000
"""A longer trial is averaged down to this many rows for the fit."""


def fit_trial(trial: TrialData) -> TrialFit:
    """Fit stiffness factor, zero and contact onset of one trial by lmfit (least squares in N).

    Raises
    ------
    NoContactError
        The depth does not change, or no force rises over the noise.
    FittingError
        The force curve ends too early for the trial.
    """
    fitted, allowed, notes = prepare_rows(trial)
    start = find_start(fitted, allowed)
    if start.stiffness <= 0.0 or not start.evidence >= LEAST_EVIDENCE:
        raise NoContactError(_no_contact(trial, start))
    hold = largest_decay(reduced(trial, MOST_ROWS))
    contact = _contact_from_loading(fitted, allowed) if hold is not None and hold.seen else None
    if contact is None:
        contact = whole = minimise(fitted, allowed, start)
    else:
        whole = minimise(fitted, allowed, contact.start, contact_fixed=True)
        notes.append("the force falls in a hold: onset and zero come from the rows up to the largest force")
    return _result(trial, fitted.rows, allowed, hold, contact, whole, notes)


def prepare_rows(trial: TrialData) -> tuple[TrialData, ContactRange, list[str]]:
    """Return the rows to fit, the range of the onset, and what was left out or averaged.

    Raises
    ------
    NoContactError, FittingError
        As `fit_trial`.
    """
    if travel(trial.depth) < LEAST_TRAVEL:
        raise NoContactError(f"{trial.label}: the depth changes by less than {1e3 * LEAST_TRAVEL:g} mm: no motion")
    notes = []
    fitted = reduced(trial, MOST_ROWS)
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
        f"{LEAST_EVIDENCE:g} is needed); was there contact, and is press positive in force and depth?"
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
        peak=float(reduced(trial, MOST_ROWS).force.max()) - whole.zero,
        residual_rms=float(np.sqrt(np.mean(residual**2))),
        residual_max=float(np.abs(residual).max()),
        lag_one=whole.lag_one,
        effective_rows=whole.effective_rows,
        hold=hold,
        contact_from_loading=contact is not whole,
        correlations=contact.correlations,
        notes=tuple(notes),
    )
    if found.onset_at_bound:
        return replace(found, notes=(*notes, "the contact onset is at an end of the range the data allow"))
    return found


def _residual(trial: TrialData, law: LawFit) -> Array:
    below = trial.depth - law.onset
    reached = below <= trial.curve.reach
    model = law.zero + np.exp(law.log_stiffness) * trial.curve(below[reached])
    return np.asarray(trial.force[reached] - model)
