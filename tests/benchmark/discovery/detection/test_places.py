"""Where an effect shows: in the phases in which it acts, and nowhere where it does not."""

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.places import effect_changes, effect_places
from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue

BY_SLUG = {effect.slug: effect for effect in catalogue()}


def drifting(time, depth, elastic):
    return elastic + 0.02 * (time - time[0])


def test_a_drift_shows_in_the_air_and_not_in_markers_that_there_are_none_of(session_of):
    session = session_of(force=drifting, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    chosen = fit_candidate(base, BY_SLUG["force_drift"])
    changes = effect_changes(chosen)
    shown = effect_places(chosen, base, changes, Settings())
    assert ("force_z", "after_lift_off") in {(place.channel, place.phase) for place in shown}
    assert {place.channel for place in shown} == {"force_z"}
    assert all(place.p < 0.05 for place in shown)
    for place in shown:
        missed = [mean(base, i, place, residual(base, i)) for i in of_condition(base, place)]
        assert place.residual == pytest.approx(np.mean(missed))
        added = [mean(base, i, place, changes[i]) for i in of_condition(base, place)]
        assert place.size == pytest.approx(np.mean(added))
    assert any(abs(place.residual - place.size) > 0.2 * abs(place.size) for place in shown)


def residual(fitted, i):
    """What is told as measured minus simulated, worked out anew."""
    return fitted.model.problem.trials[i].signals - fitted.model.signals(fitted.vector, fitted.nuisance)[i]


def of_condition(fitted, place):
    study = fitted.model.problem.study
    return [
        k for k, t in enumerate(fitted.model.problem.trials) if study.conditions[t.condition].name == place.condition
    ]


def mean(fitted, i, place, values):
    """Of the place's rows in a trial, each weighted by its samples."""
    trial = fitted.model.problem.trials[i]
    rows = fitted.model.problem.study.conditions[trial.condition].phase == PHASES.index(place.phase)
    return np.average(values[rows, 0], weights=trial.count[rows, 0])


def test_an_effect_of_no_size_shows_nowhere(session_of):
    session = session_of(noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    chosen = fit_candidate(base, BY_SLUG["tool_inertia"])
    assert effect_places(chosen, base, effect_changes(chosen), Settings()) == ()
    assert np.isfinite(chosen.objective)


def test_an_effect_that_is_small_everywhere_shows_where_it_is_largest(session_of, monkeypatch):
    session = session_of(force=drifting, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    chosen = fit_candidate(base, BY_SLUG["force_drift"])
    changes = effect_changes(chosen)
    usual = effect_places(chosen, base, changes, Settings())
    monkeypatch.setattr(criteria, "SHOWN", np.inf)
    largest = effect_places(chosen, base, changes, Settings())
    assert largest == usual[: len(largest)]
    assert 1 <= len(largest) < len(usual)
