"""A problem of some of its trials is the same problem to them."""

from dataclasses import replace

import numpy as np

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.effect_model import EffectModel
from benchmark.discovery.base.trials_problem import OWN, only
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


def test_a_late_trial_is_pressed_through_the_depth_before_its_raw_rows(session_of):
    session = session_of(trials=3)
    study = prepare(session, 60)
    base = calibrate(session, study).base
    late, number = base.nuisance.copy(), 9
    late[0, OWN.index("shift")] = study.conditions[0].before[number]
    late[0, OWN.index("height")] = 0.0
    trial = base.model.problem.trials[0]
    moved = replace(trial, motion=replace(trial.motion, depth=study.conditions[0].depth_before[0, number]))
    at_once = late.copy()
    at_once[0, OWN.index("shift")] = 0.0
    there = EffectModel(replace(base.model.problem, trials=(moved, *base.model.problem.trials[1:])), ())
    found = base.model.signals(base.vector, late)[0]
    np.testing.assert_allclose(found, there.signals(base.vector, at_once)[0], rtol=1e-9, atol=1e-9)


def test_a_tool_is_pressed_deep_once_for_all_conditions(session_of):
    from benchmark.response.wave_table import _layered_wave

    session = session_of(trials=3)
    trial = session.trials[0]
    wave_table(session.specimen, trial.tool, trial.support, 2e-3)
    before = _layered_wave.cache_info().misses
    law = wave_table(session.specimen, trial.tool, trial.support, 3e-3)
    assert _layered_wave.cache_info().misses == before
    assert law.depth[-1] > 3e-3
