"""Which strain the layered wave takes by itself, and what it says where it falls back."""

import numpy as np
import pytest

from benchmark.files import load_scenario
from benchmark.models import Drive, ModelResult, UncoveredError, prepare, scenario_drive, wave_layered
from benchmark.models.wave_parts import wave_tool
from wavemodel import LayeredWave

SHORT = {"load.observations": "4"}
FRICTION = "physics.friction_coefficient"
FALLEN = "without the layers' finite strain"


def pressed(settings: dict[str, str]) -> ModelResult:
    scenario = load_scenario("skin-5N", {**SHORT, **settings})
    return prepare("wave", scenario).run(scenario_drive(scenario))


@pytest.mark.parametrize(("kinematics", "same_as"), [("finite", "corrected"), ("linear", "linear")])
def test_it_takes_the_strain_of_the_finite_elements(kinematics: str, same_as: str) -> None:
    automatic = pressed({"fem.kinematics": kinematics})
    stated = pressed({"fem.kinematics": kinematics, "wave.large_press": same_as})
    np.testing.assert_array_equal(automatic.depth, stated.depth)
    assert automatic.notes == stated.notes


def test_beyond_the_correction_it_falls_back_to_small_strain_and_says_so() -> None:
    settings = {"tool.contact": "rigid_frictionless", "tool.edge_radius": "5 mm"}
    fallen, linear = pressed(settings), pressed({**settings, "wave.large_press": "linear"})
    np.testing.assert_array_equal(fallen.depth, linear.depth)
    assert fallen.notes["model"] == linear.notes["model"]
    assert FALLEN in fallen.warnings[0]


def test_a_tool_over_whose_edge_the_tissue_slides_is_followed_at_finite_strain() -> None:
    """Within 1.2 % of the finite elements' usual mesh, where the small-strain wave is 10 % off."""
    scenario = load_scenario("skin-5N", {"tool.contact": "rigid_frictionless", "tool.edge_radius": "1 mm"})
    drive = Drive("force", np.arange(1.0, 6.0), np.arange(1.0, 6.0))
    found, truth = (prepare(model, scenario).run(drive) for model in ("wave", "fem"))
    np.testing.assert_allclose(found.depth, truth.depth, rtol=0.012)
    np.testing.assert_allclose(found.top_deflection, truth.top_deflection, rtol=0.012)
    assert FALLEN not in " ".join(found.warnings)


@pytest.mark.parametrize("deepest", [2, pytest.param(4, marks=pytest.mark.slow)])
def test_friction_is_followed_in_loading_and_the_way_back_is_said_to_be_left_out(deepest: int) -> None:
    settings = {"tool.contact": "rigid_frictional", FRICTION: "0.3", "tool.edge_radius": "1 mm"}
    scenario = load_scenario("skin-5N", settings)
    newtons = np.arange(1.0, deepest + 1.0)
    drive = Drive("force", newtons, newtons)
    found, truth = (prepare(model, scenario).run(drive) for model in ("wave", "fem"))
    np.testing.assert_allclose(found.top_deflection, truth.top_deflection, rtol=0.015)
    assert "the way back" in " ".join(found.warnings)


@pytest.mark.parametrize(("load", "near"), [({"load.peak": "0.05 N"}, 2.0), ({"load.control": "depth"}, 1.0)])
def test_a_shallow_press_is_set_up_no_deeper_than_it_needs(
    monkeypatch: pytest.MonkeyPatch, load: dict[str, str], near: float
) -> None:
    """A tool of 3 mm on 15 mm of gel took two minutes for a press of 0.05 mm."""
    reaches = []

    def wave(*arguments, reach, large_press, **settings):
        reaches.append((large_press, reach))
        return LayeredWave(*arguments, reach=reach, large_press=large_press, **settings)

    monkeypatch.setattr(wave_layered, "LayeredWave", wave)
    if "load.control" in load:
        load = load | {"load.peak": "0.1 mm"}
    scenario = load_scenario("skin-5N", {**SHORT, **load})
    found = prepare("wave", scenario).run(scenario_drive(scenario))
    strains, depths = zip(*reaches, strict=True)
    assert strains[-1] == "corrected"
    assert depths[-1] == pytest.approx(near * found.depth.max(), rel=0.05)
    assert None not in [reach for strain, reach in reaches if strain == "corrected"]
    whole = prepare("wave", load_scenario("skin-5N", {**SHORT, **load, "wave.large_press": "corrected"}))
    np.testing.assert_allclose(found.depth, whole.run(scenario_drive(scenario)).depth, rtol=2e-3)


