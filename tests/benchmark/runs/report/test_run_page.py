"""Agreement is claimed where the mean over the history and the peak both agree."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.cli.console import Console
from benchmark.files import load_scenario
from benchmark.runs.options import RunOptions
from benchmark.runs.record import RunRecord, compare_layers
from benchmark.runs.report.run_page import run_page, run_verdict
from benchmark.runs.scenario_run import run_scenario

QUICK = {"fem.mesh": "coarse", "load.observations": "20", "wave.large_press": "linear"}


@pytest.fixture(scope="module")
def finished(in_threads: None) -> RunRecord:
    """A quick run."""
    return run_scenario(load_scenario("skin-5N", QUICK), RunOptions(repeats=1), Console(quiet=True))


def _with_wave(record: RunRecord, factor: np.ndarray) -> RunRecord:
    """The record with a wave of `factor` (n,) times the FEM's deflections."""
    fem, wave = record.pair.fem.result, record.pair.wave.result
    assert fem is not None
    assert wave is not None
    made = replace(wave, top_deflection=fem.top_deflection * factor[:, None])
    pair = replace(record.pair, wave=replace(record.pair.wave, result=made))
    tops = (fem.top_deflection, made.top_deflection)
    return replace(record, pair=pair, comparisons=compare_layers(record.scenario, record.load, *tops))


def test_errors_that_cancel_over_a_cycle_are_not_called_good(finished: RunRecord) -> None:
    rows = np.arange(20)
    verdict = run_verdict(_with_wave(finished, np.where(rows < 10, 1.025, 0.975)))
    assert verdict.status == "finding"
    assert "on average over the load history" in verdict.headline
    assert "+2.5 %" in verdict.headline


def test_agreement_at_the_peak_too_is_good(finished: RunRecord) -> None:
    verdict = run_verdict(_with_wave(finished, 1.0 + 1e-3 * np.sin(np.arange(20.0))))
    assert verdict.status == "good"


def test_a_model_that_is_off_throughout_is_told_by_layers(finished: RunRecord) -> None:
    verdict = run_verdict(_with_wave(finished, np.full(20, 1.1)))
    assert verdict.status == "finding"
    assert "is not shown in 3 of 3 layers" in verdict.headline


@pytest.mark.usefixtures("undrawn")
def test_the_first_figures_of_a_press_by_depth_are_forces(finished: RunRecord) -> None:
    environment = {"processor": "x", "usable_cores": 1, "made": "now", "seed": 0, "packages": {"tissuebench": "0"}}
    load = finished.scenario.load.model_copy(update={"control": "depth", "peak": 2e-3})
    by_depth = replace(finished, scenario=finished.scenario.model_copy(update={"load": load}))
    asked = {way: run_page(one, environment, {}).key_figures[0] for way, one in (("F", finished), ("d", by_depth))}
    assert asked["F"].unit == "mm"
    assert (asked["d"].unit, asked["d"].value) == ("N", pytest.approx(5.0))
    assert asked["d"].note.startswith("largest force, at ")
