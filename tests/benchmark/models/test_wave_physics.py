"""Options of the body in a scenario act in the wave; the solver that lacks one says so."""

import numpy as np
import pytest

from benchmark.errors import InputError
from benchmark.files import load_scenario
from benchmark.models import Drive, UncoveredError, prepare

CYCLE = Drive(
    "depth", np.linspace(0.1, 2.0, 20), 1e-3 * np.minimum(np.linspace(0.1, 2, 20), 2 - np.linspace(0.1, 2, 20))
)
HOLE = {"support.kind": "hole", "support.hole_radius": "30 mm"}
LINEAR = {"fem.kinematics": "linear"}


def pressed(settings, drive=CYCLE, tissue="skin-5N"):
    return prepare("wave", load_scenario(tissue, settings)).run(drive)


@pytest.mark.parametrize("place", [LINEAR, {}, HOLE])
def test_a_floor_adds_its_spring_and_no_more(place):
    plain = pressed(place)
    floor = pressed({**place, "physics.floor_depth": "0.5 mm", "physics.floor_stiffness": "20 N/mm"})
    added = 2e4 * np.maximum(CYCLE.value - 0.5e-3, 0.0)
    np.testing.assert_allclose(floor.force, plain.force + added, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(floor.top_deflection, plain.top_deflection, rtol=1e-9, atol=1e-12)


def test_a_floor_without_its_stiffness_is_stiff():
    press = {**LINEAR, "physics.floor_depth": "0.5 mm"}
    found = pressed(press, Drive("force", np.array([1.0, 2.0]), np.array([2.0, 3.0])))
    np.testing.assert_allclose(np.diff(found.depth), 1e-6, rtol=0.02)


CASES = {
    "adhesion": ({"adhesion_force": "5 mN"}, lambda x, plain: x[:19] == pytest.approx(plain[:19], abs=1e-9)),
    "friction": (
        {"friction_force": "10 mN", "friction_length": "1 um"},
        lambda x, plain: x[[8, 12]] - plain[[8, 12]] == pytest.approx([0.01, -0.01], rel=1e-6),
    ),
    "damping": (
        {"damping_time": "10 ms"},
        lambda x, plain: x[5] - plain[5] == pytest.approx(0.01 * (plain[5] - plain[4]) / 0.1, rel=1e-9),
    ),
    "softening": ({"softening": "0.2"}, lambda x, plain: x[9] == pytest.approx(plain[9]) and x[14] < 0.9 * plain[14]),
    "set": (
        {"permanent_set": "0.2"},
        lambda x, plain: x[9] == pytest.approx(plain[9]) and x[17] == 0.0 < plain[17],
    ),
    "stiffening": (
        {"stiffening_linear": "2"},
        lambda x, plain: x[9] / plain[9] == pytest.approx(1 + 2 * 1e-3 / HEIGHT, rel=1e-9),
    ),
    "drainage": (
        {"drainage_share": "0.5", "drainage_diffusivity": "1e6 mm^2/s"},
        lambda x, plain: x[9] == pytest.approx(0.5 * plain[9], rel=1e-3),
    ),
    "slip": (
        {"slip_force": "1 mN", "slip_share": "0.5"},
        lambda x, plain: x[9] == pytest.approx(0.5 * plain[9] + 0.5e-3, rel=1e-9),
    ),
}
HEIGHT = sum(layer.thickness for layer in load_scenario("skin-5N").tissue.layers)


@pytest.mark.parametrize("name", CASES)
def test_each_option_acts_by_its_equation(name):
    options, holds = CASES[name]
    plain = pressed(LINEAR).force
    assert holds(pressed({**LINEAR, **{f"physics.{key}": value for key, value in options.items()}}).force, plain)


def test_the_fem_says_what_it_lacks():
    scenario = load_scenario("skin-5N", {"physics.permanent_set": "0.1"})
    with pytest.raises(
        UncoveredError, match=r"permanent_set .* it has .*pretension, interface_shear_limit, .*adhesion_force"
    ):
        prepare("fem", scenario)


@pytest.mark.parametrize("strain", [LINEAR, {}])
def test_a_shear_limit_lets_layers_slide_from_a_force_on(strain):
    """Bonded below it, softer beyond it by a share that follows from the layers."""
    plain = pressed(strain).force
    found = pressed({**strain, "physics.interface_shear_limit": "2 kPa"}).force
    lost = 1.0 - found[:10] / plain[:10]
    np.testing.assert_allclose(lost[:2], 0.0, atol=1e-9)
    assert 0.03 < lost[9] < 0.06
    beyond = np.diff(found[5:10]) / np.diff(plain[5:10])
    np.testing.assert_allclose(beyond, beyond[0], rtol=1e-9)
    assert beyond[0] < 1.0 - lost[9]


@pytest.mark.parametrize(
    ("model", "limit", "settings", "message"),
    [
        ("wave", "5 kPa", HOLE, "the layered wave on a base and the finite elements have it"),
        ("wave", "0 kPa", {}, "it lets one interface slide"),
        ("fem", "5 kPa", LINEAR, "in finite strain or without friction"),
        ("fem", "5 kPa", {"fem.geometry": "block"}, "axisymmetric geometry only"),
    ],
)
def test_where_a_shear_limit_is_not_covered(model, limit, settings, message):
    scenario = load_scenario("skin-5N", {"physics.interface_shear_limit": limit, **settings})
    with pytest.raises(UncoveredError, match=message):
        prepare(model, scenario)


def test_a_shear_limit_is_given_once():
    with pytest.raises(InputError, match="slip is given twice"):
        pressed({"physics.interface_shear_limit": "5 kPa", "physics.slip_force": "1 N", "physics.slip_share": "0.5"})


SHEET = load_scenario("phantom").tissue.layers[0].name
RELAXING = {f"{SHEET}.relaxation": '[{ g = 0.3, tau = "0.5 s" }]', "fem.mesh": "coarse"}


@pytest.mark.parametrize("control", ["force", "depth"])
def test_a_sheet_over_a_hole_relaxes_as_in_the_fem(control):
    """Ramp and hold to 4 mm: within 2 %, and the course of the hold within 1 %."""
    scenario = load_scenario("phantom", RELAXING)
    time = np.array([0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0, 6.0])
    drive = Drive(control, time, np.minimum(time, 1.0) * (1.0 if control == "force" else 4e-3))
    fem, wave = (prepare(model, scenario).run(drive) for model in ("fem", "wave"))
    found, exact = (one.depth if control == "force" else one.force for one in (wave, fem))
    np.testing.assert_allclose(found, exact, rtol=0.02)
    np.testing.assert_allclose(found[4:] / found[3], exact[4:] / exact[3], rtol=0.01)
    assert abs(exact[-1] / exact[3] - 1.0) > 0.1
    assert not any("relaxation" in text for text in wave.warnings)


def test_a_sheet_under_pretension_is_as_stiff_as_in_the_fem():
    """20 kPa, 0.02 and 2 N, where the tension carries more than half of the press: within 4 %."""
    drive = Drive("force", np.array([1.0, 2.0]), np.array([0.02, 2.0]))
    scenario = load_scenario("phantom", {"physics.pretension": "20 kPa", "fem.mesh": "coarse"})
    fem, wave = (prepare(model, scenario).run(drive) for model in ("fem", "wave"))
    plain = prepare("wave", load_scenario("phantom")).run(drive)
    np.testing.assert_allclose(wave.depth, fem.depth, rtol=0.04)
    assert np.all(wave.depth < 0.65 * plain.depth)
    (told,) = [each for each in wave.warnings if "pretension" in each]
    assert "5 % of the sheet's modulus" in told
    assert not [each for each in plain.warnings if "pretension" in each]
