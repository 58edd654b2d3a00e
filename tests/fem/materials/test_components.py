import numpy as np
import pytest

from fem.materials.components import AXISYMMETRIC, SOLID

BOTH = pytest.mark.parametrize("components", [AXISYMMETRIC, SOLID], ids=["axisymmetric", "solid"])


def full(H, components=AXISYMMETRIC):
    return np.eye(3) + components.tensor(H)


def test_pairs_cover_the_upper_triangle_once_block_by_block():
    k, m = AXISYMMETRIC.pairs
    assert len(set(zip(k.tolist(), m.tolist(), strict=True))) == 15
    assert (k <= m).all()
    blocks = [(int(a) // 3, int(b) // 3) for a, b in zip(k, m, strict=True)]
    assert blocks == [(0, 0)] * 6 + [(0, 1)] * 6 + [(1, 1)] * 3


@BOTH
def test_cofactor_is_the_cofactor_of_the_tensor(components):
    H = np.random.default_rng(1).normal(scale=0.3, size=(len(components.positions), 7))
    F = full(H, components)
    cofactor = np.linalg.det(F)[:, None, None] * np.linalg.inv(F).transpose(0, 2, 1)
    ours = full(components.cofactor_change(H), components)
    np.testing.assert_allclose(ours, cofactor, rtol=1e-12, atol=1e-13)


@BOTH
def test_cofactor_derivative_is_the_difference_quotient(components):
    rng, count = np.random.default_rng(2), len(components.positions)
    H, step = rng.normal(scale=0.3, size=count), 1e-6
    packed = np.zeros(len(components.pairs[0]))
    packed[components.cofactor_pairs] = components.cofactor_derivative(H + components.identity)
    derivative = components.unpack(packed)
    for n in range(count):
        e = step * np.eye(count)[n]
        quotient = (components.cofactor_change(H + e) - components.cofactor_change(H - e)) / (2 * step)
        np.testing.assert_allclose(derivative[:, n], quotient, atol=1e-9)


@BOTH
def test_deviator_projects(components):
    projection = components.unpack(components.deviator)
    np.testing.assert_allclose(projection @ projection, projection, atol=1e-15)
    np.testing.assert_allclose(projection @ components.identity, 0.0, atol=1e-15)


@BOTH
def test_right_product_and_volume_change_are_those_of_the_tensor(components):
    H = np.random.default_rng(3).normal(scale=0.2, size=(len(components.positions), 6))
    tensor = components.tensor(H)
    product = components.tensor(components.right_product(H))
    np.testing.assert_allclose(product, tensor.transpose(0, 2, 1) @ tensor, atol=1e-14)
    change = components.volume_change(H, components.cofactor_change(H))
    np.testing.assert_allclose(change, np.linalg.det(full(H, components)) - 1.0, rtol=1e-11)


@BOTH
def test_largest_principal_strain_is_the_eigenvalue(components):
    values = np.random.default_rng(14).normal(size=(len(components.positions), 20))
    values = 0.5 * (values + values[components.transposed])
    eigenvalues = np.linalg.eigvalsh(components.tensor(values))
    np.testing.assert_allclose(components.largest_principal(values), np.abs(eigenvalues).max(axis=1), rtol=1e-12)
