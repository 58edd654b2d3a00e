"""What trials share beyond a model is told from what they do not."""

import numpy as np
import pytest

from benchmark.discovery.calibrate import calibrate
from benchmark.discovery.candidate_fit import fit_candidate
from benchmark.discovery.preparing import prepare
from benchmark.discovery.shared import share_left, shared_misfit
from benchmark.physics import catalogue

BY_SLUG = {effect.slug: effect for effect in catalogue()}


def drifting(time, depth, elastic):
    return elastic + 0.02 * (time - time[0])


def test_the_right_effect_leaves_little_and_a_wrong_one_nearly_all(session_of):
    session = session_of(force=drifting, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    assert shared_misfit(base) > 200.0
    assert share_left(base, fit_candidate(base, BY_SLUG["force_drift"])) < 0.1
    assert share_left(base, fit_candidate(base, BY_SLUG["tool_inertia"])) > 0.7


def test_noise_alone_is_not_shared(session_of):
    session = session_of(noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    rows = sum(trial.signals.size for trial in base.model.problem.trials[::4])
    assert shared_misfit(base) == pytest.approx(0.0, abs=6.0 * np.sqrt(2.0 * rows))
