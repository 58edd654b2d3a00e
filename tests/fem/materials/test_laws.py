"""What every hyperelastic law must satisfy, in both geometries: derivatives, objectivity, rest, digits."""

import numpy as np
import pytest

import fem
from fem.materials.components import AXISYMMETRIC, SOLID
from fem.materials.deformation import Deformation
from fem.materials.neo_hookean import CoupledNeoHookean

NU = 0.49
GROUNDS = {
    "neo_hookean": fem.NeoHookean(9e4, NU),
    "mooney_rivlin": fem.MooneyRivlin(1.2e4, 0.5e4, NU),
    "yeoh": fem.Yeoh(1.5e4, -2e3, 1.5e3, NU),
    "ogden": fem.Ogden(((1.2e4, 2.7), (-5e3, -3.0)), NU),
    "gent": fem.Gent(3e4, 20.0, NU),
}
PLANAR = fem.FibreReinforced(GROUNDS["neo_hookean"], (fem.Fibre(2e4, 1.5, 0.1),))
CROSSED = fem.FibreReinforced(GROUNDS["mooney_rivlin"], (fem.Fibre(2e4, 1.5, 0.1, 0.6), fem.Fibre(1e4, 3.0, 0.0, -0.4)))
CASES = [pytest.param(AXISYMMETRIC, law, id=f"axisymmetric-{name}") for name, law in GROUNDS.items()]
CASES += [pytest.param(SOLID, law, id=f"solid-{name}") for name, law in GROUNDS.items()]
CASES += [pytest.param(AXISYMMETRIC, PLANAR, id="axisymmetric-fibres"), pytest.param(SOLID, CROSSED, id="solid-fibres")]


def gradients(components, size=0.15, count=6, seed=5):
    """Random displacement gradients (components, count)."""
    return np.random.default_rng(seed).normal(scale=size, size=(len(components.positions), count))


def evaluate(material, components, H):
    d = Deformation(components, H)
    p = np.array(material.parameters)
    return material.law.energy(d, p), material.law.stress(d, p), components.unpack(material.law.tangent(d, p))


def central(function, H, step=2e-3):
    """Derivative by each component by differences of tenth order, (components, ...)."""
    weights = (5 / 6, -5 / 21, 5 / 84, -5 / 504, 1 / 1260)
    out = []
    for k in range(len(H)):
        e = np.zeros_like(H)
        e[k] = step
        slope = sum(w * (function(H + n * e) - function(H - n * e)) for n, w in enumerate(weights, start=1))
        out.append(slope / step)
    return np.array(out)


@pytest.mark.parametrize(("components", "material"), CASES)
def test_stress_is_the_derivative_of_the_energy(components, material):
    H = gradients(components)
    slope = central(lambda h: evaluate(material, components, h)[0], H)
    stress = evaluate(material, components, H)[1]
    np.testing.assert_allclose(stress, slope, atol=1e-9 * np.abs(stress).max())


@pytest.mark.parametrize(("components", "material"), CASES)
def test_tangent_is_the_derivative_of_the_stress(components, material):
    H = gradients(components)
    slope = central(lambda h: evaluate(material, components, h)[1], H)
    tangent = evaluate(material, components, H)[2]
    np.testing.assert_allclose(tangent, slope, atol=1e-9 * np.abs(tangent).max())


@pytest.mark.parametrize(("components", "material"), CASES)
def test_rest_is_free_of_stress_with_the_stated_shear_modulus(components, material):
    H = np.zeros((len(components.positions), 1))
    energy, stress, tangent = evaluate(material, components, H)
    assert np.abs(energy).max() == 0.0
    assert np.abs(stress).max() == 0.0
    expected = 2 * material.shear_modulus * components.unpack(components.deviator)
    np.testing.assert_allclose(tangent[..., 0], expected, atol=1e-12 * material.shear_modulus)


@pytest.mark.parametrize(("components", "material"), CASES[:10])
def test_tiny_strain_keeps_its_digits(components, material):
    H = 1e-10 * gradients(components)
    linear = 2 * material.shear_modulus * components.unpack(components.deviator) @ H
    stress = evaluate(material, components, H)[1]
    np.testing.assert_allclose(stress, linear, atol=1e-8 * np.abs(linear).max())


@pytest.mark.parametrize("material", [*GROUNDS.values(), CROSSED], ids=[*GROUNDS, "fibres"])
def test_stress_turns_with_the_body(material):
    H = gradients(SOLID)
    Q = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    Q *= np.linalg.det(Q)
    F = SOLID.tensor(H + SOLID.identity[:, None])
    turned = (Q @ F).reshape(-1, 9).T - SOLID.identity[:, None]
    expected = Q @ SOLID.tensor(evaluate(material, SOLID, H)[1])
    found = SOLID.tensor(evaluate(material, SOLID, turned)[1])
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("material", [*GROUNDS.values(), PLANAR], ids=[*GROUNDS, "fibres"])
def test_the_geometries_agree(material):
    """A motion without torsion has the same stress in both."""
    H = gradients(AXISYMMETRIC)
    solid = AXISYMMETRIC.tensor(H).reshape(-1, 9).T
    expected = AXISYMMETRIC.tensor(evaluate(material, AXISYMMETRIC, H)[1])
    found = SOLID.tensor(evaluate(material, SOLID, solid)[1])
    np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())


