"""Measured processes: which code they take from where, and how they end."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from benchmark.errors import InputError, NotComparableError, SolverError
from benchmark.gate.measurement import PRODUCT
from benchmark.gate.plan import load_plan
from benchmark.gate.side import Side

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
