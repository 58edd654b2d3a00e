import math
from dataclasses import replace

import numpy as np
import pytest

from benchmark.identification.parameters.free_parameters import Parameter, Prior
from benchmark.identification.parameters.identifiability import Direction, directions, shared_gain
from benchmark.identification.parameters.identified import NOT_DETERMINED, identify
from benchmark.identification.parameters.layer_model import GAIN
from benchmark.identification.parameters.profile_likelihood import profile
from tests.benchmark.identification.parameters.conftest import MODULI, TRUTH


def answer(found):
    groups = [one.data.condition for one in found.problem.trials]
    return identify(found, (), directions(found), groups, ("toy",))


def test_a_profile_is_the_parabola_of_the_covariance_where_the_problem_is_even(toy_fit) -> None:
    found = toy_fit()
    own, spread = profile(found, 1), math.sqrt(found.fit.covariance[1, 1])
    assert own.high - found.vector[1] == pytest.approx(found.quantile_of(1) * spread, rel=0.1)
    assert own.rise.min() == pytest.approx(0.0, abs=1e-6)


def test_one_tool_leaves_the_layers_apart_and_every_answer_says_so(toy_fit) -> None:
    told = answer(toy_fit(tools=(1,)))
    unknown = {one.key for one in told.undetermined}
    assert "epidermis.youngs_modulus" in unknown
    assert f"epidermis.youngs_modulus {NOT_DETERMINED}" in told.headline
    assert any("epidermis.youngs_modulus is not determined" in text for text in told.warnings)
    document = told.to_dict()["parameters"]["epidermis.youngs_modulus"]
    assert document["ci95"] is None
    assert document["interval"] == NOT_DETERMINED
    assert not document["identifiable"]
    row = next(row for row in told.rows if row.name == "epidermis.youngs_modulus")
    assert not row.identifiable
    assert row.ci95_low is None


def test_the_two_tools_that_tell_them_are_held_out_in_turn(toy_fit) -> None:
    told = answer(toy_fit())
    assert not told.undetermined
    assert {one.condition for one in told.held_out} == {"tool 0", "tool 1"}
    assert all(0.0 <= one.covered <= 1.0 for one in told.held_out)
    low, high = next((one.low, one.high) for one in told.estimates if one.key == MODULI[2])
    assert low < 1e-3 * TRUTH[MODULI[2]] < high


def moved(told, deviations):
    """An answer whose thickness, told as 10 mm to 3.5 %, the trials move by so many standard uncertainties."""
    prior = Prior(0.01, 0.035, "told without its uncertainty")
    thickness = Parameter("specimen.thickness", 0.01, 1e-4, 1.0, prior, told=True)
    vector = np.insert(told.found.vector, len(told.found.problem.parameters), np.log(0.01) + 0.035 * deviations)
    problem = replace(told.found.problem, parameters=(*told.found.problem.parameters, thickness))
    made = replace(told, found=replace(told.found, problem=problem, fit=replace(told.found.fit, vector=vector)))
    made.__dict__.update(_left=told._left, _unfollowed=told._unfollowed)  # whose model knows of no thickness
    return made


@pytest.mark.parametrize(("left", "noise", "said"), [(0.05, 0.002, True), (0.05, 0.03, False), (0.01, 0.001, False)])
def test_what_a_law_leaves_is_told_of_where_it_is_much_more_than_noise(toy_fit, left, noise, said) -> None:
    """7.3 % of the force was left beside an interval of 166 to 188 kPa, and nothing said so."""
    told = answer(toy_fit())
    assert not any("the law leaves" in one for one in told.warnings)
    assert told.to_dict()["residual_percent_of_peak"] == pytest.approx(100.0 * np.median(told._left[0]))
    told.__dict__["_left"] = np.full(6, left), np.full(6, noise)
    assert any(f"the law leaves {100 * left:.2g} % of the force" in one for one in told.warnings) is said


