"""A trial session: fit its specimen, run both models at its median peak force, set both beside every trial."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Load, Scenario, Session, Tissue, Trial, load_session, scaled_tissue
from benchmark.identification import (
    FittingError,
    SessionFit,
    TrialData,
    filmed_trial,
    fit_session,
    fit_sheet,
    predict,
    required_depth,
    sheet_force,
)
from benchmark.identification.effects_in_fit import fit_repaired, wave_force
from benchmark.identification.fitted_parameters import sheet_parameters
from benchmark.identification.session_fit import elastic_only
from benchmark.identification.sheet_model import NONE, FilmedTrial, relaxed
from benchmark.identification.sheet_session import held_out_state
from benchmark.identification.sheet_trial import SheetTrial
from benchmark.model_file import RepairedModel
from benchmark.models import NOTHING, Array, Drive, Own, PreparedModel, UncoveredError, prepare
from benchmark.response import ForceCurve, RampTable
from benchmark.response.model_with_effects import effects_of, on_its_base
from benchmark.response.ramp import Setup, setup_scenario
from benchmark.runs.film_tables import Motion, motions_of
from benchmark.runs.filming import Films, session_films
from benchmark.runs.listener import Listener
from benchmark.runs.measured import FilmedSession, MeasuredComparison, TrialPrediction
from benchmark.runs.options import RunOptions
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import fit_headline
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.session_tables import base_curves, session_sheets
from benchmark.runs.table_one import Placed, table_one
from benchmark.side_by_side import NAMES

Key = tuple[str, str]
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
        Of reading, of the curves, of the films, and of the fit.
    filmed
        What the markers tell; None without any.
    sheets
        Each filmed trial with its model, by condition and name.
    added
        By condition and trial: (n,) N that the effects of a model file add to the elastic force; empty without one.
    """

    session: Session
    fit: SessionFit
    trials: tuple[TrialData, ...]
    warnings: tuple[str, ...]
    filmed: FilmedSession | None = None
    sheets: Mapping[Key, tuple[FilmedTrial, RampTable]] = field(default_factory=dict)
    added: Mapping[Key, Array] = field(default_factory=dict)

    @property
    def stiffness_factor(self) -> float:
        """Of force and markers together where there are markers, else of the force alone."""
        sheet = None if self.filmed is None else self.filmed.sheet
        return self.fit.stiffness_factor if sheet is None else sheet.stiffness.value


