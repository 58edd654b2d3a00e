"""The FEM's geometries in scenarios: the block, bodies from surface files, and what is not offered."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import pyvista

from benchmark.errors import InputError
from benchmark.files import Scenario, load_scenario, scenario_notes
from benchmark.models import UncoveredError, prepare, scenario_drive

SMALL = {"fem.mesh": "coarse", "load.shape": "ramp", "load.observations": "1", "load.peak": "0.1 N"}
LINEAR = {**SMALL, "fem.kinematics": "linear"}
BODY = """schema = 1
name = "ball"
[tool]
radius = "6 mm"
[load]
peak = "0.1 N"
observations = 1
shape = "ramp"
[fem]
geometry = "surface"
surface = "ball.stl"
surface_unit = "{unit}"
kinematics = "linear"
mesh = "coarse"
[tissue]
schema = 1
name = "fruit"
[[tissue.layers]]
name = "rind"
thickness = "4 mm"
density = "1000 kg/m^3"
youngs_modulus = "20 kPa"
poisson_ratio = 0.48
[[tissue.layers]]
name = "pulp"
thickness = "16 mm"
density = "1000 kg/m^3"
youngs_modulus = "10 kPa"
poisson_ratio = 0.48
"""


@pytest.fixture
def ball() -> pyvista.PolyData:
    """A sphere of 20 mm, in mm."""
    return pyvista.Icosphere(radius=20.0, nsub=2)


@pytest.fixture
def body(tmp_path: Path) -> Callable[..., Scenario]:
    def write(surface: pyvista.PolyData, settings: dict[str, str] | None = None, unit: str = "mm") -> Scenario:
        if surface.n_cells:
            surface.save(tmp_path / "ball.stl")
        else:
            (tmp_path / "ball.stl").write_bytes(b"")
        (tmp_path / "body.toml").write_text(BODY.format(unit=unit))
        return load_scenario(tmp_path / "body.toml", settings or {})

    return write


def run(settings: dict[str, str]):
    scenario = load_scenario("skin-5N", settings)
    return prepare("fem", scenario).run(scenario_drive(scenario))


def test_a_coarse_block_answers_like_the_axisymmetric_model() -> None:
    axial, block = (run({**LINEAR, "fem.geometry": geometry}) for geometry in ("axisymmetric", "block"))
    np.testing.assert_allclose(block.top_deflection, axial.top_deflection, rtol=2e-2)
    np.testing.assert_allclose(block.profile, axial.profile, atol=2e-2 * axial.depth[0])
    (snapshot,) = block.fields
    assert snapshot.cell_type == pyvista.CellType.TRIQUADRATIC_HEXAHEDRON
    assert snapshot.cells.shape[1] == 27
    assert block.notes["geometry"] == "block"


def test_position_and_tilt_reach_the_block() -> None:
    hole = {"support.kind": "hole", "support.hole_radius": "20 mm", "fem.geometry": "block"}
    centred, moved = (run({**LINEAR, **hole, "tool.position": f'["{x} mm", "0 mm"]'}) for x in (0, 10))
    assert moved.depth[0] < 0.9 * centred.depth[0]
    tilted = run({**LINEAR, "fem.geometry": "block", "tool.contact": "rigid_bonded", "tool.tilt": "2 deg"})
    slope = (tilted.profile[0, 5] - tilted.depth[0]) / tilted.profile_radii[5]
    assert slope == pytest.approx(np.sin(np.radians(2.0)), rel=1e-6)


@pytest.mark.slow
def test_a_tool_with_a_rounded_edge_touches_the_block() -> None:
    touching = {**LINEAR, "fem.kinematics": "finite", "tool.contact": "rigid_frictionless", "tool.edge_radius": "1 mm"}
    axial = run({**touching, "fem.mesh": "default"})
    block, tilted = (run({**touching, "fem.geometry": "block", "tool.tilt": tilt}) for tilt in ("0 deg", "4 deg"))
    np.testing.assert_allclose(block.top_deflection, axial.top_deflection, rtol=2e-2)
    assert tilted.depth[0] > 1.1 * block.depth[0]
    assert not any("edge_radius has no effect" in text for text in block.warnings)


NOT_OFFERED = {
    "tilt without a third dimension": ({"tool.tilt": "3 deg"}, "use geometry = 'block'"),
    "off-centre hole without a third dimension": (
        {"support.kind": "hole", "support.hole_radius": "30 mm", "tool.position": '["5 mm", "0 mm"]'},
        "use geometry = 'block'",
    ),
    "tilted pressure": ({"fem.geometry": "block", "tool.tilt": "3 deg"}, "rigid_bonded"),
    "off-centre along y": ({"fem.geometry": "block", "tool.position": '["0 mm", "5 mm"]'}, "off-centre along x"),
}


@pytest.mark.parametrize("case", NOT_OFFERED)
def test_what_is_not_offered_is_an_input_error(case: str) -> None:
    settings, words = NOT_OFFERED[case]
    with pytest.raises(InputError, match=words):
        prepare("fem", load_scenario("skin-5N", settings))


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"fem.geometry": "surface"}, "fem.surface"),
        ({"fem.surface_unit": "mm"}, "only the geometry"),
    ],
)
def test_a_surface_is_complete_or_not_there(settings: dict[str, str], words: str) -> None:
    with pytest.raises(InputError, match=words):
        load_scenario("skin-5N", settings)


def test_a_surface_has_no_other_border(body: Callable[..., Scenario], ball: pyvista.PolyData) -> None:
    with pytest.raises(InputError, match=r"fem.radius.*ends at the surface"):
        body(ball, {"fem.radius": "50 mm"})


def test_a_position_that_has_no_effect_is_said() -> None:
    (note,) = scenario_notes(load_scenario("skin-5N", {"tool.position": '["5 mm", "0 mm"]'}))
    assert "tool.position has no effect" in note


def test_the_resolved_scenario_reads_again(
    body: Callable[..., Scenario], ball: pyvista.PolyData, tmp_path: Path
) -> None:
    scenario = body(ball)
    (tmp_path / "elsewhere").mkdir()
    resolved = tmp_path / "elsewhere" / "scenario.toml"
    resolved.write_text(scenario.to_toml())
    assert load_scenario(resolved) == scenario


def test_no_tool_touches_a_body_from_a_surface(body: Callable[..., Scenario], ball: pyvista.PolyData) -> None:
    touching = {"tool.contact": "rigid_frictionless", "tool.edge_radius": "1 mm", "fem.kinematics": "finite"}
    with pytest.raises(UncoveredError, match="not part of the geometry surface"):
        prepare("fem", body(ball, touching))


def test_the_wave_has_no_body_from_a_surface(body: Callable[..., Scenario], ball: pyvista.PolyData) -> None:
    with pytest.raises(UncoveredError, match="surface file"):
        prepare("wave", body(ball))


def crossing(ball: pyvista.PolyData) -> pyvista.PolyData:
    return ball.merge(ball.translate((20.0, 0.0, 0.0)), merge_points=False)


def opened(ball: pyvista.PolyData) -> pyvista.PolyData:
    return ball.extract_cells(ball.cell_centers().points[:, 2] < 12.0).extract_surface(algorithm="dataset_surface")


BAD_SURFACES = {
    "empty": (lambda ball: pyvista.PolyData(), "mm", {}, r"ball\.stl: is empty"),
    "open": (opened, "mm", {}, r"ball\.stl: is open near \(.*\) m"),
    "crossing": (crossing, "mm", {}, r"ball\.stl: crosses itself near \(.*\) m"),
    "unit too large": (lambda ball: ball, "m", {}, r"ball\.stl: is .* 40 m large.*is the unit right\?"),
    "unit too small": (lambda ball: ball, "um", {}, r"is the unit right\?"),
    "layers too thick": (lambda ball: ball, "mm", {"rind.thickness": "25 mm"}, "no place in the body is deeper"),
    "tool beside it": (lambda ball: ball, "mm", {"tool.position": '["50 mm", "0 mm"]'}, "not above the surface"),
}


@pytest.mark.parametrize("case", BAD_SURFACES)
def test_a_bad_surface_says_what_and_where(body: Callable[..., Scenario], ball: pyvista.PolyData, case: str) -> None:
    change, unit, settings, words = BAD_SURFACES[case]
    scenario = body(change(ball), settings, unit)
    with pytest.raises(InputError, match=words):
        prepare("fem", scenario)


@pytest.mark.slow
def test_an_inverted_ball_is_turned_pressed_and_says_so(body: Callable[..., Scenario], ball: pyvista.PolyData) -> None:
    scenario = body(ball.flip_faces())
    result = prepare("fem", scenario).run(scenario_drive(scenario))
    assert "the surface looked inwards and was turned" in result.warnings
    assert 0.0 < result.top_deflection[0, 1] < result.top_deflection[0, 0]
    assert np.isfinite(result.profile[:, :5]).all()
    assert np.isnan(result.profile[0, -1])
    assert {int(layer) for layer in np.unique(result.fields[0].cell_data["layer"])} == {0, 1}