@pytest.mark.parametrize(("deviations", "said"), [(1.9, False), (-1.9, False), (-7.0, True), (2.1, True)])
def test_a_told_value_that_the_trials_move_far_is_warned_of(toy_fit, deviations, said) -> None:
    warned = [one for one in moved(answer(toy_fit()), deviations).warnings if "standard uncertainties" in one]
    assert len(warned) == said
    if said:
        thickness = 10.0 * np.exp(0.035 * deviations)
        assert f"the trials move specimen.thickness from 10 to {thickness:.4g} mm, " in warned[0]
        assert f"{abs(deviations):.2g} standard uncertainties (told without its uncertainty)" in warned[0]


@pytest.mark.parametrize(("deviations", "contradicted"), [(4.9, False), (-4.9, False), (5.1, True), (-25.0, True)])
def test_nothing_is_determined_where_the_trials_contradict_what_was_told(toy_fit, deviations, contradicted) -> None:
    told = moved(answer(toy_fit()), deviations)
    assert all(one.identifiable != contradicted for one in told.estimates)
    assert all((one.low is None) == contradicted for one in told.estimates)
    if contradicted:
        assert f"{MODULI[2]} {NOT_DETERMINED}" in told.headline
        assert all("contradict what was told of specimen.thickness" in one.reason for one in told.estimates)


def held(told, *, prior=None, at_bound=False, gains=None):
    """An answer whose first free value has a prior or stands at its bound, and whose trials have gains of their own."""
    place, fit = told.found.problem.free[0], told.found.fit
    parameters, vector, nuisance = list(told.found.problem.parameters), fit.vector.copy(), fit.nuisance.copy()
    parameters[place] = replace(parameters[place], prior=prior)
    if at_bound:
        vector[place] = parameters[place].limits[0]
    if gains is not None:
        nuisance[:, GAIN] = gains
    problem = replace(told.found.problem, parameters=tuple(parameters))
    made = replace(told, found=replace(told.found, problem=problem, fit=replace(fit, vector=vector, nuisance=nuisance)))
    made.__dict__.update(_left=told._left, _unfollowed=told._unfollowed, directions=told.directions)
    return made


def test_a_prior_that_the_trials_contradict_does_not_win_in_silence(toy_fit) -> None:
    """80 kPa +/- 2 % made of trials that say 40: "determined", each with a gain of one half."""
    told, prior = answer(toy_fit()), Prior(80e3, 0.02, "a paper")
    half = np.log(0.5) + 0.01 * np.tile([1.0, -1.0], 5)
    name = told.names[0]
    contradicted = held(told, prior=prior, gains=half)
    assert contradicted.contradicted == (name,)
    assert not any(one.identifiable for one in contradicted.estimates)
    assert any(
        "0.5 times the model's, beyond their scatter" in w and f"{name} is held by its prior of 80 kPa" in w
        for w in contradicted.warnings
    )
    for gains in (half - half.mean(), 0.5 * np.tile([1.0, -0.8], 5)):
        assert held(told, prior=prior, gains=gains).contradicted == ()
    assert held(told, gains=half).contradicted == ()  # of a free value no prior holds back


def test_a_value_at_its_bound_is_called_so(toy_fit) -> None:
    told = held(answer(toy_fit()), at_bound=True)
    assert "it stands at the end of what it may be (" in told._reason(0, 0.1)
    both = held(answer(toy_fit()), prior=Prior(80e3, 0.02, "a paper"), at_bound=True, gains=np.full(10, -0.4))
    assert both.contradicted == (told.names[0],)
    assert any(f"{told.names[0]} is held by its bound of " in each for each in both.warnings)


@pytest.mark.parametrize(
    ("gains", "mean"), [((0.03, 0.031, 0.029), 0.03), ((0.1, -0.1, 0.1), None), ((0.5, 0.5), None)]
)
def test_gains_that_trials_share_surely_are_no_scatter(gains, mean) -> None:
    assert shared_gain(np.array(gains)) == (None if mean is None else pytest.approx(mean))


def test_directions_are_said_in_words() -> None:
    trade = Direction(("a", "b", "c"), np.array([1.0, -0.4, 0.01]) / 1.077, 0.05, 1e-3)
    assert trade.text == "a and b trade 1 : -0.4: told to 5 % (standard error)"
    alone = Direction(("a", "b"), np.array([0.0, 1.0]), math.inf, 0.0)
    assert alone.text == "b by itself: the trials say nothing of this"
    assert not alone.known
