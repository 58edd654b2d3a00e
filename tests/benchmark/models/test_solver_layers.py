"""The laws of a tissue file as the wave takes them."""

import numpy as np
import pytest

from benchmark.files import load_scenario
from benchmark.models import UncoveredError, prepare, scenario_drive
from benchmark.models.solver_layers import MaterialEnergy, wave_layers

LAWS = {
    "yeoh": {"hyperelastic": '{ law = "yeoh", c10 = "5 kPa", c20 = "5 kPa", c30 = "2 kPa" }'},
    "mooney_rivlin": {"hyperelastic": '{ law = "mooney_rivlin", c10 = "3 kPa", c01 = "2 kPa" }'},
    "gent": {"hyperelastic": '{ law = "gent", mu = "10 kPa", jm = 3.0 }'},
    "ogden": {"hyperelastic": '{ law = "ogden", terms = [{ mu = "2 kPa", alpha = 10.0 }] }'},
    "fibres": {"fibre": '{ k1 = "16 kPa", k2 = 2.0, dispersion = 0.1 }'},
}
FAT = "subcutaneous_fat"


def told(law: str) -> dict[str, str]:
    return {f"{FAT}.{key}": value for key, value in LAWS[law].items()}


def energy_of(law: str) -> MaterialEnergy:
    layer = wave_layers(load_scenario("skin-5N", told(law)).tissue.layers)[-1]
    assert isinstance(layer.law, MaterialEnergy)
    return layer.law


def test_neo_hookean_layers_are_the_wave_s_own() -> None:
    assert all(layer.law is None for layer in wave_layers(load_scenario("skin-5N").tissue.layers))


@pytest.mark.parametrize("law", LAWS)
def test_stress_and_tangent_are_derivatives_in_the_wave_s_components(law: str) -> None:
    energy, step = energy_of(law), 1e-6
    rng = np.random.default_rng(4)
    here, way = 0.1 * rng.standard_normal((2, 5, 7))
    ahead, back = here + step * way, here - step * way
    power = (energy.energy(ahead) - energy.energy(back)) / (2.0 * step)
    np.testing.assert_allclose((energy.stress(here) * way).sum(axis=0), power, rtol=1e-5, atol=1e-3)
    change = (energy.stress(ahead) - energy.stress(back)) / (2.0 * step)
    turned = np.einsum("ij...,j...->i...", energy.tangent(here), way)
    np.testing.assert_allclose(turned, change, atol=1e-5 * np.abs(change).max())
    turned_over = here * np.array([1.0, -1.0, -1.0, 1.0, 1.0])[:, None]  # z up
    np.testing.assert_allclose(energy.energy(turned_over), energy.energy(here), rtol=1e-9)


BONDED = {"tool.contact": "rigid_bonded"}
AT_REST = {f"{FAT}.youngs_modulus": "29.6 kPa"}
PRESSES = {
    "Yeoh's fat under a bonded tool": (told("yeoh"), {**BONDED, "load.peak": "8 N"}, AT_REST),
    "Ogden's fat under a pressure": (told("ogden"), {"load.peak": "5 N"}, AT_REST),
    "a sheet with fibres over a hole": (
        {"silicone.fibre": '{ k1 = "300 kPa", k2 = 2.0, dispersion = 0.1 }'},
        {**BONDED, "load.peak": "3 N"},
        {},
    ),
}


@pytest.mark.parametrize("name", PRESSES)
def test_the_wave_follows_a_layer_s_law_as_the_finite_elements_do(name: str) -> None:
    law, press, plain = PRESSES[name]
    press = {"load.observations": "2", **press}
    base = "phantom" if "hole" in name else "skin-5N"
    scenario = load_scenario(base, {**press, **law})
    drive = scenario_drive(scenario)
    truth, found = (prepare(model, scenario).run(drive) for model in ("fem", "wave"))
    assert truth.failure is None
    np.testing.assert_allclose(found.top_deflection[0], truth.top_deflection[0], rtol=0.01)
    inside = np.isfinite(found.profile)
    assert inside.sum() > 10
    np.testing.assert_allclose(found.profile[inside], truth.profile[inside], atol=0.02 * truth.profile.max())
    assert not any("takes the layer" in warning for warning in found.warnings)
    neo = prepare("wave", load_scenario(base, {**press, **plain})).run(drive)
    assert neo.depth[0] > 1.02 * truth.depth[0]


def test_a_plate_theory_says_that_it_does_not_follow_the_law() -> None:
    hole = {"support.kind": "hole", "support.hole_radius": "30 mm", "wave.model": "plate", "load.peak": "0.1 N"}
    scenario = load_scenario("skin-5N", {**hole, "load.observations": "2", **told("yeoh")})
    found = prepare("wave", scenario).run(scenario_drive(scenario))
    assert any("takes the layer subcutaneous_fat for neo-Hookean" in warning for warning in found.warnings)


def test_a_law_whose_constants_are_not_taken_is_not_covered() -> None:
    scenario = load_scenario("skin-5N", {**told("yeoh"), f"{FAT}.poisson_ratio": "0.49995"})
    with pytest.raises(UncoveredError, match="subcutaneous_fat: poisson_ratio"):
        prepare("wave", scenario)
