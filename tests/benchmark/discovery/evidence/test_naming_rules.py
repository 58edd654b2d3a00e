"""Which candidates are accepted, which are equals, look-alikes or needless: each rule on numbers that decide it."""

from collections import defaultdict
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.criteria import Settings
from benchmark.discovery.evidence import further_effect, parameter_evidence, selection
from benchmark.discovery.evidence.gains import Gain, Scored
from benchmark.discovery.evidence.parameter_evidence import (
    adds_force,
    at_bounds,
    by_condition,
    constant,
    determined,
    moved_far,
    seen,
    strength_told,
    terms_told,
    told_parameters,
    undetermined,
    unsteady,
)
from benchmark.discovery.evidence.shortlist import Screened
from benchmark.physics.description import EffectParameter

SETTINGS = Settings()


@pytest.fixture(autouse=True)
def _fine(monkeypatch):
    """Derivatives that are given here by hand are as fine as they can be."""
    monkeypatch.setattr(parameter_evidence, "finely", lambda fit: fit)


def effect(slug, parameters=1, richer=None, acts_on="body"):
    description = SimpleNamespace(acts_on=acts_on, parameters=())
    names = ("p",) * parameters
    made = SimpleNamespace(slug=slug, names=names, richer=richer, description=description, seen_by="")
    made.like_delay, made.in_depth, made.acts_within = False, "", None
    made.further_terms_of, made.forms = "", (made,) if richer is None else (made, *richer.forms)
    return made


def fitted(*effects, density=0.0, objective=0.0, conditions=(0,) * 8):
    """A fit with held-out densities (R,) given, in the place of one that was computed."""
    trials = tuple(SimpleNamespace(condition=number) for number in conditions)
    model = SimpleNamespace(effects=tuple(effects), problem=SimpleNamespace(trials=trials))
    spread = np.broadcast_to(np.asarray(density, dtype=float), (len(trials),))
    return SimpleNamespace(model=model, density=spread, objective=objective)


def scored(slug, mean, z=9.0, bic=-50.0, each=None, **changes):
    values = np.full(8, mean) if each is None else np.asarray(each, dtype=float)
    made = fitted(effect(slug, **changes), density=values)
    return Scored(made, slug, Gain(values, mean, 1.0, z), None, bic, fitted())


def known_where(monkeypatch, rule):
    """Strengths are known where a rule of fit and effect says so."""
    monkeypatch.setattr(selection, "strength_told", rule)


@pytest.fixture(autouse=True)
def all_determined(monkeypatch):
    known_where(monkeypatch, lambda fit, effect, names=(): "vague" not in effect.slug)
    monkeypatch.setattr(selection, "told_parameters", lambda fit, effect: len(effect.names))
    monkeypatch.setattr(parameter_evidence, "material", lambda fit, effect: True)


@pytest.fixture
def known_densities(monkeypatch):
    for module in (selection, further_effect):
        monkeypatch.setattr(module, "held_out", lambda fit: fit.density)
    monkeypatch.setattr(selection, "foretold", lambda fits, _: [fit.density for fit in fits])
    monkeypatch.setattr(selection, "within_tolerance", lambda fit: True)


class Work:
    """Fits looked up by the slugs of their effects."""

    map = staticmethod(map)

    def __init__(self, *fits):
        self.by_slugs = {tuple(each.slug for each in fit.model.effects): fit for fit in fits}

    def fits(self, stage, jobs):
        return [self.by_slugs[(*(each.slug for each in base.model.effects), added.slug)] for base, added in jobs]


@pytest.mark.parametrize(
    ("z", "bic", "each", "expected"),
    [
        (3.0, -4.1, None, True),
        (2.99, -4.1, [1.0] * 8, False),
        (3.0, -4.0, None, False),
        (0.5, -4.1, [5.0, 4.0, 5.0, 0, 0, 0, 0, 90.0], True),  # 14 without the best trial
        (0.5, -4.1, [2.0, 2.0, 3.0, 0, 0, 0, 0, 90.0], False),  # 7 without it
        (0.5, -4.1, [5.0, 4.0, 7.0, -3.0, 0, 0, 0, 90.0], True),  # 13, and 3 are lost
        (0.5, -4.1, [5.0, 4.0, 5.0, -3.0, 0, 0, 0, 90.0], True),  # one may lose, as one with a spike does
        (0.5, -4.1, [5.0, 4.0, 5.0, -3.0, -3.0, 0, 0, 90.0], False),  # others lose over a quarter
    ],
)
def test_an_effect_needs_evidence_over_trials_and_bic(z, bic, each, expected):
    assert selection._evident(scored("a", 5.0, z, bic, each), [], SETTINGS) is expected


@pytest.mark.parametrize(
    ("before", "instead", "beside", "expected"),
    [
        ("a", 18.0, 24.0, True),
        ("a", 20.5, 24.0, True),  # hardly worse than another form of the first one
        ("a", 23.0, 29.0, False),  # surely worse
        ("a", 23.0, 34.0, True),  # but most of what it gains is its own
        ("a", 18.0, 18.5, False),  # nothing is left for it beside another form
        ("a", 12.0, 12.5, None),  # but it foretells surely better than that form
        ("setup.top.thickness", 30.0, 30.0, True),  # whose form is the finite elements'
    ],
)
def test_a_further_effect_must_be_more_than_what_the_form_of_the_first_misses(
    before, instead, beside, expected, monkeypatch, known_densities
):
    a, b = effect(before), effect("b")
    under, made = fitted(a), fitted(a, b, density=20.0)
    more = Scored(made, "b", Gain(np.full(8, 20.0), 20.0, 1.0, 9.0), None, -50.0, under)
    scatter, asked = np.array([2.0, -2.0] * 4), []

    def bent(fit, forms):
        asked.append((fit, forms))
        return fitted(*fit.model.effects, density=beside if fit is made else instead + scatter)

    monkeypatch.setattr(further_effect, "bent", bent)
    assert further_effect.further(under, [more, more], SETTINGS) == ([] if expected is False else [more, more])
    once_a_round = [(under, ["a"])] + [(made, ["a"])] * (0 if expected is None else 2)
    assert asked == ([] if "." in before else once_a_round)


