"""What differs from trial to trial is found and taken off: the noise that is left is the sensor's."""

import numpy as np
import pytest

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.trials.preparing import prepare
from benchmark.response.wave_table import wave_table

TOUCH = 60e-6  # m, what a touch by force leaves between trials


def _noise(session):
    found = calibrate(session, prepare(session, 90), wave_table)
    return found, float(np.median(found.problem.noise.scale[:, 0]))


def test_the_depth_at_touch_is_each_trials_own(session_of, quick_session):
    found, noise = _noise(session_of(trials=6, touch=TOUCH))
    _, still = _noise(session_of(trials=6))
    put_in = quick_session.heights(12, TOUCH)
    heights = found.base.nuisance[:, 3]
    assert np.abs((heights - heights.mean()) - (put_in - put_in.mean())).max() < 0.15 * TOUCH
    assert found.problem.prior.height == pytest.approx(np.std(put_in, ddof=1), rel=0.2)
    assert noise == pytest.approx(still, rel=0.15)


def test_trials_that_touch_alike_have_little_of_it(session_of):
    found, _ = _noise(session_of(trials=6))
    assert found.problem.prior.height < 0.1 * TOUCH
