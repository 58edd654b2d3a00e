from collections.abc import Callable

import numpy as np
import pytest

from benchmark.files import Scenario, load_scenario
from benchmark.models import Drive, prepare
from benchmark.response import depth_ramp

SMALL = {"fem.mesh": "coarse", "load.control": "depth", "load.peak": "1 mm", "load.observations": "4"}


@pytest.fixture(scope="module")
def scenario() -> Scenario:
    return load_scenario("skin-5N", SMALL)


@pytest.mark.parametrize("model", ["wave", "fem"])
def test_a_ramp_begins_at_rest_and_is_the_model_at_its_depths(scenario, model) -> None:
    prepared = prepare(model, scenario)
    ramp = depth_ramp(prepared, 1e-3, 4)
    assert ramp.failure is None
    assert ramp.steps == 4
    assert ramp.depth == pytest.approx(np.linspace(0.0, 1e-3, 5), rel=1e-6)
    assert (ramp.force[0], *ramp.layers[0]) == (0.0,) * (1 + ramp.layers.shape[1])
    at_once = prepared.run(Drive("depth", np.array([1.0]), np.array([0.75e-3])))
    assert ramp.force_at(np.array([0.75e-3])) == pytest.approx(at_once.force, rel=1e-4)
    assert ramp.layers_at(np.array([0.75e-3])) == pytest.approx(at_once.top_deflection, rel=1e-4)


def test_beyond_the_last_point_it_goes_straight_on_and_above_the_surface_it_is_mirrored(scenario) -> None:
    ramp = depth_ramp(prepare("wave", scenario), 1e-3, 4)
    slope = (ramp.force[-1] - ramp.force[-2]) / 0.25e-3
    assert ramp.force_at(np.array([2e-3])) == pytest.approx(ramp.force[-1] + 1e-3 * slope)
    assert ramp.layers_at(np.array([-0.5e-3])) == pytest.approx(-ramp.layers_at(np.array([0.5e-3])))


def test_steps_are_told_of(scenario) -> None:
    seen: list[int] = []
    on_step: Callable[..., None] = lambda step: seen.append(step.step)  # noqa: E731
    depth_ramp(prepare("fem", scenario), 0.5e-3, 3, on_step)
    assert seen == [1, 2, 3]
