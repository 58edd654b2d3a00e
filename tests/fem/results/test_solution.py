import numpy as np
import pytest

import fem
from fem import FemError


@pytest.fixture
def solution(slab, ramp):
    return fem.prepare(slab("rigid_bonded", density="coarse")).run(ramp("force", 0.2, 3))


def test_profile_passes_through_the_nodes(solution):
    row = solution.mesh.interfaces[0]
    r = solution.mesh.nodes[row, 0]
    np.testing.assert_allclose(solution.profile(1, r)[0], -solution.displacement[1, row, 1], atol=1e-15)


def test_profile_is_flat_under_a_rigid_tool_and_ends_at_the_border(solution):
    profile = solution.profile(-1, np.array([0.0, 1e-3, 4.9e-3, 5e-3, solution.mesh.radius, 1.0]))[0]
    np.testing.assert_allclose(profile[:4], solution.depth[-1], rtol=1e-12)
    assert profile[4] == pytest.approx(0.0, abs=1e-15)
    assert np.isnan(profile[5])


def test_profile_has_a_row_per_layer(skin, ramp):
    found = fem.prepare(skin(discretisation=fem.Discretisation("coarse"))).run(ramp("force", 0.1, 1))
    profile = found.profile(0, np.linspace(0.0, 0.02, 9))
    assert profile.shape == (3, 9)
    np.testing.assert_allclose(profile[:, 0], found.top_deflection[0], rtol=1e-14)
    assert found.layer_names == ("epidermis", "dermis", "fat")


@pytest.mark.parametrize("radii", [np.array([-1e-3]), np.array([np.nan]), np.array(1e-3)])
def test_bad_radii_are_refused(solution, radii):
    with pytest.raises(FemError, match="radii"):
        solution.profile(0, radii)


def test_a_step_that_is_not_there_is_refused(solution):
    with pytest.raises(FemError, match="step = 3: the solution has 3 steps"):
        solution.profile(3, np.array([0.0]))
    with pytest.raises(FemError, match="step = -4"):
        solution.fields(-4)


def test_failure_reads_as_one_sentence():
    text = str(fem.Failure(7, 0.7, "force", 3.2, 3.5, "no equilibrium"))
    assert text == ("step 7 (time 0.7 s): force 3.5 N not reached, last equilibrium at 3.2 N: no equilibrium")
