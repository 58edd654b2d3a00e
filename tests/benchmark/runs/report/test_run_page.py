"""Agreement is claimed where the mean over the history and the peak both agree."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.cli.console import Console
from benchmark.files import load_scenario
from benchmark.runs.options import RunOptions
from benchmark.runs.output.document import results_document
from benchmark.runs.record import RunRecord, compare_layers
from benchmark.runs.report.run_page import run_page, run_verdict
from benchmark.runs.report.trials_section import _residual_row
from benchmark.runs.report.values import peak_errors
from benchmark.runs.scenario_run import run_scenario
from benchmark.runs.tables import run_tables
from benchmark.runs.validation import condition_columns, furthest_off, validation_columns
from reports import Verdict

QUICK = {"fem.mesh": "coarse", "load.observations": "20", "wave.large_press": "linear"}


@pytest.fixture(scope="module")
def finished(in_threads: None) -> RunRecord:
    """A quick run."""
    return run_scenario(load_scenario("skin-5N", QUICK), RunOptions(repeats=1), Console(quiet=True))


def _with_wave(record: RunRecord, factor: np.ndarray, beside: float = 1.0) -> RunRecord:
    """The record with a wave of `factor` (n,) times the FEM's deflections, and `beside` times its profile."""
    fem, wave = record.pair.fem.result, record.pair.wave.result
    assert fem is not None
    assert wave is not None
    made = replace(wave, top_deflection=fem.top_deflection * factor[:, None], profile=beside * fem.profile)
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


@pytest.mark.parametrize(("beside", "status"), [(1.03, "good"), (1.05, "finding"), (0.5, "finding")])
def test_a_profile_that_is_off_beside_right_maxima_is_not_called_good(finished: RunRecord, beside, status) -> None:
    """Half of the FEM's deflection everywhere but on the axis had a green verdict."""
    verdict = run_verdict(_with_wave(finished, np.full(20, 1.001), beside))
    assert verdict.status == status
    assert ("beside the axis the wave model's profile is off by up to" in verdict.headline) == (status != "good")


def test_models_within_the_margin_in_every_step_are_good_however_few_the_steps(finished: RunRecord) -> None:
    """Of 20 steps the two one-sided tests do not show 1.9 %."""
    record = _with_wave(finished, np.full(20, 1.019))
    assert not any(each.statistics.equivalence.equivalent for each in record.judged)
    assert run_verdict(record).status == "good"


def _measured(forces: dict[str, tuple[float, ...]], factor: float) -> SimpleNamespace:
    """Trials with peak forces (N) by condition, beside models with `factor` times the mean of all."""
    made = [(name, force) for name, each in forces.items() for force in each]
    told = factor * float(np.mean([force for _, force in made]))
    same = {"time": np.arange(2.0), "fem_force": np.array([0.0, told]), "wave_force": None, "held_out_force": None}
    trials = tuple(SimpleNamespace(condition=name, force=np.array([0.0, force]), **same) for name, force in made)
    stiffness = SimpleNamespace(value=1.0, ci95_low=0.99, ci95_high=1.01, log_std=0.01, trials=len(trials))
    return SimpleNamespace(trials=trials, fit=SimpleNamespace(stiffness=stiffness))


def _verdict_beside(finished: RunRecord, forces: dict[str, tuple[float, ...]], factor: float = 1.0) -> Verdict:
    """The verdict of models that agree, beside trials."""
    record = replace(_with_wave(finished, np.full(20, 1.001)), measured=_measured(forces, factor))
    found = {"validation.csv": validation_columns(record, ()), "validation_conditions.csv": condition_columns(record)}
    return run_verdict(record, None, found)


@pytest.mark.parametrize(
    ("shallow", "deep", "status"),
    [((1.0, 1.01, 0.99), (1.0, 1.0, 1.01), "good"), ((0.9, 0.91, 0.89), (1.1, 1.11, 1.09), "finding")],
)
def test_models_that_agree_beside_trials_that_do_not_are_not_called_good(finished, shallow, deep, status) -> None:
    """One stiffness missed a condition by 15 %, six times its uncertainty, and the mean of all by none."""
    verdict = _verdict_beside(finished, {"shallow": shallow, "deep": deep})
    assert verdict.status == status
    assert ("the trials speak against both: the peak force of " in verdict.headline) == (status != "good")


FORCES = (1.0, 1.005, 0.995, 1.002, 0.998)


