"""A curve where the finite elements stop: who takes over, how the pieces join, and what is said."""

import numpy as np
import pytest

from benchmark.errors import InputError, SolverError
from benchmark.files.tool import Tool
from benchmark.models import RunFailure, UncoveredError
from benchmark.response.nearest_curve import carried_forces, continued, nearest_curve, nearest_tools, stuck_tool
from benchmark.response.ramp import Ramp

TOLD = Tool(radius=10e-3, contact="rigid_frictionless", edge_radius=1e-3)
DEPTH = 8e-3


def made(reach, size=1.0, power=2.0, steps=16):
    """A ramp to DEPTH that stops at `reach` m, its force `size` times a power of the depth."""
    depth = np.arange(steps + 1) / steps * DEPTH
    kept = depth[depth <= reach * (1 + 1e-9)]
    failure = None if reach >= DEPTH else RunFailure(kept.size, 0.5, reach, DEPTH, "m", "an element folds; a hint")
    return Ramp(kept, size * 1e6 * kept**power, kept[:, None], None, failure)


def ramps(by_edge, stuck=None):
    """Ramps by the edge radius in mm, and of the tool that sticks; a missing one is not covered."""

    def ramp_of(tool):
        found = stuck if tool.contact == "rigid_bonded" else by_edge.get(round(1e3 * tool.edge_radius, 3))
        if found is None:
            raise UncoveredError("there is no such tool")
        return found

    return ramp_of


def test_a_tool_that_is_followed_is_taken_as_told() -> None:
    told = made(DEPTH)
    curve = nearest_curve(TOLD, ramps({1.0: told}))
    assert curve.under(TOLD) is told
    assert (curve.depth, curve.force) == (pytest.approx(told.depth), pytest.approx(told.force))
    assert curve.remark(DEPTH) == ""
    assert continued(curve, DEPTH)[2] == ""


def test_larger_edges_come_first_then_a_sphere_then_a_tool_that_sticks() -> None:
    tools = list(nearest_tools(TOLD))
    assert tools[0] is TOLD
    assert [tool.edge_radius for tool in tools] == [1e-3, 2.5e-3, 5e-3, 10e-3, None]
    assert [tool.contact for tool in tools[-2:]] == ["rigid_frictionless", "rigid_bonded"]
    sphere = TOLD.model_copy(update={"edge_radius": 10e-3})
    assert list(nearest_tools(sphere)) == [sphere, stuck_tool(sphere)]
    tilted = Tool(radius=5e-3, contact="rigid_bonded", tilt=0.1, position=(1e-3, 0.0))
    assert list(nearest_tools(tilted)) == [tilted, Tool(radius=5e-3, contact="rigid_bonded")]


def test_each_tool_takes_over_with_its_growth_where_the_one_before_stops() -> None:
    told, wider, stuck = made(3e-3), made(5e-3, 0.3, 2.5), made(DEPTH, 4.0, 3.0)
    curve = nearest_curve(TOLD, ramps({1.0: told, 2.5: wider, 5.0: made(4e-3, 9.0)}, stuck))
    assert curve.reach == pytest.approx(DEPTH)
    assert curve.force[:7] == pytest.approx(told.force)
    at = dict(zip(np.round(1e3 * curve.depth, 6), curve.force, strict=True))
    assert at[5.0] / at[3.0] == pytest.approx((5 / 3) ** 2.5, rel=1e-9)
    assert at[8.0] / at[5.0] == pytest.approx((8 / 5) ** 3, rel=1e-9)
    assert (np.diff(curve.force) > 0.0).all()
    said = curve.remark(DEPTH)
    for word in ("to 8 mm", "told is followed to 3 mm (an element folds)", "2.5 mm is followed to 5 mm", "to 4 mm"):
        assert word in said
    assert "a sphere of 10 mm is not covered (there is no such tool)" in said
    assert "growth of an edge of 2.5 mm (to 5 mm) and of a flat tool to which the surface sticks (to 8 mm)" in said
    assert "hint" not in said


def test_a_tool_that_is_not_covered_gives_way_to_the_nearest() -> None:
    curve = nearest_curve(TOLD, ramps({}, made(DEPTH)))
    assert curve.under(TOLD) is None
    assert curve.force == pytest.approx(made(DEPTH).force)
    assert "the tool as told is not covered" in curve.remark(DEPTH)


def test_beyond_the_deepest_the_force_goes_on_with_its_last_power() -> None:
    curve = nearest_curve(TOLD, ramps({1.0: made(4e-3, power=2.5)}))
    depth, force, said = continued(curve, DEPTH)
    assert depth[-1] == pytest.approx(DEPTH)
    assert force[-1] / curve.force[-1] == pytest.approx(2.0**2.5, rel=1e-9)
    assert (np.diff(force) > 0.0).all()
    assert "beyond 4 mm the force goes on with the power 2.5" in said


def test_a_force_that_falls_on_the_way_is_taken_as_far_as_it_rises() -> None:
    ramp = made(DEPTH)
    folded = Ramp(ramp.depth, np.where(ramp.depth > 6e-3, 1.0, ramp.force), ramp.layers)
    curve = nearest_curve(TOLD, ramps({1.0: folded}))
    assert curve.reach == pytest.approx(6e-3)
    assert (np.diff(continued(curve, DEPTH)[1]) > 0.0).all()


def test_only_a_set_up_without_any_curve_is_refused() -> None:
    def refuse(_: Tool) -> Ramp:
        raise InputError("no mesh")

    with pytest.raises(SolverError, match="no mesh"):
        nearest_curve(TOLD, refuse)
    with pytest.raises(SolverError, match="is followed to 0"):
        nearest_curve(TOLD, ramps({1.0: made(0.5e-3)}))


def test_a_tool_carries_what_its_ramp_reached_and_any_force_where_it_came_to_its_end() -> None:
    stuck = stuck_tool(TOLD)
    carried = carried_forces(((TOLD, made(3e-3)), (stuck, made(DEPTH))))
    assert carried == [(TOLD, pytest.approx(9.0)), (stuck, np.inf)]
