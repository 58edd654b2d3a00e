"""What differs between finished runs: parameters of their scenarios, and results."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from benchmark.files import Scenario
from benchmark.runs.finished.reading import SavedRun
from benchmark.runs.report.values import MM, peak_errors

Columns = dict[str, list[Any]]


def parameters(scenario: Scenario) -> dict[str, str]:
    """Every value of a scenario by its key as `--set` takes it, a layer's by the layer's name."""
    return dict(_flat(tomllib.loads(scenario.to_toml()), ""))


def _flat(value: Any, path: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _flat(item, f"{path}.{key}" if path else key)
    elif isinstance(value, list) and value and all(isinstance(item, dict) and "name" in item for item in value):
        yield path.removeprefix("tissue."), ", ".join(str(item["name"]) for item in value)
        for item in value:
            yield from _flat({key: cell for key, cell in item.items() if key != "name"}, str(item["name"]))
    elif isinstance(value, list):
        yield path, ", ".join(str(item) for item in value) or "none"
    else:
        yield path, str(value)


def changed_parameters(scenarios: Mapping[str, Scenario]) -> Columns:
    """Columns of `parameters.csv`: a row for each key that is not the same in all runs, None where a run lacks it."""
    told = {name: parameters(scenario) for name, scenario in scenarios.items()}
    keys = dict.fromkeys(key for each in told.values() for key in each)
    different = [key for key in keys if len({each.get(key) for each in told.values()}) > 1]
    return {"parameter": different, **{name: [each.get(key) for key in different] for name, each in told.items()}}


def result_columns(runs: Mapping[str, SavedRun]) -> Columns:
    """Columns of `runs.csv`: one row a run and layer."""
    rows = [row for name, run in runs.items() for row in _rows(name, run)]
    return {key: [row[key] for row in rows] for key in rows[0]}


def _rows(name: str, run: SavedRun) -> Iterator[dict[str, Any]]:
    record = run.record
    errors, comparisons = peak_errors(record), {each.layer: each for each in record.comparisons}
    fem, wave = record.pair.fem, record.pair.wave
    largest = [
        np.full(len(record.layers), np.nan) if each.result is None else MM * each.result.max_deformation()
        for each in (fem, wave)
    ]
    for place, layer in enumerate(record.layers):
        found = comparisons.get(layer)
        statistics = None if found is None else found.statistics
        yield {
            "run": name,
            "layer": layer,
            "fem_max_mm": float(largest[0][place]),
            "wave_max_mm": float(largest[1][place]),
            "error_at_peak_percent": errors.get(layer),
            "error_mean_percent": None if found is None else found.percent.mean,
            "error_max_percent": None if found is None else found.percent.maximum,
            "tost_p": None if statistics is None else statistics.equivalence.p_value,
            "equivalent": None if statistics is None else statistics.equivalence.equivalent,
            "fem_unknowns": None if fem.result is None else fem.result.unknowns,
            "wave_unknowns": None if wave.result is None else wave.result.unknowns,
            "fem_wall_s": None if fem.seconds is None else fem.seconds.wall,
            "wave_wall_s": None if wave.seconds is None else wave.seconds.wall,
            "speedup": None if record.pair.speedup is None else record.pair.speedup.median,
            "complete": record.complete,
        }
