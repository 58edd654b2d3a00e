"""`validation.csv`: errors against their uncertainties (ASME V&V 20), and the area metric of measured trials."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.comparison import (
    Validation,
    area_metric,
    input_uncertainty,
    replicate_uncertainty,
)
from benchmark.models import Array
from benchmark.runs.record import RunRecord
from benchmark.runs.refinement import ORDER, Level, convergence
from benchmark.runs.trials.measured import MeasuredComparison, TrialPrediction, peak_weights
from benchmark.side_by_side import ModelRun

if TYPE_CHECKING:
    from fem import MeshError

Columns = dict[str, list[Any]]
Row = tuple[str, str, str, str, float | str | None, str]
NAMES = ("quantity", "protocol", "simulation", "measure", "value", "unit")
BY_CONDITION = (
    "condition", "protocol", "simulation", "trials", "D_N", "E_N", "u_num_N", "u_input_N", "u_D_N", "u_val_N",
)  # fmt: skip
LEVELS = (
    "model", "refined", "level", "unknowns", "load_steps", "setup_s", "wall_s", "cpu_s", "wall_per_step_ms", "layer",
    "max_mm",
)  # fmt: skip
OF_U_VAL = ("u_val", "model error low", "model error high")
MM = 1e3


def refinement_columns(levels: tuple[Level, ...]) -> Columns:
    """Columns of `refinement.csv`: one row a run and layer."""
    rows = [
        (
            each.model,
            each.refined,
            each.level,
            each.result.unknowns,
            each.result.time.size,
            each.seconds.setup,
            each.seconds.wall,
            each.seconds.cpu,
            1e3 * each.seconds.wall / each.result.time.size,
            layer,
            float(MM * each.result.max_deformation()[place]),
        )
        for each in levels
        for place, layer in enumerate(each.result.layers)
    ]
    return {name: [row[place] for row in rows] for place, name in enumerate(LEVELS)}


def mesh_error_entry(found: MeshError) -> dict[str, Any]:
    """The estimated discretisation error and the load at which it is told, in mm and N."""
    scale, unit = (1e3, "mm") if found.quantity == "depth" else (1.0, "N")
    load = {"load_N": found.load} if found.quantity == "depth" else {"load_mm": 1e3 * found.load}
    lengths = {"value": found.value, "half_as_many_elements": found.halved, "extrapolated": found.extrapolated}
    return {
        "quantity": found.quantity,
        "error_percent": found.percent,
        **{f"{name}_{unit}": scale * value for name, value in lengths.items()},
        "order": found.order,
        **load,
    }


def validation_columns(record: RunRecord, levels: tuple[Level, ...]) -> Columns | None:
    """Columns of `validation.csv`; None where there is neither a refinement nor a trial."""
    rows: list[Row] = []
    if levels:
        rows += list(_numerical(record, levels))
    if record.measured is not None:
        rows += list(_measured(record, record.measured, levels))
    return {name: [row[place] for row in rows] for place, name in enumerate(NAMES)} if rows else None


def numerical_uncertainty(levels: tuple[Level, ...], model: str, layer: int) -> float | None:
    """u_num (m) of a layer's largest deflection: every refinement of the model in squares; None without one."""
    found = [convergence(levels, model, refined, layer) for refined in ORDER]
    parts = [each.uncertainty for each in found if each is not None]
    return math.hypot(*parts) if parts else None


def _numerical(record: RunRecord, levels: tuple[Level, ...]) -> Iterator[Row]:
    """Each layer's maximum: what every refinement tells, and wave against FEM beside the numerical uncertainties."""
    runs = (record.pair.fem, record.pair.wave)
    for place, layer in enumerate(record.layers):
        quantity = f"maximum of {layer}"
        for run in runs:
            for refined in ORDER:
                found = convergence(levels, run.model, refined, place)
                if found is not None:
                    kind = "observed order" if found.observed else "assumed order"
                    yield quantity, "verification", run.key, f"{refined}: {kind}", found.order, ""
                    yield quantity, "verification", run.key, f"{refined}: extrapolated", MM * found.extrapolated, "mm"
                    yield quantity, "verification", run.key, f"{refined}: u_num", MM * found.uncertainty, "mm"
        own = [numerical_uncertainty(levels, run.model, place) for run in runs]
        fem, wave = (None if run.result is None else float(run.result.max_deformation()[place]) for run in runs)
        if fem is not None and wave is not None and all(each is not None for each in own):
            both = math.hypot(*(each or 0.0 for each in own))
            check = Validation(MM * wave, MM * fem, MM * both, None, None)
            yield from _told(quantity, "prediction, code to code", runs[1].key, check, "mm")


def _measured(record: RunRecord, measured: MeasuredComparison, levels: tuple[Level, ...]) -> Iterator[Row]:
    """Peak force of the trials: each model's against the measured, at the rows of the trial's own peak.

    Without an u_D, which needs a replicate, there is no u_val.
    """
    every = range(len(measured.trials))
    for protocol, run, data, model in _peaks(record, measured):
        found = _check(measured, run, levels, data, model, every)
        for row in _told("peak force", protocol, run.key, found, "N"):
            yield (*row[:4], None, row[5]) if found.measured is None and row[3] in OF_U_VAL else row
        for measure, _, _, value in area_metric(data, model).rows():
            yield "peak force", protocol, run.key, measure, value, "N"


def condition_columns(record: RunRecord) -> Columns | None:
    """Columns of `validation_conditions.csv`: one row a protocol, model and condition; None without trials."""
    measured, rows = record.measured, []
    if measured is None:
        return None
    names = list(dict.fromkeys(trial.condition for trial in measured.trials))
    for protocol, run, data, model in _peaks(record, measured):
        for name in names:
            at = [k for k, trial in enumerate(measured.trials) if trial.condition == name]
            found = _check(measured, run, record.levels, data, model, at)
            parts = (found.numerical, found.inputs, found.measured)
            whole = None if found.measured is None else found.uncertainty
            rows.append((name, protocol, run.key, len(at), found.data, found.error, *parts, whole))
    return {column: [row[place] for row in rows] for place, column in enumerate(BY_CONDITION)}


