"""An interface that slides beyond a shear stress, against layered elasticity worked out apart."""

import numpy as np
import pytest
from scipy.special import j1

from wavemodel import (
    DiscTool,
    LayeredWave,
    NotCoveredError,
    Physics,
    Prony,
    ShearLimit,
    WaveDiscretisation,
    WaveError,
    WaveLayer,
)
from wavemodel.layered.shear_limit import shear_on, sliding_surface
from wavemodel.layered.stack.compliance import every_face, exact_faces
from wavemodel.layered.stack.laminate import laminate
from wavemodel.physics import InterfaceSlip

TIME = np.arange(1.0, 41.0)
TRIANGLE = 1e-3 * np.minimum(TIME, 41.0 - TIME) / 20.0


def slipping(layers, face, stress=1.0, contact="uniform_pressure", **options):
    return LayeredWave(
        layers, DiscTool(5e-3, contact), slip=ShearLimit(stress, face), **{"large_press": "linear", **options}
    )


@pytest.mark.parametrize("face", [1, 2, 3])
@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_a_free_interface_is_as_stiff_as_one_of_next_to_no_shear_modulus(skin, face, contact):
    """A film that carries pressure, is too thin to be squeezed out and too soft for shear; 0.3 % of the stiffness."""
    film = WaveLayer("film", 1e-7, 1000.0, 3e-3, 0.5 - 5e-11)
    layers = skin()
    filmed = LayeredWave([*layers[:face], film, *layers[face:]], DiscTool(5e-3, contact), large_press="linear")
    wave = slipping(layers, face, contact=contact)
    left = (1.0 - wave.options.slip.share) / wave.press.compliance
    assert left == pytest.approx(1.0 / filmed.press.compliance, rel=0.003)
    assert 0.005 < wave.options.slip.share < 0.6


@pytest.mark.parametrize("face", [1, 2])
def test_the_shear_on_an_interface_is_that_of_exact_layered_elasticity(skin, oracle, uniform_load, face):
    """From the waves that decay from each face, as tractions on the plane between two layers."""
    elasticity, layers = oracle(skin()), skin()
    limit = 12.0 / sum(one.thickness for one in layers[:face])
    point, weight = np.polynomial.legendre.leggauss(6)
    width = limit / 300
    k = ((np.arange(300) + 0.5)[:, None] * width + 0.5 * width * point).ravel()
    measure = np.tile(0.5 * width * weight, 300) * k / (2.0 * np.pi)
    shear = np.array([traction(elasticity, one, face) for one in k])
    loads = uniform_load(5e-3)(k)
    radii = np.linspace(0.0, 20e-3, 2001)
    expected = np.abs((np.einsum("kj,kj->k", shear, loads) * measure) @ j1(np.outer(k, radii))).max()
    slip = slipping(layers, face, stress=2e3).options.slip
    assert slip.limit == pytest.approx(2e3 / expected, rel=2e-3)


def traction(elasticity, k, face):
    """(2,) shear traction on an interface per unit surface load along U and W: G (dU/dz + k W), by differences."""
    layers, step = list(elasticity.layers), 1e-3 / k
    above = layers[face - 1]
    step = min(step, 0.2 * above.thickness)
    cut = [
        *layers[: face - 1],
        WaveLayer("upper", above.thickness - 2.0 * step, above.density, above.youngs_modulus, above.poisson_ratio),
        WaveLayer("near", step, above.density, above.youngs_modulus, above.poisson_ratio),
        WaveLayer("at", step, above.density, above.youngs_modulus, above.poisson_ratio),
        *layers[face:],
    ]
    faces = type(elasticity)(cut).compliance(k)[face : face + 3]
    slope = (3.0 * faces[2, 0] - 4.0 * faces[1, 0] + faces[0, 0]) / (2.0 * step)
    return above.shear_modulus * (slope + k * faces[2, 1])


def test_a_press_is_bonded_below_the_limit_and_loses_the_share_beyond_it(skin):
    bonded = LayeredWave(skin(), DiscTool(5e-3), large_press="linear").run("depth", TIME, TRIANGLE).force
    peak = bonded.max()
    per_force = 1.0 / slipping(skin(), 1).options.slip.limit
    wave = slipping(skin(), 1, stress=0.5 * peak * per_force)
    share, found = wave.options.slip.share, wave.run("depth", TIME, TRIANGLE).force
    rising = TIME <= 20.0
    stuck = rising & (bonded <= 0.5 * peak)
    np.testing.assert_allclose(found[stuck], bonded[stuck], rtol=1e-9)
    beyond = rising & ~stuck
    expected = (1.0 - share) * bonded + share * 0.5 * peak
    np.testing.assert_allclose(found[beyond], expected[beyond], rtol=1e-9)
    assert np.all(found[~rising] <= found[rising][::-1] + 1e-12)
    assert found[-1] < bonded[-1]


@pytest.mark.parametrize("options", [{"relaxation": Prony((0.3,), (2.0,))}, {"large_press": "corrected"}])
def test_force_and_depth_control_agree_beside_other_options(skin, options):
    wave = slipping(skin(), 3, stress=20.0, **options)
    force = wave.run("depth", TIME[:20], TRIANGLE[:20]).force
    np.testing.assert_allclose(wave.run("force", TIME[:20], force).depth, TRIANGLE[:20], rtol=1e-7)


@pytest.mark.parametrize(("face", "stress", "word"), [(0, 1.0, "face = 0"), (4, 1.0, "1 to 3"), (1, 0.0, "stress")])
def test_refuses_what_is_no_interface(skin, face, stress, word):
    with pytest.raises(WaveError, match=word):
        slipping(skin(), face, stress)


def test_without_a_face_the_interface_that_slides_first_does(skin):
    first = min((slipping(skin(), face).options.slip for face in (1, 2)), key=lambda slip: slip.limit)
    assert slipping(skin(), None).options.slip == first
    with pytest.raises(WaveError, match="single layer"):
        slipping(skin()[2:], None)


def test_says_what_it_does_not_cover(skin):
    with pytest.raises(NotCoveredError, match="free lower face"):
        slipping(skin(), 1, support="free", discretisation=WaveDiscretisation(window=60e-3))
    with pytest.raises(NotCoveredError, match="inertia"):
        slipping(skin(), 1, integrator="exact")
    with pytest.raises(WaveError, match="twice"):
        slipping(skin(), 1, physics=Physics(slip=InterfaceSlip(1.0, 0.1)))


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