@pytest.mark.parametrize(
    ("gained", "instead", "accepted"),
    [
        (20.0, 23.0, False),  # no more than the form of the first may miss
        (20.1, 23.0, True),
        (20.0, 12.0, True),  # but it foretells surely better than that form
    ],
)
def test_what_gains_no_more_than_a_form_may_miss_must_foretell_better_than_it(
    gained, instead, accepted, monkeypatch, known_densities
):
    a, b = effect("a"), effect("b")
    under, made = fitted(a), fitted(a, b, density=20.0)
    more = Scored(made, "b", Gain(np.full(8, gained), gained, 1.0, 9.0), None, -50.0, under)
    beside = {True: 34.0, False: instead + np.array([2.0, -2.0] * 4)}
    monkeypatch.setattr(
        further_effect, "bent", lambda fit, forms: fitted(*fit.model.effects, density=beside[fit is made])
    )
    assert further_effect.further(under, [more], SETTINGS, within=20.0) == ([more] if accepted else [])


@pytest.mark.parametrize(
    ("each", "kept", "refitted", "agrees", "expected"),
    [
        ([9.0] * 8, 2.7, 0.0, False, True),
        ([9.0] * 8, 2.6, 2.6, True, False),  # the other condition gains nothing: what the first effect's form misses
        ([9.0] * 8, -50.0, 2.7, True, True),  # so it seemed, to first order
        ([18.0] * 4 + [1.9] * 4, 0.0, 0.0, True, True),  # one condition has over nine tenths: the other cannot tell
        ([18.0] * 4 + [1.9] * 4, 0.0, 0.0, False, False),  # but it does
        ([18.0] * 4 + [2.1] * 4, 0.0, 0.0, True, False),
    ],
)
def test_a_further_effect_must_carry_over_to_a_condition_that_is_not_fitted(
    each, kept, refitted, agrees, expected, monkeypatch
):
    made = scored("b", float(np.mean(each)), each=each)
    made.fit.model.problem.trials = tuple(SimpleNamespace(condition=number) for number in (0,) * 4 + (1,) * 4)
    moved = replace(made, transfer=Gain(np.full(8, kept), kept, 1.0, 9.0))
    monkeypatch.setattr(further_effect, "steady", lambda fit, slug: agrees)
    densities = {id(moved.fit): np.full(8, refitted), id(moved.under): np.zeros(8)}
    monkeypatch.setattr(further_effect, "refitted_conditions", lambda fit: densities[id(fit)])
    assert further_effect.carries_over(moved) is expected


@pytest.mark.parametrize(("kept", "chosen", "withheld"), [(30.0, ["a", "b"], ()), (1.0, ["a"], ("b",))])
def test_a_further_effect_that_does_not_carry_over_is_withheld(monkeypatch, known_densities, kept, chosen, withheld):
    a, b, groups = effect("a"), effect("b"), (0,) * 4 + (1,) * 4
    one, other = fitted(a, density=100.0, conditions=groups), fitted(b, density=9.0, conditions=groups)
    both = fitted(a, b, density=130.0, objective=-9.0, conditions=groups)
    gain = Gain(np.full(8, 30.0), 30.0, 1.0, 9.0)
    second = Scored(both, "b", gain, Gain(np.full(8, kept), kept, 1.0, 9.0), -50.0, one)
    first = Scored(one, "a", Gain(np.full(8, 100.0), 100.0, 1.0, 9.0), None, -50.0, fitted())
    monkeypatch.setattr(selection, "usable", lambda base, effect: True)
    ranked = [Screened(each, 9.0, np.zeros((1, 8))) for each in (a, b)]
    asked = []
    monkeypatch.setattr(
        further_effect, "beats_bent", lambda scored, settings, instead, within: asked.append(within) or True
    )
    monkeypatch.setattr(further_effect, "bent", lambda fit, forms: fit)
    monkeypatch.setattr(selection, "_as_further_terms", lambda base, fit, *_: (fit, {"a": (fitted(a, effect("c")),)}))
    monkeypatch.setattr(further_effect, "refitted_conditions", lambda fit: np.full(8, kept if fit is both else 0.0))
    monkeypatch.setattr(
        selection, "screen", lambda fit, rest: tuple(r for r in ranked if r.effect in rest) if rest else ()
    )
    monkeypatch.setattr(
        selection, "score", lambda fit, fits, _: [] if not fits else [second] if fit.model.effects else [first]
    )
    found = selection.select(
        fitted(conditions=groups), [a, b], replace(SETTINGS, most_effects=2), Work(one, other, both, fitted(b, a))
    )
    assert [each.slug for each in found.chosen.model.effects] == chosen
    assert tuple(each.slug for each in found.withheld) == withheld
    assert asked == [pytest.approx(0.09 * 100.0)] * len(asked)
    assert found.lookalikes["a"][0] == "c"
    assert found.rivals["a"][0].model.effects[-1].slug == "c"


def test_of_equals_the_simplest_is_taken_then_the_first_of_the_catalogue():
    catalogue = [effect("two", 2), effect("first"), effect("second")]
    best = scored("two", 10.0, parameters=2)
    assert selection._simplest([best, scored("second", 9.71), scored("first", 9.7)], catalogue).slug == "first"
    assert selection._simplest([best, scored("second", 9.71), scored("first", 9.69)], catalogue).slug == "second"
    assert selection._simplest([best, scored("first", 9.69)], catalogue).slug == "two"


def test_of_equals_of_as_many_terms_the_form_that_may_have_fewer_is_taken(monkeypatch):
    monkeypatch.setattr(selection, "told_parameters", lambda fit, effect: 1)
    catalogue = [effect("damping", 4), effect("latency", 1)]
    tied = [scored("damping", 10.0, parameters=4), scored("latency", 9.9)]
    assert selection._simplest(tied, catalogue).slug == "latency"
    assert selection._simplest([tied[0], scored("latency", 9.6)], catalogue).slug == "damping"


def test_where_no_form_is_within_the_tolerance_half_the_gain_makes_a_lookalike(monkeypatch, known_densities):
    base, best, other = fitted(), scored("best", 10.0), scored("other", 6.0)
    rounds = [[best, other]]

    def alike():
        return selection._in_place(base, best.fit, best.fit.model.effects[0], rounds, SETTINGS, Work())[1]

    assert alike() == ()
    monkeypatch.setattr(selection, "within_tolerance", lambda fit: False)
    assert alike() == (other.fit,)


