import numpy as np
import pytest

import fem
from fem import FemError
from fem.setup.contacts import CONTACT_MODELS
from fem.setup.layout import lay_out


def conditions(problem):
    mesh = lay_out(problem)
    return mesh, CONTACT_MODELS[problem.tool.contact].conditions(mesh, problem)


@pytest.mark.parametrize("contact", sorted(set(CONTACT_MODELS) - {"rigid_frictional"}))
def test_unit_load_adds_up_to_one_newton_downwards(skin, contact):
    _, found = conditions(skin(contact, "linear"))
    assert found.load.sum() == pytest.approx(-1.0, rel=1e-13)


def test_uniform_pressure_has_the_disc_s_second_moment(skin):
    """int r^2 of the traction is radius^2 / 2, exact for quadratic elements."""
    mesh, found = conditions(skin("uniform_pressure"))
    assert -(found.load * mesh.nodes[:, 0] ** 2).sum() == pytest.approx((5e-3) ** 2 / 2, rel=1e-12)


def test_uniform_pressure_constrains_nothing(skin):
    _, found = conditions(skin("uniform_pressure"))
    assert not found.held.any()
    assert not found.tied.any()


def test_bonded_tool_holds_and_ties_all_nodes_under_it(slab):
    mesh, found = conditions(slab("rigid_bonded"))
    under = (mesh.nodes[:, 1] == 0.0) & (mesh.nodes[:, 0] <= 5e-3)
    np.testing.assert_array_equal(found.held, under)
    np.testing.assert_array_equal(found.tied, under)


def test_frictionless_tool_ties_without_holding(slab):
    _, found = conditions(slab("rigid_frictionless", "linear"))
    assert found.tied.any()
    assert not found.held.any()


def problem(contact, kinematics, edge=None):
    layer = fem.Layer("a", 1e-2, 1000.0, fem.NeoHookean(2e4, 0.48))
    return fem.Problem((layer,), fem.Tool(5e-3, contact, edge), fem.Support("bonded"), kinematics)


@pytest.mark.parametrize(
    ("contact", "kinematics", "edge", "message"),
    [
        ("rigid_frictionless", "finite", None, "edge_radius is missing.*needs a rounded edge"),
        ("rigid_bonded", "finite", 5e-4, "rounded edge is not available"),
    ],
)
def test_what_is_not_there_is_refused_when_prepared(contact, kinematics, edge, message):
    with pytest.raises(FemError, match=message):
        fem.prepare(problem(contact, kinematics, edge))


@pytest.mark.parametrize(("contact", "kinematics"), [("uniform_pressure", "finite"), ("rigid_frictionless", "linear")])
def test_an_ignored_edge_radius_is_said(contact, kinematics):
    model = fem.prepare(problem(contact, kinematics, 5e-4))
    assert any("edge_radius has no effect" in text for text in model.warnings)
