"""Tests that share the level, trends over trials, and the smallest disagreement that could have been seen."""

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection import disagreement
from benchmark.discovery.detection.cells import Cell, CellTable, FlipTest
from benchmark.discovery.detection.disagreement import (
    Detection,
    combined,
    detect,
    exchangeable,
    smallest_visible,
    strained,
)
from benchmark.discovery.trials.preparing import prepare

PROBABILITY = st.floats(0.0, 1.0)


@given(st.lists(PROBABILITY, min_size=1, max_size=3))
def test_the_combined_p_is_none_of_the_tests_own(values):
    p = combined(*values)
    assert min(values) <= p <= 1.0
    assert p >= min(value / share for value, share in zip(values, criteria.LEVEL_SHARES, strict=False)) or p == 1.0


def test_the_shares_use_the_level_up():
    assert sum(criteria.LEVEL_SHARES) == pytest.approx(1.0)
    assert combined(0.7 * 0.05, 1.0, 1.0) == pytest.approx(0.05)
    assert combined(1.0, 0.15 * 0.05) == pytest.approx(0.05)


def test_three_tests_of_chance_keep_the_level():
    drawn = np.random.default_rng(0).uniform(size=(4000, 3))
    assert np.mean([combined(*each) < 0.05 for each in drawn]) == pytest.approx(0.05, abs=0.01)


def bent(*vector, told=(0.0, 0.0, 0.0)):
    names = ("modulus", "tool.radius", "exponent")
    model = SimpleNamespace(problem=SimpleNamespace(shapes=names))
    precision = np.array([0.1, 400.0, 1e4])
    return SimpleNamespace(model=model, vector=np.array(vector), prior_mean=np.array(told), precision=precision)


def test_a_base_is_strained_by_its_priors_and_the_modulus_is_free():
    assert strained(bent(9.0, 0.0, 0.0)) == 1.0
    assert strained(bent(0.0, 0.1, 0.0)) == pytest.approx(2 * 2 * 0.02275, rel=1e-3)  # two of its deviations, two asked
    assert strained(bent(0.0, 0.0, -0.05)) < 1e-5
    assert strained(bent(0.0, 0.1, -0.05, told=(0.0, 0.1, -0.05))) == 1.0  # where it was told to be


def table(means, groups=None):
    cells = tuple(Cell(1, 1, 0, 0, {0: np.ones(4, dtype=bool)}) for _ in means)
    return CellTable(cells, np.array(means, dtype=float), groups)


def trend(means, conditions):
    trials = tuple(SimpleNamespace(number=k, condition=c) for k, c in enumerate(conditions))
    fit = SimpleNamespace(model=SimpleNamespace(problem=SimpleNamespace(trials=trials)))
    return disagreement._trend(fit, table(means))


def test_a_trend_over_trials_is_told_and_a_step_between_conditions_is_none():
    noise = 0.01 * np.random.default_rng(0).normal(size=10)
    rising, stepped = np.arange(10.0) + noise, np.repeat([0.0, 5.0], 5) + noise
    slopes = trend([rising, stepped, noise], [0] * 5 + [1] * 5)
    assert slopes[0] > 100.0
    assert np.abs(slopes[1:]).max() < criteria.TREND


@pytest.mark.parametrize(("t", "told"), [(6.1, True), (-6.1, True), (5.9, False)])
def test_trials_that_change_in_order_are_told_of(t, told):
    made = Detection(table([np.zeros(4)]), None, 1.0, 1.0, np.array([0.0, t]))
    assert bool(exchangeable(made)) is told
    assert exchangeable(Detection(table([]), None, 1.0, 1.0, np.array([]))) == ()


@pytest.mark.parametrize(("rate", "large"), [(1e-4, False), (1e-3, True)])
def test_what_is_sure_but_small_is_seen_and_is_no_disagreement_by_itself(session_of, rate, large):
    """A drift of 0.6 or 6 mN in the mean of a cell, of a press to 2.1 N."""
    session = session_of(force=lambda time, depth, elastic: elastic + rate * (time - time[0]), noise=1e-4, trials=4)
    found = detect(calibrate(session, prepare(session, 90)).base, Settings())
    assert found.p < 0.05
    assert (found.p_cells < 0.05) is large


def test_the_smallest_visible_disagreement_is_that_of_a_channels_best_cell():
    rows = {0: np.ones(4, dtype=bool)}
    cells = tuple(Cell(1, 1, 0, signal, rows) for signal in (0, 0, 1, 2))
    test = FlipTest(np.zeros(4), np.ones(4), 3.0, np.array([0.1, 0.05, 2e-6, 1e-6]), 1.0)
    least = np.array([0.0, 0.0, 5e-6, 1e-6])
    made = Detection(CellTable(cells, np.zeros((4, 6)), least=least), test, 1.0, 1.0, np.zeros(4))
    study = SimpleNamespace(channels=("force_z", "marker_radial", "marker_radial"))
    fit = SimpleNamespace(model=SimpleNamespace(problem=SimpleNamespace(study=study)))
    assert smallest_visible(fit, made) == pytest.approx({"force_z": 0.15, "marker_radial": 4e-6})
