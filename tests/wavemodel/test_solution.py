"""In-plane motion of faces against layered elasticity worked out apart, and its symmetries."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.special import j1

from wavemodel import (
    Damping,
    DiscTool,
    LayeredWave,
    NotCoveredError,
    PlateSettings,
    PlateWave,
    Prony,
    WaveDiscretisation,
    WaveError,
    WaveLayer,
    marker_motion,
)

POINTS = np.array([[0.0, 0.0], [2e-3, 0.0], [0.0, -5e-3], [6e-3, 4.5e-3]])


def pressed(layers, window=None, **options):
    modes = WaveDiscretisation(window=window)
    wave = LayeredWave(layers, DiscTool(5e-3), **{"discretisation": modes, "large_press": "linear", **options})
    return wave.run("force", np.array([10.0, 20.0]), np.array([0.05, 0.1]))


def outward(elasticity, face, radii, load):
    """Minus the integral of U J_1(k r) k dk / (2 pi) for the interface, per newton."""
    limit, panels = 4e4, 400
    point, weight = np.polynomial.legendre.leggauss(6)
    width = limit / panels
    k = ((np.arange(panels) + 0.5)[:, None] * width + 0.5 * width * point).ravel()
    table = np.geomspace(1.0, limit, 400)
    sideways = (
        CubicSpline(np.log(table), [elasticity.compliance(one)[face, 0] * one for one in table])(np.log(k)) / k[:, None]
    )
    soft = np.where(k < 0.5 * limit, 1.0, np.cos(np.pi * (k / limit - 0.5)) ** 2)
    measure = soft * np.tile(0.5 * width * weight, panels) * k / (2.0 * np.pi)
    return -(np.einsum("kj,kj->k", sideways, load(k)) * measure) @ j1(np.outer(k, radii))


@pytest.mark.parametrize("face", [1, 2])
def test_interfaces_move_as_in_exact_layered_elasticity(skin, oracle, uniform_load, face):
    """Within 1 % of the largest in a 120 mm window; the border of the automatic one, 88 mm, costs 2 %."""
    found = marker_motion(pressed(skin(), window=120e-3), POINTS, face=face)
    radii = np.hypot(*POINTS.T)
    expected = 0.1 * outward(oracle(skin()), face, radii, uniform_load(5e-3))
    direction = POINTS / np.maximum(radii, 1e-12)[:, None]
    np.testing.assert_allclose(found, expected[:, None] * direction, atol=0.01 * np.abs(expected).max())


def test_the_surface_of_a_thick_layer_moves_as_boussinesq_s(skin):
    """Inside the disc u = -(1 - 2 nu)(1 + nu) p r / (2 E) (Johnson, Contact mechanics, eq. 3.29b)."""
    fat = skin(fat=200e-3, poisson_ratio=0.3)[2:]
    radii = np.array([1e-3, 2e-3, 4e-3])
    found = marker_motion(pressed(fat), np.stack([radii, 0.0 * radii], axis=1), face=0)[:, 0]
    pressure = 0.1 / (np.pi * 5e-3**2)
    np.testing.assert_allclose(found, -0.4 * 1.3 * pressure * radii / (2 * 2e4), rtol=0.03)


def test_nothing_moves_on_a_bonded_base_and_nothing_is_said_outside_the_window(skin):
    points = np.array([[3e-3, 1e-3], [25.1e-3, 0.0]])
    found = marker_motion(pressed(skin(), window=50e-3), points)
    np.testing.assert_array_equal(found, [[0.0, 0.0], [np.nan, np.nan]])


def test_a_free_lower_face_moves_by_the_slope_of_the_plate(skin):
    """u = -c grad w with c half the thickness, well away from the tool (Kirchhoff)."""
    layers = skin(fat=1e-3, poisson_ratio=0.3)[2:]
    modes = WaveDiscretisation(window=120e-3, modes=48)
    solution = pressed(layers, support="free", discretisation=modes, integrator="quasi_static")
    r, h = 25e-3, 0.1e-3
    moved = marker_motion(solution, np.array([[r, 0.0]]))[0]
    slope = np.diff(solution.profile(-1, np.array([r - h, r + h]))[0])[0] / (2 * h)
    np.testing.assert_allclose(moved, [-0.5e-3 * slope, 0.0], rtol=0.01, atol=1e-9 * abs(moved[0]) + 1e-12)


def test_motion_follows_the_force_and_fades_with_the_layers(skin):
    solution = pressed(skin(), relaxation=Prony((0.4,), (1e-3,)))
    elastic = pressed(skin())
    for step in (0, 1):
        np.testing.assert_allclose(
            marker_motion(solution, POINTS, step, 1), marker_motion(elastic, POINTS, step, 1) / 0.6, rtol=1e-3
        )


def test_under_a_sheet_markers_move_as_its_lower_face(silicone):
    solution = PlateWave(
        silicone(), DiscTool(5e-3, "rigid_bonded"), settings=PlateSettings(reach=3e-3), hole_radius=30e-3
    ).run("depth", np.ones(1), np.array([3e-3]))
    points = np.array([[6e-3, 8e-3], [-6e-3, 8e-3], [0.0, 31e-3]])
    outwards = solution.faces.lower_face(0, np.array([10e-3]))[0, 0]
    expected = outwards * points[:2] / 10e-3
    np.testing.assert_allclose(marker_motion(solution, points)[:2], expected, rtol=1e-12)
    assert np.isnan(marker_motion(solution, points)[2]).all()


@pytest.mark.parametrize("base", ["bonded", "free"])
@pytest.mark.parametrize("face", [0, 1, 3])
def test_with_inertia_a_slow_press_moves_as_one_without(skin, base, face):
    time, force, found = np.array([20.0, 40.0]), np.array([0.05, 0.1]), []
    for integrator in ("exact", "quasi_static"):
        wave = LayeredWave(
            skin(),
            DiscTool(5e-3),
            base,
            WaveDiscretisation(window=60e-3, modes=24),
            integrator=integrator,
            damping=Damping(mass_rate=50.0),
            large_press="linear",
        )
        found.append(marker_motion(wave.run("force", time, force), POINTS, face=face))
    np.testing.assert_allclose(found[0], found[1], atol=3e-3 * np.abs(found[1]).max())
    assert np.abs(found[1]).max() > 0.0 or (base, face) == ("bonded", 3)


def test_with_inertia_each_step_is_that_of_the_run_so_far(skin):
    """The oscillators of a fast press: another than the static motion, and the same after any later load."""
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=60e-3, modes=24),
        integrator="exact",
        large_press="linear",
    )
    time, force = np.array([1e-3, 2e-3, 3e-3]), np.array([0.1, 0.1, 0.02])
    run = wave.run("force", time, force)
    at_rest = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=60e-3, modes=24),
        integrator="quasi_static",
        large_press="linear",
    )
    static = marker_motion(at_rest.run("force", time, force), POINTS, 1, 1)
    moved = marker_motion(run, POINTS, 1, 1)
    np.testing.assert_allclose(moved, marker_motion(wave.run("force", time[:2], force[:2]), POINTS, -1, 1), rtol=1e-12)
    assert np.abs(moved - static).max() > 0.2 * np.abs(static).max()


@pytest.mark.parametrize(
    ("tissue", "contact", "within"),
    [
        ("skin_forearm", "uniform_pressure", 1e-3),
        ("skin_porcine_fat", "uniform_pressure", 2e-3),
        ("skin_traction", "uniform_pressure", 1e-3),
        ("skin_forearm", "rigid_bonded", 8e-3),
    ],
)
def test_a_large_press_moves_markers_as_finite_strain_does(tissue, contact, within):
    """Of the depth; the linear wave is 4 to 9 % of it off at the larger force."""
    stored = json.loads((Path(__file__).parent / "layered" / "fem_reference.json").read_text())
    layers = [WaveLayer(*one) for one in stored["tissues"][tissue]]
    levels = [one for one in stored["outward"] if (one["tissue"], one["contact"]) == (tissue, contact)]
    radii = np.array(stored["outward_radii"])
    points = np.stack([0.6 * radii, -0.8 * radii], axis=1)
    errors = {}
    for word in ("corrected", "linear"):
        wave = LayeredWave(
            layers, DiscTool(5e-3, contact), discretisation=WaveDiscretisation(window=120e-3), large_press=word
        )
        forces = np.array(sorted({one["force"] for one in levels}))
        run = wave.run("force", np.arange(1.0, 3.0), forces)
        errors[word] = 0.0
        for one in levels:
            step = int(np.searchsorted(forces, one["force"]))
            moved = marker_motion(run, points, step, one["face"])
            expected = np.array(one["outward"])[:, None] * points / radii[:, None]
            errors[word] = max(errors[word], float(np.abs(moved - expected).max() / run.depth[step]))
    assert errors["corrected"] < within
    assert errors["linear"] > 0.03


@pytest.mark.parametrize(
    ("wave", "face", "word"),
    [
        ({"relaxation": [Prony((0.3,), (1.0,)), None, None]}, 1, "in its own way"),
    ],
)
def test_what_it_does_not_cover_it_says(skin, wave, face, word):
    with pytest.raises(NotCoveredError, match=word):
        marker_motion(pressed(skin(), **wave), POINTS, face=face)


def test_the_surface_under_a_rigid_tool_is_not_covered(skin):
    wave = LayeredWave(skin(), DiscTool(5e-3, "rigid_bonded"), large_press="linear")
    with pytest.raises(NotCoveredError, match="rigid tool"):
        marker_motion(wave.run("force", np.ones(1), np.ones(1)), POINTS, face=0)


@pytest.mark.parametrize(
    ("points", "step", "face", "word"),
    [(np.zeros(3), 0, 0, "points"), (np.full((1, 2), np.nan), 0, 0, "points"), (POINTS, 2, 0, "step"),
     (POINTS, 0, 4, "face")],
)  # fmt: skip
def test_unusable_requests_are_refused(skin, points, step, face, word):
    with pytest.raises(WaveError, match=word):
        marker_motion(pressed(skin()), points, step, face)


def test_a_solution_shows_itself_with_its_warnings(skin):
    quiet, warned = pressed(skin()), pressed(skin()).warned("too deep")
    assert repr(quiet).startswith("<WaveSolution 2 steps to 0.1 N, ")
    assert "warning" not in repr(quiet)
    assert repr(warned).endswith("\n  warning: too deep")
