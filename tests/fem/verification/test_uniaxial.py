"""Neo-Hookean cylinder between frictionless plates: homogeneous, so exact on any mesh.

With stretches a (radial) and l (axial), J = a^2 l, W = mu/2 (J^(-2/3) (2 a^2 + l^2) - 3) + K/2 (J - 1)^2:
the radial stress vanishes, the axial one times the reference area is the force.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

import fem
from fem.assembly import System, build_scatter, element_laws, gauss_geometry, number_unknowns
from fem.linear_solver import make_solver
from fem.mesh import build_mesh
from fem.solving import Equilibrium, NewtonSettings, Stepper

RADIUS, HEIGHT = 0.7, 0.5


def exact(material, stretch):
    """Radial stretch and axial nominal stress."""
    mu, K = material.shear_modulus, material.bulk_modulus

    def stresses(a):
        J, I1 = a * a * stretch, 2 * a * a + stretch**2
        s = mu * J ** (-2 / 3)
        radial = s * (a - I1 / (3 * a)) + K * (J - 1) * a * stretch
        return radial, s * (stretch - I1 / (3 * stretch)) + K * (J - 1) * a * a

    a = brentq(lambda x: stresses(x)[0], 0.2, 5.0, xtol=1e-15)
    return a, stresses(a)[1]


@pytest.mark.parametrize("nu", [0.3, 0.49, 0.4999])
@pytest.mark.parametrize("stretch", [0.5, 0.8, 1.5])
@pytest.mark.parametrize("stabilisation", [0.0, 1.0])
def test_force_and_bulging_are_the_closed_form(nu, stretch, stabilisation):
    mesh = build_mesh(np.array([0.0, 0.2, RADIUS]), np.array([0.0, 0.3, HEIGHT]), np.array([0.0]))
    material = fem.NeoHookean(2.0, nu)
    numbering = number_unknowns(np.stack((mesh.axis, mesh.base)), mesh.top)
    scatter = build_scatter(mesh.elements, numbering)
    laws = element_laws((material,), mesh.layer)
    system = System(gauss_geometry(mesh), laws, numbering, scatter, stabilisation)
    load = np.zeros(numbering.count)
    top = int(numbering.unknown[1, mesh.interfaces[0][0]])
    load[top] = -1.0
    problem = Equilibrium(system, make_solver("superlu", scatter.indptr, scatter.indices), load, top)
    state = Stepper(problem, "depth", 1e-3, NewtonSettings()).advance((1 - stretch) * HEIGHT).state
    a, stress = exact(material, stretch)
    assert -state.force == pytest.approx(stress * np.pi * RADIUS**2, rel=1e-9)
    radial = numbering.expand(state.y)[0]
    np.testing.assert_allclose(radial, (a - 1) * mesh.nodes[:, 0], atol=1e-9)
