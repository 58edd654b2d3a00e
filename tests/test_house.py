"""A house one can live in: few rooms, modules that are one concept, short functions, names for one thing."""

import importlib.util
import tomllib
from pathlib import Path

import pytest

MOST_IN_A_ROOT = 8
MOST_IN_A_ROOM = 16
MOST_MODULES = 650
LONGEST_MODULE = 450
LONGEST_FUNCTION = 40
MOST_OF_ONE_NAME = 5
SMALL, MOST_SMALL = 60, 0.25
ANYWHERE = {"errors.py", "registry.py", "__main__.py"}


@pytest.fixture(scope="module")
def house():
    spec = importlib.util.spec_from_file_location("house", Path(__file__).with_name("house.py"))
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.measure()


def over(counts, most):
    return {name: count for name, count in counts.items() if count > most}


def test_roots_and_rooms_can_be_held_in_mind(house):
    roots = {package: house.root(package) for package in ("fem", "wavemodel", "bench_hw", "reports", "benchmark")}
    assert over(roots, MOST_IN_A_ROOT) == {}
    assert over(house.rooms, MOST_IN_A_ROOM) == {}


def test_modules_are_concepts(house):
    assert len(house.modules) <= MOST_MODULES
    assert over(house.modules, LONGEST_MODULE) == {}
    assert sum(lines <= SMALL for lines in house.modules.values()) <= MOST_SMALL * len(house.modules)


def test_functions_are_short(house):
    assert over(house.functions, LONGEST_FUNCTION) == {}


def test_one_name_is_one_thing(house):
    assert over({name: count for name, count in house.names.items() if name not in ANYWHERE}, MOST_OF_ONE_NAME) == {}


def test_the_wheel_holds_the_five_packages_alone():
    """The tests and benchmarks are no part of what is installed."""
    setuptools, root = pytest.importorskip("setuptools"), Path(__file__).parents[1]
    pyproject = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))
    include = pyproject["tool"]["setuptools"]["packages"]["find"]["include"]
    found = setuptools.find_namespace_packages(str(root), include=include)
    assert {name.partition(".")[0] for name in found} == {"benchmark", "fem", "wavemodel", "bench_hw", "reports"}