def test_two_candidates_are_always_fitted_and_more_where_they_promise_something():
    ranked = [
        Screened(effect(name), won, np.zeros((1, 8))) for name, won in zip("abcd", (100.0, 0.1, 2.1, 1.9), strict=True)
    ]
    assert [each.effect.slug for each in selection._promising(ranked, 7)] == ["a", "b", "c"]
    assert [each.effect.slug for each in selection._promising(ranked, 2)] == ["a", "b"]


@pytest.mark.parametrize(("bic", "kept"), [(-56.1, "richer"), (-55.9, "plain")])
def test_one_more_term_only_where_bic_prefers_it_clearly(monkeypatch, bic, kept):
    richer = effect("memory", 4)
    plain = scored("memory", 10.0, richer=richer)
    rich = scored("memory", 12.0, bic=bic)
    monkeypatch.setattr(selection, "score", lambda current, fits, _: [rich] if fits else [])
    (chosen,) = selection._enriched(fitted(), [plain], Work(fitted(richer)))
    assert chosen is (rich if kept == "richer" else plain)


@pytest.mark.parametrize(
    ("of_plain", "of_richer", "kept"), [(True, True, 4), (True, False, 2), (False, False, 4), (False, True, 4)]
)
def test_no_further_term_takes_the_strength_from_an_effect(monkeypatch, of_plain, of_richer, kept):
    richer = effect("memory", 4)
    plain, rich = scored("memory", 10.0, richer=richer), scored("memory", 12.0, bic=-90.0)
    rich.fit.model.effects[-1].names = ("",) * 4
    told = {id(plain.fit): of_plain, id(rich.fit): of_richer}
    monkeypatch.setattr(selection, "score", lambda current, fits, _: [rich] if fits else [])
    monkeypatch.setattr(selection, "strength_told", lambda fit, _: told[id(fit)])
    (chosen,) = selection._enriched(fitted(), [plain], Work(fitted(richer)))
    assert chosen is (rich if kept == 4 else plain)


def test_no_further_term_is_tried_of_what_gains_little(monkeypatch):
    asked = []
    monkeypatch.setattr(selection, "score", lambda current, fits, _: asked.append(fits) or [])
    low = scored("low", 2.9, richer=effect("low", 3))
    unsure = scored("unsure", 9.0, z=1.9, richer=effect("unsure", 3))
    selection._enriched(fitted(), [scored("best", 10.0), unsure, low], Work())
    assert asked == [[]]


def test_a_further_term_is_tried_of_the_best_that_may_have_one(monkeypatch):
    monkeypatch.setattr(selection, "score", lambda current, fits, _: [])
    monkeypatch.setattr(selection, "terms_told", lambda fit, plain: True)
    tried = []

    def fits(stage, jobs):
        tried.extend(added.slug for _, added in jobs)
        return [fitted(added) for _, added in jobs]

    without = [scored(f"plain_{k}", 10.0) for k in range(4)]
    withs = [scored(f"may_{k}", 9.0 - k, richer=effect(f"may_{k}", 3)) for k in range(4)]
    selection._enriched(fitted(), [*without, *withs], SimpleNamespace(fits=fits, map=map))
    assert tried == ["may_0", "may_1", "may_2"]


def test_a_rival_is_a_lookalike_within_two_errors_or_a_tenth_of_the_gain(known_densities):
    wave = np.array([1.0, -1.0] * 4)
    chosen = fitted(effect("true"), density=100.0)
    rivals = [
        scored("near", 0.0, each=np.full(8, 91.0)),  # lacks 9 %
        scored("unsure", 0.0, each=60.0 - 90.0 * wave),  # lacks 40 %, but not in every trial
        scored("far", 0.0, each=np.full(8, 89.0)),  # lacks 11 %
    ]
    slug, fits, own = selection._in_place(fitted(), chosen, chosen.model.effects[0], [rivals], SETTINGS, Work())
    assert (slug, own.mean) == ("true", 100.0)
    assert [fit.model.effects[-1].slug for fit in fits] == ["near", "unsure"]


def test_a_rival_of_a_second_effect_is_measured_against_what_that_gains_itself(known_densities):
    large, small = effect("large"), effect("small")
    both = fitted(large, small, density=100.0)
    without_small, without_large = fitted(large, density=90.0), fitted(small, density=5.0)
    rivals = [scored("rival", 0.0, each=np.full(8, 50.0))]
    rivals[0].fit.model.effects[-1].slug = "rival"
    beside = fitted(large, rivals[0].fit.model.effects[-1], density=95.0)  # lacks half of what the small one gains
    in_large = fitted(small, rivals[0].fit.model.effects[-1], density=40.0)
    work = Work(without_small, without_large, fitted(large), fitted(small), beside, in_large)
    work.by_slugs[("large",)], work.by_slugs[("small",)] = without_small, without_large
    _, fits, own = selection._in_place(fitted(), both, small, [rivals], SETTINGS, work)
    assert (own.mean, fits) == (10.0, ())  # 5 of 100 in all would have been a look-alike
    assert selection._in_place(fitted(), both, large, [rivals], SETTINGS, work)[2].mean == 95.0


@pytest.mark.parametrize(("acts_on", "alike"), [("observation", True), ("body", False)])
def test_an_instrument_must_beat_the_tissue_by_more(known_densities, acts_on, alike):
    chosen = fitted(effect("chosen", acts_on=acts_on), density=100.0)
    rivals = [scored("tissue", 0.0, each=np.full(8, 80.0))]  # lacks a fifth
    _, fits, _ = selection._in_place(fitted(), chosen, chosen.model.effects[0], [rivals], SETTINGS, Work())
    assert bool(fits) is alike


def test_of_equals_one_of_known_strength_is_taken_and_no_further_one_of_unknown_strength():
    catalogue = [effect("vague"), effect("clear", 3)]
    assert selection._simplest([scored("vague", 10.0), scored("clear", 9.8, parameters=3)], catalogue).slug == "clear"
    assert selection._simplest([scored("vague", 10.0), scored("clear", 9.6, parameters=3)], catalogue).slug == "vague"
    assert not selection._evident(scored("vague", 9.0), [scored("first", 10.0)], SETTINGS)
    assert selection._evident(scored("vague", 9.0), [], SETTINGS)  # the verdict then names it nearest only


