import numpy as np
import pytest

from fem.materials import LinearElastic
from fem.verification.body import Body, distorted_square, free_of_ties, mapped_mesh, plane_stress_material, worst


def test_a_distorted_square_keeps_its_volume_and_its_border():
    mesh = distorted_square(4, seed=1)
    body = Body(mesh, LinearElastic(1.0, 0.3), np.zeros((2, len(mesh.nodes)), bool), free_of_ties(mesh))
    assert body.geometry.weight.sum() == pytest.approx(np.pi)
    inner = ~(mesh.axis | mesh.border | mesh.top | mesh.base)
    assert not np.allclose(8 * mesh.nodes[inner], np.round(8 * mesh.nodes[inner]), atol=1e-3)


def test_the_same_seed_gives_the_same_mesh():
    np.testing.assert_array_equal(distorted_square(3, 5).nodes, distorted_square(3, 5).nodes)


def test_plane_stress_in_a_uniaxial_pull():
    """Plane strain of the converted material has the plane stress modulus and contraction."""
    material = plane_stress_material(3.0, 0.25)
    E, nu = material.youngs_modulus, material.poisson_ratio
    assert E / (1 - nu**2) == pytest.approx(3.0)
    assert nu / (1 - nu) == pytest.approx(0.25)


def test_tractions_add_up_to_their_force():
    mesh = mapped_mesh(np.linspace(1.0, 3.0, 4), np.linspace(0.0, 1.0, 3), lambda r, z: (r, z + 0.2 * r))
    body = Body(mesh, LinearElastic(1.0, 0.3), np.zeros((2, len(mesh.nodes)), bool), free_of_ties(mesh))
    load = body.numbering.expand(body.traction(mesh.border, np.array([2.0, -5.0])))
    np.testing.assert_allclose(load.sum(axis=1), 2 * np.pi * 3.0 * np.array([2.0, -5.0]))


def test_a_tension_all_round_a_section_is_in_balance_axially():
    mesh = distorted_square(3, 2)
    body = Body(mesh, LinearElastic(1.0, 0.3), np.zeros((2, len(mesh.nodes)), bool), free_of_ties(mesh))
    load = body.numbering.expand(body.pull(mesh.border | mesh.top | mesh.base, 7.0))
    assert load[1].sum() == pytest.approx(0.0, abs=1e-12)
    np.testing.assert_allclose(load[1][mesh.top].sum(), 7.0 * np.pi)
    inside = body.work_of(np.broadcast_to(np.array([7.0, 0, 7.0, 0, 7.0])[:, None, None], (5, *body.points.shape[1:])))
    np.testing.assert_allclose(body.numbering.expand(inside), load, atol=1e-12)


def test_worst_is_the_farthest():
    assert worst(np.array([[0.9, 1.05], [1.0, 1.0]]), 1.0) == 0.9
