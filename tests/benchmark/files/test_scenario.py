import math

import pytest
from pydantic import ValidationError

from benchmark.files.load import Load
from benchmark.files.options import FemOptions, WaveOptions
from benchmark.files.physics import Physics
from benchmark.files.scenario import Scenario
from benchmark.files.tissue import Layer, Tissue
from benchmark.files.tool import Support, Tool


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
