"""The layered wave in a round window, against the square one, the finite elements and closed forms."""

import numpy as np
import pytest
from scipy.special import j0, j1, jn_zeros

import fem
from wavemodel import (
    Damping,
    DiscTool,
    LayeredWave,
    NotCoveredError,
    Prony,
    WaveDiscretisation,
    WaveError,
    WaveLayer,
    marker_motion,
)
from wavemodel.control import Grid, layered_body
from wavemodel.layered.stack.laminate import laminate
from wavemodel.layered.window import (
    BORDER_COST,
    Taper,
    automatic_window,
    border_cost,
    enough_modes,
    far_field,
)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"window": 0.0}, "window = 0 m"),
        ({"modes": 0}, "modes = 0"),
        ({"modes": 100_000}, "modes = 100000 is not allowed: at most 4096"),
        ({"sublayers": (1, 0, 2)}, "sublayers"),
        ({"modes": 7, "static_correction": True}, "at least 8"),
    ],
)
def test_refuses(options, message):
    with pytest.raises(WaveError, match=message):
        WaveDiscretisation(**options)


@pytest.mark.parametrize(
    ("options", "corrected"),
    [({}, True), ({"modes": 8}, True), ({"modes": 7}, False), ({"modes": 64, "static_correction": False}, False)],
)
def test_the_correction_comes_with_enough_modes(options, corrected):
    assert WaveDiscretisation(**options).corrected is corrected


ONE, FORCE = np.array([10.0]), np.array([0.1])
X = np.array([-12e-3, -5e-3, 0.0, 5e-3, 12e-3])


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_frictionless", "rigid_bonded"])
@pytest.mark.parametrize("place", [(0.0, 0.0), (7e-3, -4e-3)])
def test_far_from_the_border_it_is_the_square_window(skin, contact, place):
    """Depth, faces and marker motion within 0.1 % of the peak, 90 mm wide, tool in the middle or off it."""
    answers = []
    for domain in ("rectangle", "disc"):
        wave = LayeredWave(
            skin(),
            DiscTool(5e-3, contact),
            discretisation=WaveDiscretisation(window=90e-3, domain=domain, place=place),
            large_press="linear",
        )
        solution = wave.run("force", ONE, FORCE)
        frame = wave.surface(X, X[1:]).frame(solution.faces.snapshot(0))
        points = np.stack([X, np.roll(X, 1)], axis=1)
        parts = (solution.depth, solution.top_deflection, solution.profile(0, X[2:]), frame)
        answers.append((np.concatenate([p.ravel() for p in parts]), marker_motion(solution, points, face=1)))
        assert not solution.warnings
    (square, moved_square), (round_, moved_round) = answers
    np.testing.assert_allclose(round_ / square.max(), square / square.max(), atol=1e-3)
    np.testing.assert_allclose(moved_round / square.max(), moved_square / square.max(), atol=5e-3)


def test_all_automatic_it_has_fewer_modes_and_the_accuracy_of_the_contract(skin, oracle, uniform_load):
    wave, square = (
        LayeredWave(skin(), DiscTool(5e-3), discretisation=WaveDiscretisation(domain=domain), large_press="linear")
        for domain in ("disc", "rectangle")
    )
    radii = np.concatenate([np.linspace(0.0, 20e-3, 17), [0.35 * wave.window, 0.5 * wave.window]])
    exact = oracle(skin()).deflection(radii, uniform_load(5e-3), 20e3, wave.window)
    solution = wave.run("force", ONE, np.ones(1))
    np.testing.assert_allclose(solution.top_deflection[0], exact[:, 0], rtol=0.003)
    np.testing.assert_allclose(solution.profile(0, radii) / exact[:, :1], exact / exact[:, :1], atol=0.005)
    assert wave.unknowns < 0.25 * square.unknowns
    assert wave.window == pytest.approx(square.window)


