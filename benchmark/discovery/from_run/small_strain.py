"""The wave that a repair begins with: that of small strain, whatever finite strain the run gave it by itself."""

from __future__ import annotations

from dataclasses import replace

from benchmark.discovery.from_run.reading import FinishedRun
from benchmark.models import Drive
from benchmark.models.small_strain import in_small_strain, small_strain_deflection


def at_small_strain(run: FinishedRun) -> FinishedRun:
    """Return the run with the small-strain wave at the same loads, where `large_press = "auto"` took finite strain.

    A wave whose large press was asked for, or that has effects of a model file, stays as it is.
    """
    if run.scenario.wave.large_press != "auto" or run.large_press != "corrected" or run.effects:
        return run
    wave = small_strain_deflection(run.scenario, Drive("force", run.time, run.force))
    return replace(run, wave=wave, scenario=in_small_strain(run.scenario), large_press="linear", restarted=True)
