"""The fit of a session: each trial by itself, pooled with the trial as the unit, cross-checked jointly."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy

from benchmark.identification.fitted_parameters import FittedParameter, LayerLike, fitted_parameters
from benchmark.identification.pooling import CHANCE, JointFit, PooledStiffness, fit_jointly, fold_between, pool
from benchmark.identification.trial_data import FittingError, NoContactError, TrialData
from benchmark.identification.trial_fit import TrialFit, fit_trial, prepare_rows
from benchmark.response.force_curve import Array

SCHEMA = 1


@dataclass(frozen=True)
class Excluded:
    """A trial that tells no stiffness, and why."""

    name: str
    condition: str
    reason: str


@dataclass(frozen=True)
class SessionFit:
    """The fit of a session.

    Attributes
    ----------
    trials : tuple of TrialFit
        In the order given.
    excluded : tuple of Excluded
        Trials without motion or contact.
    stiffness : PooledStiffness
    joint : JointFit or None
        None for a single trial.
    parameters : tuple of FittedParameter
        Rows of `fitted_parameters.csv`.
    notes, warnings : tuple of str
    with_setup : PooledStiffness or None
        The same with the interval that the uncertainty of the set-up as told leaves; None where it was not worked out.
    """

    trials: tuple[TrialFit, ...]
    excluded: tuple[Excluded, ...]
    stiffness: PooledStiffness
    joint: JointFit | None
    parameters: tuple[FittedParameter, ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]
    with_setup: PooledStiffness | None = None

    @property
    def conditions_fold(self) -> float | None:
        """How many times the stiffest condition is as stiff as the softest, where one stiffness follows not all."""
        return conditions_fold(self.trials)

    @property
    def stiffness_factor(self) -> float:
        """Pooled stiffness factor."""
        return self.stiffness.value

    def trial(self, name: str, condition: str) -> TrialFit:
        """Return the fit of one trial.

        Raises
        ------
        FittingError
            The trial is not part of the fit; an excluded one with its reason.
        """
        for trial in self.trials:
            if trial.key == (condition, name):
                return trial
        reasons = [each.reason for each in self.excluded if (each.condition, each.name) == (condition, name)]
        raise FittingError(reasons[0] if reasons else f"trial {name} ({condition}) is not part of this fit")

    def to_dict(self) -> dict[str, Any]:
        """Content of `fit.json`."""
        return {
            "schema": SCHEMA,
            "stiffness_factor": self.stiffness.to_dict(),
            "with_setup_uncertain": None if self.with_setup is None else self.with_setup.to_dict(),
            "joint_stiffness_factor": None if self.joint is None else self.joint.to_dict(),
            "conditions_differ_p": conditions_p(self.trials),
            "parameters": [parameter.to_dict() for parameter in self.parameters],
            "trials": [trial.to_dict() for trial in self.trials],
            "excluded": [vars(each).copy() for each in self.excluded],
            "notes": list(self.notes),
            "warnings": list(self.warnings),
        }


def fit_session(trials: Sequence[TrialData], layers: Sequence[LayerLike]) -> SessionFit:
    """Fit all trials of a session.

    Parameters
    ----------
    trials : sequence of TrialData
        Names unique within a condition.
    layers : sequence
        The specimen's layers from the surface down (name, thickness, youngs_modulus, poisson_ratio in SI), as
        the trials' force curves were computed with them.

    Raises
    ------
    FittingError
        No trial, a name twice, a curve that ends too early, or no trial with motion and contact.
    """
    _check(trials)
    fitted: list[tuple[TrialData, TrialFit]] = []
    excluded: list[Excluded] = []
    for trial in trials:
        try:
            fitted.append((trial, fit_trial(trial)))
        except NoContactError as error:
            excluded.append(Excluded(trial.name, trial.condition, str(error)))
    if not fitted:
        raise FittingError(f"none of {len(trials)} trials can be fitted; the first: {excluded[0].reason}")
    return _session(fitted, excluded, layers)


def _check(trials: Sequence[TrialData]) -> None:
    if not trials:
        raise FittingError("a session without trials: at least one is needed")
    key, times = Counter(trial.key for trial in trials).most_common(1)[0]
    if times > 1:
        raise FittingError(f"{times} trials are named {key[1]} in condition {key[0]}: each name must be unique there")


def _session(
    fitted: list[tuple[TrialData, TrialFit]], excluded: list[Excluded], layers: Sequence[LayerLike]
) -> SessionFit:
    fits = tuple(fit for _, fit in fitted)
    pooled = pool(fits)
    rows = [(*prepare_rows(trial)[:2], fit) for trial, fit in fitted]
    joint = fit_jointly(rows, pooled) if len(fits) > 1 else None
    left_out = [f"left out of the fit: {each.reason}" for each in excluded]
    return SessionFit(
        fits,
        tuple(excluded),
        pooled,
        joint,
        fitted_parameters(pooled, fits, layers),
        tuple(fit_notes(fits, pooled, joint)),
        (*left_out, *fit_warnings(fits, pooled)),
    )


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


MISFIT = 10.0
"""Root-mean-square residual in % of the peak above which the elastic law is said not to follow the data."""
SCATTER = 0.25
"""Standard deviation of the logarithms above which the scatter between trials is called large."""


def fit_warnings(trials: Sequence[TrialFit], pooled: PooledStiffness) -> list[str]:
    """Sentences on what limits the fit, each once for all trials."""
    scatter = _conditions(trials) or _scatter(trials, pooled)
    found = (_far(pooled), _time(trials), _misfit(trials), _at_end(trials), _parted(trials), scatter, _few(pooled))
    return [text for text in found if text]


def elastic_only(trials: Sequence[TrialFit], *, followed: bool = False) -> tuple[str, ...]:
    """Those of the warnings that hold for the elastic law as told alone, not for one with relaxation or another law.

    Where that one has `followed` all conditions, what parts these under one stiffness is among them.
    """
    parted = (_conditions(trials), _parted(trials)) if followed else ()
    return tuple(text for text in (_time(trials), _misfit(trials), _at_end(trials), *parted) if text)


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


PARTED = 1.05
"""Fold between the mean stiffness of conditions, surely more than chance, that is told of: more than a radius told to
1 % makes, whose square or cube the force goes with."""


def _parted(trials: Sequence[TrialFit]) -> str:
    """Conditions that differ surely, but by less than makes one law of no use."""
    means, between = _means(trials), conditions_p(trials)
    soft, stiff = min(means, key=lambda name: means[name]), max(means, key=lambda name: means[name])
    fold = means[stiff] / means[soft]
    if between is None or between >= CHANCE or fold <= PARTED or conditions_fold(trials) is not None:
        return ""
    return (
        f"{stiff} is {fold:.3g} times as stiff as {soft}, beyond their trials' scatter (p = {between:.2g}): the "
        "interval holds for their mean; a machine that gives way, another size of a tool or a rate may be in it, which "
        "the command discover looks for"
    )


def _means(trials: Sequence[TrialFit]) -> dict[str, float]:
    """Geometric mean of the stiffness factors of each condition."""
    return {name: math.exp(math.fsum(logs) / len(logs)) for name, logs in _by_condition(trials).items()}


def conditions_p(trials: Sequence[TrialFit]) -> float | None:
    """P of equal mean logarithms in all conditions; None without two conditions of scattering trials."""
    groups = [group for group in _by_condition(trials).values() if len(group) > 1]
    if len(groups) < 2 or all(np.ptp(group) < 1e-9 for group in groups):
        return None
    return float(scipy.stats.f_oneway(*groups).pvalue)


def _by_condition(trials: Sequence[TrialFit]) -> dict[str, list[float]]:
    """Logarithms of the trials' stiffness factors."""
    logs: dict[str, list[float]] = {}
    for trial in trials:
        logs.setdefault(trial.condition, []).append(trial.log_stiffness)
    return logs


