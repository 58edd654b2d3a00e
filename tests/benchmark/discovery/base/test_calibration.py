"""What differs from trial to trial is found and taken off: the noise that is left is the sensor's."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.base import calibration
from benchmark.discovery.base.calibration import _gain_spread, _spreads, calibrate
from benchmark.discovery.base.trials_problem import OWN
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import load_session
from benchmark.response.wave_table import wave_table
from benchmark.sessions import SHIPPED

TOUCH = 60e-6  # m, what a touch by force leaves between trials


def _noise(session):
    found = calibrate(session, prepare(session, 90), wave_table)
    return found, float(np.median(found.problem.noise.scale[:, 0]))


@pytest.mark.slow
def test_the_depth_at_touch_is_each_trials_own(session_of, quick_session):
    found, noise = _noise(session_of(trials=6, touch=TOUCH))
    _, still = _noise(session_of(trials=6))
    put_in = quick_session.heights(12, TOUCH)
    heights = found.base.nuisance[:, 3]
    assert np.abs((heights - heights.mean()) - (put_in - put_in.mean())).max() < 0.15 * TOUCH
    assert found.problem.prior.height == pytest.approx(np.std(put_in, ddof=1), rel=0.2)
    assert noise == pytest.approx(still, rel=0.15)


def test_trials_that_touch_alike_have_little_of_it(session_of, monkeypatch):
    found, _ = _noise(session_of(trials=6))
    monkeypatch.setattr(calibration, "_gain_spread", lambda problem, gain: 0.123)
    assert _spreads(found.base, found.problem.noise.scale).gain == 0.123
    assert found.problem.prior.height < 0.1 * TOUCH
    late, early = found.base.nuisance.copy(), found.base.nuisance.copy()
    late[:, OWN.index("height")] -= 2.0 * TOUCH  # a rig that finds the touch by a force finds all of them late
    early[:, OWN.index("height")] += 2.0 * TOUCH  # free travel before all of them, which no search by force leaves
    shared, gap = (_spreads(replace(found.base, nuisance=n), found.problem.noise.scale) for n in (late, early))
    assert shared.height == pytest.approx(2.0 * TOUCH, rel=0.1)
    assert gap.height < 0.1 * TOUCH


def test_a_trial_that_was_not_filmed_counts_with_its_force_alone():
    session = load_session(SHIPPED / "phantom")  # the film of its first trial is in an MCAP file, not tracked here
    few = [trial for name in session.conditions for trial in [t for t in session.trials if t.condition == name][:3]]
    some = replace(session, trials=tuple(few))
    found = calibrate(some, prepare(some, 60), wave_table)
    unfilmed = [trial.markers is None for trial in some.trials]
    assert any(unfilmed)
    assert not all(unfilmed)
    assert np.isfinite(found.problem.noise.scale).all()
    assert [not trial.count[:, 1:].any() for trial in found.problem.trials] == unfilmed
    assert np.isfinite(found.base.vector).all()


def parted(setups, gain):
    """A problem with a trial for each set-up (tissue, tool, support), and their log gains."""
    conditions = tuple(SimpleNamespace(setup=setup) for setup in setups)
    trials = tuple(SimpleNamespace(condition=k) for k in range(len(setups)))
    return SimpleNamespace(study=SimpleNamespace(conditions=conditions), trials=trials), np.asarray(gain)


def test_what_two_tools_part_is_no_scatter_of_trials():
    narrow, wide, other = ("gel", "5 mm", "base"), ("gel", "8 mm", "base"), ("skin", "8 mm", "base")
    gains = [0.05, 0.04, 0.06, -0.05, -0.06, -0.04]
    two = _gain_spread(*parted([narrow] * 3 + [wide] * 3, gains))
    assert two == pytest.approx(np.hypot(0.01, criteria.TOOLS_APART))
    for setups in ([narrow] * 6, [narrow] * 3 + [other] * 3, [narrow, wide, narrow, wide, wide, other]):
        assert _gain_spread(*parted(setups, gains)) == pytest.approx(np.std(gains, ddof=1))
    single = parted([narrow, wide], [0.05, -0.05])  # no trial has a mate
    assert _gain_spread(*single) == pytest.approx(np.std([0.05, -0.05], ddof=1))