def told(current, catalogue, work):
    return selection._told(fitted(), current, catalogue, SETTINGS, work)


def test_a_further_effect_of_unknown_strength_is_dropped():
    clear, vague = effect("clear"), effect("vague")
    both, alone = fitted(clear, vague), fitted(clear)
    assert told(both, [clear, vague], Work(alone)) is alone
    assert told(alone, [clear, vague], Work()) is alone


def test_the_last_effect_goes_where_it_makes_an_earlier_one_unknown(monkeypatch):
    first, second, third = effect("first"), effect("second"), effect("third")
    known_where(monkeypatch, lambda fit, each, names=(): each is not second or third not in fit.model.effects)
    three, two, one = fitted(first, second, third), fitted(first, second), fitted(first)
    assert told(three, [first, second, third], Work(one, two)) is two


@pytest.mark.parametrize(
    ("simpler", "clear", "kept"),
    [(8.0, True, True), (0.1, True, False), (8.0, False, False)],  # density above that without the last effect
)
def test_a_further_term_goes_before_an_effect_beside_which_it_is_not_told(
    known_densities, monkeypatch, simpler, clear, kept
):
    plain, rich, last = effect("first"), effect("first", 2), effect("last")
    known_where(monkeypatch, lambda fit, each, names=(): each is not rich and (clear or each is not plain))
    both, alone = fitted(rich, last, density=9.0), fitted(rich, density=1.0)
    less = fitted(plain, last, density=1.0 + simpler + np.array([1.0, -1.0] * 4))
    assert told(both, [plain, last], Work(alone, less)) is (less if kept else alone)


def test_of_effects_that_one_trial_speaks_against_by_more_than_all_gain_one_is_still_the_best():
    odd = scored("a", -1.0, each=[4.0] * 7 + [-36.0])
    assert selection._simplest([odd], [odd.fit.model.effects[-1]]) is odd


def test_an_effect_that_another_makes_needless_is_dropped(known_densities, monkeypatch):
    monkeypatch.setattr(further_effect, "bent", lambda fit, forms: fit)
    a, b = effect("a"), effect("b")
    both = fitted(a, b, density=10.0, objective=50.0)
    same = fitted(b, density=10.0, objective=50.5)
    assert selection._pruned(fitted(), both, SETTINGS, Work(same)) == (same, ())
    worse = fitted(b, density=2.0, objective=90.0)
    assert selection._pruned(fitted(), both, SETTINGS, Work(worse)) == (both, ())


def test_an_effect_accepted_by_all_trials_but_the_best_is_not_dropped_for_its_scatter(known_densities, monkeypatch):
    """An inertia that shows in the fast presses alone, of which one speaks against it (session 47007)."""
    monkeypatch.setattr(further_effect, "bent", lambda fit, forms: fit)
    gained = np.array([1.0, 1.0, 1.4, -0.3, 39.0, -13.3, 37.6, 40.9])
    both, alone = fitted(effect("a"), effect("b"), density=gained, objective=50.0), fitted(effect("b"), objective=140.0)
    (own,) = selection._owns(fitted(), both, Work(alone))
    assert own.gain.z < SETTINGS.accept_z
    assert selection._pruned(fitted(), both, SETTINGS, Work(alone)) == (both, ())
    carried = fitted(effect("a"), effect("b"), density=np.where(gained < 40.0, 0.0, gained), objective=50.0)
    assert selection._pruned(fitted(), carried, SETTINGS, Work(alone)) == (alone, ())


@pytest.mark.parametrize(("loose", "beside", "dropped"), [(20.0, 20.5, True), (20.0, 26.0, False), (9.0, 9.5, False)])
def test_an_effect_that_is_another_form_of_a_later_one_is_withheld(
    known_densities, monkeypatch, loose, beside, dropped
):
    """`loose` and `beside` foretell trials with the later one's form bent, without and with the first one."""
    first, later = effect("first"), effect("later")
    both, alone = fitted(first, later, density=10.0, objective=50.0), fitted(later, density=2.0, objective=90.0)
    monkeypatch.setattr(further_effect, "bent", lambda fit, forms: fitted(density=beside if fit is both else loose))
    kept, forms = selection._pruned(fitted(), both, SETTINGS, Work(alone))
    assert kept is (alone if dropped else both)
    assert [each.slug for each in forms] == ["first"] * dropped


def test_what_could_have_gone_as_another_form_and_stays_is_not_withheld(known_densities, monkeypatch):
    """Of two that are other forms the one goes that is missed least; beside what is left the other is its own."""
    first, second, third = effect("first"), effect("second"), effect("third")
    three = fitted(first, second, third, density=10.0, objective=50.0)
    kept, dear = fitted(second, third, density=2.0, objective=60.0), fitted(first, third, density=2.0, objective=90.0)
    last = fitted(third, density=0.0, objective=200.0)
    loose = {id(kept): 20.0, id(dear): 20.0, id(last): 0.0}
    monkeypatch.setattr(further_effect, "bent", lambda fit, forms: fitted(density=loose.get(id(fit), 20.0)))
    found, forms = selection._pruned(fitted(), three, SETTINGS, Work(fitted(first), fitted(second), kept, dear, last))
    assert found is kept
    assert [each.slug for each in forms] == ["first"]


@pytest.fixture
def swap(monkeypatch, known_densities):
    """Whether a rival of this density (trial by trial) comes in beside b, if what it must pass lets it."""

    def made(density, **passes):
        a, b, rival = effect("a"), effect("b"), effect("rival")
        both, other = fitted(a, b, density=10.0), fitted(b, rival, density=density)
        work = Work(fitted(a), fitted(b), other, fitted(a, rival, density=1.0))
        rounds = [[scored("a", 8.0), scored("rival", 7.0)]]
        rounds[0][1].fit.model.effects[-1].slug = "rival"
        monkeypatch.setattr(
            selection,
            "score",
            lambda under, fits, _: [replace(scored("rival", 1.0), fit=fit, under=under) for fit in fits],
        )
        monkeypatch.setattr(selection, "carries_over", lambda each: passes.get("carries", True))
        monkeypatch.setattr(selection, "beats_bent", lambda each, settings: passes.get("beats", True))
        return selection._swapped(fitted(), both, rounds, SETTINGS, work) is other

    return made


