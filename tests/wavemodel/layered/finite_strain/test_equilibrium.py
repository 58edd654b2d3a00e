import numpy as np
import pytest

from wavemodel.layered.finite_strain.equilibrium import SPACING, ModalEquilibrium, press_path
from wavemodel.layered.finite_strain.tool_contact import PressureContact
from wavemodel.layered.tractions import UniformPressure


@pytest.fixture(scope="module")
def problem(small_body) -> ModalEquilibrium:
    return ModalEquilibrium(small_body, PressureContact(small_body, UniformPressure(4e-3)))


def test_forces_balance(problem):
    found = problem.solve(0.5, 0.5 * problem.linear)
    residual = 0.5 * problem.contact.load - problem.body.forces(problem.body.state(found).stress)
    size = (residual * problem.body.answer(residual)).sum() / (0.25 * problem.contact.load * problem.linear).sum()
    assert size < 1e-8


def test_small_loads_have_the_linear_answer_and_deviate_by_the_square(problem):
    linear = problem.linear
    apart = [np.abs(problem.solve(f, f * linear) - f * linear).max() for f in (0.01, 0.02)]
    assert apart[0] < 2e-2 * 0.01 * np.abs(linear).max()
    assert apart[1] / apart[0] == pytest.approx(4.0, rel=0.2)


def test_does_not_depend_on_where_it_starts(problem):
    near = problem.solve(0.4, 0.4 * problem.linear)
    far = problem.solve(0.4, np.zeros_like(near))
    np.testing.assert_allclose(far, near, atol=1e-3 * np.abs(near).max())


def test_a_crushed_start_gives_none(problem):
    assert problem.solve(0.4, 100.0 * problem.linear) is None


def test_goes_from_no_load_to_the_reach_in_even_steps(small_body):
    path = press_path(ModalEquilibrium(small_body, PressureContact(small_body, UniformPressure(4e-3))), 6e-3, 1.5e-3)
    assert path.force[0] == path.depth[0] == 0.0
    assert path.depth[-2] < 1.5e-3 <= path.depth[-1]
    assert np.all(np.diff(path.force) > 0.0)
    np.testing.assert_allclose(np.diff(path.depth), SPACING * 6e-3, rtol=0.5)
    np.testing.assert_allclose(path.deflection[:, 0].sum(axis=1), path.depth, rtol=1e-12)


def test_ends_before_a_soft_block_sinks_in(small_body):
    """A small tool with uniform pressure on the softer layer has a largest force."""
    path = press_path(ModalEquilibrium(small_body, PressureContact(small_body, UniformPressure(1.2e-3))), 6e-3, 6e-3)
    assert path.depth[-1] < 6e-3
