"""A problem of some of its trials is the same problem to them."""

import numpy as np

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.base.trials_problem import only
from benchmark.discovery.trials.preparing import prepare
from benchmark.response.wave_table import wave_table


def test_some_trials_are_simulated_and_whitened_as_among_all(session_of):
    session = session_of(trials=3)
    base = calibrate(session, prepare(session, 60)).base
    problem, picked = base.model.problem, [1, 4, 5]
    part = only(problem, picked)
    assert [t.name for t in part.trials] == [problem.trials[i].name for i in picked]
    whole = base.model.signals(base.vector, base.nuisance)
    some = EffectModel(part, ()).signals(base.vector, base.nuisance[picked])
    for k, i in enumerate(picked):
        np.testing.assert_array_equal(some[k], whole[i])
        np.testing.assert_array_equal(part.whiteners(k)[0].scale, problem.whiteners(i)[0].scale)


def test_a_tool_is_pressed_deep_once_for_all_conditions(session_of):
    from benchmark.response.wave_table import _layered_wave

    session = session_of(trials=3)
    trial = session.trials[0]
    wave_table(session.specimen, trial.tool, trial.support, 2.6e-3)  # both within half of the 12 mm
    before = _layered_wave.cache_info().misses
    law = wave_table(session.specimen, trial.tool, trial.support, 3e-3)
    assert _layered_wave.cache_info().misses == before
    assert law.depth[-1] > 3e-3


def test_a_late_trial_is_pressed_through_what_its_record_was_before(session_of):
    session = session_of(trials=3)
    study = prepare(session, 60)
    model = calibrate(session, study).base.model
    record, trial = study.conditions[0].records[0], model.problem.trials[0]
    assert trial.motion.record is record
    late = trial.motion.before(4e-3)
    np.testing.assert_allclose(late.depth - trial.motion.depth, record.means(4e-3) - record.means(0.0), atol=1e-15)
