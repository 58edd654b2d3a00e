"""A convex elastic curve, AR(1) noise, and the quick sessions of the discovery's tests for the tables of a set-up."""

import importlib.util
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from scipy.signal import lfilter

from benchmark.response import ForceCurve

_PATH = Path(__file__).parents[1] / "discovery" / "quick_session.py"


@pytest.fixture(scope="session")
def quick_session() -> ModuleType:
    spec = importlib.util.spec_from_file_location("response_quick_session", _PATH)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def curve() -> ForceCurve:
    depth = np.linspace(0.0, 9e-3, 31)[1:]
    return ForceCurve(depth, 300.0 * depth * (1.0 + (depth / 5e-3) ** 1.5))


@pytest.fixture
def ar1():
    """(rows,) stationary AR(1) noise of standard deviation 1."""

    def make(generator, rows, rho):
        white = generator.normal(size=rows + 200) * np.sqrt(1 - rho**2)
        return lfilter([1.0], [1.0, -rho], white)[200:]

    return make
