import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.response import ForceCurve, ResponseError


def test_goes_through_its_points_and_the_unloaded_state(curve):
    assert curve(curve.depth) == pytest.approx(curve.force)
    assert (curve.depth[0], curve.force[0]) == (0.0, 0.0)


def test_no_force_in_the_air(curve):
    air = np.array([-1.0, -1e-6, 0.0])
    assert (curve(air) == 0.0).all()
    assert (curve.slope(air) == 0.0).all()


def test_slope_is_the_derivative(curve):
    depth, step = np.linspace(1e-4, 8e-3, 50), 1e-9
    assert curve.slope(depth) == pytest.approx((curve(depth + step) - curve(depth - step)) / (2 * step), rel=1e-5)


@pytest.mark.parametrize("power", [1.5, 2.5])
def test_error_falls_with_the_third_power_of_the_spacing(power):
    test_depth = np.linspace(2e-3, 8e-3, 200)
    errors = []
    for points in (10, 20, 40):
        depth = np.linspace(0, 1e-2, points + 1)
        errors.append(np.abs(ForceCurve(depth, depth**power)(test_depth) / test_depth**power - 1).max())
    rates = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert (rates > 2.5).all()
    assert errors[-1] < 3e-4


def test_a_straight_line_is_exact():
    line = ForceCurve(np.array([1e-3, 4e-3, 5e-3]), np.array([1.0, 4.0, 5.0]))
    assert line(np.array([2.5e-3, 5.04e-3])) == pytest.approx([2.5, 5.04])


def test_continued_by_one_percent_and_no_further(curve):
    end = curve.depth[-1]
    assert curve(np.array([1.01 * end])) > curve(np.array([end]))
    assert curve.slope(np.array([1.005 * end])) == pytest.approx(curve.slope(np.array([end])))
    with pytest.raises(ResponseError, match=r"9\.1 mm is beyond the force curve, which ends at 9 mm"):
        curve(np.array([9.1e-3]))


@given(st.lists(st.integers(0, 1000), min_size=4, max_size=12))
def test_never_falls_between_points(steps):
    force = 1e-3 * np.cumsum([*steps, 1])
    curve = ForceCurve(np.arange(1.0, len(force) + 1.0), force)
    assert (np.diff(curve(np.linspace(0.0, len(force), 500))) >= -1e-12 * force[-1]).all()


@pytest.mark.parametrize(
    ("depth", "force", "found"),
    [
        ([1.0, 2.0], [1.0], "shape"),
        ([1.0], [1.0], "at least 2 points"),
        ([1.0, np.nan], [1.0, 2.0], "finite"),
        ([1.0, 1.0], [1.0, 2.0], "depth must increase"),
        ([1.0, 2.0, 3.0], [1.0, 3.0, 2.0], "force must not fall"),
        ([1.0, 2.0], [0.0, 0.0], "resists"),
        ([-1.0, 2.0], [0.0, 1.0], "must start at 0 mm"),
        ([0.0, 2.0], [0.5, 1.0], "must start at 0 mm"),
    ],
)
def test_what_is_no_curve_is_refused(depth, force, found):
    with pytest.raises(ResponseError, match=found):
        ForceCurve(np.array(depth), np.array(force))
