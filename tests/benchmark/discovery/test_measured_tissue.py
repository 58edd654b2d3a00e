"""Indentation and hold of pig tissue, measured by others (see `TISSUEBENCH_DATA`): each day a condition."""

import os
from dataclasses import replace
from pathlib import Path

import pytest

from benchmark.discovery import Settings, findings
from benchmark.files import load_session

DATA = os.environ.get("TISSUEBENCH_DATA")
A_DAY = 6


@pytest.mark.slow
@pytest.mark.skipif(DATA is None, reason="measured data: set TISSUEBENCH_DATA to the folder that holds pig_indentation")
def test_relaxation_is_named_and_the_error_on_another_day_falls():
    session = load_session(Path(str(DATA)) / "pig_indentation")
    trials = []
    for day in session.conditions:
        of_day = [trial for trial in session.trials if trial.condition == day]
        trials += of_day[:: len(of_day) // A_DAY][:A_DAY]
    few = replace(session, trials=tuple(trials))
    answer = findings(few, settings=Settings(rows=100, workers=1, bootstraps=40)).discovery
    named = {slug for effect in answer.effects for slug in (effect.slug, *effect.lookalikes)}
    assert "viscoelastic_relaxation" in named
    (gap,) = answer.gap
    assert gap.held_out == "condition"
    assert (gap.rmse_after / gap.rmse_before) ** 2 < 0.4
