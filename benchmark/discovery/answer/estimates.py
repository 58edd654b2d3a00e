"""From fits to the plain answer."""

from __future__ import annotations

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.base.setup_priors import is_setup
from benchmark.discovery.detection.disagreement import Detection
from benchmark.discovery.detection.places import flagged_places
from benchmark.discovery.discovery_result import (
    Candidate,
    Estimate,
    LookAlike,
    NamedEffect,
    SetupEstimate,
    channel_unit,
)
from benchmark.discovery.evidence.gains import Scored, conditions, gain, held_out
from benchmark.discovery.evidence.parameter_evidence import by_condition, constant, effect_estimates, half_widths
from benchmark.discovery.evidence.selection import Selection
from benchmark.physics.setup_entry import setup_key

MOST_REMAINS = 5
"""Sentences of what the answer leaves."""


def named_effects(selection: Selection, most: float = 1.0) -> tuple[NamedEffect, ...]:
    """The chosen effects by what each gains, with parameters, look-alikes and confidence, `most` at most."""
    chosen = selection.chosen
    estimates, parts = effect_estimates(chosen), by_condition(chosen)
    named = (
        NamedEffect(
            effect.slug,
            min(confidence(selection, effect.slug), most),
            selection.lookalikes.get(effect.slug, ()),
            tuple(each for slug, each in estimates if slug == effect.slug),
            look_alikes(selection, effect.slug),
            tuple(each for slug, each in parts if slug == effect.slug),
            own_gain(selection, effect.slug),
        )
        for effect in chosen.model.effects
    )
    return tuple(sorted(named, key=lambda each: -each.gain))


def own_gain(selection: Selection, slug: str) -> float:
    """What a chosen effect adds to the held-out log density of a trial beside the others."""
    own = selection.own.get(slug)
    return 0.0 if own is None else own.mean


def look_alikes(selection: Selection, slug: str) -> tuple[LookAlike, ...]:
    """The rivals of a chosen effect with their own parameters, best first."""
    groups, now = conditions(selection.chosen), held_out(selection.chosen)
    own, out = max(own_gain(selection, slug), 1e-12), []
    for rival in selection.rivals.get(slug, ()):
        name, lead = rival.model.effects[-1].slug, gain(now, held_out(rival), groups)
        parameters = tuple(each for of, each in effect_estimates(rival) if of == name)
        out.append(LookAlike(name, parameters, lead.mean / own, lead.z))
    return tuple(out)


def confidence(selection: Selection, slug: str) -> float:
    """How often such an answer was right first in blind trials, and no more than its weight among its look-alikes.

    The weight of a rival is exp(-z^2 / 2) of its shortfall over unseen trials. The share of right answers among k of n
    is (k + 1) / (n + 2).
    """
    chosen, rivals = selection.chosen, selection.rivals.get(slug, ())
    right, answers = criteria.RIGHT_AMONG if rivals else criteria.RIGHT_ALONE
    groups, now = conditions(chosen), held_out(chosen)
    shortfalls = [max(gain(now, held_out(rival), groups).z, 0.0) for rival in rivals]
    weight = 1.0 / (1.0 + sum(float(np.exp(-0.5 * z**2)) for z in shortfalls))
    return min((right + 1.0) / (answers + 2.0), weight)


def base_estimates(fitted: Fit) -> tuple[Estimate, ...]:
    """The base's nuisances; the modulus as a factor."""
    widths, out = half_widths(fitted), []
    for k, name in enumerate(fitted.model.problem.shapes):
        value, half = float(fitted.vector[k]), float(widths[k])
        if name == "modulus":
            ends = (float(np.exp(value - half)), float(np.exp(value + half)))
            out.append(Estimate("modulus_factor", float(np.exp(value)), "", ends))
        else:
            out.append(Estimate(name, value, "", (value - half, value + half)))
    return tuple(out)


def setup_estimates(fitted: Fit) -> tuple[SetupEstimate, ...]:
    """The set-up's parameters, whether nuisances of the base or entries that the answer names."""
    problem, widths = fitted.model.problem, half_widths(fitted)
    slugs = [*problem.shapes, *(slug for slug, _ in fitted.model.parameters)]
    out = []
    for name, value, half in zip(slugs, fitted.vector.tolist(), widths.tolist(), strict=True):
        key = setup_key(name) or (name if is_setup(name) else None)
        if key is not None:
            named = name != key
            prior = None if named else problem.setup[key]
            out.append(SetupEstimate(key, value, (value - half, value + half), prior, named))
    return tuple(out)


def candidates(selection: Selection, closed: dict[tuple[str, ...], float | None]) -> tuple[Candidate, ...]:
    """All candidates with their evidence: those refined, best first, then those that were only screened."""
    out = [_candidate(scored, closed) for scored in selection.candidates]
    seen = {slug for each in out for slug in each.slugs}
    trials = len(selection.base.model.problem.trials)
    rest = [one for one in selection.screened if one.effect.slug not in seen]
    out += [Candidate((one.effect.slug,), 0.0, one.won / trials, float("nan"), 0.0, None, None) for one in rest]
    chosen = tuple(effect.slug for effect in selection.chosen.model.effects)
    return tuple(sorted(out, key=lambda each: (each.slugs != chosen, len(each.slugs), -each.gain)))


def _candidate(scored: Scored, closed: dict[tuple[str, ...], float | None]) -> Candidate:
    g, slugs = scored.gain, scored.slugs
    return Candidate(slugs, g.z, g.mean, g.error, scored.delta_bic, closed.get(slugs), constant(scored.fit))


def remains(fitted: Fit, after: Detection, level: float) -> tuple[str, ...]:
    """What the answer leaves, a sentence a cell, the worst first."""
    out = []
    for place in flagged_places(fitted, after, level)[:MOST_REMAINS]:
        unit, scale = channel_unit(place.channel)
        phase = place.phase.replace("_", " ") + (f", press {place.cycle}" if place.cycle else "")
        out.append(
            f"{place.channel} in {phase} of {place.condition}: {scale * place.missed:+.3g} {unit} "
            f"({place.percent_of_signal:.2g} % of the signal, p = {place.p:.2g})"
        )
    return tuple(out)
