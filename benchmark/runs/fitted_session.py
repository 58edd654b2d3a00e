"""A session's specimen fitted to its trials: to the force alone, or to force and markers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from benchmark.errors import InputError
from benchmark.files import Session, Setup, Tool, Trial, load_session
from benchmark.identification import (
    FittingError,
    SessionFit,
    TrialData,
    filmed_trial,
    fit_session,
    fit_sheet,
    required_depth,
)
from benchmark.identification.effects_in_fit import fit_with_effects
from benchmark.identification.fitted_parameters import sheet_parameters
from benchmark.identification.model_error import jumps, model_error
from benchmark.identification.session_fit import elastic_only
from benchmark.identification.sheet_model import NONE, FilmedTrial
from benchmark.identification.sheet_trial import SheetTrial
from benchmark.model_file import RepairedModel
from benchmark.models import Array
from benchmark.response import ForceCurve, RampTable
from benchmark.runs.options import Listener
from benchmark.runs.report.values import fit_headline
from benchmark.runs.trials.film_tables import MarkerMotion, motions_of
from benchmark.runs.trials.filming import Films, session_films
from benchmark.runs.trials.measured import FilmedSession
from benchmark.runs.trials.session_tables import BaseCurves, Followed, base_curves, session_sheets
from benchmark.runs.trials.table_one import Placed, table_one
from reports.formatting import counted

Key = tuple[str, str]
MARGIN = 1.02


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
        In the session's order, each with the force curve of its set-up.
    warnings
        Of reading, of the curves, of the films, and of the fit.
    followed
        The tools that the finite elements cover in each set-up, the one told first, each with its ramp.
    filmed
        What the markers tell; None without any.
    sheets
        Each filmed trial with its model, by condition and name.
    added
        By condition and trial: (n,) N that the effects of a model file add to the elastic force; empty without one.
    settled
        False where the stiffness still moved when the rounds with the effects of a model file ended.
    """

    session: Session
    fit: SessionFit
    trials: tuple[TrialData, ...]
    warnings: tuple[str, ...]
    followed: Mapping[Setup, Followed]
    filmed: FilmedSession | None = None
    sheets: Mapping[Key, tuple[FilmedTrial, RampTable]] = field(default_factory=dict)
    added: Mapping[Key, Array] = field(default_factory=dict)
    settled: bool = True

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
    check: Callable[[Session], None] | None = None,
) -> FittedSession:
    """Read a session and fit its specimen to all trials.

    With `films` to their markers, too; with the effects of a model file (`repair`) to their force alone. `check` may
    refuse the session by InputError before anything is computed.

    Raises
    ------
    InputError
        Files or trials that cannot be used.
    SolverError
        The finite-element curve could not be computed deep enough.
    """
    session = load_session(path, settings, specimen)
    if check is not None:
        check(session)
    for line in session.shown:
        listener.say(line)
    base = base_curves(session, _depths(session), listener)
    listener.say(f"{session.name}: fitting {counted(len(session.trials), 'trial')}")
    try:
        setups = [session.setup(trial) for trial in session.trials]
        pairs = zip(session.trials, setups, strict=True)
        trials = tuple(_trial_data(trial, setup[1], base.curves[setup]) for trial, setup in pairs)
        if repair is not None:
            return _fitted_with(repair, session, trials, base)
        fit = fit_session(trials, session.specimen.layers)
    except FittingError as error:
        raise InputError(f"session {session.folder}: {error}") from None
    found = FittedSession(session, fit, trials, (*session.warnings, *base.warnings, *fit.warnings), base.followed)
    return _with_films(found, session_films(session, listener), listener) if films else found


def _with_films(found: FittedSession, films: Films, listener: Listener) -> FittedSession:
    """Fit force and markers together where trials were filmed."""
    session, camera = found.session, found.session.camera
    if camera is None or not films.films:
        return replace(found, warnings=(*found.warnings, *films.warnings))
    listener.say(f"{session.name}: fitting force and markers of {counted(len(films.films), 'trial')} together")
    motions = motions_of(films.films, camera)
    models, said = session_sheets(session, _depths(session), films.view, listener)
    starts = {trial.key: trial for trial in found.fit.trials}
    pairs = {
        data.key: (film, models[session.setup(trial)])
        for trial, data in zip(session.trials, found.trials, strict=True)
        if data.key in films.films and data.key in starts and session.setup(trial) in models
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

    def true_displacements(motion: MarkerMotion, depth: Array) -> Array:
        radius = np.hypot(*(motion.rest - np.array(own.state.axis)).T)
        sunk = model.face(depth - own.state.onset, radius)[1]
        return np.asarray(model.view.true(motion.rest + motion.moved, sunk) - motion.rest)

    return true_displacements


def _fitted_with(
    repair: RepairedModel, session: Session, trials: tuple[TrialData, ...], base: BaseCurves
) -> FittedSession:
    """The fit with the effects of a model file; raises FittingError."""
    names = ", ".join(repair.slugs) or "no effect"
    made = fit_with_effects(session, trials, repair)
    warnings = [f"fitted with {names} of {repair.name} switched on, to the force alone"]
    if not made.settled:
        warnings.append("the stiffness did not come to rest with the effects in the fit: take it with care")
    everything = (*session.warnings, *base.warnings, *made.fit.warnings, *warnings)
    return FittedSession(session, made.fit, trials, everything, base.followed, added=made.added, settled=made.settled)


def _depths(session: Session) -> dict[Setup, float]:
    """The depth each set-up needs a curve to."""
    depths: dict[Setup, float] = {}
    for trial in session.trials:
        key = session.setup(trial)
        needed = MARGIN * required_depth(trial.table.depth, trial.table.force)
        depths[key] = max(depths.get(key, 0.0), needed)
    return depths


def _trial_data(trial: Trial, tool: Tool, curve: ForceCurve) -> TrialData:
    table = trial.table
    error = model_error(None, jumping=jumps(tool))  # of the mesh nothing is estimated, and nothing taken off
    return TrialData(trial.name, trial.condition, table.time, table.depth, table.force, curve, error)
