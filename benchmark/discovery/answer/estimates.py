"""From fits to the plain answer."""

from __future__ import annotations

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.detection.disagreement import Detection
from benchmark.discovery.detection.places import flagged_places
from benchmark.discovery.discovery_result import Array, Candidate, Estimate, NamedEffect, channel_unit
from benchmark.discovery.evidence.gains import conditions, gain, held_out, held_out_conditions
from benchmark.discovery.evidence.selection import Scored, Selection, constant

MOST_REMAINS = 5
"""Sentences of what the answer leaves."""


def named_effects(selection: Selection) -> tuple[NamedEffect, ...]:
    """The chosen effects in the model's order, with parameters, confidence and look-alikes."""
    chosen = selection.chosen
    estimates = effect_estimates(chosen)
    return tuple(
        NamedEffect(
            effect.slug,
            confidence(selection, effect.slug),
            selection.lookalikes.get(effect.slug, ()),
            tuple(each for slug, each in estimates if slug == effect.slug),
        )
        for effect in chosen.model.effects
    )


def confidence(selection: Selection, slug: str) -> float:
    """Weight among the candidates within reach: exp(-z^2 / 2) of each rival's shortfall."""
    chosen = selection.chosen
    groups, now = conditions(chosen), held_out(chosen)
    weights = 0.0
    for rival in selection.rivals.get(slug, ()):
        lead = gain(now, held_out(rival), groups)
        weights += float(np.exp(-0.5 * max(lead.z, 0.0) ** 2))
    return 1.0 / (1.0 + weights)


def effect_estimates(fitted: Fit) -> tuple[tuple[str, Estimate], ...]:
    """(slug, estimate) of every parameter of the effects."""
    first, half = fitted.model.shape_count, _half_widths(fitted)
    values = fitted.model.values(fitted.vector)
    out = []
    for k, (slug, p) in enumerate(fitted.model.parameters, start=first):
        low, high = fitted.vector[k] - half[k], fitted.vector[k] + half[k]
        if p.logarithmic:
            low, high = np.exp(np.clip([low, high], -700.0, 700.0))
        ends = (float(np.clip(low, p.low, p.high)), float(np.clip(high, p.low, p.high)))
        out.append((slug, Estimate(p.name, values[slug][p.name], p.unit, ends)))
    return tuple(out)


def base_estimates(fitted: Fit) -> tuple[Estimate, ...]:
    """The base's nuisances; the modulus as a factor."""
    widths, out = _half_widths(fitted), []
    for k, name in enumerate(fitted.model.problem.shapes):
        value, half = float(fitted.vector[k]), float(widths[k])
        if name == "modulus":
            ends = (float(np.exp(value - half)), float(np.exp(value + half)))
            out.append(Estimate("modulus_factor", float(np.exp(value)), "", ends))
        else:
            out.append(Estimate(name, value, "", (value - half, value + half)))
    return tuple(out)


def _half_widths(fitted: Fit) -> Array:
    """(p,) half widths of the vector's 95 % intervals, widened to the trials' actual scatter (sandwich estimate)."""
    inner = fitted.covariance
    slopes = fitted.blocks.slope - fitted.blocks.slope.mean(axis=0)
    count = len(slopes)
    sandwich = inner @ (slopes.T @ slopes * count / max(count - 1, 1)) @ inner
    variance = np.maximum(np.diag(inner), np.diag(sandwich))
    return np.asarray(criteria.NORMAL_95 * np.sqrt(np.maximum(variance, 0.0)))


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


def transfers(selection: Selection) -> bool | None:
    """Whether the chosen effects gain on held-out conditions with constant parameters; None with one condition."""
    same = constant(selection.chosen)
    if same is None:
        return None
    groups = conditions(selection.chosen)
    over = gain(held_out_conditions(selection.chosen), held_out_conditions(selection.base), groups)
    return same and over.mean > 0.0


def remains(fitted: Fit, after: Detection, level: float) -> tuple[str, ...]:
    """What the answer leaves, a sentence a cell, the worst first."""
    out = []
    for place in flagged_places(fitted, after, level)[:MOST_REMAINS]:
        unit, scale = channel_unit(place.channel)
        phase = place.phase.replace("_", " ") + (f", press {place.cycle}" if place.cycle else "")
        out.append(
            f"{place.channel} in {phase} of {place.condition}: {scale * place.size:+.3g} {unit} "
            f"({place.percent_of_signal:.2g} % of the signal, p = {place.p:.2g})"
        )
    return tuple(out)
