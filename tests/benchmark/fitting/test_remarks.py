import re

import numpy as np
import pytest

from benchmark.fitting import fit_session
from benchmark.fitting.remarks import elastic_only

EFFECTS = re.compile(r"relax|viscoel|prony|creep|poro|mullins|softening|friction", re.IGNORECASE)


def test_a_fading_force_is_time_dependence_without_a_name(fading_trial, silicone):
    fit = fit_session([fading_trial(g=0.6, seed=n, name=str(n)) for n in range(3)], [silicone])
    text = " ".join(fit.warnings)
    assert "time dependence is in the data: in 3 of 3 trials" in text
    assert "while the depth is held" in text
    assert "leaves more than 10 % of the peak" in text
    assert not EFFECTS.search(text + " ".join(fit.notes))


def test_what_a_fit_with_relaxation_need_not_say(fading_trial, silicone):
    fit = fit_session([fading_trial(g=0.6, seed=n, name=str(n)) for n in range(2)], [silicone])
    elastic = elastic_only(fit.trials)
    assert set(elastic) < set(fit.warnings)
    assert [text for text in fit.warnings if text not in elastic] == ["stiffness from two trials: its interval is wide"]


def test_elastic_trials_have_no_warning(session, silicone):
    assert fit_session(session(np.random.default_rng(0)), [silicone]).warnings == ()


def test_large_scatter_is_said_with_the_range_of_a_further_trial(session, silicone):
    fit = fit_session(session(np.random.default_rng(0), scatter=0.6), [silicone])
    text = " ".join(fit.warnings)
    assert re.search(r"differs up to [\d.]+-fold: they may be different specimens", text)
    assert f"{fit.stiffness.next_trial[1]:.3g}" in text


@pytest.mark.parametrize(("trials", "found"), [(1, "a single trial"), (2, "two trials")])
def test_few_trials_are_said(session, silicone, trials, found):
    assert found in " ".join(fit_session(session(np.random.default_rng(0), trials), [silicone]).warnings)


def test_conditions_that_differ_are_noted(trial, silicone):
    def condition(name, factor, count):
        return [trial(f"{name}{n}", name, factor=factor * (1 + 0.01 * n), noise=0.003, seed=n) for n in range(count)]

    apart = fit_session(condition("slow", 1.0, 4) + condition("fast", 1.5, 4), [silicone])
    alike = fit_session(condition("slow", 1.0, 4) + condition("fast", 1.0, 4), [silicone])
    assert "differs between conditions" in " ".join(apart.notes)
    assert "differs between conditions" not in " ".join(alike.notes)
    assert apart.to_dict()["conditions_differ_p"] < 1e-4


def test_the_joint_value_is_reported(session, silicone):
    fit = fit_session(session(np.random.default_rng(0)), [silicone])
    assert any(f"one common factor fitted to all trials is {fit.joint.value:.6g}" in note for note in fit.notes)
