import math

import pytest

import fem
from fem import FemError

SOFT = fem.NeoHookean(2e4, 0.48)


def layer(name="a", thickness=1e-2, material=SOFT):
    return fem.Layer(name, thickness, 1000.0, material)


@pytest.mark.parametrize("bad", [0.0, -1e-3, math.nan])
def test_thickness_must_be_positive(bad):
    with pytest.raises(FemError, match=r"thickness.*must be a finite number above 0 m"):
        layer(thickness=bad)


def test_density_must_be_positive():
    with pytest.raises(FemError, match=r"density = -1 kg/m3"):
        fem.Layer("a", 1e-2, -1.0, SOFT)


def test_unknown_contact_lists_the_allowed_ones():
    with pytest.raises(FemError, match="allowed are rigid_bonded, rigid_frictional, rigid_frictionless"):
        fem.Tool(5e-3, "glued")


def test_edge_radius_is_at_most_the_radius():
    with pytest.raises(FemError, match=r"tool.edge_radius = 0.006 m: must be at most"):
        fem.Tool(5e-3, "rigid_frictionless", 6e-3)


@pytest.mark.parametrize(("kind", "radius"), [("hole", None), ("bonded", 0.03), ("half_space", 0.03)])
def test_hole_radius_belongs_to_the_hole(kind, radius):
    with pytest.raises(FemError, match=r"support.hole_radius"):
        fem.Support(kind, radius)


def test_layers_must_be_there():
    with pytest.raises(FemError, match="at least one"):
        fem.Problem((), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded"))


def test_layer_names_must_differ():
    with pytest.raises(FemError, match="'a' is used 2 times"):
        fem.Problem((layer(), layer()), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded"))


def test_linear_elastic_is_refused_in_finite_kinematics():
    with pytest.raises(FemError, match="LinearElastic is for kinematics = 'linear' only"):
        fem.Problem(
            (layer(material=fem.LinearElastic(2e4, 0.3)),), fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")
        )


def test_only_the_last_layer_of_a_half_space_is_endless():
    tool = fem.Tool(5e-3, "rigid_bonded")
    stack = (layer("a"), layer("b", math.inf))
    assert fem.Problem(stack, tool, fem.Support("half_space")).layers[1].thickness == math.inf
    with pytest.raises(FemError, match="'b': thickness = inf m"):
        fem.Problem(stack, tool, fem.Support("bonded"))


@pytest.mark.parametrize(
    ("support", "word"), [(fem.Support("bonded"), "tool.radius"), (fem.Support("hole", 0.03), "hole")]
)
def test_the_border_lies_outside_tool_and_hole(support, word):
    with pytest.raises(FemError, match=word):
        fem.Problem((layer(),), fem.Tool(5e-3, "rigid_bonded"), support, "finite", fem.Discretisation(radius=5e-3))


@pytest.mark.parametrize("edge", [0.5, 17.0, float("nan")])
def test_the_size_of_the_edge_is_bounded(edge):
    with pytest.raises(FemError, match=r"discretisation\.edge = .*: must be from 1 to 8"):
        fem.Discretisation(edge=edge)


def test_stabilisation_is_bounded():
    with pytest.raises(FemError, match="from 0 to 10 shear moduli"):
        fem.Discretisation(stabilisation=-1.0)
