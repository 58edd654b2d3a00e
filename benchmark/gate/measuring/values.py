"""The gated values of a case: deflections in mm, forces in N, fitted parameters."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from benchmark.files import load_scenario
from benchmark.gate.measuring.models import model_of
from benchmark.models import ModelResult, scenario_drive

MM = 1e3
FAR = 2.0
"""Where the surface is gated besides the axis, in tool radii."""


@dataclass(frozen=True)
class Value:
    """A gated number: name within its case, value, unit, and why there is none where `value` is None."""

    name: str
    value: float | None
    unit: str
    reason: str | None = None

    def to_dict(self) -> dict[str, Any]:
        """As plain types."""
        return asdict(self)


class Silent:
    """A listener that tells nobody."""

    def say(self, text: str) -> None:
        """Say nothing."""

    @contextmanager
    def progress(self, title: str) -> Iterator[Callable[[str, int, int, str], None]]:
        """Yield an `advance` that does nothing."""
        del title
        yield lambda *_: None


def press_values(case: Mapping[str, Any]) -> list[Value]:
    """Largest deflection of each layer, the surface at two tool radii, and the peak force under depth control."""
    scenario = load_scenario(Path(case["scenario"]), case["set"])
    result = model_of(case, scenario).run(scenario_drive(scenario))
    reason = None if result.failure is None else f"stopped early at {result.failure}"
    values = [
        _value(f"max_deformation_mm.{layer}", MM * deflection, "mm", reason)
        for layer, deflection in zip(result.layers, result.max_deformation(), strict=True)
    ]
    if np.isfinite(result.profile).any():
        values.append(_value("surface_at_2_radii_mm", MM * _far(result, scenario.tool.radius), "mm", reason))
    if scenario.load.control == "depth":
        peak = float(result.force[result.peak_step]) if result.force.size else np.nan
        values.append(_value("peak_force_N", peak, "N", reason))
    return values


def _far(result: ModelResult, radius: float) -> float:
    return float(np.interp(FAR * radius, result.profile_radii, result.profile[0]))


def fit_values(case: Mapping[str, Any]) -> list[Value]:
    """Pooled stiffness factor, and the medians of contact onset and force zero over the trials of a session."""
    from benchmark.runs.session_run import fit_trials

    fit = fit_trials(Path(case["session"]), None, {}, Silent(), films=False).fit
    return [
        _value("stiffness_factor", fit.stiffness_factor, "", None),
        _value("contact_onset_mm", MM * float(np.median([trial.onset for trial in fit.trials])), "mm", None),
        _value("zero_N", float(np.median([trial.zero for trial in fit.trials])), "N", None),
    ]


def _value(name: str, value: float, unit: str, reason: str | None) -> Value:
    """A value; none where a run stopped early, since a part of a history is another problem."""
    if reason is None and not np.isfinite(value):
        reason = "it is not a finite number"
    return Value(name, None if reason else float(value), unit, reason)


CASES: Mapping[str, Callable[[Mapping[str, Any]], list[Value]]] = MappingProxyType(
    {"fem": press_values, "wave": press_values, "fit": fit_values}
)
"""How the values of a case are found, by its model."""
