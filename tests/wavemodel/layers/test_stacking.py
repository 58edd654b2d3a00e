import numpy as np

from wavemodel.layers.compliance import exact_faces, quadratic_faces
from wavemodel.layers.laminate import laminate
from wavemodel.layers.stacking import inverse, layer_faces, stacked

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
