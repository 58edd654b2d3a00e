import math

import numpy as np
import pytest

import fem

GROUND = fem.NeoHookean(2e4, 0.45)


def problem(geometry, *fibres, **other):
    material = fem.FibreReinforced(GROUND, fibres)
    layer = fem.Layer("dermis", 5e-3, 1000.0, material)
    return fem.Problem((layer,), fem.Tool(5e-3, "uniform_pressure"), fem.Support("bonded"), geometry=geometry, **other)


def fibre(angle, k1=1e4, dispersion=0.1):
    return fem.Fibre(k1, 2.0, dispersion, None if angle is None else math.radians(angle))


def test_fibres_without_direction_are_axisymmetric():
    problem("axisymmetric", fibre(None), fibre(30.0, dispersion=1 / 3))


def test_a_direction_breaks_axial_symmetry():
    with pytest.raises(fem.FemError, match=r"'dermis': fibre angle = 30 deg .* leave the angle out"):
        problem("axisymmetric", fibre(None), fibre(30.0))


@pytest.mark.parametrize("angles", [(0.0,), (90.0,), (30.0, -30.0), (None, 150.0, 30.0)])
def test_a_block_takes_what_its_mirror_planes_allow(angles):
    problem("block", *(fibre(angle) for angle in angles))


@pytest.mark.parametrize("families", [(fibre(30.0),), (fibre(30.0), fibre(-30.0, k1=2e4))])
def test_a_block_refuses_a_direction_without_its_mirror_image(families):
    with pytest.raises(fem.FemError, match="mirror planes"):
        problem("block", *families)


def test_planar_fibres_stiffen_the_press():
    load = fem.Load("force", [1.0], [0.5])
    depths = [
        fem.prepare(problem("axisymmetric", fibre(None, k1=k1), discretisation=fem.Discretisation("coarse"))).run(load)
        for k1 in (1.0, 1e4, 1e5)
    ]
    assert all(solution.complete for solution in depths)
    first, second, third = (float(solution.depth[-1]) for solution in depths)
    assert first > 1.01 * second > 1.02 * third


def test_fibres_along_x_make_the_press_longer_along_y():
    """In three dimensions a family along x holds the surface along x, so the dent reaches further there."""
    model = fem.prepare(
        problem("block", fibre(0.0, k1=2e5, dispersion=0.0), discretisation=fem.Discretisation("coarse"))
    )
    solution = model.run(fem.Load("force", [1.0], [0.6]))
    assert solution.complete
    assert solution.reaction[-1] == pytest.approx(0.6, rel=1e-6)
    nodes, u = solution.mesh.nodes, -solution.displacement[-1, :, 2]
    top = (nodes[:, 2] == 0.0) & (nodes[:, 0] > 5e-3) & (nodes[:, 0] < 10e-3)
    along_x, along_y = top & (nodes[:, 1] == 0.0), (nodes[:, 2] == 0.0) & (nodes[:, 0] == 0.0)
    radii = nodes[along_x, 0]
    order = nodes[along_y, 1].argsort()
    other = np.interp(radii, nodes[along_y, 1][order], u[along_y][order])
    assert np.abs(u[along_x] - other).max() > 0.02 * u.max()
