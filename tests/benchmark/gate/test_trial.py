"""The trial of the gate (benchmarks/gate_trial): its faults are real, and it counts right."""

import ast
import time
import tomllib
from pathlib import Path
from types import SimpleNamespace

import pytest

from benchmark.gate.measurement import PRODUCT
from benchmarks.gate_trial.copies import GATE, values_gate
from benchmarks.gate_trial.faults import HOWS, Fault, deflections, slowdowns
from benchmarks.gate_trial.summary import summary


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


def test_every_fourth_call_is_made_twice() -> None:
    fault = next(each for each in slowdowns(0.25, "repeat") if each.name == "wave.frame")
    calls: list[int] = []
    space = {"Surface": SimpleNamespace(frame=calls.append)}
    exec(fault.code, space)
    for number in range(8):
        space["Surface"].frame(number)
    assert calls == [0, 1, 2, 3, 3, 4, 5, 6, 7, 7]


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
    assert "largest +18.2 %" in lines[2]
    assert lines[-1] == "a check took 20 s (median), at most 20 s"
    assert summary([]) == []
