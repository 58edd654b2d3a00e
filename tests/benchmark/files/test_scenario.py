import math

import pytest
from pydantic import ValidationError

from benchmark.files import load_scenario, scenario_notes
from benchmark.files.load import Load
from benchmark.files.physics import Physics
from benchmark.files.quantities import FROM_FILE
from benchmark.files.scenario import Comparison, FemOptions, Scenario, WaveOptions
from benchmark.files.tissue import Layer, Tissue
from benchmark.files.tool import Support, Tool


def read(model, folder=".", **table):
    return model.model_validate(table, context={**FROM_FILE, "folder": folder})


def test_physics_is_off_unless_given():
    assert set(dict(Physics()).values()) == {None}
    assert read(Physics, pretension="20 kPa", floor_depth="6 mm").pretension == 20e3


@pytest.mark.parametrize(
    "table",
    [
        {"pretension": "-1 kPa"},
        {"pretension": "20 N"},
        {"friction_coefficient": -0.1},
        {"friction_coefficient": 11},
        {"adhesion_force": "-1 N"},
        {"floor_depth": "0 mm"},
        {"interface_shear_limit": 5},
        {"clamp_shear_limit": "5 mm"},
        {"gravity": "9.81 m/s^2"},
        {"floor_stiffness": "5 N/mm"},
        {"floor_depth": "5 mm", "floor_stiffness": "5 kPa"},
        {"friction_force": "10 mN"},
        {"friction_length": "1 um"},
        {"softening": 1.0},
        {"softening_width": 0.5},
        {"permanent_set": 0.1, "permanent_set_onset": 1e-3},
        {"stiffening_linear": -1},
        {"drainage_share": 0.1, "drainage_diffusivity": "1 mm"},
        {"slip_force": "0 N", "slip_share": 0.5},
        {"slip_share": 0.5},
        {"damping_time": 0.1},
    ],
)
def test_physics_is_checked_for_name_unit_and_bounds(table):
    with pytest.raises(ValidationError):
        read(Physics, **table)


def test_options_of_the_body_come_with_their_units():
    given = read(
        Physics,
        floor_depth="6 mm",
        floor_stiffness="20 N/mm",
        friction_force="10 mN",
        friction_length="10 um",
        drainage_share=0.2,
        drainage_diffusivity="0.5 mm^2/s",
        damping_time="10 ms",
    )
    assert (given.floor_stiffness, given.friction_force, given.friction_length) == (2e4, 0.01, 1e-5)
    assert (given.drainage_diffusivity, given.damping_time) == (5e-7, 0.01)


def test_the_margin_is_two_percent():
    assert Comparison().equivalence_margin == 0.02
    assert read(Comparison, equivalence_margin="5 %").equivalence_margin == 0.05


def test_the_solvers_defaults():
    assert (FemOptions().kinematics, FemOptions().geometry, FemOptions().mesh, FemOptions().radius) == (
        "finite",
        "axisymmetric",
        "default",
        None,
    )
    assert (WaveOptions().model, WaveOptions().modes, WaveOptions().window) == ("layered", None, None)


def test_auto_is_none():
    assert read(FemOptions, radius="auto").radius is None
    wave = read(WaveOptions, modes="auto", window="auto")
    assert (wave.modes, wave.window) == (None, None)


def test_large_windows_and_many_modes_are_possible():
    wave = read(WaveOptions, modes=512, window="100 mm")
    assert (wave.modes, wave.window) == (512, 0.1)
    for wrong in ({"modes": 0}, {"modes": 2.5}, {"modes": "some"}, {"window": "0 mm"}, {"window": 60}):
        with pytest.raises(ValidationError):
            read(WaveOptions, **wrong)


def test_a_surface_needs_its_file_and_unit(tmp_path):
    (tmp_path / "liver.stl").write_text("solid")
    options = read(FemOptions, tmp_path, geometry="surface", surface="liver.stl", surface_unit="mm")
    assert options.surface == str((tmp_path / "liver.stl").resolve())
    for wrong in (
        {},
        {"surface": "liver.stl"},
        {"surface_unit": "mm"},
        {"surface": "none.stl", "surface_unit": "mm"},
        {"surface": "liver.stl", "surface_unit": "kPa"},
    ):
        with pytest.raises(ValidationError):
            read(FemOptions, tmp_path, geometry="surface", **wrong)


def slab(thickness=0.01):
    fat = Layer(name="fat", thickness=thickness, density=971.0, youngs_modulus=20e3, poisson_ratio=0.48)
    return Tissue(name="slab", layers=(fat,))


def scenario(tissue=None, **sections):
    given = {"tool": Tool(radius=5e-3), "load": Load(peak=5.0), **sections}
    return Scenario(name="press", tissue=tissue or slab(), **given)


def key_of(**sections):
    """The key that a refusal names."""
    with pytest.raises(ValidationError) as error:
        scenario(**sections)
    return error.value.errors()[0]["ctx"]["key"]


def test_its_history_is_its_loads():
    time, value = scenario(load=Load(peak=5.0, observations=4)).load_history()
    assert time.tolist() == [2.5, 5.0, 7.5, 10.0]
    assert value.tolist() == [2.5, 5.0, 2.5, 0.0]


def test_a_frictionless_tool_needs_an_edge_in_finite_strain_only():
    smooth = Tool(radius=5e-3, contact="rigid_frictionless")
    assert key_of(tool=smooth) == "tool.edge_radius"
    assert scenario(tool=smooth, fem=FemOptions(kinematics="linear")).tool == smooth
    assert scenario(tool=smooth.model_copy(update={"edge_radius": 5e-4})).tool.edge_radius == 5e-4


