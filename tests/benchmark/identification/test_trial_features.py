"""Where a trial's force rises, what is noise, and what falls in a hold."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.identification import TrialData, required_depth
from benchmark.identification.trial_features import (
    contact_range,
    evidence_of,
    evidence_of_rise,
    find_start,
    largest_creep,
    largest_decay,
    sample_noise,
)
from benchmark.identification.trial_fit import fit_trial


@pytest.mark.parametrize("onset", [-4e-4, 0.0, 3e-4, 1e-3])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_the_true_onset_and_zero_lie_in_the_range(trial, onset, noise):
    made = trial(onset=onset, noise=noise)
    allowed = contact_range(made.depth, made.force)
    assert allowed.low < onset < allowed.high
    assert allowed.rest_low < 0.01 < allowed.rest_high


@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_of_a_ramp_from_the_touch_and_a_long_hold_the_ramp_is_not_taken_for_air(trial, noise):
    """One row in twenty were all of the ramp: half of the peak was the level in air, and no contact in the range."""
    made = trial(noise=noise)
    way = np.linspace(0.0, made.depth.max(), 15)
    depth = np.concatenate([way, np.full(285, way[-1])])
    force = made.curve(depth) + noise * made.force.max() * np.random.default_rng(4).normal(size=depth.size)
    allowed = contact_range(depth, force)
    assert allowed.low < 0.0 < allowed.high
    assert allowed.rest_low < 0.0 < allowed.rest_high
    held = replace(made, time=0.035 * np.arange(depth.size), depth=depth, force=force)
    assert find_start(held, allowed).stiffness == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_weights_that_are_put_on_within_one_row_leave_the_touch_free(trial, noise):
    """The first loaded row was taken for the touch: four weights on 20 kPa were fitted with 790 kPa."""
    made = trial(noise=noise)
    depth = np.repeat([0.0, *np.linspace(0.7, 1.0, 4)], 40) * made.depth.max()
    force = made.curve(depth) + noise * made.force.max() * np.random.default_rng(5).normal(size=depth.size)
    allowed = contact_range(depth, force)
    assert allowed.low < 0.0 < allowed.high
    weighed = replace(made, time=0.05 * np.arange(depth.size), depth=depth, force=force)
    found = find_start(weighed, allowed)
    assert found.stiffness == pytest.approx(1.0, rel=0.05)
    assert fit_trial(weighed).log_stiffness == pytest.approx(0.0, abs=0.01)


def test_quiet_data_bound_the_onset_tightly(trial):
    made = trial(onset=1e-3)
    assert contact_range(made.depth, made.force).high - 1e-3 < 3e-4


@pytest.mark.parametrize("drift", [-0.04, 0.02, 0.04, 0.1])
@pytest.mark.parametrize("noise", [0.0005, 0.005])
def test_a_sensor_that_drifts_in_the_air_does_not_end_the_range_before_the_contact(trial, drift, noise):
    """The force rises or falls by a share of its peak until contact, 1 mm below where the trial begins."""
    made = trial(onset=5e-4, noise=noise)
    before = made.depth[:41] < 5e-4
    touch = made.time[:41][before].max()
    drifted = replace(made, force=made.force + drift * made.force.max() * made.time / touch)
    allowed = contact_range(drifted.depth, drifted.force)
    assert allowed.low < 5e-4 < allowed.high


def test_required_depth_covers_every_allowed_onset(trial):
    made = trial()
    needed = required_depth(made.depth, made.force)
    assert needed == pytest.approx(made.depth.max() - contact_range(made.depth, made.force).low)
    assert needed < 1.25 * (made.depth.max() - made.depth.min())
    assert required_depth(np.zeros(30), np.zeros(30)) > 0.0


def test_start_is_near_the_truth(trial):
    made = trial(noise=0.005)
    start = find_start(made, contact_range(made.depth, made.force))
    assert start.stiffness == pytest.approx(1.7, rel=0.1)
    assert start.onset == pytest.approx(2e-4, abs=1.5e-4)


def test_sample_noise_sees_through_the_signal(trial):
    made = trial(noise=0.01, rows=2000)
    assert sample_noise(made.force) == pytest.approx(0.01 * (trial().force.max()), rel=0.1)


@pytest.mark.parametrize(("rho", "share"), [(0.0, 0.0), (0.9, 0.0), (0.98, 0.01)])
def test_noise_alone_is_no_evidence(ar1, rho, share):
    generator = np.random.default_rng(4)
    ramp = np.clip(np.linspace(0, 2, 160), 0, 1)
    found = np.array([evidence_of(ramp, ar1(generator, 160, rho)) for _ in range(300)])
    assert np.mean(found >= 5.0) <= share


@pytest.mark.parametrize("rho", [0.0, 0.9, 0.98, 0.999])
def test_a_walk_of_the_force_is_no_rise(ar1, rho):
    generator = np.random.default_rng(5)
    depth = np.linspace(0.0, 5e-3, 160)
    assert max(evidence_of_rise(depth, ar1(generator, 160, rho)) for _ in range(300)) < 5.0


def test_a_force_that_never_changes_is_no_contact():
    """A dead weight from the first row on: its creep was fitted with 6e-15 kPa."""
    depth = 1e-3 * (1.0 - np.exp(-np.linspace(0.0, 5.0, 400)))
    assert evidence_of(depth, np.full(400, 0.05)) == 0.0
    assert evidence_of_rise(depth, np.full(400, 0.05)) == 0.0


def test_one_count_of_a_coarse_sensor_is_no_rise():
    depth = np.linspace(0.0, 5e-3, 60)
    assert evidence_of_rise(depth, 0.01 * (np.arange(60) > 40)) < 5.0
    assert evidence_of_rise(depth, np.zeros(60)) == 0.0
    assert evidence_of_rise(depth, -1e3 * depth) == 0.0


def test_evidence_of_a_clear_slope_and_of_none():
    ramp = np.linspace(0, 1, 50)
    assert evidence_of(ramp, 2 * ramp + 1e-3 * np.sin(np.arange(50.0) ** 2)) > 100
    assert evidence_of(np.ones(50), ramp) == 0.0
    assert evidence_of(ramp, np.zeros(50)) == 0.0


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


def pressed_by_force(trial, depth, *, noise=0.0, seed=0):
    """A ramp in force of 2 s and a hold of 14 s, 16 s at 10 Hz; `depth` in m of the time in s since the ramp began."""
    made = trial()
    force = 2.0 * np.minimum(made.time / 2.0, 1.0)
    noisy = force + noise * np.random.default_rng(seed).normal(size=force.size)
    return TrialData("a", "b", made.time, depth(made.time), noisy, made.curve)


@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_a_depth_that_grows_under_a_held_force_is_a_creep(trial, noise):
    """5 mm at the end of the ramp, and 1.5 mm more with a time of 3 s: 30 %."""
    creep = pressed_by_force(
        trial, lambda t: np.where(t < 2.0, 2.5e-3 * t, 6.5e-3 - 1.5e-3 * np.exp(-(t - 2.0) / 3.0)), noise=noise
    )
    assert largest_creep(creep) == pytest.approx(29.0, abs=3.0)


def test_neither_a_steady_depth_nor_a_saturated_sensor_nor_a_slow_press_is_a_creep(trial):
    assert largest_creep(pressed_by_force(trial, lambda t: 2.5e-3 * np.minimum(t, 2.0), noise=0.02)) == 0.0
    assert largest_creep(pressed_by_force(trial, lambda t: 2.5e-3 * t)) == 0.0
    touch = 1.24e-3 - 0.19e-3 * np.exp(-np.linspace(0.0, 2.0, 90))  # a fifth of the force, ever slower
    slow = np.r_[np.zeros(20), touch, np.linspace(1.3e-3, 5e-3, 50)]
    assert largest_creep(TrialData("a", "b", trial().time, slow, 400.0 * slow, trial().curve)) == 0.0
    for seed in range(20):
        noise = 1e-4 * np.random.default_rng(seed).normal(size=trial().rows)
        assert largest_creep(pressed_by_force(trial, lambda t, n=noise: 2.5e-3 * np.minimum(t, 2.0) + n)) == 0.0
    made = trial()
    depth = 5e-3 * np.sqrt(np.linspace(0.0, 1.0, made.rows))  # ever slower, and the force with it
    for power in (1.0, 1.5, 2.0):
        assert largest_creep(TrialData("a", "b", made.time, depth, 3e3 * depth**power, made.curve)) == 0.0


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
