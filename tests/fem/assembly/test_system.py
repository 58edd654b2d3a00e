import numpy as np
import pytest
import scipy.sparse as sp


def state(system, mesh, size=0.1):
    """A smooth displacement, the same where nodes share a place, and some pressure."""
    (r, z), rng = mesh.nodes.T, np.random.default_rng(9)
    nodal = size * np.stack((r * np.cos(2 * z + r), np.sin(3 * r) * z + 0.3))
    y, p = system.rest()
    free = system.numbering.unknown >= 0
    y[system.numbering.unknown[free]] = nodal[free]
    return y, p + rng.normal(size=p.shape)


def full(system, data):
    n = system.numbering.count
    upper = sp.csr_array((data, system.scatter.indices, system.scatter.indptr), shape=(n, n)).toarray()
    return upper + upper.T - np.diag(upper.diagonal())


@pytest.mark.parametrize("nu", [0.3, 0.499])
@pytest.mark.parametrize("stabilisation", [0.0, 1.0])
@pytest.mark.parametrize("fan", [False, True])
def test_tangent_is_the_derivative_of_the_residual(block, system_of, nu, stabilisation, fan):
    """With the pressure that follows the displacement, against central differences."""
    mesh = block(fan=fan)
    system = system_of(mesh, nu=nu, tie=True, stabilisation=stabilisation)
    y, p = state(system, mesh)

    def residual(at):
        return system.evaluate(at, p).residual

    consistent = system.evaluate(y, system.evaluate(y, p).elements.consistent_pressure)
    direction = np.random.default_rng(10).normal(size=y.shape)
    step = 2e-7
    quotient = (residual(y + step * direction) - residual(y - step * direction)) / (2 * step)
    exact = full(system, system.tangent(consistent)) @ direction
    assert np.linalg.norm(quotient - exact) <= 1e-8 * np.linalg.norm(exact)


def test_residual_does_not_depend_on_the_given_pressure(block, system_of):
    mesh = block()
    system = system_of(mesh)
    y, p = state(system, mesh)
    one, other = system.evaluate(y, p), system.evaluate(y, 0.0 * p)
    np.testing.assert_allclose(one.residual, other.residual, atol=1e-10 * np.abs(one.residual).max())
    np.testing.assert_allclose(one.elements.consistent_pressure, other.elements.consistent_pressure, atol=1e-10)


def test_a_vertical_shift_costs_nothing(block, system_of):
    mesh = block()
    system = system_of(mesh, hold=False)
    shift = np.zeros((2, len(mesh.nodes)))
    shift[1] = 0.7
    y = np.zeros(system.numbering.count)
    y[system.numbering.unknown.ravel()] = shift.ravel()
    assert np.abs(system.evaluate(y, system.rest()[1]).residual).max() < 1e-13


def test_internal_forces_balance_in_z(block, system_of):
    mesh = block(fan=True)
    system = system_of(mesh, hold=False)
    y, p = state(system, mesh)
    force = system.evaluate(y, p).elements.force
    assert abs(force[9:].sum()) < 1e-12 * np.abs(force).sum()


@pytest.mark.parametrize("stabilisation", [0.0, 1.0])
def test_linear_force_is_the_tangent_at_rest(block, system_of, stabilisation):
    system = system_of(block(), stabilisation=stabilisation)
    rest = system.evaluate(*system.rest())
    y = np.random.default_rng(11).normal(size=system.numbering.count)
    np.testing.assert_allclose(
        system.scatter.vector(system.linear_force(rest, y)), full(system, system.tangent(rest)) @ y, atol=1e-10
    )


def test_an_element_inside_out_has_no_evaluation(block, system_of):
    mesh = block()
    system = system_of(mesh)
    y = system.numbering.reduce(np.stack((0.0 * mesh.nodes[:, 0], -3.0 * (mesh.nodes[:, 1] + 1.0))))
    assert system.evaluate(y, system.rest()[1]) is None


@pytest.mark.parametrize("fan", [False, True])
@pytest.mark.parametrize("stabilisation", [0.0, 1.0])
def test_patch_homogeneous_strain_gives_its_stress(block, system_of, fan, stabilisation):
    """Patch test in finite strain: equal biaxial stretch, one material; stress is the same everywhere."""
    mesh = block(fan=fan)
    system = system_of(mesh, hold=False, stabilisation=stabilisation)
    one = np.flatnonzero(mesh.layer == 0)
    nodal = np.stack((0.1 * mesh.nodes[:, 0], -0.15 * mesh.nodes[:, 1]))
    y = np.zeros(system.numbering.count)
    y[system.numbering.unknown.ravel()] = nodal.ravel()
    found = system.evaluate(y, system.rest()[1])
    again = system.evaluate(y, found.elements.consistent_pressure)
    J = 1.1**2 * 0.85
    K = system.elements.laws.bulk_modulus[one[0]]
    np.testing.assert_allclose(again.elements.pressure_at_points[:, one], K * (J - 1.0), rtol=1e-10)
    interior = ~(mesh.top | mesh.base | mesh.border | mesh.axis) & np.isin(
        np.arange(len(mesh.nodes)), mesh.elements[:, one]
    )
    interior &= mesh.nodes[:, 1] > -0.5 + 1e-9
    unknown = system.numbering.unknown[:, interior].ravel()
    assert np.abs(found.residual[unknown]).max() < 1e-12
