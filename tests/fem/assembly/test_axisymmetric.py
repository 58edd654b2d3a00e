import numpy as np
import pytest

from fem.assembly.axisymmetric import gauss_geometry, point_geometry


@pytest.mark.parametrize("fan", [False, True])
def test_gradient_of_a_linear_field_is_exact(block, fan):
    mesh = block(fan=fan)
    geometry = gauss_geometry(mesh)
    r, z = mesh.nodes.T
    u = np.stack((0.3 * r, 0.2 * z - 0.1 * r))
    H = geometry.gradient(u[:, mesh.elements].reshape(18, -1))
    for component, value in zip(H, (0.3, 0.0, 0.3, -0.1, 0.2), strict=True):
        np.testing.assert_allclose(component, value, atol=1e-13)


def test_gauss_points_stay_off_the_axis(block):
    assert np.isfinite(gauss_geometry(block()).hoop).all()


@pytest.mark.parametrize("fan", [False, True])
def test_pressure_shapes_are_orthonormal(block, fan):
    geometry = gauss_geometry(block(fan=fan))
    products = np.einsum("iqe,jqe,qe->eij", geometry.pressure, geometry.pressure, geometry.weight)
    np.testing.assert_allclose(products, np.broadcast_to(np.eye(3), products.shape), atol=1e-12)


def test_pull_back_is_the_transpose_of_the_gradient(block):
    """P : H(u) = rows(P) . u, summed over the points."""
    mesh = block(fan=True)
    geometry, rng = gauss_geometry(mesh), np.random.default_rng(5)
    u = rng.normal(size=(18, mesh.elements.shape[1]))
    P = rng.normal(size=(5, *geometry.weight.shape))
    rows = geometry.pull_back(P).reshape(5 * geometry.shapes.count, -1)
    split = 3 * geometry.shapes.count
    work = np.sum(rows[:split] * (geometry.shapes.radial @ u[:9])) + np.sum(
        rows[split:] * (geometry.shapes.vertical @ u[9:])
    )
    assert work == pytest.approx(np.sum(P * geometry.gradient(u)), rel=1e-12)


def test_other_points_see_the_same_field(block):
    mesh = block()
    gauss = gauss_geometry(mesh)
    again = point_geometry(mesh, gauss, gauss.shapes.points)
    u = np.random.default_rng(6).normal(size=(18, mesh.elements.shape[1]))
    np.testing.assert_allclose(again.gradient(u), gauss.gradient(u))
    np.testing.assert_allclose(again.pressure, gauss.pressure)
