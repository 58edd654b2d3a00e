"""The fit of a session: each trial by itself, pooled with the trial as the unit, cross-checked jointly."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from benchmark.fitting.errors import FittingError, NoContactError
from benchmark.fitting.joint import JointFit, fit_jointly
from benchmark.fitting.parameters import FittedParameter, LayerLike, fitted_parameters
from benchmark.fitting.pooling import PooledStiffness, pool
from benchmark.fitting.remarks import conditions_p, fit_notes, fit_warnings
from benchmark.fitting.trial import TrialData
from benchmark.fitting.trial_fit import fit_trial, prepare_rows
from benchmark.fitting.trial_result import TrialFit

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
    """

    trials: tuple[TrialFit, ...]
    excluded: tuple[Excluded, ...]
    stiffness: PooledStiffness
    joint: JointFit | None
    parameters: tuple[FittedParameter, ...]
    notes: tuple[str, ...]
    warnings: tuple[str, ...]

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
