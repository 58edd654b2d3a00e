import numpy as np
import pytest

import fem
from fem.setup.layout import lay_out
from fem.setup.supports import SUPPORT_MODELS, decay_length

LAYERS = (
    fem.Layer("a", 2e-3, 1000.0, fem.NeoHookean(1e5, 0.48)),
    fem.Layer("b", 8e-3, 1000.0, fem.NeoHookean(1e4, 0.48)),
)


def problem(support, kinematics="linear", **mesh):
    return fem.Problem(LAYERS, fem.Tool(5e-3, "uniform_pressure"), support, kinematics, fem.Discretisation(**mesh))


def test_bonded_holds_base_and_border():
    p = problem(fem.Support("bonded"))
    mesh = lay_out(p)
    fixed = SUPPORT_MODELS["bonded"].fixed(mesh, p)
    assert (fixed == (mesh.base | mesh.border)).all()
    assert mesh.nodes[:, 1].min() == pytest.approx(-10e-3)


def test_a_prescribed_radius_is_kept():
    assert lay_out(problem(fem.Support("bonded"), radius=0.03)).radius == 0.03


def test_a_single_layer_decays_over_its_thickness():
    p = fem.Problem(LAYERS[1:], fem.Tool(5e-3, "uniform_pressure"), fem.Support("bonded"))
    assert decay_length(p) == pytest.approx(8e-3)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
@pytest.mark.parametrize("nu", [0.3, 0.499])
def test_the_border_costs_less_than_a_thousandth(contact, nu):
    layers = tuple(
        fem.Layer(one.name, one.thickness, 1000.0, fem.NeoHookean(one.material.youngs_modulus, nu)) for one in LAYERS
    )

    def depth(radius):
        p = fem.Problem(
            layers, fem.Tool(5e-3, contact), fem.Support("bonded"), "linear", fem.Discretisation(radius=radius)
        )
        return fem.prepare(p).run(fem.Load("force", [1.0], [1.0])).top_deflection[0]

    automatic = lay_out(fem.Problem(layers, fem.Tool(5e-3, contact), fem.Support("bonded"), "linear")).radius
    np.testing.assert_allclose(depth(automatic), depth(4.0 * automatic), rtol=1e-3)


STIFF_ON_SOFT = (
    fem.Layer("stiff", 1e-3, 1000.0, fem.NeoHookean(1e6, 0.48)),
    fem.Layer("soft", 5e-3, 1000.0, fem.NeoHookean(1e4, 0.48)),
)


@pytest.mark.parametrize("layers", [LAYERS[1:], STIFF_ON_SOFT], ids=["one layer", "stiff on soft"])
def test_so_does_the_border_of_a_sheet_over_a_hole_in_a_deep_press(layers):
    """A stiff layer hands its pull on over a soft one: held four thicknesses outside the hole it took 4 % more."""

    def force(radius):
        mesh = fem.Discretisation("coarse", radius)
        problem = fem.Problem(layers, fem.Tool(5e-3, "rigid_bonded"), fem.Support("hole", 15e-3), discretisation=mesh)
        return fem.prepare(problem).run(fem.Load("depth", [1.0, 2.0, 3.0, 4.0], [0.5e-3, 1e-3, 1.5e-3, 2e-3])).force[-1]

    wide = 15e-3 + 6.0 * decay_length(fem.Problem(layers, fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded")))
    assert force(None) == pytest.approx(force(2.0 * wide), rel=1e-3)


def test_a_sheet_clamped_at_the_rim_ends_there_and_is_held_at_its_edge_alone():
    p = problem(fem.Support("hole", 0.03, clamp="rim"))
    mesh = lay_out(p)
    fixed = SUPPORT_MODELS["hole"].fixed(mesh, p)
    assert mesh.radius == 0.03
    np.testing.assert_array_equal(fixed, mesh.border)


@pytest.mark.parametrize("wrong", [{"kind": "bonded"}, {"kind": "hole", "hole_radius": 0.03, "clamp_shear_limit": 1e3}])
def test_only_a_sheet_that_does_not_slide_has_a_rim(wrong):
    with pytest.raises(fem.FemError, match=r"support.clamp = 'rim'"):
        fem.Support(**wrong, clamp="rim")


def test_a_clamp_at_the_rim_is_a_thin_plates_clamped_edge():
    # w = F R^2 / (16 pi D) of a clamped plate under a small disc; a plate round the hole is softer
    sheet = fem.Layer("sheet", 1e-3, 1000.0, fem.NeoHookean(1e5, 0.49))

    def stiffness(clamp):
        p = fem.Problem((sheet,), fem.Tool(1e-3, "uniform_pressure"), fem.Support("hole", 0.03, clamp=clamp), "linear")
        return 1e-3 / fem.prepare(p).run(fem.Load("force", [1.0], [1e-3])).top_deflection[0, -1]

    plate = 16 * np.pi * 1e5 * 1e-9 / 12 / (1 - 0.49**2) / 0.03**2
    assert stiffness("rim") == pytest.approx(plate, rel=0.02)
    assert stiffness("plate") < 0.98 * stiffness("rim")


def test_hole_is_free_inside_and_has_its_rim_on_a_grid_line():
    p = problem(fem.Support("hole", 0.03))
    mesh = lay_out(p)
    fixed = SUPPORT_MODELS["hole"].fixed(mesh, p)
    r = mesh.nodes[:, 0]
    assert (r[mesh.base] == 0.03).sum() == 1
    np.testing.assert_array_equal(fixed[mesh.base], r[mesh.base] >= 0.03)
    assert fixed[mesh.border].all()
    assert mesh.radius > 0.03


def test_half_space_reaches_ten_thousand_radii_and_ignores_the_last_thickness():
    deep = [
        lay_out(
            fem.Problem(
                (LAYERS[0], fem.Layer("b", thickness, 1000.0, LAYERS[1].material)),
                fem.Tool(5e-3, "uniform_pressure"),
                fem.Support("half_space"),
                "linear",
            )
        )
        for thickness in (1e-3, np.inf)
    ]
    np.testing.assert_array_equal(deep[0].nodes, deep[1].nodes)
    assert deep[0].radius >= 1e4 * 5e-3
    assert -deep[0].nodes[:, 1].min() >= 1e4 * 5e-3
