"""One point: the results of both models under the names of the table, and every way to fail as a reason."""

import pickle
from pathlib import Path

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario
from benchmark.models import Keeping, StepProgress, UncoveredError, fem_steps, prepare, scenario_drive
from benchmark.sweeps import point as point_module
from benchmark.sweeps.point import FAILED, OK, Task, evaluate, failed

SMALL = {"fem.mesh": "coarse", "load.observations": "4", "load.peak": "0.5 N"}


@pytest.fixture
def scenario() -> Scenario:
    return load_scenario("skin-5N", SMALL)


def test_results_are_those_of_the_models(scenario: Scenario) -> None:
    row = evaluate(Task(7, scenario))
    assert (row.point, row.status, row.reason) == (7, OK, None)
    largest = {}
    for model in ("fem", "wave"):
        own = prepare(model, scenario).run(scenario_drive(scenario))
        largest[model] = 1e3 * own.max_deformation()
        for layer, value in zip(own.layers, largest[model], strict=True):
            assert row.values[f"{layer}.{model}_max_mm"] == pytest.approx(value, rel=1e-12)
        assert row.values[f"{model}_depth_mm"] == pytest.approx(1e3 * own.depth[1], rel=1e-12)
        assert row.values[f"{model}_force_N"] == pytest.approx(0.5)
        assert row.values[f"{model}_seconds_s"] > 0
    errors = 100 * (largest["wave"] / largest["fem"] - 1)
    for layer, error in zip(scenario.tissue.layer_names, errors, strict=True):
        assert row.values[f"{layer}.error_percent"] == pytest.approx(error)
    assert row.values["error_percent"] == pytest.approx(errors[0])
    assert not any("band" in name for name in row.values)


def test_under_depth_control_the_force_is_the_result() -> None:
    row = evaluate(Task(1, load_scenario("skin-5N", {**SMALL, "load.control": "depth", "load.peak": "0.3 mm"})))
    assert row.values["fem_depth_mm"] == pytest.approx(0.3)
    forces = [row.values[f"{model}_force_N"] for model in ("fem", "wave")]
    assert row.values["error_percent"] == pytest.approx(100 * (forces[1] / forces[0] - 1))


def test_a_point_says_that_it_rests_on_a_value_that_no_trial_determines(scenario: Scenario) -> None:
    key = f"{scenario.tissue.layer_names[0]}.youngs_modulus"
    tissue = scenario.tissue.model_copy(update={"not_determined": (key,)})
    row = evaluate(Task(1, scenario.model_copy(update={"tissue": tissue})))
    assert f"{key} is quoted but not determined" in (row.warnings or "")


def test_a_model_that_does_not_cover_the_point_leaves_its_columns_out() -> None:
    row = evaluate(Task(1, load_scenario("skin-5N", {**SMALL, "support.kind": "half_space"})))
    assert row.status == OK
    assert "wave model does not cover" in (row.warnings or "")
    assert "fem_depth_mm" in row.values
    assert not any("wave" in name or "error" in name for name in row.values)


def test_a_point_that_no_model_covers_is_failed(scenario: Scenario, monkeypatch) -> None:
    def declines(model: str, scenario: Scenario, **_: object) -> None:
        raise UncoveredError("it is beyond me")

    monkeypatch.setattr(point_module, "prepare", declines)
    row = evaluate(Task(1, scenario))
    assert row.status == FAILED
    assert "the FEM does not cover this scenario: it is beyond me" in (row.reason or "")
    assert row.values == {}


def test_a_solver_that_stops_early_fails_the_point_and_keeps_the_other_model() -> None:
    soft = {f"{layer}.youngs_modulus": "5 kPa" for layer in ("epidermis", "dermis", "subcutaneous_fat")}
    row = evaluate(
        Task(1, load_scenario("skin-5N", {**SMALL, **soft, "load.peak": "20 N", "wave.large_press": "linear"}))
    )
    assert row.status == FAILED
    assert "FEM stopped early at step" in (row.reason or "")
    assert "wave_depth_mm" in row.values
    assert "fem_depth_mm" not in row.values


