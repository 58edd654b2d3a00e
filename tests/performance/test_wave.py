"""The wave against the finite elements: the linear one case by case, finite strain tissue by tissue, and their bars."""

from dataclasses import replace

import numpy as np
import pytest

from tests.performance.wave import linear, tissues

PRESSES = {press.name: press for press in tissues.shipped()}


@pytest.mark.slow
@pytest.mark.parametrize("case", tuple(linear.cases()), ids=lambda case: str(case).replace(" | ", "-"))
def test_a_case_is_within_the_bars(case):
    found = linear.compare(case)
    print(linear.row(found))
    assert found.met


def test_a_pressure_is_judged_by_its_faces_and_a_rigid_tool_by_its_force():
    soft = linear.Errors(linear.Case("uniform_pressure", 1e-3, 3e-3, 0.45), 0.3, 1.0, 9.0)
    assert soft.met
    assert not replace(soft, maximum=0.31).met
    assert not replace(soft, profile=1.01).met
    hard = linear.Errors(linear.Case("rigid_bonded", 1e-3, 3e-3, 0.45), 9.0, 9.0, 0.5)
    assert hard.met
    assert not replace(hard, stiffness=0.51).met
    assert linear.row(replace(hard, stiffness=0.51)) == "| rigid_bonded | 1 | 3 | 0.45 | 9.000 | 9.000 | 0.510 | NO |"


@pytest.mark.slow
@pytest.mark.parametrize("name", PRESSES)
def test_a_shipped_tissue_is_within_the_bars_at_every_load_step(name):
    found = tissues.compare(PRESSES[name])
    print(tissues.row(found))
    assert found.met


def made_up(depth, maximum, profile):
    press = next(iter(PRESSES.values()))
    return tissues.Comparison(press, np.array(depth), np.array(maximum), np.array(profile), ())


def test_only_steps_inside_the_range_count_and_each_of_them_does():
    good = made_up([0.1, 0.4, 0.41], [1.0, 2.0, 9.0], [5.0, 1.0, 9.0])
    assert good.met
    assert good.worst(inside=True) == (2.0, 5.0)
    assert good.worst(inside=False) == (9.0, 9.0)
    assert not replace(good, maximum=np.array([2.1, 0.0, 0.0])).met
    assert not replace(good, profile=np.array([5.1, 0.0, 0.0])).met
    assert not replace(good, depth=np.array([0.41, 0.5, 0.6])).met


def test_a_row_says_what_was_not_met_and_leaves_out_what_there_is_not():
    assert tissues.row(made_up([0.1], [2.5], [1.0])).endswith("| 0.10 | 2.50 | 1.00 | - | - | NO |")
