import pytest
from pydantic import ValidationError

from benchmark.files.options import Comparison, FemOptions, Physics, WaveOptions
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
    ],
)
def test_physics_is_checked_for_name_unit_and_bounds(table):
    with pytest.raises(ValidationError):
        read(Physics, **table)


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
