"""The verdict on time."""

import math

import pytest

from benchmark.gate.gate_file import Timed, Timing
from benchmark.gate.timing import Judge

FRAME = Timed(name="frame", workload="wave_frame", scenario="press", references=("dense",))
FIT = Timed(name="fit", workload="fit", session="phantom", references=("calls",), margin=0.3)
BASE = {"frame": [0.70, 0.71, 0.69, 0.70], "fit": [3.0, 3.01, 2.99, 3.0]}


def judge(*, same_machine: bool = True) -> Judge:
    return Judge((FRAME, FIT), Timing(), paired=False, same_machine=same_machine, seed=0)


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
