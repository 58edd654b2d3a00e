import numpy as np
import pytest

from benchmark.verification import wave_cases

CASES = wave_cases.cases()


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_is_within_what_is_allowed(case):
    for quantity in case.compute():
        assert quantity.passed, quantity


@pytest.mark.parametrize("load", [wave_cases.held, wave_cases.ramped])
def test_creep_obeys_its_equation(load):
    """Eta w' + w = c F."""
    time, h = np.array([0.1, 0.7, 2.0]), 1e-6
    force, w = load(time)
    rate = (load(time + h)[1] - load(time - h)[1]) / (2 * h)
    np.testing.assert_allclose(wave_cases.CREEP_TIME * rate + w, force, rtol=1e-8)