def uniaxial(material, stretch):
    """Nominal stress of an incompressible body from the components of P: P_zz - P_rr F_rr / F_zz."""
    side = stretch**-0.5
    H = np.array([side - 1, 0.0, side - 1, 0.0, stretch - 1])[:, None]
    stress = evaluate(material, AXISYMMETRIC, H)[1][:, 0]
    return stress[4] - stress[0] * side / stretch


@pytest.mark.parametrize("stretch", [0.6, 0.9, 1.3, 1.8])
def test_incompressible_uniaxial_stress(stretch):
    """Closed forms: Rivlin, Yeoh 1993, Ogden 1972, Gent 1996."""
    first, difference = stretch**2 + 2 / stretch - 3, stretch - stretch**-2
    expected = {
        "mooney_rivlin": 2 * difference * (1.2e4 + 0.5e4 / stretch),
        "yeoh": 2 * difference * (1.5e4 - 2 * 2e3 * first + 3 * 1.5e3 * first**2),
        "ogden": sum(mu * (stretch ** (a - 1) - stretch ** (-a / 2 - 1)) for mu, a in ((1.2e4, 2.7), (-5e3, -3.0))),
        "gent": 3e4 * 20.0 / (20.0 - first) * difference,
    }
    for name, value in expected.items():
        assert uniaxial(GROUNDS[name], stretch) == pytest.approx(value, rel=1e-10), name


def test_fibres_bear_tension_only():
    """Along an aligned family P = 4 k1 E exp(k2 E^2) l / 2, E = l^2 - 1, on top of the ground; none when shortened."""
    fibre = fem.FibreReinforced(GROUNDS["neo_hookean"], (fem.Fibre(2e4, 1.5, 0.0, 0.0),))
    for stretch in (0.8, 1.2):
        side = stretch**-0.5
        H = (np.diag([stretch, side, side]) - np.eye(3)).reshape(9, 1)
        extra = (evaluate(fibre, SOLID, H)[1] - evaluate(fibre.ground, SOLID, H)[1])[:, 0]
        strain = max(stretch**2 - 1, 0.0)
        nominal = extra[0] - extra[4] * side / stretch
        assert nominal == pytest.approx(2 * 2e4 * strain * np.exp(1.5 * strain**2) * stretch, rel=1e-10)


def test_full_dispersion_has_no_direction():
    one, other = (fem.FibreReinforced(GROUNDS["gent"], (fem.Fibre(2e4, 1.5, 1 / 3, angle),)) for angle in (0.3, 1.2))
    H = gradients(SOLID)
    np.testing.assert_allclose(evaluate(one, SOLID, H)[1], evaluate(other, SOLID, H)[1], rtol=1e-9, atol=1e-9)
    assert not one.fibres[0].directed


def test_a_locked_chain_has_no_answer():
    stretch = np.diag([4.0, 0.5, 0.5]) - np.eye(3)
    assert np.isnan(evaluate(fem.Gent(1e4, 5.0, NU), SOLID, stretch.reshape(9, 1))[1]).all()


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: fem.MooneyRivlin(1e4, -2e4, NU), "must be above 0 Pa"),
        (lambda: fem.MooneyRivlin(np.nan, 1e4, NU), "c10"),
        (lambda: fem.Yeoh(-1.0, 0.0, 0.0, NU), "c10"),
        (lambda: fem.Yeoh(1.0, np.inf, 0.0, NU), "c20"),
        (lambda: fem.Ogden((), NU), "none given"),
        (lambda: fem.Ogden(((1e4, 0.0),), NU), "must not be zero"),
        (lambda: fem.Ogden(((-1e4, 2.0),), NU), "must be above 0 Pa"),
        (lambda: fem.Gent(1e4, 0.0, NU), "jm"),
        (lambda: fem.Gent(1e4, 1.0, 0.5), "poisson_ratio"),
        (lambda: fem.Yeoh(1e4, 0.0, 0.0, -2.0), "poisson_ratio"),
        (lambda: fem.Fibre(0.0, 1.0), "k1"),
        (lambda: fem.Fibre(1.0, 0.0), "k2"),
        (lambda: fem.Fibre(1.0, 1.0, 0.4), "dispersion"),
        (lambda: fem.Fibre(1.0, 1.0, 0.1, np.nan), "angle"),
        (lambda: fem.FibreReinforced(GROUNDS["gent"], ()), "at least one"),
        (lambda: fem.FibreReinforced(fem.LinearElastic(1e4, NU), (fem.Fibre(1.0, 1.0),)), "hyperelastic"),
    ],
)
def test_constants_outside_their_range_are_refused(make, match):
    with pytest.raises(fem.FemError, match=match):
        make()


@pytest.mark.parametrize("components", [AXISYMMETRIC, SOLID])
def test_the_coupled_law_derives_from_its_energy(components):
    material = CoupledNeoHookean(9e4, 0.4)
    H = gradients(components)
    _, stress, tangent = evaluate(material, components, H)
    slope = central(lambda at: evaluate(material, components, at)[0], H)
    bend = central(lambda at: evaluate(material, components, at)[1], H)
    np.testing.assert_allclose(stress, slope, atol=1e-8 * np.abs(stress).max())
    np.testing.assert_allclose(tangent, bend, atol=1e-8 * np.abs(tangent).max())