def fit_trials(
    path: Path,
    specimen: str | None,
    settings: Mapping[str, str],
    listener: Listener,
    *,
    films: bool = True,
    repair: RepairedModel | None = None,
) -> FittedSession:
    """Read a session and fit its specimen to all trials.

    With `films` to their markers, too; with the effects of a model file (`repair`) to their force alone.

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
    found = FittedSession(session, fit, trials, (*session.warnings, *base.warnings, *fit.warnings))
    return _with_films(found, session_films(session, listener), listener) if films else found


def _with_films(found: FittedSession, films: Films, listener: Listener) -> FittedSession:
    """Fit force and markers together where trials were filmed."""
    session, camera = found.session, found.session.camera
    if camera is None or not films.films:
        return replace(found, warnings=(*found.warnings, *films.warnings))
    listener.say(f"{session.name}: fitting force and markers of {len(films.films)} trials together")
    motions = motions_of(films.films, camera)
    models, said = session_sheets(session, _depths(session), films.view, listener)
    starts = {trial.key: trial for trial in found.fit.trials}
    pairs = {
        data.key: (film, models[trial.tool, trial.support])
        for trial, data in zip(session.trials, found.trials, strict=True)
        if data.key in films.films and data.key in starts and (trial.tool, trial.support) in models
        if (film := filmed_trial(data, films.films[data.key])) is not None
    }
    sheet = fit_sheet(tuple(pairs.values()), starts) if pairs else None
    rows, notes = found.fit.parameters, found.fit.notes
    if sheet is not None:
        rows = sheet_parameters(sheet, session.specimen.layers, rows)
        notes = (f"force alone: {fit_headline(found.fit)}", *(f"force alone: {note}" for note in notes))
    placed = (
        {} if sheet is None else {key[1]: _placed(pairs[key][1], own) for key in pairs if (own := sheet.trial(key))}
    )
    fit = replace(found.fit, notes=notes, parameters=(*rows, *table_one(session, motions, placed)))
    filmed = FilmedSession(motions, films.tracked, sheet)
    elastic = () if sheet is None or sheet.relaxation == NONE else elastic_only(found.fit.trials)
    fit = replace(fit, warnings=tuple(text for text in fit.warnings if text not in elastic))
    warnings = (*(text for text in found.warnings if text not in elastic), *films.warnings, *said)
    return replace(found, fit=fit, filmed=filmed, sheets=pairs, warnings=warnings)


def _placed(model: RampTable, own: SheetTrial) -> Placed:
    """Take perspective off the markers of a trial, by how far the fitted sheet sinks."""

    def true_displacements(motion: Motion, depth: Array) -> Array:
        radius = np.hypot(*(motion.rest - np.array(own.state.axis)).T)
        sunk = model.face(depth - own.state.onset, radius)[1]
        return np.asarray(model.view.true(motion.rest + motion.moved, sunk) - motion.rest)

    return true_displacements


def _fitted_with(
    repair: RepairedModel, session: Session, trials: tuple[TrialData, ...], said: tuple[str, ...]
) -> FittedSession:
    """The fit with the effects of a model file; raises FittingError."""
    names = ", ".join(repair.slugs) or "no effect"
    made = fit_repaired(session, trials, repair)
    warnings = [f"fitted with {names} of {repair.name} switched on, to the force alone"]
    if not made.settled:
        warnings.append("the stiffness did not come to rest with the effects in the fit: take it with care")
    everything = (*session.warnings, *said, *made.fit.warnings, *warnings)
    return FittedSession(session, made.fit, trials, everything, added=made.added)


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
    found = fit_trials(path, specimen, settings, listener, repair=own.repair)
    session, fit = found.session, found.fit
    fitted = scaled_tissue(session.specimen, found.stiffness_factor, f"{session.specimen.name}, fitted")
    scenario = session_scenario(session, fitted, fit)
    predictions, said = _predictions(found, fitted, own)
    measured, warnings = MeasuredComparison(session, fit, predictions, found.filmed), (*found.warnings, *said)
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
    force, held_out = _fem_forces(trial, found)
    return TrialPrediction(
        trial=trial.name,
        condition=trial.condition,
        time=trial.time,
        depth=trial.depth,
        force=trial.force,
        fem_force=force,
        wave_force=None if isinstance(wave, str) else wave,
        held_out_force=held_out,
    )


def _fem_forces(trial: TrialData, found: FittedSession) -> tuple[Array, Array | None]:
    """Force (n,) N of the session's fit, and of the other trials' (None with a single trial)."""
    fit, sheet = found.fit, None if found.filmed is None else found.filmed.sheet
    own = None if sheet is None else sheet.trial(trial.key)
    if sheet is None or own is None:
        added = found.added.get(trial.key, np.zeros(trial.rows))
        others = predict(fit, trial, leave_one_out=True) + added if len(fit.trials) > 1 else None
        return predict(fit, trial) + added, others
    film, model = found.sheets[trial.key]
    pooled = replace(own.state, log_stiffness=math.log(sheet.stiffness.value), relaxation=sheet.relaxation)
    state = held_out_state(own, sheet.trials, sheet.relaxation) if len(sheet.trials) > 1 else None
    return sheet_force(film, model, pooled), None if state is None else sheet_force(film, model, state)


def _wave_force(trial: TrialData, found: FittedSession, wave: PreparedModel | str, own: Own) -> Array | str:
    """Force (n,) N of the wave model at the trial's depth below its contact, zero in the air; or why there is none.

    Of a filmed trial with contact, zero and relaxation of the fit of force and markers, as the finite elements'.
    """
    if isinstance(wave, str):
        return wave
    fitted, sheet = found.fit.trial(trial.name, trial.condition), None if found.filmed is None else found.filmed.sheet
    joint = None if sheet is None else sheet.trial(trial.key)
    try:
        if own.repair is not None:
            return wave_force(found.session, trial, fitted.onset, wave, effects_of(own.repair)) + fitted.zero
        if sheet is None or joint is None:
            return wave.run(_drive(trial, fitted.onset)).force + fitted.zero
        elastic = wave.run(_drive(trial, joint.state.onset)).force
        pressing = np.maximum(relaxed(trial.time, elastic, sheet.relaxation), 0.0)
        return np.asarray(joint.state.zero + np.where(trial.depth > joint.state.onset, pressing, 0.0))
    except UncoveredError as error:
        return str(error)


def _drive(trial: TrialData, onset: float) -> Drive:
    """A trial's depth below contact as a drive, none in the air."""
    below = np.maximum(trial.depth - onset, 0.0)
    return Drive("depth", trial.time - trial.time[0] + float(np.diff(trial.time)[0]), below)