@pytest.mark.parametrize("error", [InputError("window is too small"), ZeroDivisionError("no\nluck")])
def test_an_exception_is_a_reason_on_one_line(scenario: Scenario, monkeypatch, error: Exception) -> None:
    def broken(model: str, scenario: Scenario, **_: object) -> None:
        raise error

    monkeypatch.setattr(point_module, "prepare", broken)
    row = evaluate(Task(3, scenario))
    assert row.status == FAILED
    assert " ".join(str(error).split()) in (row.reason or "")
    assert "\n" not in (row.reason or "")
    assert ("ZeroDivisionError" in (row.reason or "")) == isinstance(error, ZeroDivisionError)


def test_values_are_finite_numbers(scenario: Scenario) -> None:
    values = evaluate(Task(1, scenario)).values
    assert all(type(value) is float and np.isfinite(value) for value in values.values())


def test_a_task_travels(scenario: Scenario) -> None:
    assert pickle.loads(pickle.dumps(Task(1, scenario))) == Task(1, scenario)


def test_failed_is_one_line() -> None:
    assert failed(2, "a\n  b").reason == "a b"


def test_a_long_point_goes_on_from_its_steps(scenario: Scenario, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(fem_steps, "LEAST_PAUSE", 0.0)
    monkeypatch.setattr(fem_steps, "SHARE", 1e9)
    keep = tmp_path / "point"

    def stop(progress: StepProgress) -> None:
        if progress.step == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        prepare("fem", scenario, keeping=Keeping(keep, print)).run(scenario_drive(scenario), stop)
    assert keep.is_dir()
    row, whole = evaluate(Task(1, scenario, keep)), evaluate(Task(1, scenario))
    assert row.status == OK
    assert "FEM resumed after step 3 of 4" in (row.warnings or "")
    assert row.values["fem_depth_mm"] == pytest.approx(whole.values["fem_depth_mm"], rel=1e-10)
    assert "fem_seconds_s" not in row.values
    assert "fem_seconds_s" in whole.values
    assert not keep.exists()


TWO_LAYERS = """
schema = 1
name = "two layers"
citation = "Made up for this test."
[[layers]]
name = "top"
thickness = "2 mm"
density = "1070 kg/m^3"
youngs_modulus = "100 kPa +/- 10 %"
poisson_ratio = 0.45
[[layers]]
name = "base"
thickness = "8 mm"
density = "1070 kg/m^3"
youngs_modulus = "50 kPa +/- 20 %"
poisson_ratio = 0.45
"""


def test_stated_uncertainties_leave_bands_which_a_varied_value_does_not_widen(tmp_path: Path) -> None:
    """All stresses 10 % up are the load 10 % down: in small strain so is every deflection."""
    (tmp_path / "t.toml").write_text(TWO_LAYERS)
    settings = {**SMALL, "tissue": str(tmp_path / "t.toml"), "load.peak": "0.02 N"}
    row = evaluate(Task(1, load_scenario("skin-5N", settings)))
    assert row.status == OK
    both = [row.values[f"top.{name}_band_percent"] for name in ("fem", "wave")]
    fixed = evaluate(Task(2, load_scenario("skin-5N", {**settings, "base.youngs_modulus": "50 kPa"})))
    of_top = fixed.values["top.fem_band_percent"]
    assert 0.0 < of_top < min(both)
    sum_of_shares = np.sqrt(np.log1p(of_top / 100) ** 2 / (1.96 * 0.1) ** 2) + np.sqrt(
        np.log1p(both[0] / 100) ** 2 - np.log1p(of_top / 100) ** 2
    ) / (1.96 * 0.2)
    assert sum_of_shares == pytest.approx(1.0, rel=0.02)
    assert row.values["top.error_band_percent"] < 0.5 * min(both)
