import numpy as np
import pytest

from benchmark.fitting import TrialData
from benchmark.fitting.holds import largest_decay


@pytest.mark.parametrize(("g", "tau"), [(0.5, 2.0), (0.3, 1.0)])
def test_decay_of_a_fading_force(fading_trial, g, tau):
    made = fading_trial(g=g, tau=tau)
    hold = largest_decay(made)
    peak = made.force.max() - 0.01
    expected = 100 * (1 - (made.force[-16:].mean() - 0.01) / peak)
    assert hold is not None
    assert hold.seen
    assert hold.decay_percent == pytest.approx(expected, abs=2.0)
    assert (hold.start, hold.end) == (pytest.approx(4.0, abs=0.11), pytest.approx(15.9))
    assert hold.depth == pytest.approx(5e-3, rel=1e-3)


@pytest.mark.parametrize("rho", [0.0, 0.8, 0.95])
def test_noise_in_a_hold_is_seldom_a_decay(trial, rho):
    seen = [largest_decay(trial(noise=0.01, rho=rho, seed=seed)).seen for seed in range(100)]
    assert np.mean(seen) <= 0.05


def test_a_triangle_has_no_hold(trial):
    made = trial()
    depth = 5e-3 * (1 - np.abs(np.linspace(-1, 1, 160)))
    assert largest_decay(TrialData("a", "b", made.time, depth, 1.0 * depth, made.curve)) is None


def test_a_hold_in_the_air_does_not_count(trial):
    made = trial()
    air = np.r_[np.zeros(60), np.linspace(0, 5e-3, 100)]
    assert largest_decay(TrialData("a", "b", made.time, air, 1e3 * air, made.curve)) is None


def test_a_force_that_grows_in_the_hold_has_not_fallen(trial):
    made = trial()
    depth = np.r_[np.linspace(0, 5e-3, 60), np.full(100, 5e-3)]
    force = np.r_[np.zeros(60), np.linspace(0, 2.0, 100)]
    hold = largest_decay(TrialData("a", "b", made.time, depth, force, made.curve))
    assert hold is not None
    assert hold.decay_percent < 0.0
    assert not hold.seen
