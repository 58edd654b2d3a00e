"""What `discover` writes: discovery.json, tables, model.toml, next_experiment.toml and the page in one folder."""

from __future__ import annotations

import math
import shutil
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from benchmark.discovery.discovery_result import (
    Candidate,
    ChannelGap,
    ChannelSize,
    ConditionEstimate,
    Contrast,
    Estimate,
    NamedEffect,
    Place,
    SetupEstimate,
    TrialValues,
    channel_unit,
)
from benchmark.discovery.report.discovery_page import discovery_page
from benchmark.discovery.report.discovery_record import DiscoveryRecord, LayerGap, NextExperiment, gap_in_units
from benchmark.discovery.report.refit_section import refit_line
from benchmark.errors import TissuebenchError
from benchmark.files.units import shown
from benchmark.model_file import model_toml
from benchmark.runs.output.document import describe_environment
from reports import write_csv, write_json, write_page, write_text, write_whole

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
        "size": {each.channel: _size(each) for each in found.sizes},
        "within_tolerance": found.within_tolerance if found.sizes else None,
        "not_looked_for": dict(found.not_shown),
        "worse_held_out": list(found.worse),
        "undetermined": list(found.undetermined),
        "candidates": [_candidate(candidate) for candidate in found.candidates],
        "base": {estimate.name: _estimate(estimate) for estimate in found.base},
        "setup": {each.key: _setup(each) for each in found.setup},
        "own": [_own(each) for each in found.own],
        "remains": list(found.remains),
        "warnings": list(found.warnings),
        "conditions": list(found.conditions),
        "channels": list(found.channels),
        "trials": list(found.trials),
        "seed": record.seed,
        "seconds": found.seconds,
    }
    return {**document, **_where_there_is(record)}


def _where_there_is(record: DiscoveryRecord) -> dict[str, Any]:
    """What not every discovery has."""
    more: dict[str, Any] = {}
    if record.refits:
        more["refitted"] = {refit.model: refit.document() for refit in record.refits}
    if record.layers:
        more["layers"] = {layer.layer: _layer(layer) for layer in record.layers}
    if record.proposal is not None:
        more["next_experiment"] = _proposal(record.proposal)
    return more


def _effect(effect: NamedEffect) -> dict[str, Any]:
    return {
        "name": effect.slug,
        "confidence": effect.confidence,
        "lookalikes": list(effect.lookalikes),
        "parameters": {estimate.name: _estimate(estimate) for estimate in effect.parameters},
        "gain": None if math.isnan(effect.gain) else effect.gain,
        "rivals": [
            {
                "name": rival.slug,
                "lacking_share": rival.lacking,
                "lacking_standard_errors": rival.errors,
                "parameters": {estimate.name: _estimate(estimate) for estimate in rival.parameters},
            }
            for rival in effect.rivals
        ],
        "by_condition": [
            {"name": each.name, "condition": each.condition, **_estimate(each), "agrees": each.agrees}
            for each in effect.by_condition
        ],
    }


def _setup(estimate: SetupEstimate) -> dict[str, Any]:
    return {
        "change": estimate.change,
        "ci95": list(estimate.ci95),
        "prior": estimate.prior,
        "of_prior": estimate.of_prior,
        "named": estimate.named,
    }


def _own(values: TrialValues) -> dict[str, Any]:
    return {
        "trial": values.trial,
        "gain": values.gain,
        "zero_N": values.zero,
        "late_ms": 1e3 * values.late,
        "touch_mm": 1e3 * values.touch,
        "thicker_percent": 1e2 * values.thicker,
        "at_bound": " ".join(values.at_bound),
    }


def _estimate(estimate: Estimate | ConditionEstimate) -> dict[str, Any]:
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
        "residual": channel_unit(place.channel)[1] * place.missed,
        "either_way": place.either_way,
    }


def _contrast(contrast: Contrast) -> dict[str, Any]:
    return {
        "question": contrast.question,
        "channel": contrast.channel,
        **_sized(contrast.channel, contrast.size),
        "p": contrast.p,
    }


def _size(size: ChannelSize) -> dict[str, Any]:
    unit, scale = channel_unit(size.channel)
    sizes = {"before": size.before, "after": size.after, "tolerance": size.tolerance}
    return {"unit": unit, **{name: scale * each for name, each in sizes.items()}, "within": size.within}


def _gap(gap: ChannelGap) -> dict[str, Any]:
    row = gap_in_units(gap)
    held_out = row.pop("held_out")
    return {**row, "ci95": None if gap.ci95 is None else list(gap.ci95), "held_out": held_out}


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
        "trials": proposal.trials,
        "minutes": proposal.minutes,
        "menu": {
            name: {"separation": each[0], "minutes": each[1] if math.isfinite(each[1]) else None}
            for name, each in proposal.menu.items()
        },
    }


