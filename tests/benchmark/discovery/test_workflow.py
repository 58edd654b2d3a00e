"""The whole way on quick sessions, in few rows. Circular where an effect has the catalogue's own form."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery import Settings, expected, findings, rivals, workflow
from benchmark.discovery.answer.verdict import verdict
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.discovery_result import CHANNELS, PHASES, VERDICTS
from benchmark.discovery.workflow import without_ruled_out

SETTINGS = Settings(rows=90, workers=1, bootstraps=40, most_effects=1)


def damped(time, depth, elastic):
    """By the rate since the sample before, which no corner of the motion smears; no pull as the tool lifts off."""
    return np.maximum(elastic + 0.04 * np.append(0.0, np.diff(elastic) / np.diff(time)), 0.0)


@pytest.mark.slow
def test_damping_is_named_and_its_gap_closes(session_of, tmp_path):
    said = []
    session = session_of(force=damped, noise=0.003, trials=4)
    store = tmp_path / "store"
    found = findings(session, settings=SETTINGS, listener=lambda *words: said.append(words), store=store)
    answer = found.discovery
    assert answer.verdict in VERDICTS
    assert "viscous_damping" in {slug for e in answer.effects for slug in (e.slug, *e.lookalikes)}
    assert all(place.channel in CHANNELS and place.phase in PHASES for place in answer.where)
    (gap,) = answer.gap
    assert gap.held_out == "condition"
    assert gap.closed > 0.6
    assert said[0][0] == "prepare"
    assert len(list(store.glob("*.npz"))) > 3
    again = findings(session, settings=SETTINGS, store=store).discovery
    assert told(again) == told(answer)
    first = rivals(found)[0]
    trial = found.calibrated.problem.trials[0]
    made = expected(first, answer.conditions[0], trial.motion.time, trial.motion.depth)
    assert made.names == ("force_z",)
    assert made.signals.shape == (trial.motion.time.size, 1)


def told(answer):
    """All of an answer but its time, to the last bit."""
    with np.printoptions(threshold=10**9, floatmode="unique"):
        return repr(replace(answer, seconds=0.0))


@pytest.mark.slow
def test_an_interrupted_discovery_ends_with_the_same_answer(session_of, tmp_path, monkeypatch):
    session, settings = session_of(force=damped, noise=0.003), replace(SETTINGS, rows=60)
    whole = told(findings(session, settings=settings).discovery)
    made = []

    def stopping(base, effect):
        if len(made) == 3:
            raise KeyboardInterrupt
        made.append(effect.slug)
        return fit_candidate(base, effect)

    monkeypatch.setattr("benchmark.discovery.evidence.pool.fit_candidate", stopping)
    with pytest.raises(KeyboardInterrupt):
        findings(session, settings=settings, store=tmp_path / "store")
    assert len(list((tmp_path / "store").iterdir())) == 3
    monkeypatch.setattr("benchmark.discovery.evidence.pool.fit_candidate", fit_candidate)
    again = findings(session, settings=settings, store=tmp_path / "store")
    assert told(again.discovery) == whole


@pytest.mark.slow
def test_few_trials_cannot_tell_whatever_they_show(session_of):
    found = findings(session_of(force=damped, trials=2), settings=SETTINGS).discovery
    assert found.verdict == "cannot_tell"
    assert (found.p, found.effects, found.where, found.remains, found.smallest_visible) == (None, (), (), (), {})
    assert "too few trials" in found.statement
    assert found.gap[0].rmse_before > 0.0


def exponential(time, depth, elastic):
    """A purely elastic force that grows far faster than any base."""
    return 0.3 * np.expm1(1.2e3 * np.maximum(depth, 0.0))


@pytest.mark.slow
def test_a_steep_elastic_force_is_stiffening_and_before_is_near_what_was_measured(
    session_of, quick_session, monkeypatch
):
    plain = quick_session.motion
    monkeypatch.setattr(quick_session, "motion", lambda speed, hold: plain(speed, peak=4e-3, hold=hold))
    answer = findings(session_of(force=exponential, noise=0.003), settings=SETTINGS).discovery
    assert answer.effects[0].slug == "strain_stiffening"
    assert answer.verdict in ("named", "conditional", "lookalikes", "partly_explained")
    (gap,) = answer.gap
    assert gap.rmse_after < 0.1 * gap.rmse_before
    peak = max(np.nanmax(trace.measured) for trace in answer.traces)
    assert max(np.nanmax(trace.before) for trace in answer.traces) < 1.2 * peak
    assert answer.effects[0].by_condition
    for place in answer.where:
        assert abs(place.size) < peak


@pytest.mark.slow
def test_loading_alone_names_nothing_that_needs_more(session_of, quick_session, monkeypatch):
    plain = quick_session.motion

    def loading(speed, hold):
        time, depth = plain(3e-3, hold=hold, cycles=1)
        rows = slice(0, int(depth.argmax()) + 1)
        return time[rows], depth[rows]

    monkeypatch.setattr(quick_session, "motion", loading)
    answer = findings(session_of(force=damped, noise=0.003), settings=SETTINGS).discovery
    hidden = {"viscous_damping", "viscoelastic_relaxation", "dry_friction", "stress_softening", "permanent_set"}
    assert hidden <= set(answer.not_shown)
    said = {slug for effect in answer.effects for slug in (effect.slug, *effect.lookalikes)}
    assert not hidden & said
    assert not hidden & {slug for each in answer.candidates for slug in each.slugs}


@pytest.mark.parametrize("tiny", [False, True])
def test_the_verdict_is_told_whether_the_misfit_is_nothing(session_of, monkeypatch, tiny):
    told = []
    monkeypatch.setattr(workflow, "nothing_amiss", lambda fitted: tiny)
    monkeypatch.setattr(workflow, "verdict", lambda facts: told.append(facts) or verdict(facts))
    findings(session_of(trials=4, speeds=(3e-3,)), settings=SETTINGS)
    assert [facts.tiny for facts in told] == [tiny]


def test_time_shifts_that_go_with_the_speed_are_no_agreement(session_of, monkeypatch):
    session = session_of(seed=3)
    assert findings(session, settings=SETTINGS).discovery.verdict == "no_discrepancy"
    monkeypatch.setattr(workflow, "late_by_speed", lambda problem, shift: ((1e-3, 0.012), (3e-3, 0.004)))
    assert findings(session, settings=SETTINGS).discovery.verdict == "cannot_tell"


def test_what_is_measured_apart_from_the_trials_leaves_of_the_answer_what_stood(session_of, monkeypatch):
    """Nothing is searched anew: of the look-alikes the one that was ruled out is gone, or takes the answer with it."""
    found = findings(session_of(force=fading, noise=0.003), settings=SETTINGS)
    (effect,) = found.discovery.effects
    assert effect.slug == "viscoelastic_relaxation"
    nearest, *rest = effect.lookalikes
    monkeypatch.setattr(workflow, "select", None)
    surer = without_ruled_out(found, {nearest})
    assert [(each.slug, each.lookalikes) for each in surer.discovery.effects] == [(effect.slug, tuple(rest))]
    assert surer.discovery.verdict == found.discovery.verdict
    other = without_ruled_out(found, {effect.slug, *rest})
    assert [(each.slug, each.lookalikes) for each in other.discovery.effects] == [(nearest, ())]
    assert [rival.slugs for rival in rivals(other)] == [(nearest,)]
    assert effect.slug not in {each.slug for each in other.known}


def test_an_effect_without_which_nothing_is_missed_is_not_named(session_of, monkeypatch):
    for rule in ("misses_nothing", "nothing_amiss"):
        monkeypatch.setattr(workflow, rule, lambda fitted: True)
    answer = findings(session_of(force=fading, noise=0.003), settings=SETTINGS).discovery
    assert (answer.verdict, answer.effects, answer.remains) == ("cannot_tell", (), ())
    assert any(each.slugs == ("viscoelastic_relaxation",) for each in answer.candidates)


def fading(time, depth, elastic):
    """A Prony term of 12 % and 0.8 s."""
    lost = np.zeros_like(time)
    for row in range(1, time.size):
        share = np.exp(-(time[row] - time[row - 1]) / 0.8)
        lost[row] = share * lost[row - 1] + (1.0 - share) * 0.5 * (elastic[row] + elastic[row - 1])
    return elastic - 0.12 * lost
