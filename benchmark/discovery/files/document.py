"""`discovery.json`: the answer in one object for programs; None stands where there is no value."""

from __future__ import annotations

import math
from typing import Any

from benchmark.discovery.record import DiscoveryRecord, LayerGap, NextExperiment
from benchmark.discovery.result import Candidate, ChannelGap, Contrast, Estimate, NamedEffect, Place
from benchmark.discovery.units import channel_unit
from benchmark.model_file.units import shown

SCHEMA = 1


def discovery_document(record: DiscoveryRecord) -> dict[str, Any]:
    """Return the content of `discovery.json`."""
    found = record.found
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "name": record.name,
        "source": record.source,
        "fingerprint": record.fingerprint,
        "synthetic": record.synthetic,
        "model": record.model,
        "tissue": record.tissue,
        "verdict": found.verdict,
        "statement": found.statement,
        "p": found.p,
        "effects": [_effect(effect) for effect in found.effects],
        "where": [_place(place) for place in found.where],
        "contrasts": [_contrast(contrast) for contrast in found.contrasts],
        "gap": {gap.channel: _gap(gap) for gap in found.gap},
        "smallest_visible_effect": {channel: _sized(channel, size) for channel, size in found.smallest_visible.items()},
        "candidates": [_candidate(candidate) for candidate in found.candidates],
        "base": {estimate.name: _estimate(estimate) for estimate in found.base},
        "remains": list(found.remains),
        "warnings": list(found.warnings),
        "conditions": list(found.conditions),
        "channels": list(found.channels),
        "trials": list(found.trials),
        "seed": record.seed,
        "seconds": found.seconds,
    }
    if record.layers:
        document["layers"] = {layer.layer: _layer(layer) for layer in record.layers}
    if record.proposal is not None:
        document["next_experiment"] = _proposal(record.proposal)
    return document


def _effect(effect: NamedEffect) -> dict[str, Any]:
    return {
        "name": effect.slug,
        "confidence": effect.confidence,
        "lookalikes": list(effect.lookalikes),
        "parameters": {estimate.name: _estimate(estimate) for estimate in effect.parameters},
    }


def _estimate(estimate: Estimate) -> dict[str, Any]:
    value, unit = shown(estimate.value, estimate.unit)
    return {"value": value, "unit": unit, "ci95": [shown(end, estimate.unit)[0] for end in estimate.ci95]}


def _sized(channel: str, size: float) -> dict[str, Any]:
    unit, scale = channel_unit(channel)
    return {"size": scale * size, "unit": unit}


def _place(place: Place) -> dict[str, Any]:
    return {
        "channel": place.channel,
        "phase": place.phase,
        "condition": place.condition,
        "cycle": place.cycle,
        "depth_mm": [1e3 * end for end in place.depth],
        **_sized(place.channel, place.size),
        "percent_of_signal": place.percent_of_signal,
        "p": place.p,
    }


def _contrast(contrast: Contrast) -> dict[str, Any]:
    return {
        "question": contrast.question,
        "channel": contrast.channel,
        **_sized(contrast.channel, contrast.size),
        "p": contrast.p,
    }


def _gap(gap: ChannelGap) -> dict[str, Any]:
    unit, scale = channel_unit(gap.channel)
    return {
        "unit": unit,
        "rmse_before": scale * gap.rmse_before,
        "rmse_after": scale * gap.rmse_after,
        "noise_floor": scale * gap.noise_floor,
        "closed": gap.closed,
        "ci95": None if gap.ci95 is None else list(gap.ci95),
        "held_out": gap.held_out,
    }


def _candidate(candidate: Candidate) -> dict[str, Any]:
    return {
        "name": "+".join(candidate.slugs),
        "z": candidate.z,
        "gain": candidate.gain,
        "gain_standard_error": candidate.gain_standard_error,
        "delta_bic": candidate.delta_bic,
        "gap_closed": candidate.gap_closed,
        "constant": candidate.constant,
    }


def _layer(layer: LayerGap) -> dict[str, Any]:
    return {
        "unit": "mm",
        "rmse_before": 1e3 * layer.rmse_before,
        "rmse_after": 1e3 * layer.rmse_after,
        "closed": layer.closed,
        "percent_at_peak_before": layer.peak_before,
        "percent_at_peak_after": layer.peak_after,
        "held_out": "loads",
    }


def _proposal(proposal: NextExperiment) -> dict[str, Any]:
    return {
        "file": "next_experiment.toml",
        "rivals": list(proposal.rivals),
        "choice": proposal.choice,
        "separation_now": proposal.separation_now,
        "separation": proposal.separation,
        "minutes": proposal.minutes,
        "menu": {
            name: {"separation": each[0], "minutes": each[1] if math.isfinite(each[1]) else None}
            for name, each in proposal.menu.items()
        },
    }
