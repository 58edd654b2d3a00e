"""Where an effect shows: in the phases in which it acts, and nowhere where it does not."""

import numpy as np

from benchmark.discovery.base.calibration import calibrate
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.criteria import Settings
from benchmark.discovery.detection.places import effect_places
from benchmark.discovery.trials.preparing import prepare
from benchmark.physics import catalogue

BY_SLUG = {effect.slug: effect for effect in catalogue()}


def drifting(time, depth, elastic):
    return elastic + 0.02 * (time - time[0])


def test_a_drift_shows_in_the_air_and_not_in_markers_that_there_are_none_of(session_of):
    session = session_of(force=drifting, noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    chosen = fit_candidate(base, BY_SLUG["force_drift"])
    shown = effect_places(chosen, Settings())
    assert ("force_z", "after_lift_off") in {(place.channel, place.phase) for place in shown}
    assert {place.channel for place in shown} == {"force_z"}
    assert all(place.p < 0.05 for place in shown)


def test_an_effect_of_no_size_shows_nowhere(session_of):
    session = session_of(noise=0.003, trials=4)
    base = calibrate(session, prepare(session, 90)).base
    chosen = fit_candidate(base, BY_SLUG["tool_inertia"])
    assert effect_places(chosen, Settings()) == ()
    assert np.isfinite(chosen.objective)
