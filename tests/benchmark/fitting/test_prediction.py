from dataclasses import replace

import numpy as np
import pytest

from benchmark.fitting import FittingError, ForceCurve, fit_session, held_out_stiffness, predict


def test_measured_depth_gives_the_force_back(trial, silicone):
    trials = [trial(str(n), zero=0.1 * n, onset=1e-4 * n) for n in range(3)]
    fit = fit_session(trials, [silicone])
    for each in trials:
        assert predict(fit, each) == pytest.approx(each.force, abs=1e-5)


def test_held_out_stiffness_is_that_of_the_others(trial, silicone):
    trials = [trial(str(n), factor=factor) for n, factor in enumerate((1.0, 2.0, 8.0))]
    fit = fit_session(trials, [silicone])
    assert held_out_stiffness(fit, "0", "slow") == pytest.approx(4.0, rel=1e-6)
    assert held_out_stiffness(fit, "2", "slow") == pytest.approx(np.sqrt(2.0), rel=1e-6)


def test_held_out_prediction_does_not_depend_on_the_trial_it_predicts(trial, silicone):
    others = [trial("a", factor=1.0), trial("b", factor=1.2)]
    for factor in (0.5, 3.0):
        own = trial("own", factor=factor)
        held_out = predict(fit_session([*others, own], [silicone]), own, leave_one_out=True)
        assert held_out.max() - 0.01 == pytest.approx((own.force.max() - 0.01) * np.sqrt(1.2) / factor, rel=1e-5)


def test_rows_beyond_the_curve_are_empty(trial, curve, silicone):
    short = replace(trial(), curve=ForceCurve(curve.depth[:13], curve.force[:13]))
    force = predict(fit_session([short], [silicone]), short)
    beyond = short.depth - 2e-4 > short.curve.reach
    assert np.isnan(force[beyond]).all()
    assert np.isfinite(force[short.depth < 3e-3]).all()


def test_the_only_trial_cannot_be_held_out(trial, silicone):
    only = trial()
    with pytest.raises(FittingError, match="only one fitted"):
        predict(fit_session([only], [silicone]), only, leave_one_out=True)


def test_a_trial_of_another_session_is_refused(trial, silicone):
    with pytest.raises(FittingError, match="not part of this fit"):
        predict(fit_session([trial("a")], [silicone]), trial("b"))
