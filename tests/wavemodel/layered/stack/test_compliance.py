from dataclasses import replace

import numpy as np
import pytest

from wavemodel.layered.stack.compliance import (
    compliance,
    doubled_faces,
    exact_faces,
    inverse,
    layer_faces,
    quadratic_faces,
    stacked,
)
from wavemodel.layered.stack.laminate import laminate

K = np.geomspace(20.0, 5e3, 9)


def test_two_halves_are_the_whole(skin):
    whole = exact_faces(K, laminate(skin(), [(1.0,)] * 3, "bonded"))
    half = exact_faces(K, laminate(skin(), [(0.5, 0.5)] * 3, "bonded"))
    np.testing.assert_allclose(stacked(half[:, 4], half[:, 5]), whole[:, 2], rtol=1e-7, atol=1e-9 * whole.max())


def test_layers_are_joined_from_their_own_sublayers(skin):
    stack = laminate(skin(), [(1.0,), (0.5, 0.5), (0.2, 0.3, 0.5)], "bonded")
    blocks = quadratic_faces(K, stack)
    joined = layer_faces(stack, blocks)
    assert joined.shape == (9, 3, 4, 4)
    np.testing.assert_array_equal(joined[:, 0], blocks[:, 0])
    np.testing.assert_allclose(joined[:, 2], stacked(stacked(blocks[:, 3], blocks[:, 4]), blocks[:, 5]))


def test_inverse_of_symmetric_pairs():
    a = np.random.default_rng(1).normal(size=(5, 2, 2))
    a = a @ np.swapaxes(a, 1, 2)
    np.testing.assert_allclose(inverse(a) @ a, np.broadcast_to(np.eye(2), a.shape), atol=1e-10)


WAVENUMBERS = np.geomspace(20.0, 30e3, 25)


def halves(layers, count, base="bonded"):
    return laminate(layers, [(1.0 / count,) * count] * len(layers), base)


@pytest.mark.parametrize("nu", [0.3, 0.48, 0.499])
def test_exact_faces_give_layered_elasticity(skin, oracle, nu):
    ours = compliance(WAVENUMBERS, halves(skin(poisson_ratio=nu), 1), exact_faces).faces
    reference = np.stack([oracle(skin(poisson_ratio=nu)).compliance(k) for k in WAVENUMBERS])
    scale = np.abs(reference[:, :1]).max(axis=(2, 3), keepdims=True)
    np.testing.assert_allclose(ours / scale, reference / scale, atol=2e-9)


def test_exact_faces_do_not_care_how_a_layer_is_cut(skin):
    one, many = (compliance(WAVENUMBERS, halves(skin(), n), exact_faces).faces for n in (1, 5))
    np.testing.assert_allclose(one, many, rtol=1e-9, atol=1e-12 * np.abs(one).max())


@pytest.mark.parametrize("base", ["bonded", "free"])
def test_quadratic_sublayers_converge_with_the_fourth_power(skin, base):
    k = np.array([200.0, 400.0, 800.0])
    exact = compliance(k, halves(skin(), 1, base), exact_faces).faces[..., 1, 1]
    errors = [np.abs(compliance(k, halves(skin(), n, base)).faces[..., 1, 1] / exact - 1).max() for n in (4, 8)]
    assert errors[0] / errors[1] > 12.0
    assert errors[1] < 1e-3


def test_a_homogeneous_stack_is_a_half_space_at_large_wavenumbers(skin):
    layer = skin()[0]
    faces = compliance(np.array([2e6]), halves([layer], 1), exact_faces).faces[0, 0] * 2e6
    shear, nu = layer.shear_modulus, layer.poisson_ratio
    expected = np.array([[1 - nu, 0.5 - nu], [0.5 - nu, 1 - nu]]) / shear
    np.testing.assert_allclose(faces, expected, rtol=1e-9)


def test_condensation_leaves_the_energy_of_the_middle_node_out(skin):
    from wavemodel.layered.stack.sublayers import quadratic_stiffness

    stack = halves(skin(), 1)
    full = quadratic_stiffness(np.array([300.0]), stack)[0, 2]
    condensed = quadratic_faces(np.array([300.0]), stack)[0, 2]
    outer = np.array([1.0, -0.3, 0.2, 0.7])
    middle = -np.linalg.solve(full[4:, 4:], full[4:, :4] @ outer)
    whole = np.concatenate([outer, middle])
    assert outer @ condensed @ outer == pytest.approx(whole @ full @ whole)


@pytest.mark.parametrize("nu", [0.3, 0.48, 0.499])
def test_a_slice_put_on_its_like_again_and_again_is_the_exact_layer(skin, nu):
    stack = halves(skin(poisson_ratio=nu), 1)
    exact, doubled = exact_faces(WAVENUMBERS, stack), doubled_faces(WAVENUMBERS, stack)
    scale = np.abs(exact).max(axis=(2, 3), keepdims=True)
    np.testing.assert_allclose(doubled / scale, exact / scale, atol=2e-7)


def test_stressed_layers_are_what_many_sublayers_come_to(skin):
    stress = np.array([3e4, 2e4, 5e3])
    k = np.array([100.0, 400.0, 1600.0])
    layers = skin()
    exact = compliance(k, laminate(layers, [(1.0,)] * 3, "bonded", stress), exact_faces).faces
    fine = compliance(k, laminate(layers, [(1 / 64,) * 64] * 3, "bonded", stress)).faces
    relaxed = compliance(k, laminate(layers, [(1.0,)] * 3, "bonded"), exact_faces).faces
    scale = np.abs(exact[:, :1]).max(axis=(2, 3), keepdims=True)
    np.testing.assert_allclose(fine / scale, exact / scale, atol=5e-6)
    assert np.all(exact[:, 0, 1, 1] < 0.97 * relaxed[:, 0, 1, 1])


def test_stress_by_direction_is_taken_for_its_wavenumber_also_in_blocks(skin):
    k = np.tile([100.0, 400.0, 1600.0], 400)
    stress = np.repeat(np.linspace(0.0, 3e4, 400), 3)[:, None] * np.ones(3)
    all_at_once = compliance(k, laminate(skin(), [(1.0,)] * 3, "bonded", stress[0]).at(np.arange(3)))
    stack = laminate(skin(), [(1.0,)] * 3, "bonded")
    directed = compliance(k, replace(stack, tension=stress))
    last = compliance(k[-3:], replace(stack, tension=stress[-1]))
    np.testing.assert_allclose(directed.faces[-3:], last.faces, rtol=1e-12)
    np.testing.assert_allclose(directed.faces[:3], all_at_once.faces[:3], rtol=1e-12)
