"""Three-dimensional elements: patch test, rigid turns, tangent, and rates of convergence near incompressibility."""

import numpy as np
import pytest
import scipy.sparse as sp

import fem
from fem.assembly.solid import SOLID_ELEMENTS, solid_geometry
from fem.verification.patch import cube, solve_linear
from fem.verification.patch import equations as equations_of

ELEMENTS = ("hex27", "hex20", "tet10")


@pytest.mark.parametrize("name", ELEMENTS)
def test_the_tables_belong_to_the_nodes(name):
    element = SOLID_ELEMENTS[name]
    value, rows = element.tabulate(element.node_places.T)
    np.testing.assert_allclose(value, np.eye(len(value)), atol=1e-12)
    np.testing.assert_allclose(
        rows.reshape(3, len(value), -1) @ element.node_places,
        np.eye(3)[:, None, :].repeat(len(value), axis=1),
        atol=1e-12,
    )
    assert sorted(element.vtk_order) == list(range(len(value)))


@pytest.mark.parametrize("name", ELEMENTS)
def test_volume(name):
    assert solid_geometry(cube(name, 2)).weight.sum() == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(("name", "share"), [("tet10", 1.0), ("hex27", 0.5)])
def test_a_constant_pressure_may_leave_all_of_the_bulk_modulus_to_the_points(name, share):
    mesh = cube(name, 1)
    elements = equations_of(mesh, fem.LinearElastic(1.0, 0.3), np.tile(~mesh.base, (3, 1)), 10.0).elements
    np.testing.assert_allclose(elements.point_modulus, share * elements.laws.bulk_modulus)


def test_a_folded_element_is_refused():
    with pytest.raises(fem.FemError, match="is folded"):
        solid_geometry(cube("hex27", 2, bend=0.8))


@pytest.mark.parametrize("name", ELEMENTS)
def test_patch_a_linear_displacement_is_exact(name):
    mesh = cube(name, 2, bend=0.05 if name != "tet10" else 0.0)
    gradient = np.array([[0.1, 0.2, -0.1], [0.05, -0.2, 0.3], [0.1, 0.1, 0.15]])
    exact = gradient @ mesh.nodes.T
    outside = np.tile(mesh.base, (3, 1))
    equations = equations_of(mesh, fem.LinearElastic(1.0, 0.3), outside).displaced(mesh.elements, exact * mesh.base)
    found = equations.numbering.expand(solve_linear(equations, np.zeros(equations.numbering.count)))
    np.testing.assert_allclose(found, exact, atol=1e-10)


@pytest.mark.parametrize("name", ELEMENTS)
def test_a_rigid_turn_gives_no_force(name):
    mesh = cube(name, 1)
    angle = 0.7
    turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
    equations = equations_of(mesh, fem.NeoHookean(1.0, 0.49), np.zeros((3, len(mesh.nodes)), bool))
    y = np.zeros(equations.numbering.count)
    y[equations.numbering.unknown] = (turn - np.eye(3)) @ mesh.nodes.T
    state = equations.evaluate(y, equations.rest()[1])
    np.testing.assert_allclose(state.residual, 0.0, atol=1e-12)


@pytest.mark.parametrize("name", ELEMENTS)
def test_the_tangent_is_the_difference_quotient_of_the_residual(name):
    mesh = cube(name, 1)
    equations = equations_of(mesh, fem.NeoHookean(1.0, 0.45), np.tile(mesh.nodes[:, 2] == -1, (3, 1)))
    rng = np.random.default_rng(5)
    y, dy = 0.05 * rng.normal(size=(2, equations.numbering.count))
    pressure = equations.rest()[1]
    for _ in range(2):  # with the pressure the volume asks for, the condensed tangent is the residual's derivative
        state = equations.evaluate(y, pressure)
        pressure = state.elements.consistent_pressure

    def residual(z):
        p = equations.evaluate(z, pressure).elements.consistent_pressure
        return equations.evaluate(z, p).residual

    h = 1e-6
    quotient = (residual(y + h * dy) - residual(y - h * dy)) / (2 * h)
    state = equations.evaluate(y, pressure)
    upper = sp.csr_array(
        (equations.tangent(state), equations.scatter.indices, equations.scatter.indptr), shape=(len(y), len(y))
    )
    product = upper @ dy + upper.T @ dy - upper.diagonal() * dy
    np.testing.assert_allclose(product, quotient, atol=1e-7 * np.abs(quotient).max())


def swirl_error(name, n, nu):
    """L2 errors of displacement and gradient for u = (sin 2y, sin 2z, sin 2x), prescribed all round."""
    mesh = cube(name, n)
    x, y, z = mesh.nodes.T
    exact = np.stack((np.sin(2 * y), np.sin(2 * z), np.sin(2 * x)))
    material = fem.LinearElastic(1.0, nu)
    equations = equations_of(mesh, material, np.tile(mesh.base, (3, 1)), 0.0).displaced(
        mesh.elements, exact * mesh.base
    )
    geometry, element = equations.elements.geometry, SOLID_ELEMENTS[name]
    value, _ = element.tabulate(element.quadrature()[0])
    at = [value @ c[mesh.elements] for c in mesh.nodes.T]
    H = np.zeros((9, *geometry.weight.shape))
    H[1], H[5], H[6] = (2 * np.cos(2 * c) for c in (at[1], at[2], at[0]))
    stress = material.shear_modulus * (H + H[[0, 3, 6, 1, 4, 7, 2, 5, 8]])
    load = equations.scatter.vector(geometry.forces(stress * geometry.weight))
    u = equations.element_displacement(solve_linear(equations, load))
    nodes = len(mesh.elements)
    fields = [np.sin(2 * at[1]), np.sin(2 * at[2]), np.sin(2 * at[0])]
    off = [value @ u[i * nodes : (i + 1) * nodes] - field for i, field in enumerate(fields)]
    slope = geometry.gradient(u) - H
    return [float(np.sqrt(np.sum(np.square(e) * geometry.weight))) for e in (off, slope)]


@pytest.mark.parametrize("nu", [0.3, 0.4999])
@pytest.mark.parametrize(("name", "sizes"), [("hex27", (2, 4)), ("tet10", (3, 6))])
def test_rates_of_convergence(name, sizes, nu):
    (u1, g1), (u2, g2) = (swirl_error(name, n, nu) for n in sizes)
    assert np.log2(u1 / u2) > 2.5
    assert np.log2(g1 / g2) > 1.7


@pytest.mark.parametrize(("name", "n"), [("hex27", 3), ("tet10", 4)])
def test_no_locking(name, n):
    assert swirl_error(name, n, 0.4999)[0] < 1.6 * swirl_error(name, n, 0.45)[0]
