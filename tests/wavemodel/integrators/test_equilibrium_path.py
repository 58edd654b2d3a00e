"""A spring of force x + x^3, loaded step by step."""

from dataclasses import dataclass

import numpy as np
import pytest

from wavemodel.integrators.equilibrium_path import EquilibriumState, RisingCurve, follow, straight_on


@dataclass(frozen=True)
class Spring:
    """It finds no equilibrium by steps longer than `longest`, nor beyond `end`."""

    target: float
    longest: float = np.inf
    end: float = np.inf

    def next_load(self, path, step):
        return min(self.target, path[-1].load + step)

    def next_step(self, path, step):
        return step

    def reached(self, path):
        return path[-1].load >= self.target

    def advance(self, path, load):
        if load - path[-1].load > self.longest or load > self.end:
            return None
        real = [root.real for root in np.roots([1.0, 0.0, 1.0, -load]) if abs(root.imag) < 1e-9]
        return EquilibriumState(load, np.array(real))


REST = [EquilibriumState(0.0, np.zeros(1))]


def test_goes_to_the_target_and_no_further():
    path = follow(Spring(10.0), REST, 4.0, 0.1)
    assert [one.load for one in path] == [0.0, 4.0, 8.0, 10.0]
    assert path[-1].state == pytest.approx(2.0)


def test_halves_steps_that_fail_and_keeps_the_length_that_succeeds():
    assert [one.load for one in follow(Spring(4.0, longest=1.0), REST, 4.0, 0.5)] == [0.0, 1.0, 2.0, 3.0, 4.0]


def test_ends_where_the_shortest_step_fails():
    path = follow(Spring(4.0, end=2.6), REST, 1.0, 0.25)
    assert [one.load for one in path] == [0.0, 1.0, 2.0, 2.5]
    assert follow(Spring(4.0, end=0.1), REST, 1.0, 0.25) == REST


def test_the_next_state_is_guessed_on_the_line_through_the_last_two():
    path = [EquilibriumState(1.0, np.array([1.0, 4.0])), EquilibriumState(3.0, np.array([2.0, 2.0]))]
    np.testing.assert_allclose(straight_on(path, 4.0), [2.5, 1.0])
    np.testing.assert_array_equal(straight_on(path[:1], 4.0), [1.0, 4.0])


def test_a_rising_curve_is_inverted_where_its_slope_is_all_but_flat():
    knots = np.linspace(-1.0, 2.0, 4)
    cube = RisingCurve(knots, knots**3, lambda x: x**3, lambda x: 3.0 * x**2)
    wanted = np.array([[-1.0, -0.3], [1e-6, 7.9]])
    np.testing.assert_allclose(cube.inverse(wanted, 1e-15 * np.abs(wanted)), np.cbrt(wanted), rtol=1e-14)
