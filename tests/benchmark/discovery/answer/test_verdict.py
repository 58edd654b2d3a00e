"""The verdict: what each rests on, and what may never be said."""

import itertools

import pytest

from benchmark.discovery import criteria
from benchmark.discovery.answer.verdict import Facts, statement, verdict
from benchmark.discovery.discovery_result import VERDICTS
from benchmark.physics import catalogue
from benchmark.physics.setup_entry import setup_entry

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
    "cannot_tell": {"enough": False},
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


@pytest.mark.parametrize("word", VERDICTS)
def test_what_was_not_looked_for_stands_in_the_headline_where_trials_disagree(word):
    hidden = facts(**CASES[word], unseen=("viscoelastic_relaxation", "poroelastic_drainage"))
    said = "Not looked for, as these trials cannot show it: viscoelastic relaxation, poroelastic drainage."
    assert verdict(hidden) == word
    assert statement(word, hidden).endswith(said) == (word not in ("no_discrepancy", "cannot_tell"))
    assert "Not looked for" not in statement(word, facts(**CASES[word]))


def test_a_disagreement_without_an_effect_is_outside_the_catalogue():
    assert verdict(facts(effects=())) == "outside_catalogue"


def test_what_trials_share_row_by_row_is_no_agreement_and_no_name_where_it_is_much():
    silent = {"effects": (), "p": 0.4, "p_cells": 0.4, "p_shared": 0.004}
    made = facts(**silent, shared=900.0)
    assert verdict(made) == "outside_catalogue"
    assert "row by row" in statement("outside_catalogue", made)
    assert made.p_any == 0.004
    assert verdict(facts(**silent, shared=criteria.SHARED)) == "no_discrepancy"
    rows = {"p_shared": 0.004, "shared": 900.0}
    assert verdict(facts(left=0.5, **rows)) == "outside_catalogue"
    partly = facts(left=0.2, **rows)
    assert verdict(partly) == "partly_explained"
    assert "row by row" in statement("partly_explained", partly)
    assert verdict(facts(left=0.02, **rows)) == "named"


@pytest.mark.parametrize(("shared", "word"), [(318.0, "partly_explained"), (295.0, "named")])
def test_beside_an_effect_less_shared_misfit_shows_that_it_is_not_all(shared, word):
    """What a snap-through called a floor left, and the most that a right name did."""
    assert verdict(facts(left=0.2, p_shared=0.004, shared=shared)) == word
    assert verdict(facts(effects=(), p=0.4, p_cells=0.4, p_shared=0.004, shared=shared)) == "no_discrepancy"


def test_an_answer_that_misses_by_more_than_the_tolerance_is_not_all():
    made = facts(fitted=False)
    assert verdict(made) == "partly_explained"
    assert "stated tolerance" in statement("partly_explained", made)
    assert verdict(facts(fitted=False, lookalikes=(DRAINAGE,))) == "lookalikes"


def test_what_another_set_up_takes_up_is_no_agreement_where_the_set_up_as_told_misses():
    silent = {"effects": (), "p": 0.4, "p_cells": 0.4, "taken_up": True}
    made = facts(**silent, within=False)
    assert verdict(made) == "cannot_tell"
    assert "set-up as told" in statement("cannot_tell", made)
    assert verdict(facts(**silent)) == "no_discrepancy"


def test_what_a_withheld_effect_would_take_is_no_unknown_cause():
    assert verdict(facts(left=criteria.OUTSIDE, p_after=0.002)) == "partly_explained"
    leaving = facts(left=1.01 * criteria.OUTSIDE, p_after=0.002)
    assert verdict(leaving) == "outside_catalogue"
    share = f"{101.0 * criteria.OUTSIDE:.2g}"
    assert statement("outside_catalogue", leaving).endswith(f", which leaves {share} % of what trials share.")


def test_agreement_is_not_shown_where_time_shifts_may_hide_something():
    agreeing = {"p": 0.4, "p_cells": 0.4, "effects": (), "lookalikes": ()}
    assert verdict(facts(**agreeing)) == "no_discrepancy"
    hidden = facts(**agreeing, by_speed=True)
    assert verdict(hidden) == "cannot_tell"
    assert "these shifts go with the speed" in statement("cannot_tell", hidden)
    assert "these shifts go with the speed" in statement("cannot_tell", facts(**agreeing, by_speed=True, taken_up=True))
    assert verdict(facts(by_speed=True)) == verdict(facts())  # what was found beside them stands