@pytest.mark.parametrize(("density", "swapped"), [(10.31, True), (10.29, False)])
def test_a_swap_must_gain_more_than_a_tie(swap, density, swapped):
    assert swap(density) is swapped


@pytest.mark.parametrize("rule", ["carries", "beats"])
def test_what_would_be_withheld_does_not_come_in_by_a_swap(swap, rule):
    assert swap(20.0)
    assert not swap(20.0, **{rule: False})


def test_a_pair_may_begin_with_what_did_nearly_as_well_first(monkeypatch, known_densities):
    names = ("both", "one", "poor", "other", "rest")
    found = {name: effect(name) for name in names}
    gains = {"both": 10.0, "one": 9.0, "poor": 4.0}
    rounds = [[scored(name, gained) for name, gained in gains.items()], [scored("other", 1.0), scored("rest", 1.0)]]
    for each in (*rounds[0], *rounds[1]):
        object.__setattr__(each, "fit", fitted(found[each.slug], density=5.0, objective=100.0))
    begun = []

    def one_step(fit, effects):
        begun.append(fit.model.effects[0].slug)
        return tuple(SimpleNamespace(effect=each, won={"other": 30.0}.get(each.slug, 1.0)) for each in effects[::-1])

    monkeypatch.setattr(selection, "screen", lambda fit, effects: tuple(sorted(one_step(fit, effects), key=_won)))
    base, current = fitted(objective=200.0), fitted(found["both"], found["rest"], density=10.0)
    ((under, incoming),) = selection._other_pairs(base, current, rounds, setup_alone=False)
    assert begun == ["one"]  # the one taken is not begun with again, nor one that gains less than half
    assert (under.model.effects, incoming) == ((found["one"],), [found["other"]])
    monkeypatch.setattr(selection, "carries_over", lambda each: True)
    monkeypatch.setattr(selection, "beats_bent", lambda each, settings: True)
    monkeypatch.setattr(
        selection, "score", lambda under, fits, _: [replace(scored("x", 1.0), fit=fit, under=under) for fit in fits]
    )
    better = fitted(found["one"], found["other"], density=12.0)
    work = Work()
    work.by_slugs = defaultdict(lambda: fitted(found["rest"], density=1.0), {("one", "other"): better})
    assert selection._swapped(base, current, rounds, SETTINGS, work) is better


@pytest.mark.parametrize(
    ("top", "start", "density", "expected"),
    [
        ("setup.hole", "setup.clamp", 14.0, True),
        ("setup.hole", "setup.clamp", 10.0, False),  # no better, trial by trial
        ("setup.hole", "effect", 14.0, False),  # a pair without an entry of the set-up
        ("effect", "setup.clamp", 14.0, False),  # an effect alone stays, whose form is not the true one
    ],
)
def test_a_pair_takes_the_place_of_a_set_up_entry_alone(top, start, density, expected, monkeypatch, known_densities):
    one, other, second = effect(top), effect(start), effect("second")
    rounds = [[scored(top, 10.0), scored(start, 9.0), scored("second", 1.0)]]
    for each, whole in zip(rounds[0], (one, other, second), strict=True):
        object.__setattr__(each, "fit", fitted(whole, density=9.0))
    monkeypatch.setattr(
        selection, "screen", lambda fit, effects: tuple(SimpleNamespace(effect=e, won=9.0) for e in effects)
    )
    monkeypatch.setattr(selection, "score", lambda under, fits, _: [replace(scored("x", 1.0), fit=f) for f in fits])
    monkeypatch.setattr(selection, "carries_over", lambda each: True)
    monkeypatch.setattr(selection, "beats_bent", lambda each, settings: True)
    current, pair = fitted(one, density=10.0), fitted(other, second, density=density)
    found = selection._swapped(fitted(), current, rounds, SETTINGS, Work(pair))
    assert (found is pair) is expected
    assert expected or found is current


def test_set_up_entries_are_looked_for_beyond_better_effects(monkeypatch):
    names = ("setup.hole", "a", "b", "c", "d", "setup.clamp")
    rounds = [[scored(name, 10.0 - 0.9 * number) for number, name in enumerate(names)]]
    monkeypatch.setattr(selection, "screen", lambda fit, effects: (SimpleNamespace(effect=effects[0], won=1.0),))
    current = fitted(effect("setup.hole"))
    begun = {
        alone: [
            under.model.effects[0].slug
            for under, _ in selection._other_pairs(fitted(), current, rounds, setup_alone=alone)
        ]
        for alone in (True, False)
    }
    assert begun == {True: ["setup.clamp"], False: ["a", "b"]}


def _won(screened):
    return -screened.won


class Linear:
    """A fit whose conditions each tell of one parameter: values by condition, all of the same weight."""

    def __init__(self, values, weight, logarithmic=False):
        low, high = (1e-9, 1e9) if logarithmic else (-1e9, 1e9)
        parameter = EffectParameter("size", "N", (1.0,), low, high, logarithmic, "size")
        self.values = np.asarray(values, dtype=float)
        self.vector = np.array([self.values.mean()])
        self.precision = np.array([1e-12])
        self.blocks = SimpleNamespace(matrix=np.full((len(values), 1, 1), float(weight)))
        self.model = SimpleNamespace(
            effects=("one",),
            shape_count=0,
            parameters=(("one", parameter),),
            problem=SimpleNamespace(
                trials=tuple(SimpleNamespace(condition=k) for k in range(len(values))),
                study=SimpleNamespace(conditions=[SimpleNamespace(name=f"c{k}") for k in range(len(values))]),
            ),
        )

    def without(self, trials):
        return np.array([self.values[~trials].mean()])


@pytest.mark.parametrize(("acts_on", "values", "expected"), [
    ("observation", (10.0, 30.0), ("one",)),
    ("observation", (10.0, 16.0), ()),
    ("body", (10.0, 30.0), ()),  # a tissue's form may be another than the textbook's
])  # fmt: skip
def test_an_instrument_is_the_same_in_every_condition(acts_on, values, expected):
    made = Linear(values, 1e6)
    made.model.effects = (effect("one", acts_on=acts_on),)
    assert unsteady(made) == expected