def conditions_fold(trials: Sequence[TrialFit]) -> float | None:
    """How many times the stiffest condition is as stiff as the softest; None where one stiffness follows them."""
    return fold_between(list(_by_condition(trials).values()))


def _conditions(trials: Sequence[TrialFit]) -> str:
    fold = conditions_fold(trials)
    if fold is None:
        return ""
    means = _means(trials)
    soft, stiff = min(means, key=lambda name: means[name]), max(means, key=lambda name: means[name])
    return (
        f"one law with one stiffness does not follow all conditions: {stiff} is {fold:.3g} times as stiff as {soft} "
        f"({means[stiff]:.3g} and {means[soft]:.3g} times the value before the fit), beyond their trials' scatter. "
        "What is quoted is the mean of conditions that contradict each other: see whether each has the units, "
        "specimen, tool and support that it was pressed with, or let the command discover say which effect is missing"
    )


def _time(trials: Sequence[TrialFit]) -> str:
    decays = [t.hold.decay_percent for t in trials if t.hold is not None and t.hold.seen]
    creeps = [t.creep_percent for t in trials if t.creep_percent]
    seen = [
        f"in {len(percent)} of {len(trials)} trials {what} by up to {max(percent):.3g} % while the {held} is held"
        for percent, what, held in ((decays, "the force falls", "depth"), (creeps, "the depth grows", "force"))
        if percent
    ]
    if not seen:
        return ""
    return (
        f"time dependence is in the data: {', '.join(seen)}, which an elastic law cannot follow; the stiffness is that "
        "of the whole record"
    )