@pytest.mark.parametrize("names", ["aaaaa", "aaabb", "aaaab", "abcde"])
@pytest.mark.parametrize(("factor", "status"), [(1.0, "good"), (0.875, "finding")])
def test_what_conditions_are_called_does_not_decide_the_verdict(finished, names, factor, status) -> None:
    """Models 12.5 % off, 70 times their uncertainty, were good where all trials had one name or each its own."""
    forces = {name: tuple(f for n, f in zip(names, FORCES, strict=True) if n == name) for name in dict.fromkeys(names)}
    verdict = _verdict_beside(finished, forces, factor)
    assert verdict.status == status
    if status == "finding":
        assert "% off, and no replicate tells" in verdict.headline or "times its uncertainty" in verdict.headline


def test_a_miss_that_only_all_trials_together_show_surely_is_not_called_good(finished) -> None:
    """Scatter of 8 % hides 10 % in each of four pairs, not in their mean."""
    forces = dict.fromkeys("abcd", (0.92, 1.08))
    assert _verdict_beside(finished, forces, 1.0).status == "good"
    verdict = _verdict_beside(finished, forces, 0.9)
    assert "the trials speak against both: the peak force of all trials is -10.0 % off" in verdict.headline


def test_a_single_trial_of_a_condition_scatters_as_the_others_do(finished) -> None:
    forces = {"a": (0.95, 1.05, 1.0, 0.95, 1.05), "b": (0.95,)}
    assert _verdict_beside(finished, forces).status == "good"
    assert "the peak force of b is " in _verdict_beside(finished, forces | {"b": (0.8,)}).headline


def test_a_single_trial_tells_no_uncertainty_to_judge_by(finished) -> None:
    record = replace(finished, measured=_measured({"a": (1.0,)}, 0.99))
    columns = validation_columns(record, ())
    told = dict(zip(columns["measure"], columns["value"], strict=True))
    assert [told[name] for name in ("u_D", "u_val", "model error low", "model error high")] == [None] * 4
    assert told["E"] == pytest.approx(-0.01)
    assert told["not assessed"] == "u_num, u_D"
    assert condition_columns(record)["u_val_N"] == [None]
    assert _verdict_beside(finished, {"a": (1.0,)}, 0.99).status == "good"
    assert "no replicate tells how surely" in _verdict_beside(finished, {"a": (1.0,)}, 0.9).headline


def test_maxima_of_models_that_came_to_unlike_loads_are_those_of_the_steps_that_both_reached(finished) -> None:
    """A FEM that stopped at two thirds of the load had its maximum beside the wave's at the whole."""
    fem, wave = finished.pair.fem.result, finished.pair.wave.result
    cut = {name: getattr(fem, name)[:5] for name in ("time", "force", "depth", "top_deflection")}
    short = replace(finished, pair=replace(finished.pair, fem=replace(finished.pair.fem, result=replace(fem, **cut))))
    expected = np.abs(wave.top_deflection[:5]).max(axis=0)
    np.testing.assert_allclose(np.abs(short.max_deformation(wave)), expected)
    assert expected[0] < np.abs(wave.top_deflection).max()
    assert np.isnan(short.max_deformation(None)).all()


def test_a_model_that_is_off_throughout_is_told_by_layers(finished: RunRecord) -> None:
    verdict = run_verdict(_with_wave(finished, np.full(20, 1.1)))
    assert verdict.status == "finding"
    assert "is not shown in 3 of 3 layers" in verdict.headline


def test_single_steps_that_are_off_are_not_called_good(finished: RunRecord) -> None:
    """A model up to 16 % off on the way, in turns above and below, had a green verdict."""
    factor = np.where(np.arange(20) % 2, 1.03, 0.97)
    factor[np.abs(finished.load) >= 0.999 * np.abs(finished.load).max()] = 1.0
    verdict = run_verdict(_with_wave(finished, factor))
    assert verdict.status == "finding"
    assert "in single steps the wave model is off by up to" in verdict.headline


def test_what_is_not_compared_is_not_called_good(finished: RunRecord) -> None:
    """Layers whose mean is zero have no comparison, and a verdict of nothing was green."""
    verdict = run_verdict(replace(finished, comparisons=()))
    assert verdict.status == "finding"
    assert verdict.headline == "Equivalence is not tested: the layers are not compared, as the warnings say."
    two = compare_layers(finished.scenario, finished.load[:2], *(np.ones((2, 3)), np.ones((2, 3))))
    assert "fewer than three steps" in run_verdict(replace(finished, comparisons=two)).headline


