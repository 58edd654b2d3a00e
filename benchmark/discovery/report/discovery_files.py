"""What `discover` writes: discovery.json, tables, model.toml, next_experiment.toml and the page in one folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.discovery.discovery_result import (
    Candidate,
    ChannelGap,
    Contrast,
    Estimate,
    NamedEffect,
    Place,
    channel_unit,
)
from benchmark.discovery.report.discovery_page import discovery_page
from benchmark.discovery.report.discovery_record import DiscoveryRecord, LayerGap, NextExperiment
from benchmark.files.units import shown
from benchmark.model_file import model_toml
from benchmark.runs.document import describe_environment
from reports import whole_folder, write_csv, write_json, write_page, write_text

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


Columns = dict[str, list[Any]]


def discovery_tables(record: DiscoveryRecord) -> dict[str, Columns]:
    """Return the tables by file name; the layers' one only where there are layers."""
    tables = {
        "where.csv": _where(record),
        "contrasts.csv": _contrasts(record),
        "candidates.csv": _candidates(record),
        "gap.csv": _gap_tables(record),
        "parameters.csv": _parameters(record),
    }
    if record.layers:
        tables["layers.csv"] = _layers(record)
    return tables


def _where(record: DiscoveryRecord) -> Columns:
    return _columns(
        record.found.where,
        {
            "channel": lambda place: place.channel,
            "phase": lambda place: place.phase,
            "condition": lambda place: place.condition,
            "cycle": lambda place: place.cycle,
            "depth_low_mm": lambda place: 1e3 * place.depth[0],
            "depth_high_mm": lambda place: 1e3 * place.depth[1],
            "size": lambda place: channel_unit(place.channel)[1] * place.size,
            "unit": lambda place: channel_unit(place.channel)[0],
            "percent_of_signal": lambda place: place.percent_of_signal,
            "p": lambda place: place.p,
        },
    )


def _contrasts(record: DiscoveryRecord) -> Columns:
    return _columns(
        record.found.contrasts,
        {
            "question": lambda contrast: contrast.question,
            "channel": lambda contrast: contrast.channel,
            "size": lambda contrast: channel_unit(contrast.channel)[1] * contrast.size,
            "unit": lambda contrast: channel_unit(contrast.channel)[0],
            "p": lambda contrast: contrast.p,
        },
    )


def _candidates(record: DiscoveryRecord) -> Columns:
    return _columns(
        record.found.candidates,
        {
            "name": lambda candidate: "+".join(candidate.slugs),
            "z": lambda candidate: candidate.z,
            "gain": lambda candidate: candidate.gain,
            "gain_standard_error": lambda candidate: candidate.gain_standard_error,
            "delta_bic": lambda candidate: candidate.delta_bic,
            "gap_closed": lambda candidate: candidate.gap_closed,
            "constant": lambda candidate: candidate.constant,
        },
    )


def _gap_tables(record: DiscoveryRecord) -> Columns:
    return _columns(
        record.found.gap,
        {
            "channel": lambda gap: gap.channel,
            "unit": lambda gap: channel_unit(gap.channel)[0],
            "rmse_before": lambda gap: channel_unit(gap.channel)[1] * gap.rmse_before,
            "rmse_after": lambda gap: channel_unit(gap.channel)[1] * gap.rmse_after,
            "noise_floor": lambda gap: channel_unit(gap.channel)[1] * gap.noise_floor,
            "closed": lambda gap: gap.closed,
            "ci95_low": lambda gap: None if gap.ci95 is None else gap.ci95[0],
            "ci95_high": lambda gap: None if gap.ci95 is None else gap.ci95[1],
            "held_out": lambda gap: gap.held_out,
        },
    )


def _parameters(record: DiscoveryRecord) -> Columns:
    rows: list[tuple[str, Estimate]] = [("base", estimate) for estimate in record.found.base]
    rows += [(effect.slug, estimate) for effect in record.found.effects for estimate in effect.parameters]
    return _columns(
        rows,
        {
            "part": lambda row: row[0],
            "name": lambda row: row[1].name,
            "value": lambda row: shown(row[1].value, row[1].unit)[0],
            "unit": lambda row: shown(row[1].value, row[1].unit)[1],
            "ci95_low": lambda row: shown(row[1].ci95[0], row[1].unit)[0],
            "ci95_high": lambda row: shown(row[1].ci95[1], row[1].unit)[0],
        },
    )


def _layers(record: DiscoveryRecord) -> Columns:
    return _columns(
        record.layers,
        {
            "layer": lambda layer: layer.layer,
            "rmse_before_mm": lambda layer: 1e3 * layer.rmse_before,
            "rmse_after_mm": lambda layer: 1e3 * layer.rmse_after,
            "closed": lambda layer: layer.closed,
            "percent_at_peak_before": lambda layer: layer.peak_before,
            "percent_at_peak_after": lambda layer: layer.peak_after,
        },
    )


def _columns(rows: Iterable[Any], cells: Mapping[str, Callable[[Any], Any]]) -> Columns:
    """One list a column, one entry a row."""
    listed = list(rows)
    return {name: [cell(row) for row in listed] for name, cell in cells.items()}


@dataclass(frozen=True)
class DiscoveryOutcome:
    """A finished discovery on disk: its folder, `discovery.json`'s content, its headline and its warnings."""

    folder: Path
    document: dict[str, Any]
    headline: str
    warnings: tuple[str, ...]


def write_discovery(record: DiscoveryRecord, folder: Path) -> DiscoveryOutcome:
    """Write discovery.json, model.toml, next_experiment.toml, tables and report into `folder`.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    document, environment = discovery_document(record), describe_environment(seed=record.seed)
    tables = discovery_tables(record)
    page = discovery_page(record, environment, list(tables))
    with whole_folder(folder) as new:
        for name, columns in tables.items():
            write_csv(new / "tables" / name, columns)
        write_json(new / "discovery.json", document)
        write_json(new / "environment.json", environment)
        write_text(new / "model.toml", model_toml(record.repaired()))
        if record.proposal is not None:
            write_text(new / "next_experiment.toml", record.proposal.toml)
        write_page(new / "report.html", page)
    return DiscoveryOutcome(folder, document, page.verdict.headline, record.found.warnings)
