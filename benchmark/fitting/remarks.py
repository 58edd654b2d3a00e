"""What a reader of a fit must know: warnings first, notes for the record. No effect is named here."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import scipy

from benchmark.fitting.joint import JointFit
from benchmark.fitting.pooling import PooledStiffness
from benchmark.fitting.trial_result import TrialFit

MISFIT = 10.0
"""Root-mean-square residual in % of the peak above which the elastic law is said not to follow the data."""
SCATTER = 0.25
"""Standard deviation of the logarithms above which the scatter between trials is called large."""


def fit_warnings(trials: Sequence[TrialFit], pooled: PooledStiffness) -> list[str]:
    """Sentences on what limits the fit, each once for all trials."""
    return [text for text in (_time(trials), _misfit(trials), _scatter(trials, pooled), _few(pooled)) if text]


def elastic_only(trials: Sequence[TrialFit]) -> tuple[str, ...]:
    """Those of the warnings that hold for a fit with an elastic law alone, not for one with relaxation."""
    return tuple(text for text in (_time(trials), _misfit(trials)) if text)


def fit_notes(trials: Sequence[TrialFit], pooled: PooledStiffness, joint: JointFit | None) -> list[str]:
    """Sentences on how the numbers came about."""
    notes = [f"stiffness factor: {pooled.method}"]
    if joint is not None:
        place = "outside" if joint.differs else "inside"
        notes.append(f"one common factor fitted to all trials is {joint.value:.6g}, {place} the pooled interval")
    bound = [trial.name for trial in trials if trial.onset_at_bound]
    if bound:
        notes.append(f"contact onset at an end of its range in {len(bound)} of {len(trials)} trials")
    between = conditions_p(trials)
    if between is not None and between < 0.05:
        notes.append(f"the stiffness differs between conditions (one-way F test, p = {between:.3g})")
    return notes


def conditions_p(trials: Sequence[TrialFit]) -> float | None:
    """P of equal mean logarithms in all conditions; None without two conditions of scattering trials."""
    logs: dict[str, list[float]] = {}
    for trial in trials:
        logs.setdefault(trial.condition, []).append(trial.log_stiffness)
    groups = [group for group in logs.values() if len(group) > 1]
    if len(groups) < 2 or all(np.ptp(group) < 1e-9 for group in groups):
        return None
    return float(scipy.stats.f_oneway(*groups).pvalue)


def _time(trials: Sequence[TrialFit]) -> str:
    decays = [t.hold.decay_percent for t in trials if t.hold is not None and t.hold.seen]
    if not decays:
        return ""
    return (
        f"time dependence is in the data: in {len(decays)} of {len(trials)} trials the force falls by up "
        f"to {max(decays):.3g} % while the depth is held, which an elastic law cannot "
        "follow; the stiffness is that of the whole record"
    )


def _misfit(trials: Sequence[TrialFit]) -> str:
    above = [trial.residual_percent for trial in trials if trial.residual_percent > MISFIT]
    if not above:
        return ""
    return (
        f"the elastic law leaves more than {MISFIT:g} % of the peak (root mean square) in {len(above)} of "
        f"{len(trials)} trials, up to {max(above):.3g} %"
    )


def _scatter(trials: Sequence[TrialFit], pooled: PooledStiffness) -> str:
    if pooled.log_std is None or pooled.log_std <= SCATTER or pooled.next_trial is None:
        return ""
    logs = [trial.log_stiffness for trial in trials]
    return (
        f"the trials' stiffness differs up to {math.exp(max(logs) - min(logs)):.3g}-fold: they may be "
        "different specimens; the interval is for their mean, a further trial has a stiffness factor of "
        f"{pooled.next_trial[0]:.3g} to {pooled.next_trial[1]:.3g} (95 %)"
    )


def _few(pooled: PooledStiffness) -> str:
    if pooled.trials == 1:
        return f"stiffness from {pooled.method}"
    return "stiffness from two trials: its interval is wide" if pooled.trials == 2 else ""