def test_a_coefficient_of_friction_without_effect_has_none_in_the_wave() -> None:
    smooth = {"tool.contact": "rigid_frictionless", "tool.edge_radius": "1 mm"}
    tools = [wave_tool(load_scenario("skin-5N", {**smooth, **more})) for more in ({}, {FRICTION: "0.3"})]
    assert tools[0] == tools[1]
    rough = load_scenario("skin-5N", {**smooth, "tool.contact": "rigid_frictional", FRICTION: "0.3"})
    assert wave_tool(rough).friction == 0.3


def test_small_strain_does_not_press_through_a_base() -> None:
    with pytest.raises(UncoveredError, match=r"presses [0-9.]+ mm into a stack of 11\.6 mm"):
        pressed({"load.peak": "60 N"})
    with pytest.raises(UncoveredError, match=r"into a stack of 11\.6 mm"):
        prepare("wave", load_scenario("skin-5N", SHORT)).run(Drive("force", np.array([1.0]), np.array([60.0])))


def test_a_press_beyond_the_usual_range_is_followed_deep() -> None:
    """To 0.56 of the stack within 1 % of the finite elements, where the small-strain wave is 70 % off."""
    deep = {"load.peak": "12 N", "load.observations": "10", "fem.mesh": "coarse"}
    scenario = load_scenario("skin-5N", deep)
    drive = Drive("force", np.arange(1.0, 6.0), np.linspace(2.4, 12.0, 5))
    found, truth = (prepare(model, scenario).run(drive) for model in ("wave", "fem"))
    np.testing.assert_allclose(found.depth, truth.depth, rtol=0.01)
    assert "followed deep" in found.notes["model"]
    assert FALLEN not in " ".join(found.warnings)
    later = prepare("wave", load_scenario("skin-5N", SHORT)).run(drive)
    np.testing.assert_allclose(later.depth, found.depth, rtol=1e-12)


@pytest.mark.parametrize("control", ["depth", "force"])
@pytest.mark.parametrize("layers", ["shared", "own"])
def test_a_hold_relaxes_as_the_finite_elements_do_whose_volume_does_not(control: str, layers: str, tmp_path) -> None:
    """With all moduli relaxing alike a compressible layer as thick as the tool's radius was 10 to 20 % off."""
    tissue = tmp_path / "tissue.toml"
    layer = '[[layers]]\nname = "{}"\nthickness = "{} mm"\ndensity = "1000 kg/m^3"\nyoungs_modulus = "{} kPa"\n'
    fading = 'relaxation = [{ g = 0.4, tau = "1 s" }]\n'
    rows = [("upper", 2, 100), ("lower", 4, 20)]
    text = "".join(layer.format(*row) + "poisson_ratio = 0.4\n{}" for row in rows)
    tissue.write_text('schema = 1\nname = "one"\n' + text.format(fading if layers == "shared" else "", fading))
    settings = {
        "tissue": str(tissue), "tool.contact": "rigid_bonded", "fem.kinematics": "linear", "load.shape": "ramp_hold",
        "load.duration": "1 s", "load.hold": "9 s", "load.control": control, "load.observations": "60",
        "load.peak": {"depth": "0.05 mm", "force": "0.05 N"}[control],
    }  # fmt: skip
    scenario = load_scenario("skin-5N", settings)
    wave, fem = (prepare(name, scenario).run(scenario_drive(scenario)) for name in ("wave", "fem"))
    found, wanted = (wave.force, fem.force) if control == "depth" else (wave.depth, fem.depth)
    assert np.abs(found - wanted).max() < (0.003 if layers == "shared" else 0.006) * wanted.max()