def test_the_finite_elements_of_a_disc_of_that_radius(skin):
    """Within 0.4 % of each layer's peak to half the radius; their wall is clamped, that of the modes hinged."""
    border = 45e-3
    problem = fem.Problem(
        layers=tuple(
            fem.Layer(one.name, one.thickness, one.density, fem.LinearElastic(one.youngs_modulus, one.poisson_ratio))
            for one in skin()
        ),
        tool=fem.Tool(5e-3, "uniform_pressure"),
        support=fem.Support("bonded", None),
        kinematics="linear",
        discretisation=fem.Discretisation("default", border),
    )
    radii = np.linspace(0.0, 0.5 * border, 16)
    exact = fem.prepare(problem).run(fem.Load("force", ONE, FORCE)).profile(0, radii)
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=2.0 * border, domain="disc"),
        large_press="linear",
    )
    found = wave.run("force", ONE, FORCE).profile(0, radii)
    np.testing.assert_allclose(found / exact[:, :1], exact / exact[:, :1], atol=4e-3)


def test_a_free_disc_is_kirchhoff_s_plate_on_its_modes():
    """w = sum of 2 J_1(k a) / (k a) J_0(k r) / (D k^4 pi R^2 J_1(k R)^2) over the roots of J_0(k R)."""
    layer, tool, border = WaveLayer("sheet", 1e-3, 1000.0, 1e5, 0.3), 20e-3, 100e-3
    modes = WaveDiscretisation(window=2.0 * border, modes=30, domain="disc", static_correction=False)
    wave = LayeredWave([layer], DiscTool(tool), "free", modes, integrator="quasi_static", large_press="linear")
    bending = 1e5 * 1e-9 / 12.0 / (1.0 - 0.3**2)
    k = jn_zeros(0, 200) / border
    share = 2.0 * j1(k * tool) / (k * tool) / (bending * k**4 * np.pi * (border * j1(k * border)) ** 2)
    radii = np.array([0.0, 30e-3, 70e-3])
    found = wave.run("force", ONE, FORCE).profile(0, radii)[0]
    np.testing.assert_allclose(found, 0.1 * share @ j0(np.outer(k, radii)), rtol=3e-3)


@pytest.mark.parametrize("control", ["force", "depth"])
def test_time_inertia_and_fading_are_those_of_the_square_window(skin, control):
    time = np.linspace(2e-4, 4e-3, 20)
    value = np.sin(np.pi * time / 4e-3) * (0.1 if control == "force" else 1e-4)
    contact = "uniform_pressure" if control == "force" else "rigid_frictionless"
    runs = []
    for domain in ("rectangle", "disc"):
        modes = WaveDiscretisation(window=90e-3, modes=32 if domain == "rectangle" else 16, domain=domain)
        material = {"damping": Damping(0.0, 1e-4), "relaxation": Prony((0.3,), (1e-3,))}
        wave = LayeredWave(skin(), DiscTool(5e-3, contact), "bonded", modes, integrator="exact", **material)
        runs.append(wave.run(control, time, value))
    for name in ("depth", "force", "top_deflection"):
        square, found = (getattr(run, name) for run in runs)
        np.testing.assert_allclose(found, square, atol=5e-3 * np.abs(square).max())


def test_layers_that_fade_each_in_its_own_way_and_a_large_press(skin):
    series = [Prony((0.3,), (0.5,)), None, Prony((0.5,), (2.0,))]
    time, force = np.array([0.5, 1.0, 3.0]), np.array([0.3, 0.6, 0.6])
    square, found = (
        LayeredWave(
            skin(),
            DiscTool(5e-3),
            discretisation=WaveDiscretisation(window=90e-3, domain=domain),
            relaxation=series,
            large_press="corrected",
        ).run("force", time, force)
        for domain in ("rectangle", "disc")
    )
    np.testing.assert_allclose(found.depth, square.depth, rtol=2e-3)


def test_a_tool_under_the_hand_reaches_to_the_nearest_border(skin):
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=60e-3, domain="disc", place=(3e-3, 4e-3)),
        large_press="linear",
    )
    assert layered_body(wave, Grid(40e-3, 40e-3, 1e-3)).reach == pytest.approx(25e-3)


