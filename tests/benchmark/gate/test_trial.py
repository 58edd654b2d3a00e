"""The trial of the gate (tests/performance/gate_trial): its faults are real, and it counts right."""

import ast
import json
import time
import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest

from benchmark.gate.versions import PRODUCT
from tests.performance.gate_trial import __main__ as trial
from tests.performance.gate_trial.copies import GATE, Check, values_gate
from tests.performance.gate_trial.faults import HOWS, Fault, deflections, slowdowns
from tests.performance.gate_trial.summary import summary


@pytest.mark.parametrize("how", HOWS)
def test_faults_fit_the_product(tmp_path: Path, how: str) -> None:
    for fault in (*slowdowns(0.25, how), *deflections(1.01)):
        text = (PRODUCT / fault.module).read_text()
        copy = tmp_path / fault.module
        copy.parent.mkdir(parents=True, exist_ok=True)
        copy.write_text(text)
        fault.put_into(tmp_path)
        assert copy.read_text() == text + fault.code
        names = {node.name for node in ast.walk(ast.parse(text)) if isinstance(node, ast.ClassDef | ast.FunctionDef)}
        assert names.issuperset(_names(fault))


def _names(fault: Fault) -> set[str]:
    """The classes, methods and functions that a fault's last statements replace."""
    targets = [node.targets[0] for node in ast.parse(fault.code).body if isinstance(node, ast.Assign)]
    attributes = [node for node in targets if isinstance(node, ast.Attribute)]
    plain = {node.id for node in targets if isinstance(node, ast.Name) and not node.id.startswith("_")}
    return plain | {node.attr for node in attributes} | {node.value.id for node in attributes}


def test_the_gate_of_values_alone_times_nothing(tmp_path: Path) -> None:
    (tmp_path / GATE).parent.mkdir(parents=True)
    (tmp_path / GATE).write_text((PRODUCT / GATE).read_text())
    whole, values = (tomllib.loads(path.read_text()) for path in (PRODUCT / GATE, values_gate(tmp_path)))
    assert "timed" in whole
    assert "timed" not in values
    assert {key: values[key] for key in ("cases", "tolerances", "timing")} == {
        key: whole[key] for key in ("cases", "tolerances", "timing")
    }


def spin(seconds: float) -> None:
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass


@pytest.mark.parametrize("how", ["burn", "sleep"])
def test_a_slow_function_costs_a_quarter_more(how: str) -> None:
    fault = next(each for each in slowdowns(0.25, how) if each.name == "fit")
    space = {"fit_session": spin}
    exec(fault.code, space)
    wall, cpu = time.perf_counter(), time.process_time()
    space["fit_session"](0.04)
    assert time.perf_counter() - wall >= 0.049
    assert (time.process_time() - cpu >= 0.049) is (how == "burn")


def test_a_share_of_the_calls_is_made_twice_whatever_a_block_makes_of_them() -> None:
    fault = next(each for each in slowdowns(0.10, "repeat") if each.name == "wave.frame")
    calls: list[int] = []
    space = {"Surface": SimpleNamespace(frame=calls.append)}
    exec(fault.code, space)
    for number in range(4000):
        space["Surface"].frame(number % 20)
    repeats = [calls.count(place) / 200 - 1.0 for place in range(20)]
    assert repeats == pytest.approx([0.10] * 20, abs=0.011)


def row(copy: str, code: int, failed: tuple[str, ...] = (), now: float = 1.0) -> dict:
    timing = [
        {"quantity": name, "passed": name not in failed, "now_ratio": now, "baseline_ratio": 1.0, "allowed": 1.12}
        for name in ("fit", "wave.frame")
    ]
    document = {"timing": timing, "accuracy": [], "passed": code == 0, "rounds": 4, "warnings": []}
    return {
        "copy": copy,
        "code": code,
        "seconds": 20.0,
        "cpu_seconds": 10.0,
        "load": 3.0,
        "document": document if code in (0, 1) else None,
        "message": "",
    }


def test_alarms_and_catches_are_counted() -> None:
    rows = [
        row("unchanged", 0), row("unchanged", 1, ("fit",), 1.2), row("unchanged", 3),
        row("fit", 1, ("fit",)), row("fit", 0), row("fit", 1, ("wave.frame",)),
    ]  # fmt: skip
    lines = summary(rows)
    assert lines[0] == "unchanged: 1 false alarms in 3 checks, 1 ended with another exit code"
    assert lines[1] == "fit: caught in 1 of 3 checks"
    assert "fit in unchanged: mean +9.5 %, standard deviation 12.9 %, +0.0 % to +20.0 % (allowed 12 %)" in lines
    assert lines[-1] == (
        "a check took 20 s (median; 20 to 20 s) and 10 s of CPU (10 to 10 s) at a load average of 3.0 (3.0 to 3.0)"
    )
    assert summary([]) == []


def test_of_a_copy_with_several_faults_each_is_counted_by_itself() -> None:
    both = "wave.frame + fit"
    rows = [row(both, 1, ("fit",)), row(both, 1, ("fit", "wave.frame")), row(both, 0)]
    assert summary(rows)[:2] == ["wave.frame: caught in 1 of 3 checks", "fit: caught in 2 of 3 checks"]


def test_a_wrong_value_is_caught_where_no_time_has_its_name() -> None:
    assert summary([row("WaveModel layer 0 x 1.01", 1), row("WaveModel layer 0 x 1.01", 0)])[0].endswith(
        "1 of 2 checks"
    )


@pytest.fixture
def checked(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Trials whose checks only take down what they were made in."""
    made: list[str] = []

    def check(name: str, tree: Path, work: Path, *options: str) -> Check:
        assert (tree / GATE).is_file()
        made.append(name)
        if "--accept" in options:
            (work / trial.BASELINE).write_text("{}")
        return Check(**row(name, 0 if name == "unchanged" else 1))

    monkeypatch.setattr(trial, "run_check", check)
    return made


def test_a_trial_goes_on_where_it_was_stopped(tmp_path: Path, checked: list[str], capsys) -> None:
    log = tmp_path / "trial.jsonl"
    command = ["--together", "--only", "fit", "wave.frame", "--log", str(log), "--runs"]
    assert trial.main([*command, "1"]) == 0
    assert checked == ["accept", "unchanged", "wave.frame + fit"]
    log.write_text(log.read_text().splitlines(keepends=True)[0])
    checked.clear()
    assert trial.main([*command, "2"]) == 0
    assert checked == ["wave.frame + fit", "unchanged", "wave.frame + fit"]
    assert [json.loads(line)["copy"] for line in log.read_text().splitlines()] == ["unchanged", "wave.frame + fit"] * 2
    assert "0 false alarms in 2 checks" in capsys.readouterr().out


def test_faults_together_are_all_in_one_copy(tmp_path: Path, checked: list[str]) -> None:
    trial.main(["--together", "--runs", "1", "--log", str(tmp_path / "trial.jsonl")])
    tree = tmp_path / "trial.work" / "faulty-0"
    for fault in slowdowns(0.25, "work"):
        assert (tree / fault.module).read_text().endswith(fault.code)
