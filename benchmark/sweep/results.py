"""The results of a point by column name: which there are, and what they are called."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from benchmark.files import Scenario
from benchmark.models import ModelResult

MM = 1e3
MODELS = ("fem", "wave")
SECONDS = "seconds_s"


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
