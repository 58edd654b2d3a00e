"""The CSV tables of a result folder, as columns: names, units and order are the contract with readers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from benchmark.comparison import normal_fit_columns, statistics_columns
from benchmark.identification import parameter_columns
from benchmark.models import Array, ModelResult
from benchmark.runs.record import RunRecord, whole
from benchmark.runs.trials.film_tables import circles, marker_fits
from benchmark.runs.trials.measured import MeasuredComparison
from benchmark.runs.validation import condition_columns, mesh_error_entry, refinement_columns, validation_columns
from benchmark.side_by_side import SideBySide
from benchmark.side_by_side.parameter_bands import ParameterBands

Columns = dict[str, Any]
MM = 1e3


def run_tables(record: RunRecord) -> dict[str, Columns]:
    """Return the tables of a run by file name."""
    tables = {
        "max_deformation.csv": max_deformation(record),
        "force_depth.csv": force_depth(record),
        "profile.csv": profile(record),
        "statistics.csv": statistics_columns(record.judged),
        "normal_fits.csv": normal_fit_columns(record.comparisons, (record.pair.fem.key, record.pair.wave.key)),
        "timing.csv": timing(record.pair),
    }
    judged = None if record.pair.fem.result is None else record.pair.fem.result.mesh_error
    if judged is not None:
        tables["mesh_error.csv"] = {name: [value] for name, value in mesh_error_entry(judged).items()}
    if record.measured is not None:
        tables["fitted_parameters.csv"] = parameter_columns(record.measured.fit.parameters)
        tables["measured.csv"] = measured(record.measured)
        tables |= film_tables(record.measured)
    if record.bands is not None:
        tables["parameter_bands.csv"] = band_columns(record, record.bands)
    checked = validation_columns(record, record.levels)
    if checked is not None:
        tables["validation.csv"] = checked
    by_condition = condition_columns(record)
    if by_condition is not None:
        tables["validation_conditions.csv"] = by_condition
    if record.levels:
        tables["refinement.csv"] = refinement_columns(record.levels)
    return tables


def band_columns(record: RunRecord, bands: ParameterBands) -> Columns:
    """Deflections with the 95 % bands that uncertain parameters leave, one row a step and layer, mm."""
    shape = (record.time.size, len(record.layers))
    out: Columns = {
        "step": np.repeat(np.arange(1, shape[0] + 1), shape[1]),
        "time_s": np.repeat(record.time, shape[1]),
        "layer": list(record.layers) * shape[0],
    }
    models = (("fem", record.pair.fem.result, bands.fem), ("wave", record.pair.wave.result, bands.wave))
    for name, result, deviation in models:
        middle, factor = 1e3 * record.deflections(result), bands.factor(deviation)
        columns = {name: middle, f"{name}_low": middle / factor, f"{name}_high": middle * factor}
        out |= {f"{key}_mm": values.ravel() for key, values in columns.items()}
    return out


def film_tables(comparison: MeasuredComparison) -> dict[str, Columns]:
    """Tables of the markers; none without any."""
    filmed = comparison.filmed
    if filmed is None:
        return {}
    tables = {"marker_fits.csv": marker_fits(filmed.motions), "circle.csv": circles(filmed.motions)}
    if filmed.sheet is not None and filmed.sheet.held_out:
        rows = filmed.sheet.held_out
        tables["held_out.csv"] = {
            "trial": [row.name for row in rows],
            "condition": [row.condition for row in rows],
            "force_rms_percent": [row.force_percent for row in rows],
            "marker_rms_mm": [row.marker_mm for row in rows],
        }
    return tables


def max_deformation(record: RunRecord) -> Columns:
    """Deflection of each layer's top face on the tool axis, one row a step and layer.

    The percent error is that of the wave model against the FEM, empty where the load or the FEM is zero.
    """
    fem, wave = (MM * record.deflections(run.result) for run in (record.pair.fem, record.pair.wave))
    steps, layers = fem.shape
    return {
        "step": np.repeat(np.arange(1, steps + 1), layers),
        "time_s": np.repeat(record.time, layers),
        "force_N": np.repeat(record.force(), layers),
        "layer": list(record.layers) * steps,
        "fem_mm": fem.ravel(),
        "wave_mm": wave.ravel(),
        "percent_error": percent_errors(record).ravel(),
    }


def force_depth(record: RunRecord) -> Columns:
    """Force and depth of both models, one row a step; empty where a model has no value."""
    columns: Columns = {"step": np.arange(1, record.time.size + 1), "time_s": record.time}
    for run in (record.pair.fem, record.pair.wave):
        for name, scale in (("force", 1.0), ("depth", MM)):
            values = np.zeros(0) if run.result is None else scale * getattr(run.result, name)
            columns[f"{run.model}_{name}_{'mm' if name == 'depth' else 'N'}"] = whole(values, record.time.size)
    return columns


def percent_errors(record: RunRecord) -> Array:
    """(n, L) error of the wave model against the FEM in %, NaN where it has no meaning."""
    if not record.comparisons:
        return np.full((record.time.size, len(record.layers)), np.nan)
    return np.column_stack([comparison.percent.signed for comparison in record.comparisons])


def tissue_columns(records: Mapping[str, RunRecord]) -> Columns:
    """Columns of `tissues.csv`: one row a tissue and layer, its properties, both models' largest deflections.

    The percent error is that of the wave model against the FEM at peak load.
    """
    names = (
        "tissue", "layer", "thickness_mm", "youngs_modulus_kPa", "poisson_ratio", "fem_max_mm", "wave_max_mm",
        "percent_error",
    )  # fmt: skip
    rows = [row for name, record in records.items() for row in _tissue_rows(name, record)]
    return {column: [row[place] for row in rows] for place, column in enumerate(names)}


def _tissue_rows(name: str, record: RunRecord) -> list[tuple[Any, ...]]:
    errors = percent_errors(record)[int(np.abs(record.load).argmax())]
    fem, wave = (MM * record.max_deformation(run.result) for run in (record.pair.fem, record.pair.wave))
    return [
        (
            name,
            layer.name,
            MM * layer.thickness if np.isfinite(layer.thickness) else None,
            layer.youngs_modulus / 1e3,
            layer.poisson_ratio,
            float(fem[place]),
            float(wave[place]),
            float(errors[place]),
        )
        for place, layer in enumerate(record.scenario.tissue.layers)
    ]


def profile(record: RunRecord) -> Columns:
    """Deflection of each layer's top face over the radius at peak load, layer after layer."""
    layers = len(record.layers)
    radii = next((result.profile_radii for result in record.results), np.empty(0))
    return {
        "layer": np.repeat(np.array(record.layers, dtype=object), radii.size),
        "r_mm": np.tile(MM * radii, layers),
        "fem_mm": MM * _profile(record.pair.fem.result, layers, radii).ravel(),
        "wave_mm": MM * _profile(record.pair.wave.result, layers, radii).ravel(),
    }


