"""The simulated force sensor."""

import numpy as np
import pytest

from bench_hw.simulated.sensor import SensorModel


def read(model, force, elapsed=None, seed=1):
    force = np.atleast_2d(np.asarray(force, float))
    elapsed = np.zeros(len(force)) if elapsed is None else elapsed
    return model.wrench(force, elapsed, np.random.default_rng(seed))


QUIET = {"force_noise": 0.0, "torque_noise": 0.0}


@pytest.mark.parametrize(
    ("axis", "column", "sign"), [("-z", 2, -1), ("+z", 2, 1), ("+x", 0, 1), ("-x", 0, -1), ("+y", 1, 1), ("-y", 1, -1)]
)
def test_a_press_shows_on_its_axis(axis, column, sign):
    wrench = read(SensorModel(press_axis=axis, **QUIET), [0, 0, 2.0])[0]
    assert wrench[column] == sign * 2.0
    assert np.count_nonzero(wrench) == 1


def test_sideways_forces_are_torques_by_the_lever():
    wrench = read(SensorModel(lever=0.07, **QUIET), [0.5, 0.2, 0.0])[0]
    assert wrench[:2].tolist() == [0.5, 0.2]
    assert wrench[3:5] == pytest.approx([-0.07 * 0.2, 0.07 * 0.5])


def test_noise_has_its_stated_size():
    wrench = read(SensorModel(force_noise=2e-3, torque_noise=2e-5), np.zeros((20_000, 3)))
    assert wrench[:, :3].std() == pytest.approx(2e-3, rel=0.02)
    assert wrench[:, 3:].std() == pytest.approx(2e-5, rel=0.02)


def test_drift_creeps_on_the_press_axis():
    wrench = read(SensorModel(drift=0.01, **QUIET), np.zeros((2, 3)), np.array([0.0, 10.0]))
    assert (wrench[1] - wrench[0]).tolist() == pytest.approx([0, 0, -0.1, 0, 0, 0])


def test_beyond_its_range_it_stops_and_says_so():
    model = SensorModel(**QUIET)
    clipped, saturated = model.saturated(read(model, [[0, 0, 20.0], [0, 0, 50.0]]))
    assert clipped[:, 2].tolist() == [-20.0, -35.0]
    assert saturated.tolist() == [False, True]
