"""`run --trials`: the fitted specimen in both models at the trials' median peak force, and both beside every trial."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmark.child_processes import output_on_stderr
from benchmark.errors import TissuebenchError
from benchmark.files import Load, Scenario, Session, Setup, Support, Tissue, Tool, scaled_tissue
from benchmark.files.tissue import PronyTerm
from benchmark.identification import TrialData, predict, sheet_force
from benchmark.identification.effects_in_fit import trial_context
from benchmark.identification.sheet_model import NONE, Relaxation, relaxed
from benchmark.identification.sheet_session import held_out_state
from benchmark.model_file import RepairedModel
from benchmark.models import NOTHING, Array, Drive, Own, PreparedModel, UncoveredError, prepare
from benchmark.models.prepare import scenario_drive
from benchmark.response import depth_ramp, trial_force
from benchmark.response.model_with_effects import effects_of, on_its_base
from benchmark.response.nearest_curve import carried_forces, nearest_tools, tool_name
from benchmark.response.ramp import setup_scenario
from benchmark.runs.fitted_session import FittedSession, fit_trials
from benchmark.runs.options import Listener, RunOptions
from benchmark.runs.record import RunRecord
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.trials.measured import MeasuredComparison, TrialPrediction, peak_force
from benchmark.side_by_side import NAMES, SAME_ANSWER

OBSERVATIONS = 100
STEPS = 60
SAFE = 0.8
"""Share of what a tool carries to which both models press where none carries the trials' force."""
REACH = 1.2
"""The wave's elastic law is ramped this much deeper than the trial."""


Answer = tuple[Setup, TrialData, Array | str]
"""Of a trial under a set-up: force (n,) N, or why there is none."""


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
    scenario, other = session_scenario(found, as_told=own.reference is not None)
    predictions, said = _predictions(found, own)
    other += _told_otherwise(found, scenario.tissue)
    measured, warnings = MeasuredComparison(session, fit, predictions, found.filmed), (*found.warnings, *said, *other)
    return run_scenario(scenario, options, listener, name=session.name, measured=measured, warnings=warnings, own=own)


def fitted_tissue(found: FittedSession, told: Tissue) -> Tissue:
    """The tissue of a set-up with the stiffness that was found."""
    return scaled_tissue(told, found.stiffness_factor, f"{told.name}, fitted")


def relaxing_tissue(found: FittedSession, told: Tissue) -> Tissue:
    """The tissue with the stiffness that was found and, in every layer, the relaxation that films told, if any.

    The fit has the force relax as a whole: with one term for the shear of all layers it does, to 0.1 % on the phantom's
    sheet (Poisson's ratio 0.49). A tissue that relaxes as told stays as it is.
    """
    tissue, relaxation = fitted_tissue(found, told), _relaxation(found)
    if relaxation == NONE or any(layer.relaxation for layer in tissue.layers):
        return tissue
    term = PronyTerm(g=relaxation.share, tau=relaxation.tau)
    layers = tuple(layer.model_copy(update={"relaxation": (term,)}) for layer in tissue.layers)
    return tissue.model_copy(update={"layers": layers})


def _relaxation(found: FittedSession) -> Relaxation:
    """What films told of the relaxation; none without."""
    return NONE if found.filmed is None or found.filmed.sheet is None else found.filmed.sheet.relaxation


def _told_otherwise(found: FittedSession, tissue: Tissue) -> tuple[str, ...]:
    """That models beside the trials relax otherwise than side by side, where the specimen's own relaxation stays."""
    one = _relaxation(found)
    if one == NONE or all(layer.relaxation == (PronyTerm(g=one.share, tau=one.tau),) for layer in tissue.layers):
        return ()
    return (
        f"the relaxation found in the trials (g = {one.share:.3g}, tau = {one.tau:.3g} s) is in the models beside them "
        "alone: side by side the specimen relaxes as its file tells",
    )


def session_scenario(found: FittedSession, *, as_told: bool) -> tuple[Scenario, tuple[str, ...]]:
    """Return a press of the fitted specimen to the trials' median peak force in the first trial's set-up, and remarks.

    Where the finite elements do not carry that force, the nearest tool that does takes its place, at the most that one
    carries; a scenario `as_told` keeps tool and force.
    """
    session = found.session
    first, peak = session.setups[0], _median_peak(found)
    told, support, tissue = *first[1:], relaxing_tissue(found, first[0])
    carried = carried_forces(found.followed[first])
    if as_told or carried[0] == (told, np.inf):
        return _press(session, tissue, told, support, peak), ()
    forces = {tool: most * found.stiffness_factor for tool, most in carried}
    for tool in nearest_tools(told):
        scenario = _press(session, tissue, tool, support, peak)
        if forces.get(tool, np.inf) >= peak and _followed(scenario):
            name = tool_name(tool, told)
            said = f"the finite elements do not follow the tool as told to {peak:.3g} N: both models have {name}"
            return scenario, (() if tool == told else (said,))
    strongest = max(forces, key=lambda tool: forces[tool])
    name, most = tool_name(strongest, told), SAFE * min(forces[strongest], peak)
    said = f"the finite elements do not follow the trials' median peak of {peak:.3g} N: both models have {name}"
    return _press(session, tissue, strongest, support, most), (f"{said}, to {most:.3g} N",)


