"""The benchmarks are no part of what is installed."""

import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def test_the_wheel_holds_the_five_packages_alone():
    setuptools = pytest.importorskip("setuptools")
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    include = pyproject["tool"]["setuptools"]["packages"]["find"]["include"]
    found = setuptools.find_namespace_packages(str(ROOT), include=include)
    assert {name.partition(".")[0] for name in found} == {"benchmark", "fem", "wavemodel", "bench_hw", "reports"}
