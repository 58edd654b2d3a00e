import numpy as np

from fem.components import AXISYMMETRIC


def full(H):
    return np.eye(3) + AXISYMMETRIC.tensor(H)


def test_pairs_cover_the_upper_triangle_once_block_by_block():
    k, m = AXISYMMETRIC.pairs
    assert len(set(zip(k.tolist(), m.tolist(), strict=True))) == 15
    assert (k <= m).all()
    blocks = [(int(a) // 3, int(b) // 3) for a, b in zip(k, m, strict=True)]
    assert blocks == [(0, 0)] * 6 + [(0, 1)] * 6 + [(1, 1)] * 3


def test_cofactor_is_the_cofactor_of_the_tensor():
    H = np.random.default_rng(1).normal(scale=0.3, size=(5, 7))
    cofactor = np.linalg.det(full(H))[:, None, None] * np.linalg.inv(full(H)).transpose(0, 2, 1)
    ours = full(AXISYMMETRIC.cofactor_change(H))
    np.testing.assert_allclose(ours, cofactor, rtol=1e-12, atol=1e-13)


def test_cofactor_derivative_is_the_difference_quotient():
    rng = np.random.default_rng(2)
    H, step = rng.normal(scale=0.3, size=5), 1e-6
    F = H + AXISYMMETRIC.identity
    packed = np.zeros(15)
    packed[AXISYMMETRIC.cofactor_pairs] = AXISYMMETRIC.cofactor_derivative(F)
    derivative = AXISYMMETRIC.unpack(packed)
    for n in range(5):
        e = step * np.eye(5)[n]
        quotient = (AXISYMMETRIC.cofactor_change(H + e) - AXISYMMETRIC.cofactor_change(H - e)) / (2 * step)
        np.testing.assert_allclose(derivative[:, n], quotient, atol=1e-9)


def test_deviator_projects():
    projection = AXISYMMETRIC.unpack(AXISYMMETRIC.deviator)
    np.testing.assert_allclose(projection @ projection, projection, atol=1e-15)
    np.testing.assert_allclose(projection @ AXISYMMETRIC.identity, 0.0, atol=1e-15)
