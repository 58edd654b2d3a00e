"""The whole way on quick sessions, in few rows. Circular where an effect has the catalogue's own form."""

from dataclasses import replace

import numpy as np
import pytest

from benchmark.discovery import Settings, expected, findings, rivals
from benchmark.discovery.base.candidate_fit import fit_candidate
from benchmark.discovery.discovery_result import CHANNELS, PHASES, VERDICTS

SETTINGS = Settings(rows=90, workers=1, bootstraps=40, most_effects=1)


def damped(time, depth, elastic):
    return elastic + 0.04 * np.gradient(elastic, time)


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
