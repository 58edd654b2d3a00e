"""Measured processes that answer, fail or die, and rounds until the answer is clear."""

import math
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Self

import pytest

from benchmark.errors import InputError, NotComparableError, SolverError
from benchmark.gate.plan import GatePlan, load_plan
from benchmark.gate.processes import Measured, Party, Side, measure
from benchmark.gate.versions import PRODUCT

OTHERS = ("fem", "wavemodel", "bench_hw", "reports")


@pytest.fixture
def older(tmp_path: Path) -> Path:
    """A tree of an older revision: without a gate, and with another deflection."""
    tree = tmp_path / "older"
    shutil.copytree(PRODUCT / "benchmark", tree / "benchmark", ignore=shutil.ignore_patterns("gate", "__pycache__"))
    for name in OTHERS:
        (tree / name).symlink_to(PRODUCT / name)
    with (tree / "benchmark" / "models" / "user_model.py").open("a") as stream:
        stream.write(
            "\nUserModel.run.__globals__['np'].outer = lambda a, b: 2.0 * a[:, None] * __import__('numpy').array(b)\n"
        )
    return tree


def value(side: Side, plan) -> float:
    return side.values(plan)[0]["value"]


def test_an_older_revision_is_measured_by_this_gate(tiny_gate, older: Path) -> None:
    plan = load_plan(tiny_gate(timed=True).path)
    with Side(PRODUCT) as now, Side(older, "v0") as before:
        assert value(now, plan) == pytest.approx(5.0)
        assert value(before, plan) == pytest.approx(10.0)
        for side in (now, before):
            side.prepare(plan)
            assert set(side.block()) == {"dense", "springs.history"}


def test_what_the_code_prints_does_not_disturb(tiny_gate) -> None:
    gate = tiny_gate()
    gate.change("my_model.py", "import numpy as np\n", "import os\nimport numpy as np\n")
    gate.change("my_model.py", "    return", "    print('hello')\n    os.write(1, b'raw')\n    return")
    with Side(PRODUCT) as side:
        assert value(side, load_plan(gate.path)) == pytest.approx(5.0)


def test_what_the_code_starts_finds_an_empty_stdin(tiny_gate) -> None:
    """It was the commands of the process: a solver that reads took them, and the check waited for ever."""
    gate = tiny_gate()
    gate.change("my_model.py", "import numpy as np\n", "import os, subprocess\nimport numpy as np\n")
    gate.change(
        "my_model.py", "    return", "    assert os.read(0, 1) == subprocess.check_output(['cat']) == b''\n    return"
    )
    plan = load_plan(gate.path)
    with Side(PRODUCT) as side:
        assert value(side, plan) == value(side, plan) == pytest.approx(5.0)


def test_a_model_that_asks_ends_with_an_error_of_its_own(tiny_gate) -> None:
    gate = tiny_gate()
    gate.change("my_model.py", "    return", "    input('go? ')\n    return")
    with Side(PRODUCT) as side, pytest.raises(InputError, match=r"my_model\.py, line 7: EOFError"):
        side.values(load_plan(gate.path))


def test_a_mistake_in_the_input_is_bad_input(tiny_gate) -> None:
    gate = tiny_gate()
    plan = load_plan(gate.path)
    gate.change("my_model.py", "return np.outer", "return np.oter")
    with Side(PRODUCT) as side, pytest.raises(InputError, match=r"my_model\.py, line 7"):
        side.values(plan)
    with Side(PRODUCT, "v0") as side, pytest.raises(NotComparableError, match="v0"):
        side.values(plan)


def test_a_process_that_dies_says_why(tiny_gate, tmp_path: Path) -> None:
    (tmp_path / "benchmark").mkdir()
    (tmp_path / "benchmark" / "__init__.py").write_text("raise SystemExit('no such library')\n")
    plan = load_plan(tiny_gate().path)
    with Side(tmp_path) as side, pytest.raises(SolverError, match="no such library"):
        side.values(plan)
    with Side(tmp_path, "v0") as side, pytest.raises(NotComparableError, match="no such library"):
        side.values(plan)