@pytest.mark.parametrize(
    ("values", "weight", "logarithmic", "expected"),
    [
        ((10.0, 16.0), 1e6, False, True),  # 3 of 13 off: 23 %
        ((10.0, 30.0), 1e6, False, False),  # 50 %
        ((10.0, 30.0), 0.05, False, True),  # but within three standard errors of 4.5
        ((0.0, 1.3), 1e6, True, True),  # a factor of 1.9 off the joint value
        ((0.0, 1.5), 1e6, True, False),  # of 2.1
    ],
)
def test_parameters_agree_between_conditions_by_error_or_share(values, weight, logarithmic, expected):
    made = Linear(values, weight, logarithmic)
    assert constant(made) is expected
    told = [each for _, each in by_condition(made)]
    assert [each.condition for each in told] == ["c0", "c1"]
    shown = np.exp(values) if logarithmic else values
    np.testing.assert_allclose([each.value for each in told], shown)
    assert all(each.ci95[0] < each.value < each.ci95[1] for each in told)


class Told:
    """A fit of one effect with strengths (k,), their covariance, and trials that scatter as it says."""

    def __init__(self, values, variance, *parameters):
        self.vector, self.covariance = np.asarray(values, dtype=float), np.diag(np.asarray(variance, dtype=float))
        self.blocks = SimpleNamespace(slope=np.zeros((6, len(values))))
        self.precision = np.zeros(len(values))
        self.model = SimpleNamespace(
            shape_count=0,
            parameters=tuple(("one", p) for p in parameters),
            values=lambda vector: {"one": {p.name: v for p, v in zip(parameters, values, strict=True)}},
        )


def strong(amplitude, amplitudes=(), form=(), **more):
    named = {"slug": "one", "amplitude": amplitude, "amplitudes": amplitudes, "form": form, "like_delay": False}
    named |= {"in_depth": "", "acts_within": None}
    return SimpleNamespace(**named, **more)


SHARE = EffectParameter("share", "", (0.2,), 0.0, 0.95, False, "share")
WHOLE = EffectParameter("part", "", (0.2,), 0.0, 1.0, False, "share that may be whole")
FORCE = EffectParameter("force", "N", (1.0,), 0.0, 100.0, False, "force")
LIMIT = EffectParameter("limit", "N", (1.0,), 1e-3, 1e3, True, "limit")


@pytest.mark.parametrize(
    ("values", "variance", "parameters", "expected"),
    [
        ((0.3,), (0.01,), (SHARE,), True),  # three standard errors off none
        ((0.08,), (0.002,), (SHARE,), False),  # [0, 0.17]: the second term that the phantom was given
        ((0.949,), (1e-6,), (SHARE,), False),  # at its bound
        ((1.0,), (1e-6,), (WHOLE,), True),  # whole is no bound of a fit
        ((0.3, 5.0), (0.04, 0.01), (SHARE, FORCE), True),  # one of two is enough
        ((0.3, 5.0), (0.04, 9.0), (SHARE, FORCE), False),
        ((0.0, 5.0), (0.04, 1.0), (SHARE, FORCE), True),  # one that is not there says nothing against the other
        ((0.0,), (0.01,), (SHARE,), False),
        ((5.0,), (0.1,), (LIMIT,), True),
        ((5.0,), (16.0,), (LIMIT,), False),  # an interval over the whole range
    ],
)
def test_a_strength_is_told_where_it_is_off_its_bounds_and_off_nothing(values, variance, parameters, expected):
    one = strong(amplitude=parameters[0].name, amplitudes=tuple(p.name for p in parameters[1:]))
    assert determined(Told(values, variance, *parameters), one) is expected


GROWTH = EffectParameter("growth", "", (1.0,), 0.0, 30.0, False, "growth of the force with depth")
OTHER = EffectParameter("other", "", (0.0,), 0.0, 9.0, False, "what the base can do as well")


@pytest.mark.parametrize(
    ("growth", "linear", "told"),
    [
        (29.9, 1.0, True),  # 15 of 16 parts of the force are its own, however large it is
        (0.0, 1.0, False),
        (0.5, 1.0, False),
        (29.9, 1e4, False),
    ],
)
def test_a_strength_is_told_by_what_it_adds_to_the_force(growth, linear, told):
    one = strong(amplitude="growth", amplitudes=())
    made = Told((growth, 0.0), (300.0, 1.0), GROWTH, OTHER)
    made.nuisance, made.model.effects = None, (one,)
    made.model.bounds = (np.zeros(2), np.array([30.0, 9.0]))
    depth = np.linspace(0.0, 1.0, 5)
    made.model.signals = lambda vector, _: [(depth * (linear + vector[0] * depth))[:, None]] * 3
    assert not determined(made, one)
    assert adds_force(made, one) is told
    assert undetermined(made) == (() if told else ("one",))


WIDTH = EffectParameter("width", "", (1.0,), 0.0, 5.0, False, "how far it reaches")


@pytest.mark.parametrize(("trade", "told"), [(-0.99, True), (0.0, False)])
def test_a_share_that_trades_with_a_width_is_told_by_what_both_take_off_the_force(trade, told):
    one = strong(amplitude="share", amplitudes=())
    made = Told((0.1, 2.0), (0.06**2, 1.2**2), SHARE, WIDTH)
    made.covariance[0, 1] = made.covariance[1, 0] = trade * 0.06 * 1.2
    made.nuisance, made.model.effects = None, (one,)
    made.model.bounds = (np.zeros(2), np.array([0.95, 5.0]))
    depth = np.linspace(0.0, 1.0, 5)
    made.model.signals = lambda vector, _: [(depth * (1.0 - vector[0] * vector[1] * (1.0 - depth)))[:, None]] * 3
    assert not determined(made, one)
    assert strength_told(made, one) is told
    assert undetermined(made) == (() if told else ("one",))


REACH = EffectParameter("reach", "m", (1e-3,), 1e-5, 0.1, True, "how far a pull goes before it lets go")


