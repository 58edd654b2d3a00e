"""What one step promises of an effect, beside what its fit gains."""

import re

import numpy as np
import pytest

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate, screened
from benchmark.discovery.base.effect_model import EffectModel, without_jumps
from benchmark.discovery.evidence.parameter_evidence import effect_estimates, told_together
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue
from benchmark.response.trials_model import TrialColumns
from tests.benchmark.discovery.quick_session import PEAK, law

GAP, SET = (next(e for e in catalogue() if e.slug == slug) for slug in ("contact_gap", "permanent_set"))


def test_an_offset_that_each_trial_could_take_up_is_promised_what_its_fit_gains(session_of):
    """A gap of 0.1 mm beside touches that scatter by 0.03 mm: by a whole start it was promised a tenth of it."""
    session = session_of(force=lambda time, depth, elastic: law(depth - 0.1e-3), noise=0.0005, touch=0.03e-3)
    base = calibrate(session, prepare(session, 90)).base
    found = fit_candidate(base, GAP)
    best, *_ = screened(base, EffectModel(base.model.problem, (GAP,)), GAP)
    assert best.won == pytest.approx(base.objective - found.objective, rel=0.5)


def left_behind(depth, share=0.15, onset=0.6e-3):
    """Depth that a tool meets where the surface stays at a share of what the deepest one so far is beyond an onset."""
    deepest = np.maximum.accumulate(np.maximum(depth, 0.0))
    surface = share * np.maximum(deepest - onset, 0.0)
    return (depth - surface) * deepest / np.maximum(deepest - surface, 1e-9)


def test_presses_to_one_depth_tell_the_set_and_neither_its_share_nor_its_onset(session_of):
    """By the fit's own steps rows that leave contact parted them: 0.131 (0.124 to 0.138) where 0.15 was put in."""
    session = session_of(force=lambda time, depth, elastic: law(left_behind(depth)), noise=0.004)
    found = fit_candidate(calibrate(session, prepare(session, 200)).base, SET)
    ends = {each.name: each.ci95 for _, each in effect_estimates(found)}
    assert ends["permanent_set"][0] == 0.0
    assert ends["permanent_set"][1] > 0.5
    assert ends["permanent_set_onset"][0] == 0.0
    assert ends["permanent_set_onset"][1] > PEAK
    [said] = told_together(found)
    set_, low, high = (float(word) for word in re.findall(r"[0-9]\.[0-9]+", said))
    assert low < set_ < high < 1.05 * low
    assert set_ == pytest.approx(0.15 * (3.0 - 0.6), rel=0.05)


def test_a_number_that_jumps_off_none_keeps_the_usual_derivative():
    """A pull's force at none was told to 0.01 mN: the jump of a row's contact over a thousandth of the step."""
    usual = TrialColumns([np.ones((3, 2)), np.ones((2, 2))], [])
    fine = TrialColumns([np.full((3, 2), [1.2, 170.0]), np.full((2, 2), [0.9, 0.0])], [])
    first, second = without_jumps(fine, usual).vector
    np.testing.assert_array_equal(first, np.full((3, 2), [1.2, 1.0]))
    np.testing.assert_array_equal(second, np.full((2, 2), [0.9, 1.0]))
