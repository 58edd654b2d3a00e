"""Small sweeps, and the rows they would give."""

from collections.abc import Callable

import pytest

from benchmark.sweeps.design import Design
from benchmark.sweeps.parameter import parse_parameter
from benchmark.sweeps.plan import SweepPlan, make_plan

SMALL = {"fem.mesh": "coarse", "load.observations": "4", "load.peak": "0.5 N"}


@pytest.fixture
def plan_of() -> Callable[..., SweepPlan]:
    """Make the plan of a small grid: `plan_of("tool.radius=2 mm,5 mm", load_peak="1 N")`."""

    def plan(*vary: str, scenario: str = "skin-5N", seed: int = 0, **settings: str) -> SweepPlan:
        chosen = {**SMALL, **{key.replace("_", ".", 1): value for key, value in settings.items()}}
        return make_plan(scenario, chosen, [parse_parameter(text) for text in vary], Design("grid", None, seed))

    return plan
