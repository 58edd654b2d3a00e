import numpy as np
import pytest

from wavemodel.layers.compliance import every_face, exact_faces
from wavemodel.layers.laminate import laminate
from wavemodel.layers.sliding import shear_on, sliding_surface

K = np.array([30.0, 300.0, 3000.0])
LOAD = np.array([[0.2, 1.0]] * 3)


@pytest.fixture
def stack(skin):
    return laminate(skin(), [np.ones(1)] * 3, "bonded")


def test_the_shear_is_in_equilibrium_with_the_body_above(stack):
    """What the layers above pass on to an interface is what the layers below ask of it."""
    blocks = exact_faces(K, stack)
    faces = np.einsum("nsij,nj->nsi", every_face(stack, blocks), LOAD)
    for node in (1, 2):
        below = np.concatenate([faces[:, node], faces[:, node + 1]], axis=-1)
        onto = np.einsum("nij,nj->ni", blocks[:, node], below)[:, 0]
        np.testing.assert_allclose(shear_on(stack, blocks, LOAD, node), onto, rtol=1e-6, atol=1e-9 * np.abs(onto).max())


@pytest.mark.parametrize("node", [1, 2, 3])
def test_a_sliding_face_makes_the_surface_softer_and_symmetric(stack, node):
    blocks = exact_faces(K, stack)
    sliding, bonded = sliding_surface(stack, blocks, node), every_face(stack, blocks)[:, 0]
    np.testing.assert_allclose(sliding[:, 0, 1], sliding[:, 1, 0], rtol=1e-9)
    softer = np.linalg.eigvalsh(sliding - bonded)
    assert np.all(softer > -1e-9 * np.abs(sliding).max(axis=(1, 2))[:, None])
    assert softer[0].max() > 1e-3 * bonded[0].max()


def test_a_lone_layer_on_a_smooth_base_keeps_its_lower_face_level_and_free_to_spread(skin):
    """Its stiffness (U, W of the top, U of the bottom) with W of the bottom held, inverted as a whole."""
    stack = laminate(skin()[2:], [np.ones(1)], "bonded")
    block = exact_faces(K, stack)
    held = np.linalg.inv(block[:, 0, :3, :3])[:, :2, :2]
    np.testing.assert_allclose(sliding_surface(stack, block, 1), held, rtol=1e-8, atol=1e-14 * np.abs(held).max())
