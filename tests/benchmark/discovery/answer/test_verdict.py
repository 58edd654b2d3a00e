import pytest

from benchmark.discovery.answer.verdict import Facts, statement, verdict
from benchmark.discovery.discovery_result import VERDICTS
from benchmark.physics import catalogue

BY_SLUG = {effect.slug: effect for effect in catalogue()}
RELAXATION, DRAINAGE = BY_SLUG["viscoelastic_relaxation"], BY_SLUG["poroelastic_drainage"]
DRIFT = BY_SLUG["force_drift"]


def facts(**changes):
    plain = {
        "p": 0.001,
        "p_cells": 0.01,
        "enough": True,
        "effects": (RELAXATION,),
        "lookalikes": (),
        "left": 0.02,
        "p_after": 0.6,
        "transfers": True,
        "level": 0.05,
    }
    return Facts(**{**plain, **changes})


CASES = {
    "named": {},
    "no_discrepancy": {"effects": (), "p": 0.4, "p_cells": 0.4},
    "outside_catalogue": {"left": 0.5, "p_after": 0.002},
    "lookalikes": {"lookalikes": (DRAINAGE,)},
    "instrument_first": {"lookalikes": (DRIFT,)},
    "conditional": {"transfers": None},
    "partly_explained": {"left": 0.2, "p_after": 0.002},
}


@pytest.mark.parametrize("word", VERDICTS)
def test_each_verdict_has_its_facts(word):
    made = facts(**CASES[word])
    assert verdict(made) == word
    assert statement(word, made).endswith(".")


def test_a_disagreement_without_an_effect_is_outside_the_catalogue():
    assert verdict(facts(effects=())) == "outside_catalogue"


def test_too_few_trials_name_nothing():
    made = facts(enough=False)
    assert verdict(made) == "no_discrepancy"
    assert "too few trials" in statement("no_discrepancy", made)


def test_parameters_that_do_not_transfer_are_conditional():
    assert verdict(facts(transfers=False)) == "conditional"
