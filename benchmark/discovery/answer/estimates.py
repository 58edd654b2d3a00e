"""From fits to the plain answer."""

from __future__ import annotations

import numpy as np

from benchmark.discovery.base.effect_model import Fit
from benchmark.discovery.detection.disagreement import Detection
from benchmark.discovery.discovery_result import Array, Candidate, Estimate, NamedEffect
from benchmark.discovery.evidence.gains import gain, held_out, held_out_conditions
from benchmark.discovery.evidence.selection import Scored, Selection, conditions, constant

SHAPE_UNITS = {"modulus": ""}
LIMIT = 1.96


def named_effects(selection: Selection) -> tuple[NamedEffect, ...]:
    """The chosen effects with parameters, confidence and look-alikes, the one that gains most first."""
    chosen = selection.chosen
    out = []
    for effect in chosen.model.effects:
        parameters = tuple(e for slug, e in effect_estimates(chosen) if slug == effect.slug)
        alike = selection.lookalikes.get(effect.slug, ())
        out.append(NamedEffect(effect.slug, confidence(selection, effect.slug), alike, parameters))
    return tuple(out)


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
    first = fitted.model.shape_count
    error = np.sqrt(np.maximum(np.diag(_covariance(fitted)), 0.0))
    values = fitted.model.values(fitted.vector)
    out = []
    for k, (slug, p) in enumerate(fitted.model.parameters, start=first):
        low, high = fitted.vector[k] - LIMIT * error[k], fitted.vector[k] + LIMIT * error[k]
        if p.logarithmic:
            low, high = np.exp(np.clip([low, high], -700.0, 700.0))
        ends = (float(np.clip(low, p.low, p.high)), float(np.clip(high, p.low, p.high)))
        out.append((slug, Estimate(p.name, values[slug][p.name], p.unit, ends)))
    return tuple(out)


def _covariance(fitted: Fit) -> Array:
    """Covariance of the vector, widened to the trials' actual scatter (sandwich estimate)."""
    inner = fitted.covariance
    slopes = fitted.blocks.slope - fitted.blocks.slope.mean(axis=0)
    count = len(slopes)
    meat = slopes.T @ slopes * count / max(count - 1, 1)
    sandwich = inner @ meat @ inner
    return np.where(np.eye(len(inner)) > 0.0, np.maximum(inner, sandwich), inner)


def base_estimates(fitted: Fit) -> tuple[Estimate, ...]:
    """The base's nuisances; the modulus as a factor."""
    error = np.sqrt(np.maximum(np.diag(_covariance(fitted)), 0.0))
    out = []
    for k, name in enumerate(fitted.model.problem.shapes):
        value, half = float(fitted.vector[k]), LIMIT * float(error[k])
        if name == "modulus":
            ends = (float(np.exp(value - half)), float(np.exp(value + half)))
            out.append(Estimate("modulus_factor", float(np.exp(value)), "", ends))
        else:
            out.append(Estimate(name, value, "", (value - half, value + half)))
    return tuple(out)


def candidates(selection: Selection, closed: dict[tuple[str, ...], float | None]) -> tuple[Candidate, ...]:
    """All candidates with their evidence: those refined, best first, then those that were only screened."""
    out = [_candidate(scored, closed) for scored in selection.candidates]
    seen = {slug for each in out for slug in each.slugs}
    for one in selection.screened:
        if one.effect.slug not in seen:
            out.append(Candidate((one.effect.slug,), 0.0, one.won / _trials(selection), float("nan"), 0.0, None, None))
    chosen = tuple(effect.slug for effect in selection.chosen.model.effects)
    return tuple(sorted(out, key=lambda each: (each.slugs != chosen, len(each.slugs), -each.gain)))


def _trials(selection: Selection) -> int:
    return len(selection.base.model.problem.trials)


def _candidate(scored: Scored, closed: dict[tuple[str, ...], float | None]) -> Candidate:
    g = scored.gain
    same = constant(scored.fit)
    return Candidate(scored.slugs, g.z, g.mean, g.error, scored.delta_bic, closed.get(scored.slugs), same)


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
    from benchmark.discovery.detection.disagreement import places

    out = []
    for place in places(fitted, after, level)[:5]:
        unit, size = ("N", place.size) if place.channel == "force_z" else ("mm", 1e3 * place.size)
        cycle = f", press {place.cycle}" if place.cycle else ""
        out.append(
            f"{place.channel} in {place.phase.replace('_', ' ')}{cycle} of {place.condition}: {size:+.3g} {unit} "
            f"({place.percent_of_signal:.2g} % of the signal, p = {place.p:.2g})"
        )
    return tuple(out)
