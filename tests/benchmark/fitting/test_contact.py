import numpy as np
import pytest

from benchmark.fitting import required_depth
from benchmark.fitting.contact import contact_range, evidence_of, find_start, sample_noise


@pytest.mark.parametrize("onset", [-4e-4, 0.0, 3e-4, 1e-3])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_the_true_onset_and_zero_lie_in_the_range(trial, onset, noise):
    made = trial(onset=onset, noise=noise)
    allowed = contact_range(made.depth, made.force)
    assert allowed.low < onset < allowed.high
    assert allowed.rest_low < 0.01 < allowed.rest_high


def test_quiet_data_bound_the_onset_tightly(trial):
    made = trial(onset=1e-3)
    assert contact_range(made.depth, made.force).high - 1e-3 < 3e-4


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


def test_evidence_of_a_clear_slope_and_of_none():
    ramp = np.linspace(0, 1, 50)
    assert evidence_of(ramp, 2 * ramp + 1e-3 * np.sin(np.arange(50.0) ** 2)) > 100
    assert evidence_of(np.ones(50), ramp) == 0.0
    assert evidence_of(ramp, np.zeros(50)) == 0.0
