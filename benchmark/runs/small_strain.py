"""What the wave of small strain would have said, where the run's wave took finite strain by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.files import Scenario
from benchmark.models import Drive, UncoveredError
from benchmark.models.prepare import small_strain_deflection, took_finite_strain
from benchmark.side_by_side import SideBySide

NOTE = "small strain"


def beside_small_strain(scenario: Scenario, pair: SideBySide, drive: Drive) -> SideBySide:
    """Return the pair with a note on how far the wave of small strain is off at peak load, layer by layer.

    Without one where small strain does not cover the tool, as under friction.
    """
    fem, wave = pair.fem.result, pair.wave.result
    if fem is None or wave is None or wave.model != "wave" or not took_finite_strain(scenario, wave):
        return pair
    peak = int(np.abs(drive.value).argmax())
    if peak >= len(fem.top_deflection):
        return pair
    try:
        linear = small_strain_deflection(scenario, drive)[peak]
    except UncoveredError:
        return pair
    expected = fem.top_deflection[peak]
    errors = 100.0 * (linear / expected - 1.0)
    told = ", ".join(f"{layer} {error:+.1f} %" for layer, error in zip(wave.layers, errors, strict=True))
    result = replace(wave, notes={**wave.notes, NOTE: f"the wave of small strain would be off by {told} at peak load"})
    return replace(pair, wave=replace(pair.wave, result=result))
