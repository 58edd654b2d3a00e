import pytest
from pydantic import ValidationError

from benchmark.files.tool import Support, Tool, check_hole


def test_a_tool_needs_its_radius_only():
    tool = Tool(radius=5e-3)
    assert (tool.contact, tool.edge_radius, tool.position, tool.tilt) == ("uniform_pressure", None, (0.0, 0.0), 0.0)
    assert not tool.rigid
    assert Tool(radius=5e-3, contact="rigid_bonded").rigid


def test_a_contact_must_be_known():
    with pytest.raises(ValidationError, match="rigid_frictional"):
        Tool(radius=5e-3, contact="glued")


def test_an_edge_is_no_rounder_than_the_tool():
    assert Tool(radius=5e-3, edge_radius=5e-3).edge_radius == 5e-3
    with pytest.raises(ValidationError, match="6 mm is larger than the tool's radius of 5 mm"):
        Tool(radius=5e-3, edge_radius=6e-3)


def test_a_hole_needs_a_radius():
    with pytest.raises(ValidationError, match='give a length such as "30 mm"'):
        Support(kind="hole")
    assert Support().kind == "bonded"


def test_the_tool_passes_through_the_hole():
    check_hole(Tool(radius=5e-3), Support(kind="hole", hole_radius=6e-3))
    check_hole(Tool(radius=5e-3), Support(kind="bonded", hole_radius=1e-3))
    for radius in (5e-3, 4e-3):
        with pytest.raises(ValueError, match="not larger than the tool's radius of 5 mm"):
            check_hole(Tool(radius=5e-3), Support(kind="hole", hole_radius=radius))
