from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fem
from fem.analysis.equilibrium import State
from fem.analysis.newton import NewtonSettings
from fem.analysis.prediction import HIGHEST_ORDER, LOWEST_ORDER, GuidedStates, KnownStates, along_tangent
from fem.analysis.stepping import Stepper


def quadratic(v):
    return State(np.array([1.0 + v, v**2]), np.array([[3.0 * v - v**2]]), 2.0 * v + v**2)


def known(values):
    states = KnownStates(0.0, quadratic(0.0))
    for v in values:
        states.add(v, quadratic(v))
    return states


@given(st.floats(-2.0, 5.0))
@settings(deadline=None)
def test_quadratic_paths_are_predicted_exactly(target):
    found, exact = known([1.0, 2.0]).predict(target), quadratic(target)
    np.testing.assert_allclose(found.y, exact.y, atol=1e-10)
    np.testing.assert_allclose(found.pressure, exact.pressure, atol=1e-10)
    assert found.force == pytest.approx(exact.force, abs=1e-10)


def test_one_known_state_predicts_itself():
    found = KnownStates(0.0, quadratic(0.0)).predict(1.0)
    np.testing.assert_array_equal(found.y, quadratic(0.0).y)


def test_nearly_equal_loads_do_not_blow_the_extrapolation_up():
    states = known([1.0])
    noisy = quadratic(1.0)
    states.add(1.0 + 1e-9, State(noisy.y + 1e-6, noisy.pressure, noisy.force))
    assert np.abs(states.predict(1.5).y).max() < 10.0


def test_a_known_load_gives_its_state():
    np.testing.assert_array_equal(known([1.0, 2.0, 3.0]).predict(2.0).y, quadratic(2.0).y)


def smooth(v):
    return State(np.array([np.exp(0.3 * v), 1.0]), np.zeros((1, 1)), v)


def states_of(path, values):
    states = KnownStates(values[0], path(values[0]))
    for v in values[1:]:
        states.add(v, path(v))
    return states


def test_a_smooth_path_is_predicted_to_a_higher_order():
    known_states = states_of(smooth, np.arange(8.0))
    errors = [abs(known_states.predict(8.0, order).y[0] - smooth(8.0).y[0]) for order in (2, 3, 4, 5)]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < 0.05 * errors[0]
    np.testing.assert_allclose(known_states.predict(8.0).y, known_states.predict(8.0, HIGHEST_ORDER).y)


def test_behind_a_kink_the_order_stays_low():
    path = lambda v: State(np.array([v + 5.0 * max(v - 5.0, 0.0)]), np.zeros((1, 1)), v)  # noqa: E731
    states = states_of(path, np.arange(7.0))
    np.testing.assert_allclose(states.predict(7.0).y, states.predict(7.0, LOWEST_ORDER).y)


def guided(times, guides):
    """Of two displacements, the second one the probe's, and a multiplier; all states with one pressure."""
    numbering = SimpleNamespace(unknown=np.array([[0, -1]]))
    problem = SimpleNamespace(system=SimpleNamespace(numbering=numbering), probe=1)
    states = [State(np.array([*y, 0.0]), np.zeros((1, 1)), force) for y, force in guides]
    return GuidedStates(problem, 0.0, states[0], np.array(times), states)


def test_a_guide_adds_its_increment_and_multipliers_go_with_the_force():
    known = guided([0.0, 1.0, 3.0], [((0.0, 0.0), 0.0), ((2.0, -1.0), 4.0), ((4.0, -3.0), 8.0)])
    first, plain = known.predictions(4.0, 1.0)
    np.testing.assert_allclose(first.y, [2.0, -1.0, 0.0])
    assert first.force == 4.0
    np.testing.assert_array_equal(plain.y, np.zeros(3))
    known.add(4.0, 1.0, State(np.array([2.5, -1.0, 7.0]), np.ones((1, 1)), 5.0))
    half, _ = known.predictions(6.0, 2.0)  # the step was cut
    np.testing.assert_allclose(half.y, [3.5, -2.0, 7.0 * 7.0 / 5.0])
    assert half.force == 7.0
    np.testing.assert_array_equal(half.pressure, [[1.0]])


def test_a_sudden_press_is_predicted_by_the_last_state():
    known = guided([0.0, 0.0, 1.0], [((0.0, 0.0), 0.0), ((2.0, -1.0), 4.0), ((3.0, -1.0), 5.0)])
    np.testing.assert_array_equal(next(known.predictions(4.0, 0.0)).y[:2], [0.0, 0.0])
    known.add(4.0, 0.0, State(np.array([2.0, -1.0, 1.0]), np.zeros((1, 1)), 4.0))
    np.testing.assert_allclose(next(known.predictions(5.0, 1.0)).y, [3.0, -1.0, 1.25])


def test_the_tangent_foretells_a_short_step_to_second_order(skin):
    problem = fem.prepare(skin("uniform_pressure", discretisation=fem.Discretisation("coarse"))).equilibrium
    stepper, off = Stepper(problem, "force", 5e-3, NewtonSettings()), []
    states = [stepper.advance(force).state for force in (1.0, 1.02, 1.04)]
    for then in states[1:]:
        guess = along_tangent(problem, states[0], "force", then.force - 1.0)
        by_depth = along_tangent(problem, states[0], "depth", problem.depth(then.y) - problem.depth(states[0].y))
        assert guess.force == pytest.approx(then.force)
        assert problem.depth(by_depth.y) == pytest.approx(problem.depth(then.y))
        off.append([np.linalg.norm(one.y - then.y) for one in (guess, by_depth)])
    np.testing.assert_allclose(np.array(off[1]) / off[0], 4.0, rtol=0.1)