def test_a_pull_that_trades_with_its_reach_is_told_where_it_lets_go_a_little_further():
    """Its reach has the error of its prior, far more than the way on which what it adds is straight."""
    one = strong(amplitude="force", amplitudes=())
    made = Told((2.0, 0.0), (5.0**2, 2.5**2), FORCE, REACH)
    made.covariance[0, 1] = made.covariance[1, 0] = 0.9999 * 5.0 * 2.5
    made.nuisance, made.model.effects = None, (one,)
    made.model.bounds = (np.array([0.0, -9.0]), np.array([100.0, 3.0]))
    depth = np.linspace(0.0, 1.0, 5)

    def signals(vector, _):
        held = vector[0] * (np.exp(-vector[1]) if vector[1] < 0.02 else 0.3)
        return [(depth * (10.0 - held * (depth == depth[2])))[:, None]] * 3

    made.model.signals = signals
    assert not determined(made, one)
    assert strength_told(made, one)


@pytest.mark.parametrize(("slug", "told"), [("stress_softening", True), ("setup.tool.contact", False)])
def test_what_a_set_up_entry_adds_does_not_tell_its_number(slug, told, monkeypatch):
    monkeypatch.setattr(parameter_evidence, "determined", lambda fit, effect: False)
    monkeypatch.setattr(parameter_evidence, "adds_force", lambda fit, effect: True)
    assert strength_told(fitted(), SimpleNamespace(slug=slug)) is told


def test_a_share_at_its_bound_is_not_told_by_what_it_adds():
    one = strong(amplitude="share", amplitudes=())
    made = Told((0.95,), (1e-6,), SHARE)
    assert not adds_force(made, one)


@pytest.mark.parametrize(
    ("between", "told", "ends"),
    [((0.9, 1.2), True, (0.9, 1.2)), ((-1.0, 1.2), False, (0.0, 1.2)), ((0.9, 200.0), True, (0.9, 100.0))],
)
def test_a_strength_without_a_slope_is_told_by_how_far_it_may_go(between, told, ends):
    """A pull at which a tool lets go between two samples: no small change of it changes anything."""
    one = strong(amplitude="force", amplitudes=())
    made = Told((1.0,), (1e4,), FORCE)
    made.precision, made.nuisance, made.model.effects = np.array([1e-4]), None, (one,)
    made.model.bounds = (np.zeros(1), np.array([100.0]))
    inside = lambda vector: between[0] < vector[0] < between[1]  # noqa: E731
    made.model.evaluated = lambda vector, _: SimpleNamespace(residuals=[np.full(6, 0.0 if inside(vector) else 1.0)] * 3)
    assert determined(made, one) is told
    [(_, estimate)] = parameter_evidence.effect_estimates(made)
    np.testing.assert_allclose(estimate.ci95, ends, rtol=0.01, atol=0.01)


def test_a_strength_is_judged_with_its_form_as_fitted():
    made = Told((2.0, 0.5), (1.5**2, 1.0), FORCE, LIMIT)
    made.covariance[0, 1] = made.covariance[1, 0] = -0.95 * 1.5
    assert not determined(made, strong(amplitude="force"))
    assert determined(made, strong(amplitude="force", form=("limit",)))


def test_a_strength_that_trades_with_one_at_none_is_told_since_that_cannot_be_less():
    one = strong(amplitude="growth", amplitudes=("force",))
    made = Told((0.0, 2.0), (1.0, 1.5**2), GROWTH, FORCE)
    assert not determined(made, one)  # 2 of 1.5 standard errors, and nothing to trade with
    made.covariance[0, 1] = made.covariance[1, 0] = -0.95 * 1.5
    assert determined(made, one)
    assert not determined(made, one, ("force",))
    free = Told((0.01, 2.0), (1.0, 1.5**2), GROWTH, FORCE)
    free.covariance = made.covariance
    assert determined(free, one)


@pytest.mark.parametrize(
    ("layout", "shown", "expected"), [(None, 0.0, True), ("grid", 0.0, False), ("grid", 0.3, True)]
)
def test_what_must_show_in_markers_shows_in_them_where_there_are_some(layout, shown, expected):
    slip = strong(amplitude="part", amplitudes=("share",), seen_by="part")
    made = Told((0.2, shown), (0.01**2, 0.05**2), SHARE, WHOLE)
    made.model.problem = SimpleNamespace(study=SimpleNamespace(layout=layout))
    assert seen(made, slip) is expected
    assert seen(made, SimpleNamespace(slug="one", seen_by="", like_delay=False, in_depth="", acts_within=None))


def test_a_slip_that_no_marker_shows_is_neither_named_nor_a_look_alike(monkeypatch, known_densities):
    monkeypatch.setattr(selection, "seen", lambda fit, effect: effect.slug != "slip")
    slip, friction = scored("slip", 6.0), scored("friction", 5.0)
    work = Work(slip.fit, friction.fit)
    assert not selection._evident(slip, [], SETTINGS)
    assert selection._evident(friction, [], SETTINGS)
    chosen = friction.fit.model.effects[0]
    _, rivals, _ = selection._in_place(fitted(), friction.fit, chosen, [[slip, friction]], SETTINGS, work)
    assert rivals == ()


def test_only_the_terms_that_the_plain_form_lacks_must_be_told():
    more = EffectParameter("more", "", (0.0,), 0.0, 9.0, False, "a second term")
    richer = strong(amplitude="growth", description=SimpleNamespace(parameters=(GROWTH, LIMIT, more)))
    made = Told((0.0, 1.0, 4.0), (1.0, 0.1, 1.0), GROWTH, LIMIT, more)
    made.model.effects = (richer,)
    assert terms_told(made, SimpleNamespace(names=("growth",)))
    assert terms_told(made, SimpleNamespace(names=("growth", "more")))
    assert not terms_told(made, SimpleNamespace(names=("more", "limit")))  # the first term is at none


def test_a_parameter_that_only_its_prior_holds_does_not_count():
    one = strong(amplitude="part", amplitudes=())
    made = Told((0.3, 0.5), (0.01, 0.999), SHARE, WHOLE)
    made.precision = np.array([1.0, 1.0])
    assert told_parameters(made, one) == 1
    made.covariance = np.diag([0.01, 0.5])
    assert told_parameters(made, one) == 2


def test_a_term_at_none_does_not_count():
    one = strong(amplitude="share", amplitudes=("part",))
    made = Told((0.3, 0.0), (0.01, 0.5), SHARE, WHOLE)
    made.precision = np.array([1.0, 1.0])
    assert told_parameters(made, one) == 1


