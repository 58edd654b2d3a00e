import math

import numpy as np
import pytest
import scipy

from benchmark.identification import FittingError, fit_session, fit_trial
from benchmark.identification.pooling import fit_jointly, fold_between, mean_interval, pool, widened
from benchmark.identification.trial_fit import prepare_rows


def test_geometric_mean_and_t_interval_of_the_trials(trial):
    fits = [fit_trial(trial(str(n), factor=factor)) for n, factor in enumerate((1.0, 2.0, 4.0))]
    pooled = pool(fits)
    logs = np.log([1.0, 2.0, 4.0])
    half = scipy.stats.t.ppf(0.975, 2) * logs.std(ddof=1) / math.sqrt(3)
    assert pooled.value == pytest.approx(2.0, rel=1e-6)
    assert pooled.ci95_low == pytest.approx(2.0 * math.exp(-half), rel=1e-6)
    assert pooled.ci95_high == pytest.approx(2.0 * math.exp(half), rel=1e-6)
    assert pooled.log_std == pytest.approx(math.log(2.0), rel=1e-6)
    assert pooled.next_trial == (
        pytest.approx(2.0 * math.exp(-2 * half), rel=1e-6),
        pytest.approx(2.0 * math.exp(2 * half), rel=1e-6),
    )
    assert "trial as the unit" in pooled.method


def test_more_rows_do_not_narrow_the_interval(trial):
    factors = (1.5, 1.7, 1.9)
    few = pool([fit_trial(trial(str(n), factor=f, noise=0.01, rows=100)) for n, f in enumerate(factors)])
    many = pool([fit_trial(trial(str(n), factor=f, noise=0.01, rows=2000)) for n, f in enumerate(factors)])
    assert math.log(many.ci95_high / many.ci95_low) == pytest.approx(math.log(few.ci95_high / few.ci95_low), rel=0.2)


def test_a_single_trial_has_its_own_interval_and_says_so(trial):
    fit = fit_trial(trial(noise=0.01, rho=0.5))
    pooled = pool([fit])
    half = scipy.stats.t.ppf(0.975, max(fit.effective_rows - 3, 2.0)) * fit.log_stiffness_stderr
    assert pooled.ci95_high == pytest.approx(fit.stiffness * math.exp(half), rel=1e-9)
    assert pooled.log_std is None
    assert pooled.next_trial is None
    assert "single trial" in pooled.method


def test_autocorrelated_noise_widens_the_interval_of_a_single_trial(trial):
    def width(rho):
        found = [pool([fit_trial(trial(noise=0.01, rho=rho, seed=seed))]) for seed in range(20)]
        return np.median([math.log(each.ci95_high / each.ci95_low) for each in found])

    assert width(0.8) > 2 * width(0.0)


def test_mean_interval_by_hand():
    mean, half, std = mean_interval([1.0, 2.0, 3.0])
    assert (mean, std) == (2.0, 1.0)
    quantile = 0.95 / math.sqrt(2 * 0.975 * 0.025)  # of t with two degrees of freedom, in closed form
    assert half == pytest.approx(quantile / math.sqrt(3), rel=1e-10)


def test_nothing_to_pool():
    with pytest.raises(FittingError, match="no trial"):
        pool([])


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


def test_the_fold_between_conditions_is_told_beyond_chance_and_scatter():
    """The F test is SciPy's; within a quarter, in wide scatter and from single trials nothing is told."""
    random = np.random.default_rng(3)
    soft, stiff = 0.02 * random.standard_normal(5), math.log(3.0) + 0.02 * random.standard_normal(4)
    assert fold_between([soft, stiff]) == pytest.approx(math.exp(stiff.mean() - soft.mean()))
    assert scipy.stats.f_oneway(soft, stiff).pvalue < 1e-3
    assert fold_between([soft, 0.15 + soft]) is None
    assert fold_between([40.0 * soft, 40.0 * soft + 1.0]) is None
    assert fold_between([[0.0], [2.0]]) is None
    assert fold_between([soft]) is None


@pytest.mark.parametrize("factors", [(1.0,), (1.0, 1.1), (1.0, 1.1, 1.2)])
def test_further_causes_widen_an_interval_and_leave_the_value(trial, factors):
    fits = [fit_trial(trial(str(n), factor=factor, noise=0.01)) for n, factor in enumerate(factors)]
    pooled = pool(fits)
    same, wide = widened(pooled, {"thickness": 0.0}), widened(pooled, {"thickness": 0.03, "radius": 0.04})
    assert (same.ci95_low, same.ci95_high) == pytest.approx((pooled.ci95_low, pooled.ci95_high))
    assert wide.value == pooled.value
    for end in ("ci95_low", "ci95_high"):
        own, both = (abs(math.log(getattr(each, end) / pooled.value)) for each in (pooled, wide))
        assert both == pytest.approx(math.hypot(own, 1.96 * 0.05))
    assert "radius 4 %, thickness 3 %" in wide.method
    assert wide.next_trial is None
