"""Trials of specimens of unlike thickness are told by their markers; trials of one specimen have none of their own."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from benchmark.discovery.base.calibration import calibrate, unlike_mates
from benchmark.discovery.base.effect_model import EffectModel, fit
from benchmark.discovery.base.thickness_spread import thickness_spread, unlike_in_thickness
from benchmark.discovery.base.trial_bounds import trial_values
from benchmark.discovery.base.trials_problem import OWN
from benchmark.discovery.trials.preparing import prepare
from benchmark.files import load_session
from benchmark.response.wave_table import wave_table
from benchmark.sessions import SHIPPED

THICKER = np.array([0.03, -0.02, 0.01, -0.035, 0.02, -0.01])


@pytest.fixture(scope="module")
def base():
    """The base of six filmed presses of the phantom, with a table that knows its thickness."""
    session = load_session(SHIPPED / "phantom")
    filmed = [trial for trial in session.trials if trial.markers is not None and trial.condition == "press"]
    some = replace(session, trials=tuple((filmed or list(session.trials))[:6]))
    return calibrate(some, prepare(some, 40), partial(wave_table, keys=("tool.radius", "silicone.thickness"))).base


def _pressed(base, thicker):
    """The base fitted to trials that its model makes of specimens thicker by shares (R,), with white noise."""
    state = base.nuisance.copy()
    state[:, OWN.index("thickness")] = thicker
    problem, rng = base.model.problem, np.random.default_rng(5)
    signals = base.model.signals(base.vector, state)
    trials = tuple(
        replace(trial, signals=rows + problem.noise.scale[index] * rng.normal(size=rows.shape))
        for index, (trial, rows) in enumerate(zip(problem.trials, signals, strict=True))
    )
    noise = replace(problem.noise, memory=(0.0,) * len(problem.noise.memory))
    return fit(EffectModel(replace(problem, trials=trials, noise=noise), ()), base.vector, base.nuisance, most=4)


def _unlike(fitted):
    signals = fitted.model.signals(fitted.vector, fitted.nuisance)
    return unlike_in_thickness(fitted, signals, unlike_mates(fitted, signals))


def test_specimens_of_unlike_thickness_are_told_by_how_their_markers_differ(base):
    fitted = _pressed(base, THICKER)
    assert _unlike(fitted)
    problem = fitted.model.problem
    problem = replace(problem, prior=replace(problem.prior, thickness=0.05))
    own = fit(EffectModel(problem, ()), fitted.vector, fitted.nuisance, most=8)
    found = np.array([each.thicker for each in trial_values(problem, own.nuisance)])
    np.testing.assert_allclose(found - found.mean(), THICKER - THICKER.mean(), atol=0.004)
    assert thickness_spread(own) == pytest.approx(np.std(THICKER, ddof=1), rel=0.1)
    assert own.objective < 0.7 * fitted.objective


def test_trials_of_one_specimen_have_no_thickness_of_their_own(base):
    fitted = _pressed(base, np.zeros(6))
    assert not _unlike(fitted)
    assert thickness_spread(fitted) == 0.0
    assert not fitted.nuisance[:, OWN.index("thickness")].any()