def test_agreement_is_not_shown_where_gains_part_conditions():
    agreeing = {"p": 0.4, "p_cells": 0.4, "effects": (), "lookalikes": ()}
    hidden = facts(**agreeing, parted=True)
    assert verdict(hidden) == "cannot_tell"
    assert "part the conditions" in statement("cannot_tell", hidden)
    assert verdict(facts(parted=True)) == verdict(facts())


def test_too_few_trials_cannot_tell():
    made = facts(enough=False)
    assert verdict(made) == "cannot_tell"
    assert "too few trials" in statement("cannot_tell", made)
    assert "nothing is named" in statement("cannot_tell", made)


def test_parameters_that_do_not_transfer_are_conditional():
    assert verdict(facts(transfers=False)) == "conditional"


CHOICES = {
    "p": (0.001, 0.4),
    "p_cells": (0.01, 0.4),
    "enough": (True, False),
    "effects": ((), (RELAXATION,)),
    "lookalikes": ((), (DRAINAGE,), (DRIFT,)),
    "left": (0.02, 0.2, 0.5),
    "p_after": (0.6, 0.002),
    "transfers": (True, False, None),
    "within": (True, False),
    "worse": ((), ("fast",), ("slow", "fast")),
    "grows": (False, True),
    "shrinks": (True, False),
    "undetermined": ((), ("viscoelastic_relaxation",)),
    "p_strained": (1.0, 1e-4),
    "unsteady": ((), ("force_drift",)),
    "p_shared": (1.0, 0.004),
}


@pytest.fixture(scope="module")
def every():
    """All combinations, each with its verdict."""
    combinations = (dict(zip(CHOICES, each, strict=True)) for each in itertools.product(*CHOICES.values()))
    made = (facts(shared=1000.0, **each) for each in combinations)
    return [(each, verdict(each)) for each in made]


def verdicts_where(every, condition):
    return {word for each, word in every if condition(each)}


def test_every_combination_of_facts_has_one_of_the_verdicts_and_a_sentence(every):
    assert {word for _, word in every} == set(VERDICTS)
    assert all(statement(word, each).endswith(".") for each, word in every)


def test_nothing_is_named_of_too_few_trials_or_of_chance(every):
    assert verdicts_where(every, lambda each: not each.enough) == {"cannot_tell"}
    chance = verdicts_where(every, lambda each: each.enough and each.p >= each.level and each.p_shared >= each.level)
    assert chance == {"no_discrepancy", "cannot_tell"}


def test_what_misses_by_more_than_the_tolerance_is_never_called_agreement(every):
    assert "no_discrepancy" not in verdicts_where(every, lambda each: not each.within)
    large = facts(effects=(), p=0.4, p_cells=0.4, within=False)
    assert verdict(large) == "cannot_tell"
    assert "more than the stated tolerance" in statement("cannot_tell", large)
    assert "too few" not in statement("cannot_tell", large)


def test_an_effect_with_which_no_gap_shrinks_and_one_grows_is_no_answer():
    found = facts(grows=True)
    assert verdict(found) == "outside_catalogue"
    assert "predicts unseen data worse" in statement("outside_catalogue", found)


def test_an_effect_that_no_held_out_condition_needs_is_conditional():
    """A tool's inertia acts in the fast presses alone, of which the slow ones tell nothing, nor need it."""
    assert verdict(facts(shrinks=False)) == "conditional"


def test_a_held_out_condition_predicted_worse_forbids_a_name_and_all_of_them_an_effect():
    one, both = facts(worse=("fast",)), facts(worse=("slow", "fast"))
    assert (verdict(one), verdict(both)) == ("partly_explained", "outside_catalogue")
    assert "fast is predicted worse" in statement("partly_explained", one)
    assert "predicts unseen data worse" in statement("outside_catalogue", both)
    unsure = facts(worse=("fast",), shrinks=False)
    assert verdict(unsure) == "outside_catalogue"
    single = facts(worse=("slow",), conditions=1, transfers=None)
    assert verdict(single) == "outside_catalogue"


