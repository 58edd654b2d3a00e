"""The linear wave, nothing calibrated, against the linear finite elements: the bars of the wave, case by case."""

from dataclasses import replace

import pytest

from tests.performance.wave.linear import Case, Errors, cases, compare, row


@pytest.mark.slow
@pytest.mark.parametrize("case", tuple(cases()), ids=lambda case: str(case).replace(" | ", "-"))
def test_a_case_is_within_the_bars(case):
    found = compare(case)
    print(row(found))
    assert found.met


def test_a_pressure_is_judged_by_its_faces_and_a_rigid_tool_by_its_force():
    soft = Errors(Case("uniform_pressure", 1e-3, 3e-3, 0.45), 0.3, 1.0, 9.0)
    assert soft.met
    assert not replace(soft, maximum=0.31).met
    assert not replace(soft, profile=1.01).met
    hard = Errors(Case("rigid_bonded", 1e-3, 3e-3, 0.45), 9.0, 9.0, 0.5)
    assert hard.met
    assert not replace(hard, stiffness=0.51).met
    assert row(replace(hard, stiffness=0.51)) == "| rigid_bonded | 1 | 3 | 0.45 | 9.000 | 9.000 | 0.510 | NO |"