def test_one_condition_or_no_effect_tells_nothing_of_constancy():
    assert constant(Linear((1.0,), 1.0)) is None
    bare = Linear((1.0, 2.0), 1.0)
    bare.model.effects = ()
    assert constant(bare) is None


def test_the_least_p_counts_how_many_were_tried():
    few = selection.Selection(fitted(), fitted(), (scored("a", 5.0, z=4.0, each=np.full(8, 0.1)),), (), (), {}, {})
    one = selection.Selection(few.base, few.chosen, few.steps, (scored("a", 5.0),), (), {}, {})
    ten = selection.Selection(few.base, few.chosen, few.steps, (scored("a", 5.0),) * 10, (), {}, {})
    assert selection.first_gain(ten) == pytest.approx(10.0 * selection.first_gain(one))
    assert selection.first_gain(selection.Selection(few.base, few.base, (), (), (), {}, {})) == 1.0


def test_the_rules_are_those_of_the_criteria():
    assert (criteria.TIE, criteria.FORM_OFF, criteria.CLOSE) == (0.03, 0.3, 0.1)
    assert (criteria.ACCEPT_BIC, criteria.RICHER_BIC, SETTINGS.accept_z, SETTINGS.lookalike_z) == (-4.0, -6.0, 3.0, 2.0)


@pytest.mark.parametrize(
    ("with_terms", "told", "alone"),  # of 100 with both effects, of which the flow gains 90
    [(100.0, True, True), (91.5, True, True), (89.0, True, False), (100.0, False, False)],
)
def test_a_flow_that_further_terms_stand_for_is_a_lookalike_of_them(
    with_terms, told, alone, monkeypatch, known_densities
):
    monkeypatch.setattr(selection, "terms_told", lambda fit, plain: told)
    monkeypatch.setattr(selection, "determined", lambda fit, effect: True)
    flow, memory, other = effect("flow"), effect("memory", 2, richer=effect("memory", 4)), effect("other")
    flow.further_terms_of = "memory"
    both = fitted(flow, other, memory, density=100.0)
    longer, apart = fitted(other, memory.richer, density=with_terms), fitted(other, memory, flow, density=100.0)
    known = (fitted(other), fitted(other, memory, density=10.0), longer, apart)

    class Fits:
        def fits(self, stage, jobs):
            return [self.of([*base.model.effects, added]) for base, added in jobs]

        def of(self, asked):
            return next(fit for fit in known if [*map(id, fit.model.effects)] == [*map(id, asked)])

    found = selection._as_further_terms(fitted(), both, SETTINGS, Fits())
    assert found == ((longer, {"memory": (apart,)}) if alone else (both, {}))


@pytest.mark.parametrize(
    ("told", "stay"),
    [
        ({"flow", "memory"}, ["other", "flow", "memory"]),
        ({"memory"}, ["other", "memory"]),
        ({"flow"}, ["other", "flow"]),
    ],
)
def test_of_a_memory_and_a_flow_beside_it_each_must_be_told_by_itself(told, stay, monkeypatch, known_densities):
    """What the one adds to the force may be what the other's form misses, however surely it adds it."""
    monkeypatch.setattr(selection, "determined", lambda fit, effect: effect.slug in told)
    monkeypatch.setattr(selection, "strength_told", lambda fit, effect: True)
    flow, memory, other = effect("flow"), effect("memory", 2), effect("other")
    flow.further_terms_of, memory.forms = "memory", (memory,)
    both = fitted(other, flow, memory, density=100.0)
    work = Work(fitted(other), fitted(other, memory), fitted(other, flow))
    found, apart = selection._as_further_terms(fitted(), both, SETTINGS, work)
    assert ([each.slug for each in found.model.effects], apart) == (stay, {})


def test_effects_that_are_no_terms_of_each_other_stay(known_densities):
    both = fitted(effect("flow"), effect("memory", 2, richer=effect("memory", 4)), density=100.0)
    assert selection._as_further_terms(fitted(), both, SETTINGS, Work()) == (both, {})


@pytest.mark.parametrize(
    ("value", "logarithmic", "said"),
    [(30.0, False, True), (29.0, False, False), (0.1, False, False), (0.1, True, True)],
)
def test_parameters_as_large_as_they_may_be_are_told_of(value, logarithmic, said):
    """A stiffening stood at both of its ends, beside a confidence of 0.91 and without a word."""
    parameter = EffectParameter("b_1", "", (1.0,), 0.1, 30.0, logarithmic, "steepness")
    model = SimpleNamespace(
        values=lambda _: {"strain_stiffening": {"b_1": value}}, parameters=(("strain_stiffening", parameter),)
    )
    found = at_bounds(SimpleNamespace(model=model, vector=np.zeros(1)))
    said_of = f"strain stiffening stands at the end of what its parameters may be (b_1 = {value:.4g})"
    assert [said_of in each for each in found] == [True] * said


@pytest.mark.parametrize(("change", "effects", "said"), [(0.214, 1, True), (0.04, 1, False), (0.214, 0, False)])
def test_a_set_up_that_moved_far_beside_an_effect_is_warned_of(change, effects, said):
    problem = SimpleNamespace(shapes=("modulus", "support.hole_radius", "bend"), setup={"support.hole_radius": 0.01})
    model = SimpleNamespace(problem=problem, effects=("pretension",) * effects)
    found = moved_far(SimpleNamespace(model=model, vector=np.array([3.0, change, 1.0]), prior_mean=np.zeros(3)))
    assert [all(part in each for part in ("support.hole_radius by +21 %", "21 standard")) for each in found] == [
        True
    ] * said


def test_a_modulus_that_moved_far_is_told_by_its_share_though_its_logarithm_is_fitted():
    problem = SimpleNamespace(shapes=("fat.youngs_modulus",), setup={"fat.youngs_modulus": 0.1})
    model = SimpleNamespace(problem=problem, effects=("pretension",))
    fitted = SimpleNamespace(model=model, vector=np.array([np.log(3.0)]), prior_mean=np.zeros(1))
    assert "fat.youngs_modulus by +200 %, 11 standard" in moved_far(fitted)[0]