Columns = dict[str, list[Any]]
COLUMNS = {
    "where.csv": ("channel", "phase", "condition", "cycle", "depth_low_mm", "depth_high_mm", "size", "unit",
                  "percent_of_signal", "p", "residual"),
    "contrasts.csv": ("question", "channel", "size", "unit", "p"),
    "candidates.csv": ("name", "z", "gain", "gain_standard_error", "delta_bic", "gap_closed", "constant"),
    "gap.csv": ("channel", "unit", "rmse_before", "rmse_after", "noise_floor", "closed", "ci95_low", "ci95_high",
                "held_out"),
    "parameters.csv": ("part", "name", "value", "unit", "ci95_low", "ci95_high"),
    "refitted.csv": ("model", "held_out", "conditions", "channel", "unit", "rmse_before", "rmse_after", "noise_floor",
                     "before_in_noise", "after_in_noise", "explained"),
    "trials.csv": ("trial", "gain", "zero_N", "late_ms", "touch_mm", "thicker_percent", "at_bound"),
    "layers.csv": ("layer", "rmse_before_mm", "rmse_after_mm", "closed", "percent_at_peak_before",
                   "percent_at_peak_after"),
}  # fmt: skip
"""Names and order are the contract with readers; the values are those of `discovery.json`."""


def discovery_tables(document: Mapping[str, Any]) -> dict[str, Columns]:
    """Return the CSV tables of a `discovery.json` as columns, by file name; the layers' only where there are layers."""
    parameters = [{"part": "base", "name": name, **each} for name, each in document["base"].items()]
    for effect in document["effects"]:
        parameters += [{"part": effect["name"], "name": name, **each} for name, each in effect["parameters"].items()]
    rows: dict[str, list[dict[str, Any]]] = {
        "where.csv": document["where"],
        "contrasts.csv": document["contrasts"],
        "candidates.csv": document["candidates"],
        "gap.csv": [{"channel": channel, **gap} for channel, gap in document["gap"].items()],
        "parameters.csv": parameters,
    }
    if "refitted" in document:
        rows["refitted.csv"] = [
            {"model": model, **row}
            for model, refit in document["refitted"].items()
            for row in refit.get("predictions", ())
        ]
    if document["own"]:
        rows["trials.csv"] = document["own"]
    if "layers" in document:
        rows["layers.csv"] = [{"layer": name, **each} for name, each in document["layers"].items()]
    return {file: _columns(map(_flat, each), COLUMNS[file]) for file, each in rows.items()}


def _flat(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row with its intervals in two cells each, and a layer's sizes by their names with the unit."""
    out = dict(row)
    for name, low, high in (("depth_mm", "depth_low_mm", "depth_high_mm"), ("ci95", "ci95_low", "ci95_high")):
        if name in out:
            out[low], out[high] = out[name] or (None, None)
    if "layer" in out:
        out |= {f"{name}_mm": out[name] for name in ("rmse_before", "rmse_after")}
    return out


def _columns(rows: Iterable[Mapping[str, Any]], names: Sequence[str]) -> Columns:
    """One list a column, one entry a row."""
    listed = list(rows)
    return {name: [row[name] for row in listed] for name in names}


@dataclass(frozen=True)
class DiscoveryOutcome:
    """A finished discovery on disk.

    Its folder, `discovery.json`'s content, headline, warnings, a line a refit, and what ended a closed loop early.
    """

    folder: Path
    document: dict[str, Any]
    headline: str
    warnings: tuple[str, ...]
    lines: tuple[str, ...] = ()
    stopped: TissuebenchError | None = None


def write_discovery(record: DiscoveryRecord, folder: Path) -> DiscoveryOutcome:
    """Write discovery.json, model.toml, next_experiment.toml, tables, report and a grown session into `folder`.

    Raises
    ------
    OSError
        Where the file system refuses; `folder` is then as it was.
    """
    document, environment = {**discovery_document(record), **_loop(record)}, describe_environment(seed=record.seed)
    tables = discovery_tables(document)
    page = discovery_page(record, environment, list(tables))

    def fill(new: Path) -> None:
        for name, columns in tables.items():
            write_csv(new / "tables" / name, columns)
        write_json(new / "discovery.json", document)
        write_json(new / "environment.json", environment)
        write_text(new / "model.toml", model_toml(record.repaired()))
        if record.proposal is not None:
            write_text(new / "next_experiment.toml", record.proposal.toml)
        if record.grown is not None:
            shutil.copytree(record.grown, new / "session")
        write_page(new / "report.html", page)

    write_whole(folder, fill)
    lines = tuple(refit_line(refit) for refit in record.refits)
    return DiscoveryOutcome(folder, document, page.verdict.headline, record.found.warnings, lines, record.stopped)


def _loop(record: DiscoveryRecord) -> dict[str, Any]:
    """What `discovery.json` has of a closed loop; nothing without one."""
    if record.grown is None:
        return {}
    stopped = None if record.stopped is None else str(record.stopped)
    return {"rounds": [asdict(each) for each in record.rounds], "stopped": stopped}
