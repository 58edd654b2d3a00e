"""Scatter parted between specimens and between their trials; against statsmodels' mixed model and known truth."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
import statsmodels.formula.api as smf

from benchmark.identification import TrialData
from benchmark.identification.parameters.mixed_effects import courses_left, spread_parts
from benchmark.response import ForceCurve


def drawn(between, within, counts, seed=0):
    generator = np.random.default_rng(seed)
    names = np.repeat([f"s{k}" for k in range(len(counts))], counts)
    shifts = np.repeat(between * generator.normal(size=len(counts)), counts)
    return shifts + within * generator.normal(size=names.size), list(names)


@pytest.mark.parametrize("counts", [[6] * 8, [2, 3, 6, 5, 4, 2, 7]])
def test_it_is_restricted_maximum_likelihood(counts) -> None:
    gains, names = drawn(0.3, 0.1, counts, seed=4)
    found = spread_parts(gains, names)
    model = smf.mixedlm("y ~ 1", pd.DataFrame({"y": gains, "s": names}), groups="s").fit(reml=True)
    assert found.within**2 == pytest.approx(model.scale, rel=0.02)
    assert found.between**2 == pytest.approx(float(model.cov_re.iloc[0, 0]), rel=0.04)


def test_intervals_hold_the_truth() -> None:
    inside = []
    for seed in range(200):
        found = spread_parts(*drawn(0.3, 0.1, [4] * 8, seed))
        low, high = found.between_ci95
        inside.append((low <= 0.3 <= high, found.within_ci95[0] <= 0.1 <= found.within_ci95[1]))
    assert np.mean(inside, axis=0) == pytest.approx(0.95, abs=0.04)


def test_alike_specimens_have_no_spread_and_do_not_widen_the_mean() -> None:
    gains = np.tile([-0.1, 0.0, 0.1], 5)
    found = spread_parts(gains, [f"s{k}" for k in range(5) for _ in range(3)])
    assert (found.between, found.inflation) == (0.0, 1.0)


def test_trials_of_unlike_specimens_are_few_witnesses() -> None:
    gains, names = drawn(1.0, 0.01, [9] * 6)
    assert spread_parts(gains, names).inflation == pytest.approx(3.0, rel=0.02)


@pytest.mark.parametrize("names", [["a", "a", "a"], ["a", "b", "c"]])
def test_one_specimen_or_single_trials_part_nothing(names) -> None:
    assert spread_parts(np.array([0.1, 0.0, -0.1]), names) is None


def held_fit(left, conditions, noise=1e-3):
    """A fit under one tool that leaves, N, a function of time and condition in holds, and noise of samples."""
    generator, time = np.random.default_rng(3), np.linspace(0.0, 10.0, 400)
    curve, trials = ForceCurve(np.array([1e-3, 2e-3]), np.array([1.0, 2.0])), []
    for number, name in enumerate(conditions):
        depth = np.minimum(time, 1.0) * 1e-3 - 5e-5
        force = left(time, name) + noise * generator.normal(size=time.size)
        trials.append(SimpleNamespace(data=TrialData(str(number), name, time, depth, force, curve), press=0))
    model = SimpleNamespace(trials=trials, surrogates=[None], predicted=lambda *_: np.zeros((len(trials), time.size)))
    return SimpleNamespace(model=model, vector=None, nuisance=np.zeros((len(trials), 3)))


def in_hold(time, name):
    return (0.01 if name == "fast" else -0.01) * np.cos(0.6 * time)


def test_what_each_condition_leaves_over_the_time_of_a_hold_is_told() -> None:
    """Two terms of relaxation fitted by one: slow and fast presses leave the other way, at one depth."""
    (found,) = courses_left(held_fit(in_hold, ("slow", "slow", "fast", "fast")))
    assert found.over_time
    assert found.left == pytest.approx(0.01 * 0.5**0.5, rel=0.1)
    assert found.noise == pytest.approx(1e-3, rel=0.2)


def test_noise_alone_and_a_course_of_one_trial_are_none_over_time() -> None:
    (noise,) = courses_left(held_fit(lambda time, _: 0.0 * time, ("slow", "slow", "fast", "fast")))
    assert noise.ratio < 1.0
    (alone,) = courses_left(held_fit(in_hold, ("slow", "fast")))
    assert not alone.over_time
    assert alone.ratio < 1.0
