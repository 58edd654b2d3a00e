"""Both models side by side in processes, and the speed-up of repeated timings."""

import numpy as np
import pytest

from benchmark.errors import InputError, SolverError
from benchmark.files import Scenario, load_scenario
from benchmark.models import Own, StepProgress, prepare, read_user_file, scenario_drive
from benchmark.side_by_side import ModelProcess, run_side_by_side
from benchmark.side_by_side.process import ended_by
from benchmark.side_by_side.runner import cores, median_interval, median_seconds, speedup
from benchmark.side_by_side.worker import Seconds


def repeats(*walls: float) -> list[Seconds]:
    return [Seconds(setup=0.5, wall=wall, cpu=0.9 * wall) for wall in walls]


def test_median_of_each_part() -> None:
    assert median_seconds(repeats(3.0, 1.0, 2.0)) == Seconds(0.5, 2.0, pytest.approx(1.8))


def test_ratio_is_taken_pair_by_pair() -> None:
    drifting = speedup(repeats(1.0, 2.0, 4.0), repeats(0.1, 0.2, 0.4))
    assert drifting.median == pytest.approx(10.0)
    assert drifting.ci95 == pytest.approx((10.0, 10.0))


def test_interval_spans_what_three_pairs_show() -> None:
    found = speedup(repeats(8.0, 10.0, 12.0), repeats(1.0, 1.0, 1.0))
    assert found.median == 10.0
    assert found.ci95 == (8.0, 12.0)
    assert found.repeats == 3
    assert found.coverage == 0.75  # all three on one side of the median: 2 of 8 ways


def test_interval_narrows_with_repeats() -> None:
    generator = np.random.default_rng(3)
    slow = repeats(*generator.normal(10.0, 1.0, 60))
    fast = repeats(*np.ones(60))
    found = speedup(slow, fast)
    assert 9.4 < found.ci95[0] < 10.0 < found.ci95[1] < 10.6


@pytest.mark.parametrize(
    ("n", "place", "coverage"), [(1, 1, 0.0), (5, 1, 0.9375), (6, 1, 0.96875), (9, 2, 0.9609375), (20, 6, 0.95861)]
)
def test_the_interval_of_the_median_has_the_tabled_places(n: int, place: int, coverage: float) -> None:
    low, high, share = median_interval([float(value) for value in range(n, 0, -1)])
    assert (low, high) == (place, n + 1 - place)
    assert share == pytest.approx(coverage, abs=1e-5)


def test_unequal_repeats_are_refused() -> None:
    with pytest.raises(ValueError, match="shorter"):
        speedup(repeats(1.0, 1.0), repeats(1.0))


SMALL = {"load.peak": "0.5 N", "load.observations": "4", "fem.mesh": "coarse"}


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("skin-5N", SMALL)


def test_processes_give_what_the_models_give(scenario: Scenario) -> None:
    seen: dict[str, list[StepProgress]] = {"fem": [], "wave": []}
    pair = run_side_by_side(
        scenario, repeats=3, every_field=False, on_progress=lambda model, step: seen[model].append(step)
    )
    for run in (pair.fem, pair.wave):
        own = prepare(run.model, scenario).run(scenario_drive(scenario))
        assert run.result is not None
        np.testing.assert_allclose(run.result.top_deflection, own.top_deflection, rtol=1e-9)
        assert len(run.repeats) == 3
        assert all(seconds.wall > 0.0 and seconds.setup > 0.0 for seconds in run.repeats)
    assert pair.fem.frame is None
    assert pair.wave.frame is not None
    assert 0.0 < pair.wave.frame < 0.1
    assert [step.step for step in seen["fem"]] == [1, 2, 3, 4]
    assert pair.speedup is not None
    assert pair.speedup.ci95[0] <= pair.speedup.median <= pair.speedup.ci95[1]


def test_of_a_fem_that_stops_early_the_wave_s_profile_is_that_of_its_last_step() -> None:
    """Profiles at 3.3 and 5 N had been compared: 38 % of the peak apart, 6 % at one load."""
    soft = {"subcutaneous_fat.youngs_modulus": "1 kPa", "dermis.youngs_modulus": "1 kPa", "fem.kinematics": "finite"}
    asked = {
        **SMALL,
        **soft,
        "wave.large_press": "linear",
        "epidermis.youngs_modulus": "1 kPa",
        "load.observations": "20",
        "load.peak": "0.2 N",
    }
    pair = run_side_by_side(
        load_scenario("skin-5N", asked), repeats=1, every_field=False, on_progress=lambda model, step: None
    )
    fem, wave = pair.fem.result, pair.wave.result
    assert fem is not None
    assert wave is not None
    assert fem.failure is not None
    assert 0 < fem.time.size < wave.time.size
    assert wave.peak_step == fem.peak_step
    np.testing.assert_allclose(wave.profile[:, 0], wave.top_deflection[fem.peak_step], rtol=2e-3)


