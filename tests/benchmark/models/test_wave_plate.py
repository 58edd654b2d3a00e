"""The wave over a hole, through scenario files."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario
from benchmark.models import ModelResult, UncoveredError, prepare, scenario_drive

SHORT = {"load.observations": "10"}
SKIN_OVER_A_HOLE = {"support.kind": "hole", "support.hole_radius": "30 mm", "load.peak": "1 N"}


def pressed(scenario: Scenario, model: str = "wave") -> ModelResult:
    return prepare(model, scenario).run(scenario_drive(scenario))


@pytest.mark.parametrize(
    ("name", "settings"), [("phantom", SHORT), ("skin-5N", {**SHORT, **SKIN_OVER_A_HOLE})], ids=["phantom", "skin"]
)
def test_it_follows_the_fem_at_every_load_step(name: str, settings: dict[str, str]) -> None:
    scenario = load_scenario(name, settings)
    fem, wave = pressed(scenario, "fem"), pressed(scenario)
    peak = fem.top_deflection.max(axis=0)
    np.testing.assert_allclose(wave.top_deflection / peak, fem.top_deflection / peak, atol=0.02)
    inside = fem.profile_radii <= scenario.support.hole_radius
    np.testing.assert_allclose(wave.profile[:, inside], fem.profile[:, inside], atol=0.05 * fem.profile.max())


def test_layered_over_a_hole_is_the_layered_sheet_and_the_plate_theory_is_near() -> None:
    light = {"load.observations": "4", "load.peak": "0.5 N"}
    by_default, by_name = (
        pressed(load_scenario("phantom", {**light, "wave.model": word})) for word in ("layered", "plate")
    )
    np.testing.assert_allclose(by_default.top_deflection, by_name.top_deflection, rtol=0.02)
    assert by_default.notes["window"] == "the hole, 60 mm wide"
    assert "no calibration" in by_default.notes["model"]
    assert "identified once" in by_name.notes["model"]


def test_a_profile_ends_at_the_hole_s_edge() -> None:
    result = pressed(load_scenario("phantom", {**SHORT, "support.hole_radius": "20 mm", "load.peak": "1 N"}))
    assert np.array_equal(np.isnan(result.profile[0]), result.profile_radii > 20e-3)


def test_depth_control_gives_the_force_back() -> None:
    by_force = pressed(load_scenario("phantom", {**SHORT, "load.peak": "2 N", "load.shape": "ramp"}))
    peak = f"{1e3 * by_force.depth[-1]:.17g} mm"
    by_depth = pressed(
        load_scenario("phantom", {**SHORT, "load.control": "depth", "load.peak": peak, "load.shape": "ramp"})
    )
    assert by_depth.force[-1] == pytest.approx(2.0, rel=1e-3)


def test_more_or_fewer_functions_only_where_the_plate_is_asked_for() -> None:
    asked = pressed(load_scenario("phantom", {**SHORT, "wave.model": "plate", "wave.modes": "8"}))
    assert (asked.notes["modes"], asked.warnings) == ("8 radial functions each", ())
    automatic = pressed(load_scenario("phantom", {**SHORT, "wave.modes": "8", "wave.window": "40 mm"}))
    assert automatic.notes["modes"] == "40 radial functions each"
    assert [warning.split(" is left out")[0] for warning in automatic.warnings] == ["wave.window", "wave.modes"]


YEOH = {"silicone.hyperelastic": '{ law = "yeoh", c10 = "60 kPa", c20 = "30 kPa" }'}
AT_REST = {"silicone.youngs_modulus": "357.6 kPa"}
PLATE = {"wave.model": "plate"}


def test_a_law_that_the_plate_theory_does_not_have_it_says() -> None:
    result = pressed(load_scenario("phantom", {**SHORT, **PLATE, **YEOH}))
    assert "its yeoh law" in " ".join(result.warnings)
    plain = pressed(load_scenario("phantom", {**SHORT, **PLATE, **AT_REST}))
    np.testing.assert_allclose(result.depth, plain.depth, rtol=1e-6)


def test_the_layered_sheet_follows_a_law_as_the_fem_does() -> None:
    few = {"load.observations": "4"}
    scenario, plain = load_scenario("phantom", {**few, **YEOH}), load_scenario("phantom", {**few, **AT_REST})
    fem, wave = pressed(scenario, "fem"), pressed(scenario)
    assert wave.warnings == ()
    stiffer = 1.0 - wave.depth.max() / pressed(plain).depth.max()
    assert stiffer > 0.02
    np.testing.assert_allclose(wave.depth.max(), fem.depth.max(), rtol=0.25 * stiffer)


def test_layers_over_a_hole_that_relax_each_in_its_own_way_are_left_elastic_and_it_says_so() -> None:
    press = {**SHORT, "support.kind": "hole", "support.hole_radius": "30 mm", "load.peak": "0.1 N"}
    result = pressed(load_scenario("skin-5N", {**press, "dermis.relaxation": '[{ g = 0.3, tau = "0.5 s" }]'}))
    assert "relaxation of dermis is left out" in " ".join(result.warnings)
    np.testing.assert_array_equal(result.depth, pressed(load_scenario("skin-5N", press)).depth)


@pytest.mark.parametrize(
    ("settings", "error", "word"),
    [
        ({"support.kind": "bonded"}, UncoveredError, "bonded"),
        ({"wave.model": "plate", "wave.modes": "3"}, InputError, "modes = 3"),
        ({"silicone.youngs_modulus": "1 kPa", "load.peak": "1000 N"}, UncoveredError, "followed up to"),
    ],
    ids=["on a base", "too few functions", "no equilibrium"],
)
def test_what_it_cannot_answer(settings: dict[str, str], error: type[Exception], word: str) -> None:
    with pytest.raises(error, match=word):
        prepare("wave", load_scenario("phantom", {"wave.model": "plate", **settings}))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"silicone.thickness": "1.2 m"}, ["thickness of 1200 mm", "radius of 5 mm", "3.3 times"]),
        (
            {"support.hole_radius": "4 m", "tool.contact": "uniform_pressure"},
            ["thickness of 4 mm", "hole (hole_radius) of 4000 mm", "up to a force of 0 N"],
        ),
    ],
    ids=["too thick", "no equilibrium at all"],
)
def test_a_sheet_that_is_not_covered_is_told_by_what_was_given(settings: dict[str, str], words: list[str]) -> None:
    """The first took all memory; the second was a load that nobody had given."""
    with pytest.raises(UncoveredError) as refused:
        prepare("wave", load_scenario("phantom", settings))
    assert all(word in str(refused.value) for word in words)
    assert "load =" not in str(refused.value)
