"""A session's fit with the effects of a model file: what they add to the elastic force is taken off before the fit.

The elastic fit gives stiffness, onset and zero; with these the effects' share of each row follows, and is taken off
the measured force; then the fit is done again. A few rounds settle it. The stiffness moves with the effects'
parameters, whose intervals are part of its own.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmark.files import Session
from benchmark.identification import FittingError, SessionFit, TrialData, fit_session
from benchmark.identification.fitted_parameters import fitted_parameters
from benchmark.model_file import RepairedModel
from benchmark.models import Array, UncoveredError
from benchmark.models.scenario_effects import measured_height, open_radius, specimen_layers
from benchmark.physics import TrialContext
from benchmark.response.model_with_effects import effects_of, held_by_finite_strain
from benchmark.response.pipeline import Added, trial_force

ROUNDS = 12
SETTLED = 1e-3
"""Relative change of the stiffness from which a round is the last."""


@dataclass(frozen=True, eq=False)
class FitWithEffects:
    """A fit with effects.

    Attributes
    ----------
    fit : SessionFit
        Stiffness, onsets and zeros of the elastic part.
    trials : tuple of TrialData
        The measured trials with the effects' share taken off their force.
    added : mapping of (condition, trial) to (n,) array
        That share, N.
    settled : bool
        Whether the rounds came to rest.
    """

    fit: SessionFit
    trials: tuple[TrialData, ...]
    added: Mapping[tuple[str, str], Array]
    settled: bool


def fit_with_effects(session: Session, trials: Sequence[TrialData], repair: RepairedModel) -> FitWithEffects:
    """Fit a session's specimen with effects switched on.

    Raises
    ------
    FittingError
        The trials cannot be fitted, or the effects do not cover them.
    """
    made = _settled(session, trials, effects_of(repair), repair, fit_session(trials, session.specimen.layers))
    moves = []
    for slug, name, half in _uncertain(repair):
        moved = [_moved(each, slug, name, half) for each in effects_of(repair)]
        other = _settled(session, trials, moved, repair, made.fit)
        moves.append(math.log(other.fit.stiffness_factor / made.fit.stiffness_factor))
    return replace(made, fit=_widened(made.fit, session, moves))


def _settled(
    session: Session, trials: Sequence[TrialData], added: Sequence[Added], repair: RepairedModel, fit: SessionFit
) -> FitWithEffects:
    """Rounds of fitting what is left after the effects, from a fit without or near."""
    effects = tuple(each for each in added if not held_by_finite_strain(each[0], repair))
    reduced, shares, settled = tuple(trials), {trial.key: np.zeros(trial.rows) for trial in trials}, False
    for _ in range(ROUNDS):
        before = fit.stiffness_factor
        shares = {trial.key: _share(session, trial, fit, effects) for trial in trials if _fitted(trial, fit)}
        reduced = tuple(
            replace(trial, force=trial.force - shares.get(trial.key, np.zeros(trial.rows))) for trial in trials
        )
        fit = fit_session(reduced, session.specimen.layers)
        if abs(fit.stiffness_factor - before) <= SETTLED * before:
            settled = True
            break
    return FitWithEffects(fit, reduced, shares, settled)


def _uncertain(repair: RepairedModel) -> list[tuple[str, str, float]]:
    """Effect, parameter and half width of its interval, where the model file has one."""
    return [
        (effect.slug, name, 0.5 * (value.ci95[1] - value.ci95[0]))
        for effect in repair.effects
        for name, value in effect.parameters.items()
        if value.ci95 is not None and value.ci95[1] > value.ci95[0]
    ]


def _moved(added: Added, slug: str, name: str, half: float) -> Added:
    """An effect with a parameter larger by so much, within what it allows; another effect as it is."""
    effect, values = added
    if effect.slug != slug:
        return added
    parameter = next(each for each in effect.description.parameters if each.name == name)
    return effect, {**values, name: min(max(values[name] + half, parameter.low), parameter.high)}


def _widened(fit: SessionFit, session: Session, moves: Sequence[float]) -> SessionFit:
    """A fit whose stiffness is as uncertain as the effects' parameters make it beside the trials' scatter.

    `moves` of its logarithm, one for the half width of each parameter's interval, add up as if parameters were
    independent, since a model file has no correlations.
    """
    pooled = fit.stiffness
    if not any(moves):
        return fit
    more = math.fsum(move**2 for move in moves)
    low, high = (
        pooled.value * math.exp(sign * math.sqrt(math.log(end / pooled.value) ** 2 + more))
        for sign, end in ((-1.0, pooled.ci95_low), (1.0, pooled.ci95_high))
    )
    wide = replace(pooled, ci95_low=low, ci95_high=high, method=f"{pooled.method}; with the intervals of the effects")
    return replace(fit, stiffness=wide, parameters=fitted_parameters(wide, fit.trials, session.specimen.layers))


def _fitted(trial: TrialData, fit: SessionFit) -> bool:
    return trial.key in {each.key for each in fit.trials}


def _share(session: Session, trial: TrialData, fit: SessionFit, effects: Sequence[Added]) -> Array:
    """(n,) N that the effects add to the elastic force of a trial."""
    own, factor = fit.trial(trial.name, trial.condition), fit.stiffness_factor
    depth = trial.depth - own.onset

    def law(below: Array) -> Array:
        return factor * trial.curve.extended(below)

    try:
        force = trial_force(law, effects, trial.time, depth, trial_context(session, trial, depth))
    except UncoveredError as error:
        raise FittingError(f"{trial.label}: {error}") from None
    return np.asarray(force - np.where(depth > 0.0, law(np.maximum(depth, 0.0)), 0.0))


def trial_context(session: Session, trial: TrialData, depth: Array) -> TrialContext:
    """What effects may know of a trial that is pressed to a depth (n,) below contact, m."""
    measured = next(each for each in session.trials if (each.condition, each.name) == trial.key)
    tissue, tool, support = session.setup(measured)
    return TrialContext(
        tool_radius=tool.radius,
        thickness=measured_height(tissue.thickness, support, tool.radius),
        peak_depth=float(depth.max()),
        peak_force=float(np.ptp(trial.force)),
        duration=float(np.ptp(trial.time)),
        hole_radius=open_radius(support),
        layers=specimen_layers(tissue.layers),
        contact=tool.contact,
        edge_radius=tool.edge_radius or 0.0,
    )
