"""Accepted effects refitted in the FEM and the wave model themselves, and what they predict of unseen trials.

The discovery's engine bends a table of the set-up as told by small polynomials and puts effects on top of it. Here each
model carries the effects as it can, is computed anew where the refit goes, and nothing bends: free are the modulus, the
set-up within what is known of it, the effects' parameters, and each trial's own gain, zero, clock and touch. What a
model misses with the effects counts as noise, so that intervals are as wide as the misfit asks.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.base.effect_model import EffectModel, Fit
from benchmark.discovery.base.setup_priors import is_setup, table_keys
from benchmark.discovery.base.trials_problem import NoiseModel, TrialsProblem
from benchmark.discovery.discovery_result import Array, Estimate
from benchmark.discovery.evidence.parameter_evidence import effect_estimates, half_widths
from benchmark.discovery.evidence.shortlist import compared, on_some
from benchmark.discovery.refitting.native_terms import TERMS, NativeTerm, moved
from benchmark.discovery.refitting.press_model import FREE, MEMORY, EffectsInModel, PressFit, Stand
from benchmark.discovery.refitting.refit_result import CarriedEffect, ModelRefit, RefittedNumber
from benchmark.discovery.refitting.solid_press import FemSpecimen, ModelName, WaveSpecimen
from benchmark.discovery.refitting.unseen import Refitted, predictions, splits, traces, unseen_rows
from benchmark.errors import TissuebenchError
from benchmark.files import Session
from benchmark.physics import Effect
from benchmark.physics.setup_entry import PREFIX, setup_key
from benchmark.response.setup_change import CHOICES

SERIES = "a Prony series of every layer's shear, followed through the press of each condition"
SETUP = "the set-up of the model is changed"
RIG = "what goes into the model, or what sensors make of its answer"
ON_TOP = "on top of the elastic answer (quasi-linear)"


def refits(session: Session, chosen: Fit) -> tuple[ModelRefit, ...]:
    """Refit the effects of a discovery in the FEM and in the wave model.

    Parameters
    ----------
    session : Session
    chosen : Fit
        The discovery's, with the effects that were accepted. Of many trials some are taken, as for its candidates.
    """
    some = on_some(chosen, compared(chosen))
    return tuple(_refit_or_reason(session, some, name) for name in ("fem", "wave"))


def picked(base: Fit, effects: Sequence[Effect]) -> Fit:
    """Effects that a person picks, fitted to all trials as the search does, whatever it found."""
    for effect in effects:
        base = fit_candidate(base, effect)
    return base


def _refit_or_reason(session: Session, chosen: Fit, name: ModelName) -> ModelRefit:
    try:
        return refit(session, chosen, name)
    except TissuebenchError as error:
        return ModelRefit(name, reason=str(error))


def refit(session: Session, chosen: Fit, name: ModelName) -> ModelRefit:
    """Refit the effects in one model; raises TissuebenchError where it does not cover the session."""
    carried = tuple(_carried(session, chosen.model.effects, name))
    work, start = _in_model(session, chosen, name, carried)
    first, _, _ = work.fit(chosen.model.problem, start, chosen.nuisance)
    fitted, stand, apart = work.weighed(first, _widened(first))
    problem = replace(chosen.model.problem, noise=fitted.model.problem.noise)
    elastic = replace(work.specimen, terms=()) if isinstance(work.specimen, FemSpecimen) else work.specimen
    without = EffectsInModel(elastic)
    bare, bare_stand = _converged(without, problem, (stand, fitted.nuisance), (Stand({}, {}, {}), chosen.nuisance))
    plain, repaired = Refitted(without, bare, bare_stand), Refitted(work, fitted, stand)
    parts = list(splits(chosen))
    rows = unseen_rows(parts, plain, repaired)
    return ModelRefit(
        name,
        carried,
        tuple(_numbers(repaired, chosen)),
        tuple(predictions(chosen, plain, repaired, parts, rows)),
        _added(fitted, without.pressed(problem, Stand({}, stand.shape, {}))),
        _added(chosen, EffectModel(chosen.model.problem, ())),
        apart,
        tuple(traces(chosen, parts, rows)),
    )


def _converged(work: EffectsInModel, problem: TrialsProblem, *starts: tuple[Stand, Array]) -> tuple[PressFit, Stand]:
    """The best of fits from several starts, so that no fit that got stuck stands for the model without effects."""
    found = [work.fit(problem, Stand({}, start.shape, {}), nuisance) for start, nuisance in starts]
    best, stand, _ = min(found, key=lambda each: each[0].objective)
    return best, stand


def _carried(session: Session, effects: Sequence[Effect], name: ModelName) -> Iterator[CarriedEffect]:
    """How a model carries each effect."""
    for effect in effects:
        term, acts_on = TERMS.get(effect.slug), effect.description.acts_on
        if acts_on == "setup":
            yield CarriedEffect(effect.slug, True, SETUP)
        elif acts_on != "body":
            yield CarriedEffect(effect.slug, True, RIG)
        elif name == "wave":
            yield CarriedEffect(effect.slug, False, f"{ON_TOP} of the wave")
        elif effect.slug == MEMORY:
            yield CarriedEffect(effect.slug, True, SERIES)
        elif term is None:
            yield CarriedEffect(effect.slug, False, f"{ON_TOP} of the FEM, which has no such term here")
        else:
            reason = term.refused(session)
            words = term.words if reason is None else f"{ON_TOP} of the FEM: {reason}"
            yield CarriedEffect(effect.slug, reason is None, words)


def _in_model(
    session: Session, chosen: Fit, name: ModelName, carried: Sequence[CarriedEffect]
) -> tuple[EffectsInModel, Stand]:
    """The effects in a model, and where a refit begins: at the discovery's answer, without its bends."""
    named = {setup_key(effect.slug) for effect in chosen.model.effects}
    keys = tuple(key for key in table_keys(session) if key in chosen.model.problem.setup or key in named)
    if name == "wave":
        keys = tuple(key for key in keys if key not in CHOICES)
    terms = tuple(TERMS[each.slug] for each in carried if each.inside and each.slug in TERMS)
    own = {term.slug for term in terms} | {PREFIX + key for key in CHOICES if name == "wave"}
    effects = tuple(each for each in chosen.model.effects if each.slug not in own)
    specimen = FemSpecimen(session, keys, terms) if name == "fem" else WaveSpecimen(session, keys)
    remembers = name == "fem" and any(each.slug == MEMORY for each in effects)
    return EffectsInModel(specimen, terms, effects, remembers), _start(session, chosen, terms, effects)