def test_a_model_that_does_not_cover_the_scenario_declines(scenario: Scenario) -> None:
    half_space = load_scenario("skin-5N", {**SMALL, "support.kind": "half_space", "fem.kinematics": "linear"})
    pair = run_side_by_side(half_space, repeats=3, every_field=False, on_progress=lambda *_: None)
    assert pair.wave.result is None
    assert pair.wave.declined is not None
    assert "half_space" in pair.wave.declined
    assert pair.fem.result is not None
    assert len(pair.fem.repeats) == 3
    assert pair.speedup is None


def test_fields_are_kept_only_where_asked(scenario: Scenario) -> None:
    with ModelProcess("fem", scenario, every_field=True) as process:
        process.command(keep_result=True)
        answer = process.answer()
        process.command(keep_result=False)
        timing = process.answer()
    assert len(answer.result.fields) == 4
    assert timing.result is None


def test_a_fault_in_the_scenario_is_an_input_error(scenario: Scenario) -> None:
    narrow = scenario.model_copy(update={"wave": scenario.wave.model_copy(update={"window": 1e-3})})
    with ModelProcess("wave", narrow) as process:
        process.command(keep_result=True)
        with pytest.raises(InputError, match="window"):
            process.answer()


def test_a_dead_process_is_said_to_be_dead(scenario: Scenario) -> None:
    with ModelProcess("wave", scenario) as process:
        process._process.kill()
        with pytest.raises(SolverError, match="ended unexpectedly"):
            process.receive()


@pytest.mark.parametrize(
    ("code", "words"),
    [(0, "exit code 0"), (-11, "exit code -11, SIGSEGV"), (-9, "exit code -9, SIGKILL; usually memory ran out")],
)
def test_how_a_process_ended_is_said_in_words(code: int, words: str) -> None:
    assert ended_by(code) == words


UNSEEDED = """
import numpy as np
def deform(layers, tool, support, time, force):
    return np.outer(force, np.ones(len(layers))) * (1e-4 + SIZE * np.random.default_rng().random())
"""


@pytest.mark.parametrize(("size", "count"), [("1e-5", 1), ("1e-12", 0)])
def test_a_model_that_answers_differently_each_time_is_told_of(scenario, tmp_path, size: str, count: int) -> None:
    path = tmp_path / "mine.py"
    path.write_text(UNSEEDED.replace("SIZE", size))
    own = Own(wave=read_user_file(path))
    pair = run_side_by_side(scenario, repeats=3, every_field=False, on_progress=lambda *_: None, own=own)
    assert sum("differently each time" in each for each in pair.wave.result.warnings) == count


def test_what_a_users_model_writes_past_python_is_not_on_stdout(scenario: Scenario, tmp_path, capfd) -> None:
    """It stood before the object of `--json`."""
    path = tmp_path / "loud.py"
    path.write_text("import os\nos.write(1, b'loud')\ndef deform(layers, tool, support, time, force):\n    pass\n")
    with ModelProcess("wave", scenario, own=read_user_file(path)) as process:
        process.command(keep_result=True)
        with pytest.raises(InputError):
            process.answer()
    assert capfd.readouterr() == ("", "loud")


def test_a_users_model_that_dies_is_named(scenario: Scenario, tmp_path) -> None:
    path = tmp_path / "mine.py"
    path.write_text("import os, signal\nos.kill(os.getpid(), signal.SIGSEGV)\n")
    with ModelProcess("wave", scenario, own=read_user_file(path)) as process:
        process.command(keep_result=True)
        with pytest.raises(SolverError, match=r"your model .*mine\.py ended unexpectedly \(exit code -11, SIGSEGV\)"):
            process.answer()


def test_no_core_is_chosen_where_there_are_too_few() -> None:
    assert cores(10_000) == [None] * 10_000


def test_set_up_counts_beside_the_load_history() -> None:
    slow = [Seconds(setup=1.0, wall=10.0, cpu=10.0)] * 3
    fast = [Seconds(setup=30.0, wall=1.0, cpu=1.0)] * 3
    found = speedup(slow, fast)
    assert found.median == pytest.approx(10.0)
    assert found.with_setup == pytest.approx(11.0 / 31.0)
    assert found.pays_from == 4  # 1 + 4 x 10 > 30 + 4 x 1, and 1 + 3 x 10 < 30 + 3 x 1
    assert speedup(fast, slow).pays_from is None
    assert speedup(slow, [Seconds(0.5, 1.0, 1.0)] * 3).pays_from == 1


def test_few_pairs_have_a_range_and_many_an_interval() -> None:
    assert speedup(repeats(8.0, 10.0, 12.0), repeats(1.0, 1.0, 1.0)).spread == "range"
    assert speedup(repeats(*[8.0] * 9), repeats(*[1.0] * 9)).spread == "95 %"