Miss = tuple[str, float, float | None]
"""Whose peak force is missed, E over D, and |E| over u_val; None where no replicate tells u_D."""
ALL = "all trials"


def furthest_off(
    conditions: Mapping[str, Sequence[Any]], least: float, whole: Mapping[str, Sequence[Any]] | None = None
) -> Miss | None:
    """What speaks most against the finite elements: a condition, or all trials, whatever conditions are called.

    Of `condition_columns` and, in `whole`, `validation_columns`, by the stiffness fitted to all trials or to the
    others: off by a share `least` of D and by more than two u_val, or by that share without an u_D; None where none is.
    """
    found = [
        (name, error / data, abs(error) / uncertainty if uncertainty else None)
        for name, data, error, uncertainty in _judged(conditions, whole)
        if abs(error) > max(least * abs(data), 2.0 * (uncertainty or 0.0))
    ]
    return max(found, key=lambda one: one[2] or 0.0, default=None)


def _judged(
    conditions: Mapping[str, Sequence[Any]], whole: Mapping[str, Sequence[Any]] | None
) -> Iterator[tuple[str, float, float, float | None]]:
    """Name, D, E and u_val (None without u_D) of the finite elements, by protocol, of each condition and of all."""
    names = ("protocol", "simulation", "condition", "trials", "D_N", "E_N", "u_D_N", "u_val_N")
    rows = [row for row in zip(*(conditions[name] for name in names), strict=True) if row[1] == "fem"]
    for protocol in dict.fromkeys(row[0] for row in rows):
        own = [row for row in rows if row[0] == protocol]
        for _, _, name, _, data, error, scatter, uncertainty in own:
            yield str(name), float(data), float(error), _known(scatter, uncertainty)
        if whole is not None and len(own) > 1:
            cells = zip(*(whole[name] for name in ("protocol", "simulation", "measure", "value")), strict=True)
            told = {measure: value for *key, measure, value in cells if key == [protocol, "fem"]}
            mean = sum(row[3] * row[4] for row in own) / sum(row[3] for row in own)
            yield ALL, mean, float(told["E"]), _known(told["u_D"], told["u_val"])


def _known(scatter: Any, uncertainty: Any) -> float | None:
    """u_val as it is in a table; None without u_D."""
    return None if scatter in (None, "") or uncertainty in (None, "") else float(uncertainty)


def _peaks(record: RunRecord, measured: MeasuredComparison) -> Iterator[tuple[str, ModelRun, Array, Array]]:
    """Protocol, model, and (R,) measured and simulated peak forces, N."""
    trials = measured.trials
    rules = [peak_weights(trial.time, trial.force) for trial in trials]
    data = np.array([rule @ trial.force for rule, trial in zip(rules, trials, strict=True)])
    for protocol, run, answers in _answers(record, trials):
        if any(each is None for each in answers):
            continue
        pairs = zip(rules, answers, strict=True)
        model = np.array([rule[rule != 0.0] @ each[rule != 0.0] for rule, each in pairs if each is not None])
        if np.isfinite(model).all():
            yield protocol, run, data, model


def _check(
    measured: MeasuredComparison, run: ModelRun, levels: tuple[Level, ...], data: Array, model: Array, of: Sequence[int]
) -> Validation:
    """Error and uncertainties of a model's mean peak force over some trials."""
    at = list(of)
    stiffness, force = measured.fit.stiffness, float(model[at].mean())
    freedom = stiffness.trials - 1 if stiffness.log_std is not None and stiffness.trials > 1 else None
    inputs = input_uncertainty(force / stiffness.value, (stiffness.ci95_low, stiffness.ci95_high), freedom)
    names, apart = np.array([trial.condition for trial in measured.trials]), data - model
    scatter = replicate_uncertainty(apart[at].tolist(), names[at].tolist())
    if scatter is None and (whole := replicate_uncertainty(apart.tolist(), names.tolist())) is not None:
        scatter = whole * math.sqrt(apart.size / len(at))  # a single trial of a condition scatters as the others do
    numerical = _relative_numerical(run, levels)
    return Validation(force, float(data[at].mean()), None if numerical is None else numerical * force, inputs, scatter)


def _relative_numerical(run: ModelRun, levels: tuple[Level, ...]) -> float | None:
    """u_num of a force as a fraction of it: that of the surface's largest deflection."""
    found = numerical_uncertainty(levels, run.model, 0)
    largest = 0.0 if run.result is None else abs(float(run.result.max_deformation()[0]))
    return None if found is None or largest == 0.0 else found / largest


def _answers(
    record: RunRecord, trials: tuple[TrialPrediction, ...]
) -> Iterator[tuple[str, ModelRun, list[Array | None]]]:
    """Protocol, model and forces of each: fitted to these trials (circular), and held out where it exists."""
    fem, wave = record.pair.fem, record.pair.wave
    yield "fitted to these trials (circular)", fem, [trial.fem_force for trial in trials]
    yield "prediction, stiffness of the other trials", fem, [trial.held_out_force for trial in trials]
    yield "fitted to these trials (circular)", wave, [trial.wave_force for trial in trials]


def _told(quantity: str, protocol: str, name: str, found: Validation, unit: str) -> Iterator[Row]:
    for measure, _, _, value in found.rows():
        yield quantity, protocol, name, measure, value, unit
    yield quantity, protocol, name, "not assessed", ", ".join(found.missing) or "none", ""
