"""The force of a trial from its measured depth: the session's stiffness, the trial's own onset and zero."""

from __future__ import annotations

import numpy as np

from benchmark.fitting.curve import Array
from benchmark.fitting.errors import FittingError
from benchmark.fitting.pooling import pool
from benchmark.fitting.session import SessionFit
from benchmark.fitting.trial import TrialData


def predict(fit: SessionFit, trial: TrialData, leave_one_out: bool = False) -> Array:
    """Force (n,) in N at each row of a trial of the session; NaN where its depth is beyond the force curve.

    Parameters
    ----------
    fit : SessionFit
    trial : TrialData
        One of the trials that were fitted.
    leave_one_out : bool
        Pool the stiffness over the other trials only, so that the trial's own stiffness is not fed back.

    Raises
    ------
    FittingError
        The trial is not part of the fit, or no other trial is there to leave it out.
    """
    own = fit.trial(trial.name, trial.condition)
    factor = held_out_stiffness(fit, trial.name, trial.condition) if leave_one_out else fit.stiffness_factor
    below = trial.depth - own.onset
    reached = below <= trial.curve.reach
    force = np.full(trial.rows, np.nan)
    force[reached] = own.zero + factor * trial.curve(below[reached])
    return force


def held_out_stiffness(fit: SessionFit, name: str, condition: str) -> float:
    """Stiffness factor pooled over all trials but one.

    Raises
    ------
    FittingError
        As `predict`.
    """
    own = fit.trial(name, condition)
    others = [other for other in fit.trials if other is not own]
    if not others:
        raise FittingError(f"trial {name} ({condition}) is the only one fitted: no other gives a stiffness for it")
    return pool(others).value