def _by_depth(record: RunRecord, factor: float) -> RunRecord:
    """The record as a press by depth whose wave has `factor` times the FEM's force at the same deflections."""
    fem, wave = record.pair.fem.result, record.pair.wave.result
    assert fem is not None
    assert wave is not None
    same_faces = {"top_deflection": fem.top_deflection, "profile": fem.profile, "depth": fem.depth}
    made = replace(wave, **same_faces, force=factor * fem.force)
    pair = replace(record.pair, wave=replace(record.pair.wave, result=made))
    load = record.scenario.load.model_copy(update={"control": "depth", "peak": float(np.abs(fem.depth).max())})
    scenario = record.scenario.model_copy(update={"load": load})
    same = compare_layers(record.scenario, fem.depth, fem.top_deflection, fem.top_deflection)
    return replace(record, pair=pair, scenario=scenario, load=fem.depth, comparisons=same)


def test_a_press_by_depth_is_judged_by_its_force(finished: RunRecord) -> None:
    """Twice the force at a depth that both were told was called equivalent, with 0 % at peak load."""
    twice = _by_depth(finished, 2.0)
    verdict = run_verdict(twice)
    assert verdict.status == "finding"
    assert "is not shown in the force; the wave model is off by up to +100.0 % at peak load" in verdict.headline
    assert next(iter(peak_errors(twice))) == "force"
    assert results_document(twice)["force"]["equivalent"] is False
    rows = run_tables(twice)["statistics.csv"]
    at_peak = [
        value
        for layer, quantity, value in zip(rows["layer"], rows["quantity"], rows["value"], strict=True)
        if (layer, quantity) == ("force", "at peak %")
    ]
    assert at_peak == [pytest.approx(100.0)]
    assert run_verdict(_by_depth(finished, 1.001)).status == "good"
    assert "in force and maximum deformations" in run_verdict(_by_depth(finished, 1.001)).headline
    assert "force" not in results_document(finished)


def test_of_a_hold_the_largest_error_at_peak_load_is_told(finished: RunRecord) -> None:
    """The error at the hold's begin, 1.4 %, stood beside maxima of its end that were 3.4 % apart."""
    held = replace(_with_wave(finished, np.linspace(1.0, 1.05, 20)), load=np.minimum(np.arange(20.0), 10.0))
    assert peak_errors(held) == pytest.approx(dict.fromkeys(held.layers, 5.0 * 18 / 19))


@pytest.mark.usefixtures("undrawn")
def test_the_first_figures_of_a_press_by_depth_are_forces(finished: RunRecord) -> None:
    environment = {"processor": "x", "usable_cores": 1, "made": "now", "seed": 0, "packages": {"tissuebench": "0"}}
    load = finished.scenario.load.model_copy(update={"control": "depth", "peak": 2e-3})
    by_depth = replace(finished, scenario=finished.scenario.model_copy(update={"load": load}))
    asked = {way: run_page(one, environment, {}).key_figures[0] for way, one in (("F", finished), ("d", by_depth))}
    assert asked["F"].unit == "mm"
    assert (asked["d"].unit, asked["d"].value) == ("N", pytest.approx(5.0))
    assert asked["d"].note.startswith("largest force, at ")


def test_trials_judge_the_finite_elements_alone() -> None:
    """A wave that is off speaks against itself, not against both."""
    columns = {
        "protocol": ["prediction"] * 2, "simulation": ["fem", "wave"], "condition": ["a"] * 2, "trials": [3, 3],
        "D_N": [1.0, 1.0], "E_N": [0.0, 0.5], "u_D_N": [0.01, 0.01], "u_val_N": [0.01, 0.01],
    }  # fmt: skip
    assert furthest_off(columns, 0.02) is None
    assert furthest_off({**columns, "simulation": ["wave", "fem"]}, 0.02) == ("a", 0.5, 50.0)


def test_a_model_is_compared_at_the_peak_though_it_has_no_force_elsewhere(finished) -> None:
    measured = _measured({"a": (1.0, 1.0)}, 1.0)
    for trial in measured.trials:
        trial.fem_force = np.array([np.nan, 1.1])
    columns = validation_columns(replace(finished, measured=measured), ())
    assert dict(zip(columns["measure"], columns["value"], strict=True))["E"] == pytest.approx(0.1)


def test_residuals_are_shares_of_the_peak_that_is_not_the_noise() -> None:
    time = np.arange(200) / 20.0
    force = 0.3 + np.random.default_rng(1).normal(0.0, 5e-3, 200)
    models = {"fem_force": force, "wave_force": None, "held_out_force": None}
    row = _residual_row(SimpleNamespace(trial="t", condition="a", time=time, force=force, **models))
    assert row[2] == pytest.approx(0.3, abs=2e-3)