def test_a_frictional_tool_needs_a_coefficient_and_in_finite_strain_an_edge():
    sharp, friction = Tool(radius=5e-3, contact="rigid_frictional"), Physics(friction_coefficient=0.3)
    rough = sharp.model_copy(update={"edge_radius": 5e-4})
    assert key_of(tool=rough) == "physics.friction_coefficient"
    assert key_of(tool=sharp, physics=friction) == "tool.edge_radius"
    assert scenario(tool=rough, physics=friction).tool == rough


def test_the_tool_fits_the_hole():
    assert key_of(support=Support(kind="hole", hole_radius=5e-3)) == "support.hole_radius"
    assert scenario(support=Support(kind="hole", hole_radius=30e-3)).support.hole_radius == 30e-3


def test_the_models_reach_past_the_tool():
    assert key_of(fem=FemOptions(radius=5e-3)) == "fem.radius"
    assert key_of(wave=WaveOptions(window=10e-3)) == "wave.window"
    assert key_of(fem=FemOptions(radius=30e-3), support=Support(kind="hole", hole_radius=30e-3)) == "fem.radius"
    assert scenario(fem=FemOptions(radius=6e-3), wave=WaveOptions(window=11e-3)).fem.radius == 6e-3


def test_only_a_half_space_may_be_endless():
    assert key_of(tissue=slab(math.inf)) == "tissue"
    assert math.isinf(scenario(slab(math.inf), support=Support(kind="half_space")).tissue.thickness)
    assert scenario(slab(0.01), support=Support(kind="half_space")).tissue.thickness == 0.01


def test_equal_scenarios_are_equal():
    assert scenario() == scenario()
    assert scenario() != scenario(load=Load(peak=4.0))


def notes(**overrides):
    return scenario_notes(load_scenario("skin-5N", {key.replace("__", "."): value for key, value in overrides.items()}))


def energy_of_abaqus(terms, stretch: float) -> float:
    """Ogden's energy in Abaqus's form, sum of 2 mu / alpha^2 (...), of an isochoric uniaxial stretch."""
    stretches = (stretch, stretch**-0.5, stretch**-0.5)
    return sum(2 * mu / alpha**2 * (sum(each**alpha for each in stretches) - 3) for mu, alpha in terms)


def test_ogden_constants_of_another_form_are_told_with_their_factor() -> None:
    """E = 960 kPa and nu = 0.48 are a shear modulus of 324.3 kPa; Abaqus's constants add up to it, ours do not."""
    abaqus = ((224.3e3, 10.0), (100e3, -2.0))
    step = 1e-4
    second = (energy_of_abaqus(abaqus, 1 + step) + energy_of_abaqus(abaqus, 1 - step)) / step**2
    assert second / 3 == pytest.approx(324.3e3, rel=1e-3)

    def said(terms):
        told = ", ".join(f'{{ mu = "{mu} Pa", alpha = {alpha} }}' for mu, alpha in terms)
        return " ".join(notes(dermis__hyperelastic=f'{{ law = "ogden", terms = [{told}] }}'))

    assert "fit the moduli in the form 2 mu / alpha^2 (Abaqus): mu is 2 mu / alpha here" in said(abaqus)
    assert said((2 * mu / alpha, alpha) for mu, alpha in abaqus) == ""
    febio = tuple((2 * mu, alpha) for mu, alpha in abaqus)
    assert "fit the moduli in the form c / m^2 (FEBio): mu is c / m here" in said(febio)
    assert said((mu / alpha, alpha) for mu, alpha in febio) == ""
    assert "fit the moduli" not in said(((500e3, 10.0),))


def test_the_shipped_scenario_has_nothing_to_note():
    assert notes() == ()


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"dermis__hyperelastic": '{ law = "yeoh", c10 = "20 kPa" }'}, "layer dermis: its yeoh law begins"),
        ({"load__observations": "25"}, "25 observations, an odd number"),
        ({"load__hold": "3 s"}, "load.hold has no effect: the shape is triangle"),
        ({"support__hole_radius": "30 mm"}, "support.hole_radius has no effect: the support is bonded"),
        ({"physics__friction_coefficient": "0.3"}, "physics.friction_coefficient has no effect"),
        (
            {"tool__radius": "4 m"},
            'tool.radius is 4 m, more than any bench has (500 mm): is another unit meant, such as "4',
        ),
        ({"dermis__thickness": "1.5 m"}, "dermis.thickness is 1.5 m, more than any bench has (1 m)"),
        ({"support__kind": "hole", "support__hole_radius": "30 m"}, "support.hole_radius is 30 m"),
        (
            {"dermis__youngs_modulus": "500 mPa"},
            "dermis.youngs_modulus is 0.5 Pa; soft tissue and phantoms have 10 Pa to 10000 MPa: is another unit meant "
            "(mPa is a thousandth of a pascal, MPa a million)?",
        ),
        ({"dermis__youngs_modulus": "120 GPa"}, "dermis.youngs_modulus is 120000 MPa; soft tissue"),
        (
            {"dermis__density": "1.1 kg/m^3"},
            "dermis.density is 1.1 kg/m^3; soft tissue and phantoms have 100 kg/m^3 to",
        ),
    ],
)
def test_what_is_easily_misread_is_said(overrides, says):
    (note,) = notes(**overrides)
    assert note.startswith(says)


def test_a_law_that_agrees_with_the_moduli_is_not_noted():
    assert notes(dermis__hyperelastic='{ law = "yeoh", c10 = "0.162162 MPa", c20 = "1 kPa" }') == ()
