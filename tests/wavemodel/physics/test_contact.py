import numpy as np
import pytest
from scipy.integrate import solve_ivp

from wavemodel import WaveError
from wavemodel.physics.contact import Adhesion, DryFriction, PermanentSet
from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress

STICKY = Physics(adhesion=Adhesion(0.1))


def test_does_not_act_before_touch(press):
    np.testing.assert_array_equal(press(STICKY, np.array([-2e-3, -1e-4, -1e-5])), 0.0)


def test_pulls_until_it_lets_go_and_not_again_until_touch(press):
    depth = np.array([-1e-4, 1e-3, 0.0, -1e-4, -1.9e-4, -2.1e-4, -1e-4, 0.0, -1e-4])
    expected = 500.0 * np.where([0, 1, 1, 1, 1, 0, 0, 1, 1], depth, 0.0)
    np.testing.assert_allclose(press(STICKY, depth), expected, atol=1e-15)


def test_the_largest_pull_is_the_pull_off_force(press, path):
    found = press(STICKY, path(0.0, 3e-3, -1e-3, points=40001))
    assert found.min() == pytest.approx(-0.1, rel=1e-3)
    assert found.min() >= -0.1


def test_adhesion_is_off_at_zero(press, path):
    depth = path(0.0, 3e-3, -1e-3, 1e-3)
    np.testing.assert_array_equal(press(Physics(adhesion=Adhesion(0.0)), depth), np.maximum(500.0 * depth, 0.0))


def test_adhesion_refuses():
    with pytest.raises(WaveError, match="force = -1 N"):
        Adhesion(-1.0)


RUBBING = Physics(friction=DryFriction(0.2, 1e-4))


def test_builds_up_over_its_length(press):
    depth = np.linspace(0.0, 1e-3, 31)
    np.testing.assert_allclose(press(RUBBING, depth) - 500.0 * depth, 0.2 * (1 - np.exp(-depth / 1e-4)), atol=1e-14)


def test_does_not_depend_on_rate_or_on_the_steps(press, path):
    depth = path(0.0, 3e-3, 1e-3, 2e-3)
    slow, fast = (press(RUBBING, depth, speed) for speed in (1e-4, 1e-1))
    np.testing.assert_array_equal(slow, fast)
    corners = press(RUBBING, np.array([0.0, 3e-3, 1e-3, 2e-3]))
    np.testing.assert_allclose(corners[-1], slow[-1], rtol=1e-12)


def test_a_wide_cycle_loses_twice_the_friction_a_unit_of_depth(press, path):
    """Less what each turn costs: 2 F_c length (1 - e^(-swing / length)) at each of the two ends."""
    depth = path(0.0, 9e-3, 5e-3, 9e-3, points=20001)
    cycle = slice(np.argmax(depth), None)
    lost = np.trapezoid(press(RUBBING, depth)[cycle], depth[cycle])
    assert lost == pytest.approx(2 * 0.2 * 4e-3 - 4 * 0.2 * 1e-4, rel=1e-3)


def test_is_coulomb_s_as_the_length_goes_to_zero(press, path):
    depth = path(1e-3, 3e-3, 2e-3, points=101)
    found = press(Physics(friction=DryFriction(0.2, 1e-9)), depth) - 500.0 * depth
    np.testing.assert_allclose(found, 0.2 * np.sign(np.diff(depth, prepend=0.0)), atol=1e-12)


def test_may_grow_with_the_press(press):
    depth = np.linspace(0.0, 3e-3, 301)
    found = press(Physics(friction=DryFriction(0.0, 1e-9, 0.1)), depth)
    np.testing.assert_allclose(found, 1.1 * 500.0 * depth, rtol=1e-9)


def test_is_forgotten_when_the_tool_is_lifted(press, path):
    once = path(0.0, 2e-3)
    again = path(0.0, 3e-3, -1e-3, 0.0)
    found = press(RUBBING, np.concatenate([again, once]))[again.size :]
    np.testing.assert_allclose(found, press(RUBBING, once), atol=1e-13)


def test_off_without_force(press, path):
    depth = path(0.0, 3e-3, 1e-3)
    np.testing.assert_array_equal(press(Physics(friction=DryFriction(0.0, 1e-4)), depth), 500.0 * depth)


@pytest.mark.parametrize("wrong", [(-0.1, 1e-4), (0.1, 0.0), (0.1, 1e-4, -1.0)])
def test_friction_refuses(wrong):
    with pytest.raises(WaveError, match="dry friction"):
        DryFriction(*wrong)