def test_a_tree_without_the_product_is_not_mistaken_for_this_one(tiny_gate, tmp_path: Path) -> None:
    plan = load_plan(tiny_gate().path)
    with Side(tmp_path / "nothing", "v0") as side, pytest.raises(NotComparableError, match="no package benchmark"):
        side.values(plan)


def test_leaving_ends_the_process(tiny_gate) -> None:
    with pytest.raises(RuntimeError), Side(PRODUCT) as side:
        raise RuntimeError
    assert side._process.poll() is not None


def test_the_package_is_cheap_to_import() -> None:
    code = "import sys, benchmark.gate; print(sorted({'numpy', 'scipy', 'pydantic'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


class Counter:
    """A side that takes `seconds` for its workload and writes down who was asked when."""

    def __init__(self, name: str, seconds: float, log: list[str], *, sees_waiting: bool = True):
        self.name, self.seconds, self.log, self.sees_waiting = name, seconds, log, sees_waiting

    def prepare(self, plan: GatePlan) -> bool:
        self.log.append(f"prepare {self.name}")
        return self.sees_waiting

    def block(self) -> dict[str, float]:
        self.log.append(self.name)
        return {"springs.history": self.seconds, "dense": 0.5}

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.log.append(f"end {self.name}")


@pytest.fixture
def plan(tiny_gate) -> GatePlan:
    gate = tiny_gate(timed=True)
    gate.change("gate.toml", "rounds = [1, 1]\nblocks = 2", "rounds = [2, 4]\nblocks = 3")
    return load_plan(gate.path)


def party(plan: GatePlan, name: str, seconds: float, log: list[str], **options: bool) -> Party:
    return Party(lambda: Counter(name, seconds, log, **options), plan)


def test_each_round_is_a_fresh_process_with_its_ratio(plan: GatePlan) -> None:
    log: list[str] = []
    told: list[tuple[int, int]] = []
    found = measure((party(plan, "A", 2.0, log),), lambda _: False, lambda *round_: told.append(round_))
    assert log == ["prepare A", "A", "A", "A", "end A"] * 4
    assert told == [(1, 4), (2, 4), (3, 4), (4, 4)]
    assert found.ratios[0]["springs.history"] == pytest.approx([math.log(4.0)] * 4)
    assert found.rounds == 4


def test_measuring_ends_where_it_is_clear_but_never_before_the_fewest(plan: GatePlan) -> None:
    asked: list[int] = []

    def clear(found: Measured) -> bool:
        asked.append(found.rounds)
        return found.rounds == 3

    assert measure((party(plan, "A", 2.0, []),), clear, lambda *_: None).rounds == 3
    assert asked == [2, 3]


def test_two_sides_take_turns_and_none_is_always_first(plan: GatePlan) -> None:
    log: list[str] = []
    parties = (party(plan, "A", 2.0, log), party(plan, "B", 1.0, log))
    found = measure(parties, lambda _: True, lambda *_: None)
    blocks = [each for each in log if len(each) == 1]
    assert "".join(blocks) == "ABBAAB" + "BAABBA"
    assert found.ratios[0]["springs.history"] == pytest.approx([math.log(4.0)] * 2)
    assert found.ratios[1]["springs.history"] == pytest.approx([math.log(2.0)] * 2)


def test_one_blind_side_makes_the_whole_blind(plan: GatePlan) -> None:
    parties = (party(plan, "A", 1.0, []), party(plan, "B", 1.0, [], sees_waiting=False))
    assert not measure(parties, lambda _: True, lambda *_: None).sees_waiting


def test_nothing_timed_starts_no_process(tiny_gate) -> None:
    log: list[str] = []
    found = measure((party(load_plan(tiny_gate().path), "A", 1.0, log),), lambda _: False, lambda *_: None)
    assert (log, found.rounds, found.ratios) == ([], 0, ({},))
