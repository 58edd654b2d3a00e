"""The fitted and the fixed parameters of a specimen, their intervals, and whether the data can tell them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Protocol

from benchmark.fitting.pooling import PooledStiffness, mean_interval
from benchmark.fitting.trial_result import TrialFit

COLUMNS = ("name", "value", "unit", "ci95_low", "ci95_high", "identifiable", "source")


class LayerLike(Protocol):
    """What is read of a layer: SI, an endless thickness is infinite."""

    @property
    def name(self) -> str:
        """Name of the layer."""

    @property
    def thickness(self) -> float:
        """Thickness in m."""

    @property
    def youngs_modulus(self) -> float:
        """Young's modulus in Pa."""

    @property
    def poisson_ratio(self) -> float:
        """Poisson's ratio."""


@dataclass(frozen=True)
class FittedParameter:
    """One row of `fitted_parameters.csv`; the value is in `unit`, None where there is none."""

    name: str
    value: float | None
    unit: str
    ci95_low: float | None
    ci95_high: float | None
    identifiable: bool
    source: str

    def to_dict(self) -> dict[str, Any]:
        """Fields by name."""
        return asdict(self)


def parameter_columns(parameters: Sequence[FittedParameter]) -> dict[str, list[Any]]:
    """Columns of `fitted_parameters.csv`; `identifiable` as true or false."""
    rows = [parameter.to_dict() | {"identifiable": str(parameter.identifiable).lower()} for parameter in parameters]
    return {name: [row[name] for row in rows] for name in COLUMNS}


def fitted_parameters(
    pooled: PooledStiffness, trials: Sequence[TrialFit], layers: Sequence[LayerLike]
) -> tuple[FittedParameter, ...]:
    """Rows for the pooled stiffness, the layers of the specimen, and the trials' onsets and zeros."""
    count = "1 trial" if pooled.trials == 1 else f"{pooled.trials} trials"
    factor = FittedParameter(
        "stiffness_factor",
        pooled.value,
        "",
        pooled.ci95_low,
        pooled.ci95_high,
        True,
        f"fitted to force over depth of {count}; {pooled.method}",
    )
    rows = [factor]
    for layer in layers:
        rows += [_modulus(layer, pooled, len(layers)), *_fixed(layer)]
    bound = sum(trial.onset_at_bound for trial in trials)
    onset = _summary("contact_onset", "mm", [1e3 * t.onset for t in trials], 1e3 * trials[0].onset_stderr)
    zero = _summary("force_zero", "N", [t.zero for t in trials], trials[0].zero_stderr)
    if 2 * bound > len(trials):
        source = f"{onset.source}; {bound} of {len(trials)} lie at an end of the range the data allow"
        onset = replace(onset, identifiable=False, source=source)
    return (*rows, onset, zero)


def _modulus(layer: LayerLike, pooled: PooledStiffness, layers: int) -> FittedParameter:
    if layers == 1:
        given = "given tool, support, thickness and Poisson's ratio"
    else:
        given = "a force-depth curve gives one stiffness, not several: the ratios of the layers are the file's"
    kilopascal = 1e-3 * layer.youngs_modulus
    return FittedParameter(
        f"{layer.name}.youngs_modulus",
        pooled.value * kilopascal,
        "kPa",
        pooled.ci95_low * kilopascal,
        pooled.ci95_high * kilopascal,
        layers == 1,
        f"stiffness_factor x {kilopascal:.6g} kPa of the specimen; {given}",
    )


def _fixed(layer: LayerLike) -> list[FittedParameter]:
    source = "fixed at the specimen's value, not fitted"
    thickness = 1e3 * layer.thickness if math.isfinite(layer.thickness) else None
    endless = "" if thickness is not None else "; endless"
    return [
        FittedParameter(f"{layer.name}.poisson_ratio", layer.poisson_ratio, "", None, None, False, source),
        FittedParameter(f"{layer.name}.thickness", thickness, "mm", None, None, False, source + endless),
    ]


def _summary(name: str, unit: str, values: list[float], stderr: float) -> FittedParameter:
    """Mean over trials with its t interval; a single trial has 1.96 of its own standard errors."""
    if len(values) == 1:
        half, mean, source = 1.96 * stderr, values[0], "of the single trial, from its own residual"
    else:
        mean, half, _ = mean_interval(values)
        source = f"mean over {len(values)} trials of each trial's own value"
    return FittedParameter(name, mean, unit, mean - half, mean + half, True, source)
