"""The answer's figures: confidence, transfer, intervals and the order of candidates."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.discovery.answer import estimates
from benchmark.discovery.discovery_result import Estimate
from benchmark.discovery.evidence.gains import Gain, Scored
from benchmark.discovery.evidence.selection import Selection
from benchmark.discovery.evidence.shortlist import Screened
from benchmark.physics import EffectParameter


def fitted(slug, density):
    trials = tuple(SimpleNamespace(condition=0) for _ in range(8))
    model = SimpleNamespace(effects=(SimpleNamespace(slug=slug),), problem=SimpleNamespace(trials=trials))
    return SimpleNamespace(model=model, density=np.asarray(density, dtype=float))


def selected(chosen, **changes):
    plain = {"base": chosen, "chosen": chosen, "steps": (), "candidates": (), "screened": (), "lookalikes": {}}
    return Selection(**{**plain, "rivals": {}, **changes})


@pytest.fixture
def known_densities(monkeypatch):
    monkeypatch.setattr(estimates, "held_out", lambda fit: fit.density)


def test_confidence_is_what_blind_trials_allow_and_the_weight_among_rivals(known_densities):
    chosen = fitted("true", np.full(8, 5.0))
    assert estimates.confidence(selected(chosen), "true") == pytest.approx(30 / 33)
    equal, far = fitted("equal", np.full(8, 5.0)), fitted("far", np.full(8, -500.0))
    assert estimates.confidence(selected(chosen, rivals={"true": (equal,)}), "true") == 0.5
    assert estimates.confidence(selected(chosen, rivals={"true": (equal, equal, equal)}), "true") == 0.25
    told = estimates.confidence(selected(chosen, rivals={"true": (far,)}), "true")
    assert told == pytest.approx(12 / 17)  # a look-alike in form, however far off by density


def test_a_rival_that_does_better_is_no_more_than_an_equal(known_densities):
    chosen, better = fitted("true", np.full(8, 5.0)), fitted("better", np.full(8, 50.0))
    assert estimates.confidence(selected(chosen, rivals={"true": (better,)}), "true") == 0.5


def test_the_chosen_candidate_stands_first_then_single_ones_by_gain(monkeypatch):
    monkeypatch.setattr(estimates, "constant", lambda fit: None)

    def scored(slug, mean):
        return Scored(
            fitted(slug, np.zeros(8)), slug, Gain(np.zeros(8), mean, 1.0, 3.0), None, -10.0, fitted(slug, 0.0)
        )

    made = selected(
        fitted("chosen", np.zeros(8)),
        candidates=(scored("other", 9.0), scored("chosen", 5.0)),
        screened=tuple(
            Screened(SimpleNamespace(slug=slug), 80.0, np.zeros((1, 8))) for slug in ("chosen", "looked at")
        ),
    )
    found = estimates.candidates(made, {("chosen",): 0.8})
    assert [each.slugs for each in found] == [("chosen",), ("looked at",), ("other",)]
    assert [each.gap_closed for each in found] == [0.8, None, None]
    assert (found[1].gain, found[1].z) == (10.0, 0.0)
    assert np.isnan(found[1].gain_standard_error)


def linear_fit(scatter, parameters, vector, variance):
    """A fit of R trials whose slopes (R, p) scatter, with covariance of a diagonal."""
    model = SimpleNamespace(
        effects=(),
        shape_count=0,
        parameters=tuple(("effect", each) for each in parameters),
        values=lambda v: {"effect": dict(zip([p.name for p in parameters], v, strict=True))},
    )
    return SimpleNamespace(
        model=model,
        vector=np.array(vector),
        covariance=np.diag(variance),
        precision=np.zeros(len(vector)),
        blocks=SimpleNamespace(slope=scatter),
    )


def test_intervals_widen_to_the_scatter_of_the_trials_and_stop_at_the_bounds():
    plain = EffectParameter("share", "", (0.3,), 0.0, 0.95, False, "share")
    calm = linear_fit(np.zeros((5, 1)), [plain], [0.5], [0.01])
    assert estimates.effect_estimates(calm)[0][1].ci95 == pytest.approx((0.304, 0.696))
    wild = linear_fit(np.array([[-20.0], [20.0], [-20.0], [20.0]]), [plain], [0.5], [0.01])
    assert estimates.effect_estimates(wild)[0][1].ci95 == (0.0, 0.95)


def test_a_logarithmic_parameter_has_its_interval_in_ratios():
    time = EffectParameter("tau", "s", (1.0,), 1e-3, 1e3, True, "time")
    low, high = estimates.effect_estimates(linear_fit(np.zeros((5, 1)), [time], [np.log(2.0)], [0.04]))[0][1].ci95
    assert low * high == pytest.approx(4.0)
    assert high / low == pytest.approx(np.exp(4 * 0.196 * 1.0))


def test_effects_stand_in_the_order_of_their_own_gain_with_their_rivals_parameters(known_densities, monkeypatch):
    """A rival that lacks a tenth of what the effect gains itself, with the parameters of its own fit."""
    chosen = fitted("small", np.full(8, 50.0))
    chosen.model.effects = (SimpleNamespace(slug="small"), SimpleNamespace(slug="large"))
    rival = fitted("rival", np.full(8, 49.0))
    own = {name: Gain(np.full(8, size), size, 1.0, 9.0) for name, size in (("small", 10.0), ("large", 40.0))}
    values = {id(chosen): (("small", 1.0), ("large", 2.0)), id(rival): (("large", 3.0), ("rival", 4.0))}
    monkeypatch.setattr(
        estimates,
        "effect_estimates",
        lambda fit: tuple((slug, Estimate("p", value, "N", (0.0, 9.0))) for slug, value in values[id(fit)]),
    )
    monkeypatch.setattr(estimates, "by_condition", lambda fit: ())
    made = selected(chosen, own=own, rivals={"small": (rival,)}, lookalikes={"small": ("rival",)})
    first, second = estimates.named_effects(made)
    assert (first.slug, first.gain, first.rivals) == ("large", 40.0, ())
    assert (second.slug, second.gain, second.lookalikes) == ("small", 10.0, ("rival",))
    assert [each.value for each in second.rivals[0].parameters] == [4.0]
    assert second.rivals[0].lacking == pytest.approx(0.1)
    assert all(each.confidence == 0.0 for each in estimates.named_effects(made, 0.0))
