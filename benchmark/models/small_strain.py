"""The wave of small strain for a scenario whose wave took finite strain by itself."""

from __future__ import annotations

from collections.abc import Mapping

from benchmark.files import Scenario
from benchmark.models.prepare import prepare
from benchmark.models.result import Array, Drive
from benchmark.models.wave_layered import STRAINS


def in_small_strain(scenario: Scenario) -> Scenario:
    """The scenario with the wave of small strain."""
    return scenario.model_copy(update={"wave": scenario.wave.model_copy(update={"large_press": "linear"})})


def took_finite_strain(scenario: Scenario, notes: Mapping[str, str]) -> bool:
    """Whether `large_press = "auto"` gave a wave the layers' finite strain, as its notes say."""
    return scenario.wave.large_press == "auto" and STRAINS["corrected"] in notes.get("model", "")


def small_strain_deflection(scenario: Scenario, drive: Drive) -> Array:
    """(n, L) m: each layer's deflection on the axis by the wave of small strain."""
    return prepare("wave", in_small_strain(scenario)).run(drive).top_deflection
