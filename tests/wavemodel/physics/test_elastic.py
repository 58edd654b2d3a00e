import numpy as np
import pytest
from scipy.special import erf

from wavemodel import WaveError
from wavemodel.physics.contact import Adhesion
from wavemodel.physics.elastic import Floor, InterfaceSlip, Pretension, StrainStiffening, StressSoftening
from wavemodel.physics.quasi_static_press import Physics

DEPTH = np.linspace(0.0, 4e-3, 41)


def test_is_its_polynomial(press):
    x = DEPTH / 8e-3
    found = press(Physics(stiffening=StrainStiffening(0.3, 2.0, 8e-3)), DEPTH)
    np.testing.assert_allclose(found, 500.0 * DEPTH * (1 + 0.3 * x + 2.0 * x**2), rtol=1e-13)


def test_grows_exponentially_where_its_exponent_is_given(press):
    x = DEPTH / 8e-3
    found = press(Physics(stiffening=StrainStiffening(0.3, 2.0, 8e-3, 4.0)), DEPTH)
    np.testing.assert_allclose(found, 500.0 * DEPTH * (1 + (0.3 * x + 2.0 * x**2) * np.exp(4.0 * x**2)), rtol=1e-13)


def test_stays_finite_however_steep():
    assert np.isfinite(StrainStiffening(0.3, 2.0, 1e-4, 1e4).factor(DEPTH)).all()


def test_off_without_coefficients(press):
    np.testing.assert_array_equal(press(Physics(stiffening=StrainStiffening()), DEPTH), 500.0 * DEPTH)


def test_the_way_back_is_the_way_there(press, path):
    depth = path(0.0, 3e-3, 0.0)
    found = press(Physics(stiffening=StrainStiffening(0.3, 2.0, 8e-3)), depth)
    np.testing.assert_allclose(np.trapezoid(found, depth), 0.0, atol=1e-12)


@pytest.mark.parametrize("wrong", [{"linear": -0.1}, {"quadratic": np.nan}, {"length": 0.0}, {"exponential": -1.0}])
def test_stiffening_refuses(wrong):
    with pytest.raises(WaveError, match="strain stiffening"):
        StrainStiffening(**wrong)


def test_adds_a_spring(press):
    np.testing.assert_allclose(press(Physics(pretension=Pretension(120.0)), DEPTH), 620.0 * DEPTH, rtol=1e-13)


def test_pretension_is_off_at_zero(press):
    np.testing.assert_array_equal(press(Physics(pretension=Pretension(0.0)), DEPTH), 500.0 * DEPTH)


def test_of_a_membrane_is_the_solution_of_its_equation():
    """T (r w')' = 0 between a and R: the slope at the tool carries the force, 2 pi a T w'(a) = F."""
    k = Pretension.of_membrane(30.0, 5e-3, 30e-3).stiffness
    r = np.geomspace(5e-3, 30e-3, 20001)
    w = np.log(30e-3 / r) / np.log(6.0)
    slope = (w[0] - w[1]) / (r[1] - r[0])
    assert k == pytest.approx(2 * np.pi * 5e-3 * 30.0 * slope, rel=1e-4)


def test_pulls_back_where_the_tool_is_held_but_not_in_air(press):
    depth = np.array([-1e-3, 1e-3, -1e-4])
    held = press(Physics(pretension=Pretension(100.0), adhesion=Adhesion(1.0)), depth)
    np.testing.assert_allclose(held, [0.0, 0.6, -0.06], rtol=1e-12)
    np.testing.assert_allclose(press(Physics(pretension=Pretension(100.0)), depth), [0.0, 0.6, 0.0], rtol=1e-12)


def test_pretension_refuses():
    with pytest.raises(WaveError, match="stiffness = -1 N/m"):
        Pretension(-1.0)
    with pytest.raises(WaveError, match="tool radius"):
        Pretension.of_membrane(30.0, 30e-3, 30e-3)


def test_stiffens_beyond_its_depth_only(press):
    found = press(Physics(floor=Floor(2e-3, 5e4)), DEPTH)
    np.testing.assert_allclose(found, 500.0 * DEPTH + 5e4 * np.maximum(DEPTH - 2e-3, 0.0), rtol=1e-13)


def test_off_without_stiffness(press):
    np.testing.assert_array_equal(press(Physics(floor=Floor(2e-3, 0.0)), DEPTH), 500.0 * DEPTH)


@pytest.mark.parametrize("wrong", [(-1e-3, 1.0), (1e-3, -1.0), (1e-3, np.inf)])
def test_floor_refuses(wrong):
    with pytest.raises(WaveError, match="floor"):
        Floor(*wrong)


