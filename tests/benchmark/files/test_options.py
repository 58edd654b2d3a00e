import pytest
from pydantic import ValidationError

from benchmark.files.options import Comparison, FemOptions, WaveOptions
from benchmark.files.physics import Physics
from benchmark.files.quantities import FROM_FILE


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