def _misfit(trials: Sequence[TrialFit]) -> str:
    above = [trial.residual_percent for trial in trials if trial.residual_percent > MISFIT]
    if not above:
        return ""
    return (
        f"the elastic law leaves more than {MISFIT:g} % of the peak (root mean square) in {len(above)} of "
        f"{len(trials)} trials, up to {max(above):.3g} %; they are kept, but their stiffness is that of another law"
    )


def _at_end(trials: Sequence[TrialFit]) -> str:
    at_end = sum(trial.onset_at_bound for trial in trials)
    if 2 * at_end <= len(trials):
        return ""
    return (
        f"the contact of {at_end} of {len(trials)} trials lies at an end of the range of depths that their forces "
        "allow: the force rises otherwise than the law, as by a drift in the air, and the stiffness may be far off"
    )


OTHER_UNIT = 4.0
"""Fold in stiffness between trials from which on one may be in another unit (N and lbf, the nearest two, are 4.4)."""


FAR = 100.0
"""Times the stiffness before a fit from which on a unit is in doubt (mN under N are 1000, grams-force 102)."""


def _far(pooled: PooledStiffness) -> str:
    if 1.0 / FAR < pooled.value < FAR:
        return ""
    return (
        f"the stiffness is {pooled.value:.3g} times that of the specimen before the fit: see whether force (N) and "
        "depth (mm) are in the units that their columns tell, and whether the specimen is the one that was pressed"
    )


def _scatter(trials: Sequence[TrialFit], pooled: PooledStiffness) -> str:
    if pooled.log_std is None or pooled.log_std <= SCATTER or pooled.next_trial is None:
        return ""
    ordered = sorted(trials, key=lambda trial: trial.log_stiffness)
    fold = math.exp(ordered[-1].log_stiffness - ordered[0].log_stiffness)
    unit = ", or of other units" if fold > OTHER_UNIT else ""
    return (
        f"the trials' stiffness differs up to {fold:.3g}-fold: they may be different specimens{unit} (the softest is "
        f"{ordered[0].name}, the stiffest {ordered[-1].name}); the interval is for their mean, a "
        f"further trial has a stiffness factor of {pooled.next_trial[0]:.3g} to {pooled.next_trial[1]:.3g} (95 %)"
    )


def _few(pooled: PooledStiffness) -> str:
    if pooled.trials == 1:
        return f"stiffness from {pooled.method}"
    return "stiffness from two trials: its interval is wide" if pooled.trials == 2 else ""