def _profile(result: ModelResult | None, layers: int, radii: Array) -> Array:
    """(L, m) m, NaN without a result."""
    return np.full((layers, radii.size), np.nan) if result is None else result.profile


def timing(pair: SideBySide) -> Columns:
    """One row a model and timed repeat; peak memory is that of the model's process, MB, one value for its rows."""
    rows = [
        (run.key, repeat, seconds.setup, seconds.wall, seconds.cpu, _megabytes(run.peak_memory))
        for run in (pair.fem, pair.wave)
        for repeat, seconds in enumerate(run.repeats, start=1)
    ]
    names = ("model", "repeat", "setup_s", "wall_s", "cpu_s", "peak_memory_mb")
    return {name: [row[column] for row in rows] for column, name in enumerate(names)}


def _megabytes(size: int | None) -> float:
    """MB of `size` bytes, NaN where the system does not tell it."""
    return np.nan if size is None else size / 1e6


def measured(comparison: MeasuredComparison) -> Columns:
    """Each trial's rows beside both models' forces at the measured depth."""
    trials = comparison.trials
    empty = [np.full(trial.time.size, np.nan) for trial in trials]
    wave = [blank if trial.wave_force is None else trial.wave_force for trial, blank in zip(trials, empty, strict=True)]
    return {
        "trial": [trial.trial for trial in trials for _ in trial.time],
        "condition": [trial.condition for trial in trials for _ in trial.time],
        "time_s": np.concatenate([trial.time for trial in trials]),
        "depth_mm": MM * np.concatenate([trial.depth for trial in trials]),
        "force_N": np.concatenate([trial.force for trial in trials]),
        "fem_force_N": np.concatenate([trial.fem_force for trial in trials]),
        "wave_force_N": np.concatenate(wave),
    }
