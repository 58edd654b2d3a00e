"""The verdict on time."""

import math

import numpy as np
import pytest

from benchmark.gate.gate_file import Timed, Timing
from benchmark.gate.timing import Judge, careful_noise

FRAME = Timed(name="frame", workload="wave_frame", scenario="press", references=("dense",))
FIT = Timed(name="fit", workload="fit", session="phantom", references=("calls",), margin=0.3)
BASE = {"frame": [0.70, 0.71, 0.69, 0.70], "fit": [3.0, 3.01, 2.99, 3.0]}


def judge(*, same_machine: bool = True, paired: bool = False) -> Judge:
    return Judge((FRAME, FIT), Timing(), paired=paired, same_machine=same_machine, seed=0)


def slower(by: float) -> dict[str, list[float]]:
    return {name: [value + math.log1p(by) for value in values] for name, values in BASE.items()}


@pytest.mark.parametrize(("by", "passed"), [(0.0, True), (-0.5, True), (0.11, True), (0.13, False), (0.25, False)])
def test_slower_than_the_margin_fails(by: float, passed: bool) -> None:
    frame, fit = judge().rows(slower(by), BASE)
    assert frame.passed is passed
    assert fit.passed is True
    assert frame.slowdown == pytest.approx(by, abs=1e-12)
    assert frame.baseline == pytest.approx(math.exp(0.70))
    assert frame.allowed == pytest.approx(1.12 * frame.baseline)
    assert frame.ci95[0] < frame.now < frame.ci95[1]


def test_a_quantity_may_have_its_own_margin() -> None:
    _, fit = judge().rows(slower(0.31), BASE)
    assert not fit.passed
    assert fit.allowed == pytest.approx(1.3 * fit.baseline)


def test_on_another_machine_only_a_large_slowdown_fails() -> None:
    other = judge(same_machine=False)
    assert all(row.passed for row in other.rows(slower(0.45), BASE))
    assert not any(row.passed for row in other.rows(slower(0.55), BASE))


@pytest.mark.parametrize(("by", "passed"), [(0.0, True), (0.045, True), (0.06, False), (0.1, False)])
def test_beside_another_revision_less_is_let_pass(by: float, passed: bool) -> None:
    assert judge(paired=True).rows(slower(by), BASE)[0].passed is passed


@pytest.mark.parametrize("scatter", [0.02, 0.03, 0.04])
def test_a_tenth_is_caught_and_nothing_is_not_at_the_scatter_of_shared_machines(scatter: float) -> None:
    """Simulated checks beside another revision, processes added until it is clear, ten at most."""
    generator, paired = np.random.default_rng(11), Judge((FRAME,), Timing(), paired=True, same_machine=True, seed=0)

    def verdict(slowdown: float) -> tuple[bool, int]:
        now, base = math.log1p(slowdown) + scatter * generator.normal(size=10), np.zeros(10)
        ends = (n for n in range(4, 10) if paired.clear({"frame": now[:n]}, {"frame": base[:n]}))
        rounds = next(ends, 10)
        return paired.rows({"frame": now[:rounds]}, {"frame": base[:rounds]})[0].passed, rounds

    unchanged, slow = [verdict(0.0) for _ in range(60)], [verdict(0.1) for _ in range(60)]
    assert sum(not passed for passed, _ in unchanged) <= 1
    assert sum(not passed for passed, _ in slow) >= 57
    assert np.mean([rounds for _, rounds in unchanged]) < 7.0


def test_few_processes_that_agree_by_chance_are_not_believed() -> None:
    assert careful_noise(0.0, 4) == pytest.approx(0.03 / math.sqrt(7.0), rel=0.01)
    assert careful_noise(math.nan, 1) == pytest.approx(0.03)
    assert careful_noise(0.02, 50) == pytest.approx(0.02, rel=0.1)


def test_measuring_may_end_only_where_all_is_far_below_the_limit() -> None:
    assert judge().clear(slower(0.05), BASE)
    assert not judge().clear({**BASE, "frame": slower(0.1)["frame"]}, BASE)
    assert not judge().clear({**BASE, "frame": slower(0.3)["frame"]}, BASE)


def test_a_clear_slowdown_ends_it_after_six_processes() -> None:
    longer, base = ({name: list(values[:1]) * 6 for name, values in each.items()} for each in (slower(0.3), BASE))
    assert judge().clear({**base, "frame": longer["frame"]}, base)
    near = {name: list(values[:1]) * 6 for name, values in slower(0.13).items()}
    assert not judge().clear({**base, "frame": near["frame"]}, base)


def test_the_row_of_the_document() -> None:
    row = judge().rows(slower(0.25), BASE)[0].to_dict()
    assert {"quantity", "baseline_ratio", "now_ratio", "ci95", "allowed", "passed"} <= set(row)
    assert row["slowdown_percent"] == pytest.approx(25.0)
    assert row["caught_19_of_20_percent"] > 12.0