@pytest.mark.parametrize(
    ("options", "word"),
    [
        ({"domain": "ellipse"}, "'ellipse'"),
        ({"place": (19e-3, 18e-3)}, "place = 26.1"),
        ({"window": 9e-3}, "wider than the tool"),
        ({"window": -1.0}, "window"),
        ({"modes": 0}, "modes = 0"),
    ],
)
def test_refuses_what_does_not_fit(skin, options, word):
    with pytest.raises(WaveError, match=word):
        LayeredWave(
            skin(),
            DiscTool(5e-3),
            discretisation=WaveDiscretisation(**({"domain": "disc", "window": 60e-3} | options)),
            large_press="linear",
        )


def test_says_what_it_does_not_cover_and_what_is_outside(skin):
    with pytest.raises(NotCoveredError, match="differs along x and y"):
        LayeredWave(
            skin(),
            DiscTool(5e-3),
            discretisation=WaveDiscretisation(domain="disc"),
            pretension=(1e4, 2e4),
            large_press="linear",
        )
    wave = LayeredWave(
        skin(), DiscTool(5e-3), discretisation=WaveDiscretisation(window=60e-3, domain="disc"), large_press="linear"
    )
    solution = wave.run("force", ONE, FORCE)
    with pytest.raises(WaveError, match=r"35.3553 mm from the middle"):
        wave.surface(np.array([25e-3]), np.array([25e-3]))
    assert np.isnan(solution.profile(0, np.array([30.1e-3]))).all()
    assert np.isnan(marker_motion(solution, np.array([[25e-3, 25e-3]]))).all()


def stack(layers):
    return laminate(layers, [(1.0,)] * len(layers), "bonded")


def test_far_field_is_the_endless_response(skin, oracle, uniform_load):
    distance = np.array([15e-3, 25e-3, 40e-3])
    reference = oracle(skin()).deflection(np.concatenate([[0.0], distance]), uniform_load(5e-3), 20e3, 45e-3)
    found = far_field(stack(skin()), 5e-3, distance)
    np.testing.assert_allclose(found, reference[:, 1:] / reference[:, :1], atol=1e-3)


@pytest.mark.parametrize("fat", [3e-3, 20e-3])
def test_the_window_grows_until_its_border_costs_little(skin, fat):
    whole = stack(skin(fat))
    side = automatic_window(whole, 5e-3)
    assert border_cost(whole, 5e-3, side) <= BORDER_COST * 1.001
    assert side >= 8 * 5e-3


def test_the_window_follows_the_stack_and_a_narrow_one_costs_more(skin):
    sides = [automatic_window(stack(skin(fat)), 2e-3) for fat in (5e-3, 10e-3, 20e-3)]
    assert sides[0] < sides[1] < sides[2]
    assert border_cost(stack(skin()), 5e-3, 24e-3) > 0.05


def test_modes_follow_window_and_tool_within_bounds():
    assert enough_modes(60e-3, 5e-3) == 46
    assert enough_modes(60e-3, 2.5e-3) == 92
    assert enough_modes(1.0, 1e-3) == 512
    assert enough_modes(10e-3, 5e-3) == 24


def test_modes_and_remainder_share_the_whole_load():
    k = np.linspace(1.0, 300.0, 50)
    taper = Taper(200.0)
    np.testing.assert_allclose(taper.modes(k) + taper.remainder(k), 1.0)


def test_long_waves_go_to_the_modes_and_waves_beyond_them_do_not():
    taper = Taper(200.0)
    assert taper.remainder(np.array([10.0]))[0] < 1e-8
    assert taper.modes(np.array([200.0]))[0] < 1e-3


def test_inactive_it_leaves_all_to_the_modes():
    np.testing.assert_array_equal(Taper(1.0, active=False).modes(np.array([0.5, 9.0])), 1.0)
