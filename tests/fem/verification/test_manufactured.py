"""Manufactured solutions: the rate of convergence is the test.

The load is the work of the exact stress, int P(u) : grad v, so the discrete solution is the Galerkin projection of
a chosen smooth displacement. Q2 must converge with h^2 in the gradient and h^3 in the displacement, at nu = 0.4999
as at 0.3.
"""

import numpy as np
import pytest

import fem
from fem.assembly import System, build_scatter, element_laws, gauss_geometry, number_unknowns
from fem.components import AXISYMMETRIC
from fem.deformation import Deformation
from fem.linear_solver import make_solver
from fem.mesh import build_mesh
from fem.solving import Equilibrium, NewtonSettings, State
from fem.solving.newton import solve_newton


def stream(r, z):
    """Linear kinematics: solenoidal displacement and its gradient (rr, rz, tt, zr, zz), zero on the base z = -1."""
    b = z + 1
    u = np.stack((-r * (1 - r * r) * b * (2 + 3 * b), (2 - 4 * r * r) * b * b * (1 + b)))
    tt = -(1 - r * r) * b * (2 + 3 * b)
    rr, rz = tt + 2 * r * r * b * (2 + 3 * b), -r * (1 - r * r) * (2 + 6 * b)
    return u, np.stack((rr, rz, tt, -8 * r * b * b * (1 + b), (2 - 4 * r * r) * b * (2 + 3 * b)))


def bulge(r, z):
    """Finite kinematics: z -> h(z), r -> r h'(z)^(-1/2), h = z - b^3 / 24, b = z + 1; J = 1 everywhere."""
    b = z + 1
    slope = 1 - 0.125 * b * b
    wide = slope**-0.5
    u = np.stack((r * (wide - 1), -(b**3) / 24))
    return u, np.stack((wide - 1, 0.125 * r * b * slope**-1.5, wide - 1, 0.0 * r, slope - 1))


FIELDS = {False: stream, True: bulge}


def exact_stress(material, H, finite):
    d = Deformation(AXISYMMETRIC, H)
    if finite:
        parameters = np.array(material.parameters)
        return material.law.stress(d, parameters) + material.bulk_modulus * d.volume_change * d.cofactor
    trace = H[AXISYMMETRIC.normal].sum(axis=0)
    stress = 2 * material.shear_modulus * d.small_strain
    stress[AXISYMMETRIC.normal] += (material.bulk_modulus - 2 / 3 * material.shear_modulus) * trace
    return stress


def errors(n, nu, finite):
    """L2 errors of displacement and gradient on an n x n mesh."""
    mesh = build_mesh(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), np.array([0.0]))
    material = fem.NeoHookean(1.0, nu)
    numbering = number_unknowns(np.stack((mesh.base | mesh.axis, mesh.base)), np.zeros(len(mesh.nodes), bool))
    scatter, geometry = build_scatter(mesh.elements, numbering), gauss_geometry(mesh)
    system = System(geometry, element_laws((material,), mesh.layer), numbering, scatter)
    r, z = ((geometry.shapes.radial[-geometry.shapes.count :] @ x[mesh.elements]) for x in mesh.nodes.T)
    exact, H = FIELDS[finite](r, z)
    rows = geometry.pull_back(exact_stress(material, H, finite) * geometry.weight)
    flat, split = rows.reshape(-1, rows.shape[2]), 3 * geometry.shapes.count
    force = np.concatenate((geometry.shapes.radial.T @ flat[:split], geometry.shapes.vertical.T @ flat[split:]))
    load = scatter.vector(force)
    solver = make_solver("superlu", scatter.indptr, scatter.indices)
    problem = Equilibrium(system, solver, load, 0)
    if finite:
        nodal, y = FIELDS[True](*mesh.nodes.T)[0], np.zeros(numbering.count)
        free = numbering.unknown >= 0
        y[numbering.unknown[free]] = nodal[free]
        guess = State(y, system.rest()[1], 1.0)
        result = solve_newton(problem, guess, "force", 1.0, 1.0, NewtonSettings())
        assert result.success
        y = result.state.y
    else:
        solver.factorise(system.tangent(system.evaluate(*system.rest())))
        y = solver.solve(load[:, None])[:, 0]
    found = scatter.gather(y)
    values = geometry.shapes.radial[-geometry.shapes.count :]
    off = np.stack((values @ found[:9], values @ found[9:])) - exact
    slope = geometry.gradient(found) - H
    return [np.sqrt(np.sum(e**2 * geometry.weight)) for e in (off, slope)]


@pytest.mark.parametrize("field", [stream, bulge])
def test_the_gradient_belongs_to_the_displacement(field):
    r, z, h = np.array([0.3, 0.8]), np.array([-0.7, -0.2]), 1e-6
    by_r = (field(r + h, z)[0] - field(r - h, z)[0]) / (2 * h)
    by_z = (field(r, z + h)[0] - field(r, z - h)[0]) / (2 * h)
    u, H = field(r, z)
    np.testing.assert_allclose(H, np.stack((by_r[0], by_z[0], u[0] / r, by_r[1], by_z[1])), atol=1e-9)


def test_neither_field_changes_the_volume():
    r, z = np.meshgrid(np.linspace(0.1, 1, 5), np.linspace(-1, 0, 5))
    np.testing.assert_allclose(Deformation(AXISYMMETRIC, bulge(r, z)[1]).volume_change, 0.0, atol=1e-14)
    np.testing.assert_allclose(stream(r, z)[1][AXISYMMETRIC.normal].sum(axis=0), 0.0, atol=1e-12)


@pytest.mark.parametrize("finite", [False, True], ids=["linear", "finite"])
@pytest.mark.parametrize("nu", [0.3, 0.499, 0.4999])
def test_rates_of_convergence(nu, finite):
    (u4, g4), (u8, g8), (u16, g16) = (errors(n, nu, finite) for n in (4, 8, 16))
    rate_u, rate_g = np.log2(u8 / u16), np.log2(g8 / g16)
    assert rate_u > 2.8
    assert rate_g > 1.9
    assert u16 < u8 < u4
    assert g16 < g8 < g4


@pytest.mark.parametrize("finite", [False, True], ids=["linear", "finite"])
def test_no_locking(finite):
    """The error at nu = 0.4999 is the one at 0.45, not a multiple."""
    assert errors(8, 0.4999, finite)[0] < 1.5 * errors(8, 0.45, finite)[0]
