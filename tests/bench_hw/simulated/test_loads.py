"""Loads of devices that are simulated on their own."""

import numpy as np
import pytest

from bench_hw.simulated.loads import pressed_sheet, swinging


def test_the_press_swings_between_nothing_and_its_peak():
    force = swinging(2.0)(np.array([0.0, 1.0, 2.0, 3.0, 4.0]))
    assert force[:, 2] == pytest.approx([0.0, 1.0, 2.0, 1.0, 0.0], abs=1e-12)
    assert not force[:, :2].any()


def test_the_sheet_is_deepest_in_mid_swing():
    markers = pressed_sheet(2e-3)
    assert markers(0.0)[:, 2].max() == 0.0
    assert markers(2.0)[:, 2].max() > markers(1.0)[:, 2].max() > 0.0
