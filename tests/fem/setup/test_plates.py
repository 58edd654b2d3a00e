"""A cylinder between two plates: closed forms, a peer's values, and what is said and refused."""

import numpy as np
import pytest
from scipy.optimize import brentq

import fem

RADIUS, HEIGHT = 10e-3, 15e-3
MATERIAL = fem.NeoHookean(60e3, 0.45)
FELUPE = {0.1: 2.5347, 0.2: 5.6008}
"""N by strain where faces stick: FElupe 11.3, 512 elements of 9 nodes on a mesh of its own, displacements alone."""


def problem(contact, layers=1, **others):
    parts = tuple(fem.Layer(f"part {k}", HEIGHT / layers, 1000.0, MATERIAL) for k in range(layers))
    given = {"support": fem.Support("plates", specimen_radius=RADIUS), "tool": fem.Tool(RADIUS, contact), **others}
    return fem.Problem(parts, **given)


def run(of, deepest, steps=4):
    load = fem.Load("depth", np.arange(1.0, steps + 1), deepest * np.arange(1, steps + 1) / steps)
    return fem.prepare(of).run(load)


def sliding_force(stretch):
    """W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 without stress across; N, press positive."""
    mu, bulk = MATERIAL.shear_modulus, MATERIAL.bulk_modulus

    def nominal(across, of):
        volume, total = across**2 * stretch, 2.0 * across**2 + stretch**2
        return mu * volume ** (-2 / 3) * (of - total / (3.0 * of)) + bulk * (volume - 1.0) * volume / of

    across = brentq(lambda a: nominal(a, a), 0.5, 2.0, xtol=1e-15)
    return -nominal(across, stretch) * np.pi * RADIUS**2


@pytest.mark.parametrize("layers", [1, 3])
@pytest.mark.parametrize("strain", [0.4, -0.4])
def test_a_cylinder_that_slides_follows_the_closed_form(layers, strain):
    found = run(problem("rigid_frictionless", layers), strain * HEIGHT)
    assert found.force[-1] == pytest.approx(sliding_force(1.0 - strain), rel=1e-9)
    assert found.depth[-1] == pytest.approx(strain * HEIGHT)


@pytest.mark.parametrize("strain", [0.02, -0.02])
def test_small_strain_is_hookes(strain):
    elastic = fem.Layer("part", HEIGHT, 1000.0, fem.LinearElastic(60e3, 0.45))
    support, tool = fem.Support("plates", specimen_radius=RADIUS), fem.Tool(2 * RADIUS, "rigid_frictionless")
    found = run(fem.Problem((elastic,), tool, support, "linear"), strain * HEIGHT)
    assert found.force[-1] == pytest.approx(60e3 * strain * np.pi * RADIUS**2, rel=1e-9)


def test_faces_that_stick_are_stiffer_and_told_of_mesh_and_bulge():
    of = problem("rigid_bonded")
    model, load = fem.prepare(of), fem.Load("depth", np.arange(1.0, 10.0), 0.3 * HEIGHT * np.arange(1, 10) / 9)
    found = model.run(load)
    assert found.complete
    assert found.force[-1] > 1.05 * sliding_force(0.7)
    for strain, peer in FELUPE.items():
        assert found.force[np.argmin(np.abs(found.depth - strain * HEIGHT))] == pytest.approx(peer, rel=2e-3)
    error = fem.estimate_mesh_error(model, load, found)
    assert abs(error.percent) < 1.0
    assert any("bulges past the plates" in text for text in found.warnings)
    assert not run(of, 0.05 * HEIGHT, 2).warnings


def test_a_flat_cylinder_that_sticks_is_as_stiff_as_gent_and_lindley_say():
    """A. N. Gent, P. B. Lindley 1959: 1/E_a = 1/(3 mu (1 + 2 S^2)) + 1/K with S = R/(2 h), for a disc of rubber."""
    height, mu, radius, nu = 2.5e-3, 20e3, 20e-3, 0.4999
    disc = fem.Layer("disc", height, 1000.0, fem.LinearElastic(2.0 * mu * (1.0 + nu), nu))
    support = fem.Support("plates", specimen_radius=radius)
    depth, bulk = 1e-3 * height, 2.0 * mu * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu))
    found = run(fem.Problem((disc,), fem.Tool(radius, "rigid_bonded"), support, "linear"), depth, 1)
    apparent = 1.0 / (1.0 / (3.0 * mu * (1.0 + 2.0 * (radius / (2.0 * height)) ** 2)) + 1.0 / bulk)
    assert found.force[-1] == pytest.approx(apparent * np.pi * radius**2 * depth / height, rel=0.03)


def test_a_pull_is_told_to_be_glued():
    assert any("glued" in text for text in run(problem("rigid_bonded"), -0.05 * HEIGHT, 2).warnings)


@pytest.mark.parametrize(
    ("others", "message"),
    [
        ({"tool": fem.Tool(RADIUS, "uniform_pressure")}, "between plates only rigid_bonded or rigid_frictionless"),
        ({"tool": fem.Tool(0.5 * RADIUS, "rigid_bonded")}, "must cover the specimen"),
        ({"discretisation": fem.Discretisation(radius=0.1)}, "without discretisation.radius"),
        ({"pretension": 1e3}, "without pretension"),
        ({"geometry": "block"}, "without geometry"),
    ],
)
def test_what_a_plate_cannot_be_is_refused(others, message):
    contact = others.pop("tool", fem.Tool(RADIUS, "rigid_bonded"))
    with pytest.raises(fem.FemError, match=message):
        problem("rigid_bonded", tool=contact, **others)


@pytest.mark.parametrize(("kind", "radius"), [("plates", None), ("bonded", 1e-2)])
def test_a_radius_belongs_to_plates(kind, radius):
    with pytest.raises(fem.FemError, match="specimen_radius"):
        fem.Support(kind, specimen_radius=radius)