def _start(session: Session, chosen: Fit, terms: Sequence[NativeTerm], effects: Sequence[Effect]) -> Stand:
    values = chosen.model.values(chosen.vector)
    shape = dict(zip(chosen.model.problem.shapes, chosen.vector.tolist(), strict=False))
    kept = {key: value for key, value in shape.items() if key in FREE or is_setup(key)}
    numbers = {key: value for term in terms for key, value in term.start(session, values[term.slug]).items()}
    return Stand(numbers, kept, {effect.slug: values[effect.slug] for effect in effects})


def _widened(fitted: PressFit) -> NoiseModel:
    """The noise with what the model misses in each signal."""
    model, noise = fitted.model, fitted.model.problem.noise
    signals = model.signals(fitted.vector, fitted.nuisance)
    squares = []
    for trial, white in zip(model.problem.trials, model.white.residuals(signals), strict=True):
        rows = white.reshape(trial.signals.shape)
        squares.append((rows**2).sum(axis=0) / np.maximum((trial.count > 0.0).sum(axis=0), 1))
    return replace(noise, scale=noise.scale * np.maximum(np.sqrt(np.mean(squares, axis=0)), 1.0))


def _numbers(repaired: Refitted, chosen: Fit) -> Iterator[RefittedNumber]:
    """Stiffness, set-up and the effects' parameters, with the discovery's where it has the same."""
    fitted, half = repaired.fit, half_widths(repaired.fit)
    found = {(slug, each.name): each for slug, each in effect_estimates(chosen)}
    for place, (key, value) in enumerate(zip(fitted.model.problem.shapes, fitted.vector.tolist(), strict=False)):
        if key == "modulus":
            ends = (float(np.exp(value - half[place])), float(np.exp(value + half[place])))
            yield RefittedNumber("base", Estimate("stiffness_factor", float(np.exp(value)), "", ends))
        elif is_setup(key):
            ends = (float(value - half[place]), float(value + half[place]))
            prior = chosen.model.problem.setup.get(key)
            yield RefittedNumber("base", Estimate(key, value, "", ends), prior=prior)
    for slug, estimate in effect_estimates(fitted):
        if setup_key(slug) in fitted.model.origin:
            yield _native(repaired, slug, estimate)
        else:
            yield RefittedNumber(slug, estimate, found.get((slug, estimate.name)))


def _native(repaired: Refitted, slug: str, change: Estimate) -> RefittedNumber:
    """A number of a term in the model, from its change."""
    key = slug.removeprefix(PREFIX)
    owner, number = next((t, n) for t in repaired.work.terms for n in t.numbers if n.name == key)
    now = repaired.fit.model.origin[key]
    low, high = (min(max(moved(key, now, end), number.low), number.high) for end in change.ci95)
    return RefittedNumber(owner.slug, Estimate(key, moved(key, now, change.value), number.unit, (low, high)))


def _added(fitted: Fit | PressFit, without: EffectModel) -> float:
    """Root mean square of what the effects add to the force, the base staying as it is, N."""
    shape = fitted.vector[: fitted.model.shape_count]
    pairs = zip(
        fitted.model.signals(fitted.vector, fitted.nuisance), without.signals(shape, fitted.nuisance), strict=True
    )
    return float(np.sqrt(np.mean(np.concatenate([(more - less)[:, 0] ** 2 for more, less in pairs]))))
