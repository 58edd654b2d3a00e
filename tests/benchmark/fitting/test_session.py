import json
from dataclasses import replace

import numpy as np
import pytest

from benchmark.fitting import FittingError, fit_session, fit_trial
from benchmark.fitting.pooling import pool


def coverage(session, repeats, **options):
    """Share of seeded sessions whose 95 % interval holds the true factor 1.7."""
    generator = np.random.default_rng(20)
    found = [pool([fit_trial(trial) for trial in session(generator, **options)]) for _ in range(repeats)]
    return np.mean([each.ci95_low <= 1.7 <= each.ci95_high for each in found])


def test_exact_without_noise_and_scatter(trial, silicone):
    trials = [trial(str(n), zero=0.1 * n, onset=-1e-4 * n) for n in range(5)]
    fit = fit_session(trials, [silicone])
    assert fit.stiffness_factor == pytest.approx(1.7, rel=1e-6)
    assert fit.warnings == ()


@pytest.mark.parametrize(
    "options",
    [
        {"trials": 6, "scatter": 0.08, "noise": 0.01, "rho": 0.8},
        {"trials": 1, "scatter": 0.0, "noise": 0.01, "rho": 0.5},
        {"trials": 1, "scatter": 0.0, "noise": 0.01, "rho": 0.9},
    ],
)
def test_interval_covers_the_truth(session, options):
    assert 0.89 <= coverage(session, 100, **options) <= 1.0


@pytest.mark.slow
@pytest.mark.parametrize(
    "options",
    [
        {"trials": 10, "scatter": 0.08, "noise": 0.01, "rho": 0.8},
        {"trials": 10, "scatter": 0.5, "noise": 0.02, "rho": 0.95},
        {"trials": 5, "scatter": 0.02, "noise": 0.01, "rho": 0.0},
        {"trials": 1, "scatter": 0.0, "noise": 0.01, "rho": 0.0},
        {"trials": 1, "scatter": 0.0, "noise": 0.01, "rho": 0.8},
        {"trials": 1, "scatter": 0.0, "noise": 0.01, "rho": 0.95},
    ],
)
def test_interval_covers_the_truth_in_95_of_100_sessions(session, options):
    assert 0.925 <= coverage(session, 600, **options) <= 0.975


def test_order_of_trials_does_not_matter(session, silicone):
    trials = session(np.random.default_rng(2), 6)
    one, other = fit_session(trials, [silicone]), fit_session(trials[::-1], [silicone])
    assert other.stiffness == one.stiffness
    assert other.trials == one.trials[::-1]
    assert other.joint.value == pytest.approx(one.joint.value, rel=1e-5)


def test_trials_in_the_air_and_without_motion_are_left_out_and_named(session, silicone, ar1):
    trials = session(np.random.default_rng(3), 5)
    still = replace(trials[0], name="still", depth=np.zeros(160))
    air = replace(trials[0], name="air", force=0.01 * ar1(np.random.default_rng(0), 160, 0.5))
    fit = fit_session([still, *trials, air], [silicone])
    assert fit.stiffness == fit_session(trials, [silicone]).stiffness
    assert [each.name for each in fit.excluded] == ["still", "air"]
    assert any("trial still (slow)" in warning and "no motion" in warning for warning in fit.warnings)
    assert any("trial air (slow)" in warning for warning in fit.warnings)
    with pytest.raises(FittingError, match="no motion"):
        fit.trial("still", "slow")


def test_a_session_without_a_usable_trial_is_refused(trial, silicone):
    still = replace(trial(), depth=np.zeros(160))
    with pytest.raises(FittingError, match=r"none of 1 trials can be fitted.*no motion"):
        fit_session([still], [silicone])
    with pytest.raises(FittingError, match="at least one"):
        fit_session([], [silicone])


def test_a_name_may_repeat_in_another_condition_only(trial, silicone):
    assert len(fit_session([trial("a", "slow"), trial("a", "fast")], [silicone]).trials) == 2
    with pytest.raises(FittingError, match="2 trials are named a in condition slow"):
        fit_session([trial("a"), trial("a")], [silicone])


def test_a_trial_that_is_not_there_is_refused(trial, silicone):
    with pytest.raises(FittingError, match=r"trial b \(slow\) is not part"):
        fit_session([trial("a")], [silicone]).trial("b", "slow")


def test_document_is_plain_and_complete(session, fading_trial, silicone):
    trials = [*session(np.random.default_rng(4), 3), fading_trial(name="fading")]
    document = fit_session(trials, [silicone]).to_dict()
    assert json.loads(json.dumps(document, allow_nan=False)) == document
    assert document["schema"] == 1
    assert document["stiffness_factor"]["trials"] == 4
    assert [each["name"] for each in document["trials"]] == ["trial_000", "trial_001", "trial_002", "fading"]
    first = document["trials"][0]
    for key in ("stiffness_factor", "zero_N", "onset_mm", "residual_rms_N", "hold_decay_percent", "correlations"):
        assert key in first
    assert document["parameters"][0]["name"] == "stiffness_factor"