def test_a_domed_floor_is_met_by_a_power(press) -> None:
    depth = np.array([0.0, 2e-3, 3e-3, 6e-3])
    found = press(Physics(floor=Floor(2e-3, 1e3, 1.5)), depth) - 500.0 * depth
    assert found == pytest.approx([0.0, 0.0, 1.0, 8.0])


SLIP = InterfaceSlip(limit=1.0, share=0.4)


def test_sticks_below_its_limit(press):
    depth = np.array([0.0, 5e-4, 1.9e-3, 1e-3, 0.0])
    np.testing.assert_allclose(press(Physics(slip=SLIP), depth), 500.0 * depth, rtol=1e-12, atol=1e-15)


def test_beyond_it_only_the_rest_of_the_stiffness_is_left(press):
    depth = np.linspace(0.0, 6e-3, 61)
    expected = np.where(depth <= 2e-3, 500.0 * depth, 0.6 * 500.0 * depth + 0.4)
    np.testing.assert_allclose(press(Physics(slip=SLIP), depth), expected, rtol=1e-12, atol=1e-15)


def test_a_wide_cycle_loses_what_the_slider_loses(press, path):
    """4 s F_s (swing - what sticks), the slider moving by half the cycle's way less the elastic part, both ways."""
    depth = path(0.0, 20e-3, 10e-3, 20e-3, points=4001)
    force = press(Physics(slip=SLIP), depth)
    cycle = slice(np.argmax(depth), None)
    lost = -np.trapezoid(force[cycle], depth[cycle])
    carried, spring = 0.4 * 1.0, 0.4 * 500.0
    assert -lost == pytest.approx(2.0 * carried * (10e-3 - 2.0 * carried / spring), rel=1e-6)


def test_does_not_depend_on_rate(press, path):
    depth = path(0.0, 6e-3, 1e-3, 4e-3, 0.0)
    np.testing.assert_array_equal(*(press(Physics(slip=SLIP), depth, speed) for speed in (1e-4, 1e-1)))


def test_off_without_a_share(press, path):
    depth = path(0.0, 6e-3, 0.0)
    np.testing.assert_allclose(press(Physics(slip=InterfaceSlip(1.0, 0.0)), depth), 500.0 * depth, atol=1e-15)


def test_from_shear_stress():
    assert InterfaceSlip.at_shear(2e3, 500.0, 0.3) == InterfaceSlip(4.0, 0.3)


@pytest.mark.parametrize("wrong", [(0.0, 0.5), (1.0, 1.1), (1.0, -0.1)])
def test_slip_refuses(wrong):
    with pytest.raises(WaveError, match="interface slip"):
        InterfaceSlip(*wrong)


SOFT = Physics(softening=StressSoftening(0.3, 0.6))


def test_the_first_loading_is_the_base_law(press):
    depth = np.linspace(0.0, 3e-3, 31)
    np.testing.assert_allclose(press(SOFT, depth), 500.0 * depth, rtol=1e-13)


def test_below_the_deepest_depth_it_is_the_law_of_ogden_and_roxburgh(press, path):
    depth = path(0.0, 3e-3, 0.0)
    found, back = press(SOFT, depth), slice(np.argmax(depth), None)
    ratio = (depth[back] / 3e-3) ** 2
    np.testing.assert_allclose(found[back], 500.0 * depth[back] * (1 - 0.3 * erf((1 - ratio) / 0.6)), atol=1e-13)


def test_loading_again_follows_the_way_back_and_then_the_base_law(press, path):
    depth = path(0.0, 3e-3, 0.0, 5e-3, points=801)
    found, top = press(SOFT, depth), int(np.argmax(depth >= 3e-3 - 1e-12))
    down = slice(top, np.argmin(np.where(np.arange(depth.size) > top, depth, 1.0)) + 1)
    up = slice(down.stop - 1, None)
    grid = np.linspace(1e-4, 2.9e-3, 20)
    there = np.interp(grid, depth[down][::-1], found[down][::-1])
    np.testing.assert_allclose(np.interp(grid, depth[up], found[up]), there, rtol=1e-2)
    beyond = depth[up] > 3.05e-3
    np.testing.assert_allclose(found[up][beyond], 500.0 * depth[up][beyond], rtol=1e-13)


def test_softening_is_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(softening=StressSoftening(0.0)), depth), 500.0 * depth)


@pytest.mark.parametrize("wrong", [(1.0, 0.5), (-0.1, 0.5), (0.3, 0.0)])
def test_softening_refuses(wrong):
    with pytest.raises(WaveError, match="stress softening"):
        StressSoftening(*wrong)
