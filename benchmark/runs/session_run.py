"""A trial session: fit its specimen, run both models at its median peak force, set both beside every trial."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Load, Scenario, Session, Tissue, Trial, load_session, scaled_tissue
from benchmark.fitting import (
    FittingError,
    ForceCurve,
    SessionFit,
    TrialData,
    fit_session,
    predict,
    required_depth,
)
from benchmark.model_file import RepairedModel
from benchmark.models import NOTHING, Array, Drive, Own, PreparedModel, UncoveredError, prepare
from benchmark.models.repaired import effects_of, on_its_base
from benchmark.runs.base_curve import Setup, base_curves, setup_scenario
from benchmark.runs.listener import Listener
from benchmark.runs.measured import MeasuredComparison, TrialPrediction
from benchmark.runs.options import RunOptions
from benchmark.runs.record import RunRecord
from benchmark.runs.repaired_fit import fit_repaired, wave_force
from benchmark.runs.scenario_run import run_scenario
from benchmark.side_by_side import NAMES

MARGIN = 1.02
OBSERVATIONS = 100


@dataclass(frozen=True)
class FittedSession:
    """A session with its fit.

    Attributes
    ----------
    session
        As read.
    fit
        Of its specimen.
    trials
        In the session's order, each with the force curve of its tool and support.
    warnings
        Of reading, of the curves, and of the fit.
    added
        By condition and trial: (n,) N that the effects of a model file add to the elastic force; empty without one.
    """

    session: Session
    fit: SessionFit
    trials: tuple[TrialData, ...]
    warnings: tuple[str, ...]
    added: Mapping[tuple[str, str], Array] = field(default_factory=dict)


def fit_trials(
    path: Path,
    specimen: str | None,
    settings: Mapping[str, str],
    listener: Listener,
    repair: RepairedModel | None = None,
) -> FittedSession:
    """Read a session and fit its specimen to all trials, with the effects of a model file where one is given.

    Raises
    ------
    InputError
        Files or trials that cannot be used.
    SolverError
        The finite-element curve could not be computed deep enough.
    """
    session = load_session(path, settings, specimen)
    base = base_curves(session, _depths(session), listener)
    listener.say(f"{session.name}: fitting {len(session.trials)} trials")
    try:
        trials = tuple(_trial_data(trial, base.curves[trial.tool, trial.support]) for trial in session.trials)
        if repair is not None:
            return _fitted_with(repair, session, trials, base.warnings)
        fit = fit_session(trials, session.specimen.layers)
    except FittingError as error:
        raise InputError(f"session {session.folder}: {error}") from None
    return FittedSession(session, fit, trials, (*session.warnings, *base.warnings, *fit.warnings))


def _fitted_with(
    repair: RepairedModel, session: Session, trials: tuple[TrialData, ...], said: tuple[str, ...]
) -> FittedSession:
    """The fit with the effects of a model file; raises FittingError."""
    names = ", ".join(repair.slugs) or "no effect"
    made = fit_repaired(session, trials, repair)
    warnings = [f"fitted with {names} of {repair.name} switched on"]
    if not made.settled:
        warnings.append("the stiffness did not come to rest with the effects in the fit: take it with care")
    everything = (*session.warnings, *said, *made.fit.warnings, *warnings)
    return FittedSession(session, made.fit, trials, everything, made.added)


def run_session(
    path: Path,
    specimen: str | None,
    settings: Mapping[str, str],
    options: RunOptions,
    listener: Listener,
    own: Own = NOTHING,
) -> RunRecord:
    """Fit a session and run both models with the fitted specimen; raises like `fit_trials`.

    The fit is that of the finite elements, whatever `own` model stands in the wave's place.
    """
    found = fit_trials(path, specimen, settings, listener, own.repair)
    session, fit = found.session, found.fit
    fitted = scaled_tissue(session.specimen, fit.stiffness_factor, f"{session.specimen.name}, fitted")
    scenario = session_scenario(session, fitted, fit)
    predictions, said = _predictions(found, fitted, own)
    measured, warnings = MeasuredComparison(session, fit, predictions), (*found.warnings, *said)
    return run_scenario(scenario, options, listener, name=session.name, measured=measured, warnings=warnings, own=own)


def session_scenario(session: Session, tissue: Tissue, fit: SessionFit) -> Scenario:
    """Return a press to the trials' median peak force with the tool and support of the first trial."""
    peak = float(np.median([trial.peak for trial in fit.trials]))
    load = Load(control="force", peak=peak, shape="triangle", duration=10.0, observations=OBSERVATIONS)
    first = session.trials[0]
    return session.scenario(tissue, first.tool, first.support, load)


