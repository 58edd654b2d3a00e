import numpy as np
import pytest

from benchmark.files import load_scenario
from benchmark.models import UncoveredError, prepare, scenario_drive

FIBRE = '{ k1 = "10 kPa", k2 = 1.0 }'

OUTSIDE = {
    "option of the body": ({"physics.floor_depth": "6 mm"}, "floor_depth", ("fem",)),
    "clamp": ({"physics.clamp_shear_limit": "6 kPa"}, "clamp_shear_limit", ("fem", "wave")),
    "fibres in small strain": ({"dermis.fibre": FIBRE, "fem.kinematics": "linear"}, "fibres", ("fem", "wave")),
    "fibres in one direction": (
        {"dermis.fibre": '{ angle = "30 deg", k1 = "10 kPa", k2 = 1.0 }'},
        "one direction",
        ("wave",),
    ),
    "fibres in a plate": (
        {
            "dermis.fibre": FIBRE,
            "support.kind": "hole",
            "support.hole_radius": "30 mm",
            "wave.model": "plate",
            "load.peak": "0.1 N",
        },
        "plate theory",
        ("wave",),
    ),
    "tilted tool": ({"tool.tilt": "3 deg"}, "tilted", ("wave",)),
    "off the hole's centre": (
        {"support.kind": "hole", "support.hole_radius": "30 mm", "tool.position": '["5 mm", "0 mm"]'},
        "off the centre",
        ("wave",),
    ),
    "friction": (
        {"tool.contact": "rigid_frictional", "physics.friction_coefficient": "0.3", "fem.kinematics": "linear"},
        "friction",
        ("fem", "wave"),
    ),
    "endless base": ({"support.kind": "half_space"}, "half_space", ("wave",)),
    "published membrane": ({"wave.model": "published"}, "published", ("wave",)),
}


@pytest.mark.parametrize("case", OUTSIDE)
def test_what_a_model_lacks_it_declines(case: str) -> None:
    settings, word, models = OUTSIDE[case]
    scenario = load_scenario("skin-5N", settings)
    for model in models:
        with pytest.raises(UncoveredError, match=word):
            prepare(model, scenario)


def test_a_wave_creeps_where_its_layers_relax() -> None:
    series = '[{ g = 0.3, tau = "50 s" }]'
    settings = {f"{layer}.relaxation": series for layer in ("epidermis", "dermis", "subcutaneous_fat")}
    press = {"load.peak": "0.1 N", "load.shape": "ramp_hold", "load.duration": "100 ms", "load.hold": "2000 s"}
    scenario = load_scenario("skin-5N", {**settings, **press, "fem.kinematics": "linear"})
    wave, fem = (prepare(name, scenario).run(scenario_drive(scenario)).depth for name in ("wave", "fem"))
    assert wave[-1] / wave[0] == pytest.approx(fem[-1] / fem[0], rel=1e-3)
    assert 1.35 < wave[-1] / wave[0] < 1.0 / (1.0 - 0.3)  # where volume does not creep


def test_a_corrected_wave_follows_the_finite_strain_of_the_fem() -> None:
    press = {"load.peak": "4 N", "load.observations": "6", "wave.large_press": "corrected"}
    scenario = load_scenario("skin-5N", press)
    drive = scenario_drive(scenario)
    fem, wave = (prepare(model, scenario).run(drive) for model in ("fem", "wave"))
    loaded = drive.value > 0
    np.testing.assert_allclose(wave.top_deflection[loaded], fem.top_deflection[loaded], rtol=0.01)
    np.testing.assert_allclose(wave.profile, fem.profile, atol=0.02 * fem.profile.max())


def test_a_press_beyond_the_corrected_range_is_declined() -> None:
    scenario = load_scenario("skin-5N", {"load.peak": "12 N", "wave.large_press": "corrected"})
    with pytest.raises(UncoveredError, match="mm"):
        prepare("wave", scenario).run(scenario_drive(scenario))


def test_a_sheet_that_slides_on_its_plate_is_the_fem_s() -> None:
    hole = {"support.kind": "hole", "support.hole_radius": "15 mm", "load.observations": "4", "fem.mesh": "coarse"}
    load = {"load.peak": "1 N", "tissue": "rtv3498_sheet"}
    sheet = load_scenario("skin-5N", {**hole, **load})
    loose = load_scenario("skin-5N", {**hole, **load, "physics.clamp_shear_limit": "1 kPa"})
    held, slid = (prepare("fem", scenario).run(scenario_drive(scenario)).depth for scenario in (sheet, loose))
    assert slid.max() > 1.001 * held.max()
    with pytest.raises(UncoveredError, match="clamp_shear_limit"):
        prepare("wave", loose)


def test_layers_that_slide_on_each_other_are_deeper_in_both_models() -> None:
    press = {"load.peak": "3 N", "load.observations": "6", "fem.mesh": "coarse"}
    loose = {**press, "physics.interface_shear_limit": "1 kPa"}
    for model in ("fem", "wave"):
        held, slid = (
            prepare(model, scenario).run(scenario_drive(scenario)).depth.max()
            for scenario in (load_scenario("skin-5N", press), load_scenario("skin-5N", loose))
        )
        assert 1.005 < slid / held < 1.1
