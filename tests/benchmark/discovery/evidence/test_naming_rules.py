"""Which candidates are accepted, which are equals, look-alikes or needless: each rule on numbers that decide it."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery import criteria
from benchmark.discovery.criteria import Settings
from benchmark.discovery.evidence import selection
from benchmark.discovery.evidence.gains import Gain
from benchmark.discovery.evidence.selection import Scored, constant
from benchmark.discovery.evidence.shortlist import Screened

SETTINGS = Settings()


def effect(slug, parameters=1, richer=None):
    return SimpleNamespace(slug=slug, names=("p",) * parameters, richer=richer)


def fitted(*effects, density=0.0, objective=0.0, conditions=(0,) * 8):
    """A fit with held-out densities (R,) given, in the place of one that was computed."""
    trials = tuple(SimpleNamespace(condition=number) for number in conditions)
    model = SimpleNamespace(effects=tuple(effects), problem=SimpleNamespace(trials=trials))
    spread = np.broadcast_to(np.asarray(density, dtype=float), (len(trials),))
    return SimpleNamespace(model=model, density=spread, objective=objective)


def scored(slug, mean, z=9.0, bic=-50.0, each=None, **changes):
    values = np.full(8, mean) if each is None else np.asarray(each, dtype=float)
    return Scored(fitted(effect(slug, **changes), density=values), slug, Gain(values, mean, 1.0, z), None, bic)


@pytest.fixture
def known_densities(monkeypatch):
    monkeypatch.setattr(selection, "held_out", lambda fit: fit.density)


class Work:
    """Fits looked up by the slugs of their effects."""

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
        (0.5, -4.1, [5.0, 4.0, 5.0, -3.0, 0, 0, 0, 90.0], False),  # others lose over a tenth
    ],
)
def test_an_effect_needs_evidence_over_trials_and_bic(z, bic, each, expected):
    assert selection._accepted(scored("a", 5.0, z, bic, each), [], SETTINGS) is expected


@pytest.mark.parametrize(("mean", "expected"), [(1.2, True), (1.19, False)])
def test_a_further_effect_must_gain_an_eighth_of_the_first(mean, expected):
    assert selection._accepted(scored("b", mean), [scored("a", 10.0)], SETTINGS) is expected


def test_of_equals_the_simplest_is_taken_then_the_first_of_the_catalogue():
    catalogue = [effect("two", 2), effect("first"), effect("second")]
    best = scored("two", 10.0)
    assert selection._simplest([best, scored("second", 9.71), scored("first", 9.7)], catalogue).slug == "first"
    assert selection._simplest([best, scored("second", 9.71), scored("first", 9.69)], catalogue).slug == "second"
    assert selection._simplest([best, scored("first", 9.69)], catalogue).slug == "two"


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
    monkeypatch.setattr(selection, "score", lambda current, fits: [rich] if fits else [])
    (chosen,) = selection._enriched(fitted(), [plain], Work(fitted(richer)))
    assert chosen is (rich if kept == "richer" else plain)


def test_no_further_term_is_tried_of_what_gains_little(monkeypatch):
    asked = []
    monkeypatch.setattr(selection, "score", lambda current, fits: asked.append(fits) or [])
    low = scored("low", 4.9, richer=effect("low", 3))
    unsure = scored("unsure", 9.0, z=1.9, richer=effect("unsure", 3))
    selection._enriched(fitted(), [scored("best", 10.0), unsure, low], Work())
    assert asked == [[]]


def test_a_rival_is_a_lookalike_within_two_errors_or_a_tenth_of_the_gain(known_densities):
    wave = np.array([1.0, -1.0] * 4)
    chosen = fitted(effect("true"), density=100.0)
    rivals = [
        scored("near", 0.0, each=np.full(8, 91.0)),  # lacks 9 %
        scored("unsure", 0.0, each=60.0 - 90.0 * wave),  # lacks 40 %, but not in every trial
        scored("far", 0.0, each=np.full(8, 89.0)),  # lacks 11 %
    ]
    names, fits = selection._lookalikes(fitted(), chosen, [rivals], SETTINGS, Work())
    assert names == {"true": ("near", "unsure")}
    assert [fit.model.effects[-1].slug for fit in fits["true"]] == ["near", "unsure"]


def test_an_effect_that_another_makes_needless_is_dropped(known_densities):
    a, b = effect("a"), effect("b")
    both = fitted(a, b, density=10.0, objective=50.0)
    same = fitted(b, density=10.0, objective=50.5)
    assert selection._pruned(fitted(), both, SETTINGS, Work(same)) is same
    worse = fitted(b, density=2.0, objective=90.0)
    assert selection._pruned(fitted(), both, SETTINGS, Work(worse)) is both


@pytest.mark.parametrize(("density", "swapped"), [(10.31, True), (10.29, False)])
def test_a_swap_must_gain_more_than_a_tie(known_densities, density, swapped):
    a, b, rival = effect("a"), effect("b"), effect("rival")
    both = fitted(a, b, density=10.0)
    other = fitted(b, rival, density=density)
    work = Work(fitted(a), fitted(b), other, fitted(a, rival, density=1.0))
    rounds = [[scored("a", 8.0), scored("rival", 7.0)]]
    rounds[0][1].fit.model.effects[-1].slug = "rival"
    assert (selection._swapped(fitted(), both, rounds, work) is other) is swapped


class Linear:
    """A fit whose conditions each tell of one parameter: values by condition, all of the same weight."""

    def __init__(self, values, weight, logarithmic=False):
        self.values = np.asarray(values, dtype=float)
        self.vector = np.array([self.values.mean()])
        self.precision = np.array([1e-12])
        self.blocks = SimpleNamespace(matrix=np.full((len(values), 1, 1), float(weight)))
        self.model = SimpleNamespace(
            effects=("one",),
            shape_count=0,
            parameters=(("one", SimpleNamespace(logarithmic=logarithmic)),),
            problem=SimpleNamespace(trials=tuple(SimpleNamespace(condition=k) for k in range(len(values)))),
        )

    def without(self, trials):
        return np.array([self.values[~trials].mean()])


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
    assert constant(Linear(values, weight, logarithmic)) is expected


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
    assert (criteria.TIE, criteria.WORTH, criteria.CLOSE) == (0.03, 0.12, 0.1)
    assert (criteria.ACCEPT_BIC, criteria.RICHER_BIC, SETTINGS.accept_z, SETTINGS.lookalike_z) == (-4.0, -6.0, 3.0, 2.0)
