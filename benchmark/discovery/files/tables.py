"""The CSV tables of a discovery, as columns: names, units and order are the contract with readers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.result import Estimate
from benchmark.discovery.units import channel_unit
from benchmark.model_file.units import shown

Columns = dict[str, list[Any]]


def discovery_tables(record: DiscoveryRecord) -> dict[str, Columns]:
    """Return the tables by file name; the layers' one only where there are layers."""
    tables = {
        "where.csv": _where(record),
        "contrasts.csv": _contrasts(record),
        "candidates.csv": _candidates(record),
        "gap.csv": _gap(record),
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


def _gap(record: DiscoveryRecord) -> Columns:
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
