import numpy as np
import pytest

import fem
from fem.assembly.axisymmetric import gauss_geometry
from fem.assembly.elements import make_elements
from fem.assembly.scatter import build_scatter, number_unknowns
from fem.assembly.system import make_system
from fem.materials.element_laws import element_laws
from fem.mesh.quads import build_mesh
from fem.results.fields import FieldRecovery


@pytest.fixture
def stretched():
    """A cylinder in homogeneous strain: mesh, displacement and the deformation gradient's diagonal."""
    mesh = build_mesh(np.array([0.0, 0.3, 1.0]), np.array([0.0, 0.4, 1.0]), np.array([0.0]))
    return mesh, np.array([0.1, -0.15]) * mesh.nodes, np.array([1.1, 1.1, 0.85])


@pytest.mark.parametrize("finite", [True, False])
@pytest.mark.parametrize("stabilisation", [0.0, 1.0])
def test_homogeneous_strain_gives_homogeneous_stress(stretched, finite, stabilisation):
    mesh, u, stretch = stretched
    material = fem.NeoHookean(3.0, 0.4)
    laws = element_laws((material,), mesh.layer)
    numbering = number_unknowns(np.zeros((2, len(u)), dtype=bool), np.zeros(len(u), dtype=bool))
    elements = make_elements(gauss_geometry(mesh), laws, stabilisation)
    system = make_system(elements, numbering, build_scatter(mesh.elements, numbering))
    y = np.empty(numbering.count)
    y[numbering.unknown] = u.T
    if finite:
        pressure = system.evaluate(y, system.rest()[1]).elements.consistent_pressure
    else:
        pressure = system.pressure_after(system.evaluate(*system.rest()), y)
    recovery = FieldRecovery(mesh, laws, elements.geometry, elements.point_modulus, finite)
    fields = recovery.fields(u, pressure)
    mu, K, strain = material.shear_modulus, material.bulk_modulus, stretch - 1.0
    if finite:
        J = stretch.prod()
        b = stretch**2 * J ** (-2 / 3)
        stress, measure = mu / J * (b - b.mean()) + K * (J - 1.0), 0.5 * (stretch**2 - 1.0)
    else:
        J = 1.0 + strain.sum()
        stress, measure = 2 * mu * (strain - strain.mean()) + K * strain.sum(), strain
    expected = np.broadcast_to(np.diag(stress), fields.cauchy_stress.shape)
    np.testing.assert_allclose(fields.cauchy_stress, expected, atol=1e-12)
    np.testing.assert_allclose(fields.strain, np.broadcast_to(np.diag(measure), fields.strain.shape), atol=1e-13)
    np.testing.assert_allclose(fields.det_F, J, rtol=1e-13)


def test_arrays_fit_together(skin, ramp):
    solution = fem.prepare(skin(discretisation=fem.Discretisation("coarse"))).run(ramp("force", 0.5, 2))
    fields = solution.fields(-1)
    cells = len(fields.cells)
    assert cells == 4 * solution.mesh.elements.shape[1]
    assert fields.layer.shape == fields.det_F.shape == (cells,)
    assert fields.cauchy_stress.shape == fields.strain.shape == (cells, 3, 3)
    assert fields.points.shape == fields.displacement.shape == (len(solution.mesh.nodes), 3)
    assert set(fields.layer.tolist()) == {0, 1, 2}
    np.testing.assert_allclose(fields.cauchy_stress, fields.cauchy_stress.transpose(0, 2, 1), atol=1e-6)


def test_cells_turn_one_way_and_cover_the_mesh(skin):
    solution = fem.prepare(skin("rigid_bonded", "linear")).run(fem.Load("force", [1.0], [1e-3]))
    fields = solution.fields(0)
    x, z = fields.points[fields.cells][..., [0, 2]].transpose(2, 0, 1)
    area = 0.5 * np.sum(x * np.roll(z, -1, axis=1) - z * np.roll(x, -1, axis=1), axis=1)
    assert (area > 0.0).all()
    assert area.sum() == pytest.approx(solution.mesh.radius * 11.6e-3, rel=1e-12)


def test_pressed_surface_carries_the_pressure(slab):
    """Under a uniform pressure the vertical stress just below the surface is the pressure."""
    solution = fem.prepare(slab("uniform_pressure", "linear")).run(fem.Load("force", [1.0], [1e-3]))
    fields = solution.fields(0)
    middle = fields.points[fields.cells].mean(axis=1)
    near = np.argmin(np.hypot(middle[:, 0], middle[:, 2]))
    assert fields.cauchy_stress[near, 2, 2] == pytest.approx(-1e-3 / (np.pi * 25e-6), rel=1e-2)
