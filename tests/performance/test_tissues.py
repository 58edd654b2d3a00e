"""Finite strain, tissue by tissue, against the converged finite elements: the bars of the wave, each load step."""

from dataclasses import replace

import numpy as np
import pytest

from tests.performance.wave.tissues import Comparison, compare, row, shipped

PRESSES = {press.name: press for press in shipped()}


@pytest.mark.slow
@pytest.mark.parametrize("name", PRESSES)
def test_a_shipped_tissue_is_within_the_bars_at_every_load_step(name):
    found = compare(PRESSES[name])
    print(row(found))
    assert found.met


def made_up(depth, maximum, profile):
    press = next(iter(PRESSES.values()))
    return Comparison(press, np.array(depth), np.array(maximum), np.array(profile), ())


def test_only_steps_inside_the_range_count_and_each_of_them_does():
    good = made_up([0.1, 0.3, 0.31], [1.0, 2.0, 9.0], [5.0, 1.0, 9.0])
    assert good.met
    assert good.worst(inside=True) == (2.0, 5.0)
    assert good.worst(inside=False) == (9.0, 9.0)
    assert not replace(good, maximum=np.array([2.1, 0.0, 0.0])).met
    assert not replace(good, profile=np.array([5.1, 0.0, 0.0])).met
    assert not replace(good, depth=np.array([0.4, 0.5, 0.6])).met


def test_a_row_says_what_was_not_met_and_leaves_out_what_there_is_not():
    assert row(made_up([0.1], [2.5], [1.0])).endswith("| 0.10 | 2.50 | 1.00 | - | - | NO |")
