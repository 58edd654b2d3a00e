"""What effects may know of a scenario."""

import pytest

from benchmark.files import load_scenario
from benchmark.models.scenario_effects import HALF_SPACE_RADII, measured_height, scenario_context


@pytest.mark.parametrize("told", ["30 mm", "300 mm"])
def test_of_a_half_space_the_told_thickness_of_its_last_layer_says_nothing(told):
    """The same trials were a stiffening with 30 mm and a floor with 300."""
    changes = {"support.kind": "half_space", "subcutaneous_fat.thickness": told}
    scenario = load_scenario("skin-5N", changes)
    assert scenario_context(scenario).thickness == pytest.approx(HALF_SPACE_RADII * scenario.tool.radius)
    bonded = load_scenario("skin-5N", {"subcutaneous_fat.thickness": told})
    assert scenario_context(bonded).thickness == pytest.approx(bonded.tissue.thickness)
    assert measured_height(float("inf"), bonded.support, 2e-3) == HALF_SPACE_RADII * 2e-3
