"""One point of a sweep: both models on its scenario, in whatever process, and its results by column name."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from benchmark.errors import TissuebenchError
from benchmark.files import Scenario, scenario_notes
from benchmark.models import Keeping, ModelResult, UncoveredError, prepare, scenario_drive
from benchmark.runs.output.unfinished import is_kept
from benchmark.side_by_side.parameter_bands import parameter_bands
from reports.manifest import remove_known

OK, FAILED = "ok", "failed"
MODELS = {"fem": "FEM", "wave": "wave model"}

_ONE_AT_A_TIME = threading.Lock()
"""A Dask worker may have several threads; the solvers of one process take turns."""
MM = 1e3
SECONDS, BAND = "seconds_s", "band_percent"


@dataclass(frozen=True)
class Task:
    """A point to compute: its number, from 1, its scenario, and a folder for what a long one has so far."""

    point: int
    scenario: Scenario
    keep: Path | None = None


@dataclass(frozen=True)
class PointResult:
    """What became of a point.

    Attributes
    ----------
    point : int
        From 1.
    status : str
        "ok" or "failed".
    reason : str or None
        Why it failed, one line.
    warnings : str or None
        What a reader must know of it, one line.
    values : mapping of str to float
        Results by column name.
    """

    point: int
    status: str
    reason: str | None = None
    warnings: str | None = None
    values: Mapping[str, float] = field(default_factory=dict)


def failed(point: int, reason: str) -> PointResult:
    """A point without results."""
    return PointResult(point, FAILED, " ".join(reason.split()))


def evaluate(task: Task) -> PointResult:
    """Run both models on a point, with one thread; whatever goes wrong is its reason."""
    from threadpoolctl import threadpool_limits

    with _ONE_AT_A_TIME, threadpool_limits(1):
        answers = {model: _ModelAnswer.of(model, task.scenario, task.keep) for model in MODELS}
        bands, unknown = _bands(task.scenario, answers["fem"].result)
    if task.keep is not None:
        remove_known(task.keep, is_kept)
    results = {model: answer.result for model, answer in answers.items()}
    faults = [answer.fault for answer in answers.values() if answer.fault]
    warnings = [*(warning for answer in answers.values() for warning in answer.warnings), *unknown]
    if all(result is None for result in results.values()) and not faults:
        faults = warnings
    warnings = [*scenario_notes(task.scenario), *warnings]
    return PointResult(
        point=task.point,
        status=FAILED if faults else OK,
        reason=_line(faults),
        warnings=_line(warnings),
        values=point_values(task.scenario, results, {model: answer.seconds for model, answer in answers.items()})
        | bands,
    )


def _bands(scenario: Scenario, fem: ModelResult | None) -> tuple[dict[str, float], list[str]]:
    """What stated uncertainties leave of each layer's deflection at peak load, %, and why that is not known.

    Columns `LAYER.fem_band_percent`, `LAYER.wave_band_percent`, and `LAYER.error_band_percent` of the wave against the
    FEM: by how much the upper end of the 95 % band is above the value. None without stated uncertainties.
    """
    if fem is None or not scenario.uncertainties:
        return {}, []
    try:
        bands = parameter_bands(scenario, scenario_drive(scenario))
    except TissuebenchError as error:
        return {}, [f"what uncertain parameters leave was not worked out: {error}"]
    if bands is None:
        return {}, []
    parts = {"fem": bands.fem, "wave": bands.wave, "error": bands.difference}
    values = {
        f"{layer}.{name}_{BAND}": 100.0 * float(bands.factor(deviation[fem.peak_step, place]) - 1.0)
        for name, deviation in parts.items()
        for place, layer in enumerate(fem.layers)
    }
    return {name: value for name, value in values.items() if math.isfinite(value)}, []


@dataclass(frozen=True)
class _ModelAnswer:
    """One model's part: its complete result, or its fault, or neither where it does not cover the scenario."""

    result: ModelResult | None = None
    fault: str = ""
    warnings: tuple[str, ...] = ()
    seconds: float = float("nan")

    @classmethod
    def of(cls, model: str, scenario: Scenario, keep: Path | None) -> _ModelAnswer:
        """Run one model."""
        name, said = MODELS[model], list[str]()
        keeping = None if keep is None else Keeping(keep, said.append)
        started = time.perf_counter()
        try:
            result = prepare(model, scenario, keeping=keeping).run(scenario_drive(scenario))
        except UncoveredError as error:
            return cls(warnings=(f"the {name} does not cover this scenario: {error}",))
        except TissuebenchError as error:
            return cls(fault=f"{name}: {error}")
        except Exception as error:
            return cls(fault=f"{name}: {type(error).__name__}: {error}")
        warnings = (*said, *(f"{name}: {warning}" for warning in result.warnings))
        if result.failure is not None:
            return cls(fault=f"{name} stopped early at {result.failure}", warnings=warnings)
        if result.resumed is not None:
            return cls(result, "", (*warnings, f"{name} {result.resumed}; its time is left out"))
        return cls(result, "", warnings, time.perf_counter() - started)


def _line(texts: list[str]) -> str | None:
    """Sentences as one line; None for none."""
    return " ".join("; ".join(texts).split()) or None


def headline(control: str) -> tuple[str, str]:
    """The quantity that a load under `control` leaves free, with its unit: what pictures show."""
    return ("depth", "mm") if control == "force" else ("force", "N")


def point_values(
    scenario: Scenario, results: Mapping[str, ModelResult | None], seconds: Mapping[str, float]
) -> dict[str, float]:
    """Columns of one point; a model without a result has none.

    For each model `m` of fem and wave: `m_depth_mm` and `m_force_N` at peak load, `LAYER.m_max_mm` (the largest
    deflection of each layer's top face on the tool axis, press positive), and `m_seconds_s` (set-up and run, no
    benchmark: other points may run beside it). With both models `error_percent`, the wave against the FEM in the
    depth (the force under depth control), and `LAYER.error_percent` in the layer's largest deflection.
    """
    values: dict[str, float] = {}
    for model in MODELS:
        result = results[model]
        if result is not None:
            values |= _of_model(model, result)
    quantity, unit = headline(scenario.load.control)
    prefixes = [(f"{{}}_{quantity}_{unit}", "")]
    prefixes += [(f"{layer}.{{}}_max_mm", f"{layer}.") for layer in scenario.tissue.layer_names]
    for pattern, prefix in prefixes:
        fem, wave = (values.get(pattern.format(model), math.nan) for model in MODELS)
        if math.isfinite(wave - fem) and fem != 0.0:
            values[f"{prefix}error_percent"] = 100.0 * (wave - fem) / fem
    values |= {f"{model}_{SECONDS}": seconds[model] for model in MODELS}
    return {name: value for name, value in values.items() if math.isfinite(value)}


def _of_model(model: str, result: ModelResult) -> dict[str, float]:
    peak = result.peak_step
    largest = MM * np.asarray(result.max_deformation())
    return {
        f"{model}_depth_mm": float(MM * result.depth[peak]),
        f"{model}_force_N": float(result.force[peak]),
        **{f"{layer}.{model}_max_mm": float(largest[place]) for place, layer in enumerate(result.layers)},
    }