def test_an_effect_of_unknown_strength_is_the_nearest_entry_only():
    unknown = facts(undetermined=("viscoelastic_relaxation",))
    assert verdict(unknown) == "outside_catalogue"
    assert "strength these data do not tell" in statement("outside_catalogue", unknown)


def test_only_one_effect_that_holds_elsewhere_and_leaves_nothing_is_named(every):
    for each, word in every:
        if word == "named":
            assert each.enough
            assert each.p < each.level
            assert each.effects
            assert not each.lookalikes
            assert each.transfers is True
            assert each.left <= 0.1 or min(each.p_after, each.p_shared) >= each.level
            assert not each.worse
            assert each.shrinks
            assert not each.undetermined
            assert not each.strained


def test_what_leaves_a_third_for_sure_is_never_an_answer(every):
    left = verdicts_where(every, lambda each: each.effects and each.left > 0.3 and each.p_after < each.level)
    assert left == {"outside_catalogue", "no_discrepancy", "cannot_tell"}


def test_an_instrument_among_the_rivals_of_tissue_asks_for_a_calibration(every):
    mixed = verdicts_where(every, lambda each: each.effects and DRIFT in each.lookalikes)
    assert mixed == {"instrument_first", "outside_catalogue", "no_discrepancy", "cannot_tell"}
    assert verdict(facts(effects=(DRIFT,), lookalikes=(BY_SLUG["tool_inertia"],))) == "lookalikes"
    assert verdict(facts(effects=(DRIFT,), lookalikes=(RELAXATION,))) == "instrument_first"


def test_the_statement_names_effects_and_rivals():
    made = facts(effects=(RELAXATION, DRIFT), lookalikes=(DRAINAGE,))
    words = statement("lookalikes", made)
    assert all(name in words for name in ("viscoelastic relaxation and force drift", "poroelastic drainage"))


def test_where_the_set_up_must_be_another_no_effect_is_called_all():
    told = facts(p_strained=1e-4)
    assert verdict(told) == "partly_explained"
    assert "another than was told" in statement("partly_explained", told)
    assert verdict(facts(p_strained=0.01)) == "named"
    assert verdict(facts(p_strained=1e-4, transfers=None)) == "partly_explained"


def test_an_instrument_that_differs_between_conditions_and_leaves_something_is_no_answer():
    drift = facts(effects=(DRIFT,), unsteady=("force_drift",), transfers=False)
    assert verdict(drift) == "conditional"
    left = facts(effects=(DRIFT,), unsteady=("force_drift",), transfers=False, left=0.2, p_after=0.002)
    assert verdict(left) == "outside_catalogue"
    assert "another instrument in each condition" in statement("outside_catalogue", left)
    assert verdict(facts(effects=(DRIFT,), left=0.2, p_after=0.002)) == "partly_explained"


def test_a_set_up_that_is_not_as_told_is_said_apart_from_what_the_model_lacks():
    clamp = setup_entry("support.clamp", 1.0, choice=True)
    alone = statement("named", facts(effects=(clamp,)))
    both = statement("named", facts(effects=(clamp, BY_SLUG["pretension"])))
    assert alone.startswith("The set-up is not as told (support.clamp): it holds")
    assert both.startswith("The set-up is not as told (support.clamp), and the model lacks pretension:")
    assert verdict(facts(effects=(clamp,), lookalikes=(BY_SLUG["pretension"],))) == "instrument_first"


def test_a_misfit_that_is_less_than_finite_elements_are_right_to_is_no_disagreement():
    sure = {"effects": (), "p": 1e-9, "p_cells": 1e-9}
    assert verdict(facts(**sure)) == "outside_catalogue"
    tiny = facts(**sure, tiny=True)
    assert verdict(tiny) == "no_discrepancy"
    assert "less than 0.25 % of the force" in statement("no_discrepancy", tiny)
    assert verdict(facts(**sure, tiny=True, within=False)) == "cannot_tell"
    assert verdict(facts(tiny=True)) == "named"
    assert "No disagreement" in statement("no_discrepancy", facts(effects=(), p=0.4, p_cells=0.4, tiny=True))
