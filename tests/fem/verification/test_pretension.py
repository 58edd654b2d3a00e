"""The closed form of the sheet under tension, and what the finite elements make of a pretension."""

import numpy as np
import pytest

import fem
from fem.verification.pretension import (
    HOLE,
    POISSON_RATIO,
    RADIUS,
    TENSIONS,
    THICKNESS,
    YOUNGS_MODULUS,
    closed_form,
    sheet,
)


def test_a_very_thin_sheet_is_a_membrane():
    thickness, tension = 1e-7, 1e4
    membrane = 2.0 * np.pi * tension * thickness / np.log(HOLE / RADIUS)
    assert closed_form(tension, thickness) == pytest.approx(membrane, rel=5e-4)


def test_with_little_tension_it_is_a_plate():
    """Clamped plate, rigid disc without slope: F = 16 pi D w / ((R^2 - a^2) - 4 R^2 a^2 ln(R/a)^2 / (R^2 - a^2))."""
    stiffness = YOUNGS_MODULUS * THICKNESS**3 / (12.0 * (1.0 - POISSON_RATIO**2))
    ring, log = HOLE**2 - RADIUS**2, np.log(HOLE / RADIUS)
    plate = 16.0 * np.pi * stiffness / (ring - 4.0 * (HOLE * RADIUS * log) ** 2 / ring)
    assert closed_form(1e-3, THICKNESS) == pytest.approx(plate, rel=1e-3)


def test_a_wrong_tension_would_fail(monkeypatch):
    monkeypatch.setattr("fem.verification.pretension.closed_form", lambda S, h: closed_form(1.01 * S, h))
    assert not sheet(TENSIONS[1], "linear")[0].passed


def held(kinematics, tension, **changes):
    law = fem.LinearElastic if kinematics == "linear" else fem.NeoHookean
    layers = (fem.Layer("skin", 1.5e-3, 1000.0, law(1e5, 0.48)), fem.Layer("fat", 5e-3, 1000.0, law(1e4, 0.48)))
    return fem.prepare(
        fem.Problem(
            layers, fem.Tool(5e-3, "rigid_bonded"), fem.Support("bonded"), kinematics, pretension=tension, **changes
        )
    )


def test_small_and_large_strain_agree_at_a_small_press():
    load = fem.Load("force", [1.0], [1e-5])
    finite, linear = (held(kinematics, 5e4).run(load).depth[0] for kinematics in ("finite", "linear"))
    assert finite == pytest.approx(linear, rel=1e-2)
    assert linear < 0.9 * held("linear", 0.0).run(load).depth[0]


def test_the_support_returns_the_force_and_unloading_retraces_it():
    force = 0.2 * np.array([1.0, 2.0, 3.0, 2.0, 1.0, 0.0])
    found = held("finite", 1e4).run(fem.Load("force", np.arange(1.0, 7.0), force))
    assert found.complete
    np.testing.assert_allclose(found.reaction, force, atol=1e-6 * force.max())
    np.testing.assert_allclose(found.depth[3:5], found.depth[1::-1], rtol=1e-8)
    assert abs(found.depth[-1]) < 1e-9 * found.depth.max()


def test_fields_show_the_tension_at_rest():
    """One tiny press: the stress far from the tool is the tension, in the plane alone."""
    model = held("finite", 1e4)
    stress = model.run(fem.Load("force", [1.0], [1e-9])).fields(0).cauchy_stress
    np.testing.assert_allclose(stress, np.broadcast_to(np.diag([1e4, 1e4, 0.0]), stress.shape), atol=1.0)


@pytest.mark.parametrize(
    ("tension", "geometry", "message"),
    [(-1.0, "axisymmetric", "must be from 0"), (2e8, "axisymmetric", "must be from 0"), (1e3, "surface", "no plane")],
)
def test_what_has_no_tension_is_refused(tension, geometry, message):
    with pytest.raises(fem.FemError, match=f"pretension.*{message}"):
        held("finite", tension, geometry=geometry)