LASTING = Physics(permanent_set=PermanentSet(0.1))


def test_the_first_loading_is_the_base_law(press):
    depth = np.linspace(0.0, 3e-3, 31)
    np.testing.assert_allclose(press(LASTING, depth), 500.0 * depth, rtol=1e-13)


def test_later_cycles_meet_the_surface_later(press, path):
    depth = path(0.0, 3e-3, 0.0, 3e-3, points=601)
    found, peak = press(LASTING, depth), int(np.argmax(depth >= 3e-3 - 1e-12))
    expected = 500.0 * np.maximum(depth - 0.3e-3, 0.0) * 3.0 / 2.7
    np.testing.assert_allclose(found[peak:], expected[peak:], atol=1e-13)
    assert found[-1] == pytest.approx(found[peak])


def test_the_surface_stays_where_it_was_left():
    trace = QuasiStaticPress(lambda d: 500.0 * d, LASTING).trace(
        np.arange(1.0, 5.0), np.array([2e-3, 4e-3, 1e-3, -1e-3])
    )
    np.testing.assert_allclose(trace.surface, [2e-3, 4e-3, 1e-3, 0.4e-3])
    np.testing.assert_array_equal(trace.touching, [True, True, True, False])


def test_depths_up_to_the_onset_leave_none(press, path):
    depth = path(0.0, 2e-3, 0.0)
    np.testing.assert_allclose(press(Physics(permanent_set=PermanentSet(0.2, 2e-3)), depth), 500.0 * depth, atol=1e-15)


def test_permanent_set_is_off_at_zero(press, path):
    depth = path(0.0, 3e-3, 0.0)
    np.testing.assert_array_equal(press(Physics(permanent_set=PermanentSet(0.0)), depth), 500.0 * depth)


DELAY = 2.0
LATE = Physics(permanent_set=PermanentSet(0.2, 0.5e-3, DELAY))


def sunk(time: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """The equation of a late set, step by step with an integrator that is not ours."""
    surface, stood, deepest = [0.0], 0.0, depth[0]
    for k in range(1, time.size):
        before, deepest = deepest, max(deepest, depth[k])
        step, first, last = time[k] - time[k - 1], *(0.2 * max(d - 0.5e-3, 0.0) for d in (before, deepest))

        def rate(t, s, step=step, first=first, last=last):
            return (first + (last - first) * t / step - s) / DELAY

        if depth[k] > 0.0:
            stood = solve_ivp(rate, (0.0, step), [stood], rtol=1e-10, atol=1e-16).y[0, -1]
        surface.append(stood)
    return np.array(surface)


def test_a_late_set_follows_its_equation(path):
    depth = path(-1e-3, 3e-3, -1e-3, 3e-3, 1e-3, points=61)
    time = 0.1 * np.arange(1, depth.size + 1)
    met = np.maximum(depth - sunk(time, depth), 0.0)
    found = QuasiStaticPress(lambda d: 500.0 * d, LATE).force(time, depth)
    np.testing.assert_allclose(found, 500.0 * met, atol=1e-10)


def test_a_late_set_lets_the_force_of_a_hold_fall_and_does_not_come_back():
    time, depth = np.array([0.0, 1e-6, 1.0, 4.0, 40.0, 41.0, 90.0, 90.001]), 1e-3 * np.array([0, 3, 3, 3, 3, -1, -1, 3])
    trace = QuasiStaticPress(lambda d: 500.0 * d, LATE).trace(time, depth)
    surface = 0.2 * 2.5e-3 * -np.expm1(-time[1:5] / DELAY)
    np.testing.assert_allclose(trace.force[1:5], 500.0 * (3e-3 - surface), rtol=1e-6)
    np.testing.assert_allclose(trace.surface[5:7], 0.5e-3, rtol=1e-6)
    assert trace.force[-1] == pytest.approx(500.0 * 2.5e-3, rel=1e-6)


def test_a_long_delay_leaves_no_set(press, path):
    depth = path(0.0, 3e-3, 0.0, 3e-3)
    found = press(Physics(permanent_set=PermanentSet(0.2, 0.0, 1e6)), depth)
    np.testing.assert_allclose(found, 500.0 * depth, atol=1e-5)


@pytest.mark.parametrize("wrong", [(1.0, 0.0), (-0.1, 0.0), (0.1, -1e-3), (0.1, 0.0, -1.0)])
def test_permanent_set_refuses(wrong):
    with pytest.raises(WaveError, match="permanent set"):
        PermanentSet(*wrong)