def _depths(session: Session) -> dict[Setup, float]:
    """The depth each tool and support needs a curve to."""
    depths: dict[Setup, float] = {}
    for trial in session.trials:
        key = (trial.tool, trial.support)
        needed = MARGIN * required_depth(trial.table.depth, trial.table.force)
        depths[key] = max(depths.get(key, 0.0), needed)
    return depths


def _trial_data(trial: Trial, curve: ForceCurve) -> TrialData:
    table = trial.table
    return TrialData(trial.name, trial.condition, table.time, table.depth, table.force, curve)


def _predictions(found: FittedSession, tissue: Tissue, own: Own) -> tuple[tuple[TrialPrediction, ...], tuple[str, ...]]:
    """Both models' forces for each trial that was fitted, and why the wave model has none for some."""
    kept = {trial.key for trial in found.fit.trials}
    setups = [(trial.tool, trial.support) for trial in found.session.trials]
    waves = {setup: _wave(found.session, tissue, setup, own) for setup in dict.fromkeys(setups)}
    answers = [
        (trial, _wave_force(trial, found, waves[setup], own))
        for setup, trial in zip(setups, found.trials, strict=True)
        if trial.key in kept
    ]
    reasons = Counter(answer for _, answer in answers if isinstance(answer, str))
    name = own.name("wave") or NAMES["wave"]
    said = tuple(f"the {name} has no force for {count} of the trials: {reason}" for reason, count in reasons.items())
    return tuple(_prediction(trial, found, answer) for trial, answer in answers), said


def _wave(session: Session, tissue: Tissue, setup: Setup, own: Own) -> PreparedModel | str:
    """The wave model of the fitted specimen, or why it does not cover it."""
    scenario = setup_scenario(session, tissue, setup)
    try:
        if own.repair is not None:
            return prepare("wave", on_its_base(own.repair, scenario))
        return prepare("wave", scenario, own=own.wave)
    except UncoveredError as error:
        return str(error)


def _prediction(trial: TrialData, found: FittedSession, wave: Array | str) -> TrialPrediction:
    fit, added = found.fit, found.added.get(trial.key, np.zeros(trial.rows))
    return TrialPrediction(
        trial=trial.name,
        condition=trial.condition,
        time=trial.time,
        depth=trial.depth,
        force=trial.force,
        fem_force=predict(fit, trial) + added,
        wave_force=None if isinstance(wave, str) else wave,
        held_out_force=predict(fit, trial, leave_one_out=True) + added if len(fit.trials) > 1 else None,
    )


def _wave_force(trial: TrialData, found: FittedSession, wave: PreparedModel | str, own: Own) -> Array | str:
    """Force (n,) N of the wave model at the trial's depth below its contact, zero in the air; or why there is none."""
    if isinstance(wave, str):
        return wave
    fitted = found.fit.trial(trial.name, trial.condition)
    below = np.maximum(trial.depth - fitted.onset, 0.0)
    drive = Drive("depth", trial.time - trial.time[0] + float(np.diff(trial.time)[0]), below)
    try:
        if own.repair is not None:
            return wave_force(found.session, trial, fitted.onset, wave, effects_of(own.repair)) + fitted.zero
        return wave.run(drive).force + fitted.zero
    except UncoveredError as error:
        return str(error)
