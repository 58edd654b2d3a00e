"""Circles through markers, and the block they go through."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bench_hw.errors import InputError
from bench_hw.vision.displacement import fit_circles, inner_nine

GRID = np.stack(np.meshgrid(np.arange(6.0) - 2.5, np.arange(3.0) - 1.0), axis=-1).reshape(-1, 2) * 8e-3


@given(st.floats(-50, 50), st.floats(-50, 50), st.floats(0.1, 30), st.integers(3, 12))
def test_points_on_a_circle_give_that_circle(x, y, radius, count):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False) + 0.3
    points = np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)
    circles = fit_circles(np.stack([points, 2 * points]))
    assert np.allclose(circles.centre, [[x, y], [2 * x, 2 * y]], atol=1e-6)
    assert np.allclose(circles.radius, [radius, 2 * radius], rtol=1e-6)


def test_through_all_nine_the_circle_is_5_7_percent_smaller_than_through_the_ring():
    block = inner_nine(GRID, 3, 6)
    nine, ring = (fit_circles(GRID[None, markers]).radius[0] for markers in (block.nine, block.ring))
    assert ring == pytest.approx(np.sqrt(1.5) * 8e-3)
    assert nine / ring - 1 == pytest.approx(-0.057, abs=0.0003)


def test_a_missing_point_leaves_no_circle():
    points = np.random.default_rng(0).normal(size=(4, 9, 2))
    points[2, 5, 0] = np.nan
    assert np.isnan(fit_circles(points).radius).tolist() == [False, False, True, False]
    assert np.isnan(fit_circles(points).centre[2]).all()
    assert fit_circles(np.full((2, 9, 2), np.nan)).radius.shape == (2,)


def test_the_block_is_the_one_nearest_the_axis_and_ties_go_left():
    block = inner_nine(GRID, 3, 6)
    assert block.centre == 8
    assert block.nine.tolist() == [1, 2, 3, 7, 8, 9, 13, 14, 15]
    assert block.ring.tolist() == [1, 2, 3, 7, 9, 13, 14, 15]
    assert inner_nine(GRID - np.array([10e-3, 0]), 3, 6).centre == 10
    assert inner_nine(GRID, 3, 6, centre=9).nine[4] == 9


def test_what_is_no_block_is_refused():
    with pytest.raises(InputError, match=r"centre marker 6: allowed are .*\[7, 8, 9, 10\]"):
        inner_nine(GRID, 3, 6, centre=6)
    with pytest.raises(InputError, match="at least 3 x 3"):
        inner_nine(GRID, 2, 9)
    with pytest.raises(InputError, match="none of the inner markers"):
        inner_nine(np.full((18, 2), np.nan), 3, 6)
