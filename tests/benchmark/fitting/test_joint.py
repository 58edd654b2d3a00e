import numpy as np
import pytest

from benchmark.fitting import fit_session, fit_trial
from benchmark.fitting.joint import fit_jointly
from benchmark.fitting.pooling import pool
from benchmark.fitting.trial_fit import prepare_rows


def jointly(trials):
    fits = [fit_trial(trial) for trial in trials]
    pooled = pool(fits)
    return fit_jointly([(*prepare_rows(trial)[:2], fit) for trial, fit in zip(trials, fits, strict=True)], pooled)


def test_same_as_the_pooled_value_where_trials_do_not_differ(trial):
    trials = [trial(str(n), zero=0.05 * n, onset=1e-4 * n, noise=0.003, seed=n) for n in range(4)]
    joint = jointly(trials)
    assert joint.value == pytest.approx(1.7, rel=0.01)


def test_without_noise_it_is_exact(trial):
    trials = [trial(str(n), zero=0.05 * n, onset=1e-4 * n) for n in range(3)]
    assert jointly(trials).value == pytest.approx(1.7, rel=1e-6)


def test_each_trial_counts_alike_whatever_its_rows(trial):
    few, many = trial("few", factor=1.0), trial("many", factor=2.0, rows=1600)
    joint = jointly([few, many]).value
    assert joint == pytest.approx(jointly([few, trial("many", factor=2.0)]).value, rel=0.01)
    assert 1.0 < joint < 2.0


def test_a_value_outside_the_interval_is_marked(session, silicone):
    fit = fit_session(session(np.random.default_rng(5), scatter=0.6), [silicone])
    assert fit.joint is not None
    inside = fit.stiffness.ci95_low <= fit.joint.value <= fit.stiffness.ci95_high
    assert fit.joint.differs is not inside


def test_fading_trials_keep_the_contact_of_their_loading(fading_trial):
    trials = [fading_trial(seed=n, name=str(n)) for n in range(3)]
    mean = np.mean([fit_trial(trial).stiffness for trial in trials])
    assert jointly(trials).value == pytest.approx(mean, rel=0.02)
