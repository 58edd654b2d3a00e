"""The wave that a repair begins with: that of small strain, whatever finite strain the run gave it by itself."""

from __future__ import annotations

from dataclasses import replace

from benchmark.discovery.from_run.reading import FinishedRun
from benchmark.models import Drive, prepare


def at_small_strain(run: FinishedRun) -> FinishedRun:
    """Return the run with the small-strain wave at the same loads, where `large_press = "auto"` took finite strain.

    A wave whose large press was asked for, or that has effects of a model file, stays as it is.
    """
    chosen = run.scenario.wave
    if chosen.large_press != "auto" or run.large_press != "corrected" or run.effects:
        return run
    wave = chosen.model_copy(update={"large_press": "linear"})
    scenario = run.scenario.model_copy(update={"wave": wave})
    linear = prepare("wave", scenario).run(Drive("force", run.time, run.force))
    return replace(run, wave=linear.top_deflection, scenario=scenario, large_press="linear", restarted=True)