def _median_peak(found: FittedSession) -> float:
    """Median of the peak forces of the trials that were fitted, above their zeros, N."""
    data = {trial.key: trial for trial in found.trials}
    records = [(data[fit.key], fit.zero) for fit in found.fit.trials]
    return float(np.median([peak_force(trial.time, trial.force) - zero for trial, zero in records]))


def _press(session: Session, tissue: Tissue, tool: Tool, support: Support, peak: float) -> Scenario:
    load = Load(control="force", peak=peak, shape="triangle", duration=10.0, observations=OBSERVATIONS)
    return session.scenario(tissue, tool, support, load)


def _followed(scenario: Scenario) -> bool:
    """Whether the finite elements come to the end of a press, whose steps are other ones than a ramp's."""
    try:
        return prepare("fem", scenario).run(scenario_drive(scenario)).failure is None
    except (UncoveredError, TissuebenchError):
        return False


@output_on_stderr()
def _predictions(found: FittedSession, own: Own) -> tuple[tuple[TrialPrediction, ...], tuple[str, ...]]:
    """Both models' forces for each trial that was fitted, and why the wave model has none for some.

    Of a user's model, stdout goes to stderr.
    """
    kept = {trial.key for trial in found.fit.trials}
    setups = [found.session.setup(trial) for trial in found.session.trials]
    waves = {setup: _wave(found, setup, own) for setup in dict.fromkeys(setups)}
    answers = [
        (setup, trial, _wave_force(trial, found, waves[setup], own))
        for setup, trial in zip(setups, found.trials, strict=True)
        if trial.key in kept
    ]
    reasons = Counter(answer for _, _, answer in answers if isinstance(answer, str))
    name = own.name("wave") or NAMES["wave"]
    said = tuple(f"the {name} has no force for {count} of the trials: {reason}" for reason, count in reasons.items())
    said += () if own.wave is None else _remembers(own.wave.name, answers, waves, found)
    return tuple(_prediction(trial, found, answer) for _, trial, answer in answers), said


def _remembers(
    name: str, answers: Sequence[Answer], waves: dict[Setup, PreparedModel | str], found: FittedSession
) -> tuple[str, ...]:
    """That a user's model answers otherwise for a set-up's first trial, asked again after the others."""
    firsts: dict[Setup, Answer] = {}
    for each in answers:
        firsts.setdefault(each[0], each)
    for setup, trial, force in firsts.values():
        again = _wave_force(trial, found, waves[setup], NOTHING)
        if isinstance(force, str) or isinstance(again, str):
            continue
        apart = float(np.abs(again - force).max())
        if apart > SAME_ANSWER * float(np.abs(force).max()):
            return (
                f"the {name} answers the same trial differently each time: {trial.condition}/{trial.name} by up to "
                f"{apart:.3g} N when it is asked again; what it keeps from call to call, or draws, is in its forces",
            )
    return ()


def _wave(found: FittedSession, setup: Setup, own: Own) -> PreparedModel | str:
    """The wave model of the fitted specimen, or why it does not cover it."""
    tissue, tool, support = setup
    scenario = setup_scenario(found.session, (fitted_tissue(found, tissue), tool, support))
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
            return _force_with_effects(found.session, trial, fitted.onset, wave, own.repair) + fitted.zero
        if sheet is None or joint is None:
            return wave.run(_drive(trial, fitted.onset)).force + fitted.zero
        elastic = wave.run(_drive(trial, joint.state.onset)).force
        pressing = np.maximum(relaxed(trial.time, elastic, sheet.relaxation), 0.0)
        return np.asarray(joint.state.zero + np.where(trial.depth > joint.state.onset, pressing, 0.0))
    except UncoveredError as error:
        return str(error)


def _force_with_effects(
    session: Session, trial: TrialData, onset: float, wave: PreparedModel, repair: RepairedModel
) -> Array:
    """(n,) N of a wave model at a trial's depth with all effects around its elastic law; raises UncoveredError."""
    depth = trial.depth - onset
    ramp = depth_ramp(wave, REACH * float(depth.max()), STEPS)
    context = trial_context(session, trial, depth)
    return trial_force(ramp.force_at, effects_of(repair), trial.time, depth, context)


def _drive(trial: TrialData, onset: float) -> Drive:
    """A trial's depth below contact as a drive, none in the air."""
    below = np.maximum(trial.depth - onset, 0.0)
    return Drive("depth", trial.time - trial.time[0] + float(np.diff(trial.time)[0]), below)
