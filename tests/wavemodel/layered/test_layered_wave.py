"""A tool anywhere in its window."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import j1

from wavemodel import DiscTool, LayeredWave, NotCoveredError, WaveDiscretisation, WaveError, WaveLayer, marker_motion

HAYES = {0.2: 1.2523, 0.4: 1.5993, 0.6: 2.0328, 0.8: 2.5354, 1.0: 3.0914, 1.5: 4.6576, 2.0: 6.4206}


def press(wave, force=1.0):
    return wave.run("force", np.array([10.0]), np.array([force]))


@pytest.mark.parametrize("fat", [3e-3, 20e-3])
@pytest.mark.parametrize("nu", [0.45, 0.499])
@pytest.mark.parametrize("radius", [1e-3, 5e-3])
def test_predicts_layered_elasticity_without_calibration(skin, oracle, uniform_load, fat, nu, radius):
    """All automatic: 0.3 % of each layer's maximum, 1 % of peak along the profile to four radii and the border."""
    wave = LayeredWave(skin(fat, nu), DiscTool(radius), large_press="linear")
    radii = np.concatenate([np.linspace(0.0, 4.0 * radius, 17), [0.35 * wave.window, 0.5 * wave.window]])
    exact = oracle(skin(fat, nu)).deflection(radii, uniform_load(radius), 100.0 / radius, wave.window)
    solution = press(wave)
    np.testing.assert_allclose(solution.top_deflection[0], exact[:, 0], rtol=0.003)
    np.testing.assert_allclose(solution.profile(0, radii) / exact[:, :1], exact / exact[:, :1], atol=0.005)


@settings(max_examples=12, deadline=None, derandomize=True)
@given(
    st.lists(
        st.tuples(st.floats(-4.0, -2.0), st.floats(3.5, 6.0), st.sampled_from([0.3, 0.45, 0.499])),
        min_size=1,
        max_size=4,
    ),
    st.floats(-3.0, -2.0),
)
def test_any_stack_is_predicted(oracle, uniform_load, layers, size):
    """Thickness 0.1 to 10 mm, E 3 kPa to 1 MPa in any order, tools of 1 to 10 mm."""
    stack = [WaveLayer(f"{i}", 10**h, 1000.0, 10**e, nu) for i, (h, e, nu) in enumerate(layers)]
    radius = 10**size
    wave = LayeredWave(stack, DiscTool(radius), large_press="linear")
    radii = np.array([0.0, 0.5, 1.5, 4.0]) * radius
    exact = oracle(stack).deflection(radii, uniform_load(radius), 1000.0 / radius, wave.window)
    found = press(wave).profile(0, radii)
    largest = np.abs(exact).max(axis=1, keepdims=True)
    np.testing.assert_allclose(found[:, 0] / largest[:, 0], exact[:, 0] / largest[:, 0], atol=0.003)
    np.testing.assert_allclose(found / largest, exact / largest, atol=0.005)


@pytest.mark.parametrize(("ratio", "kappa"), HAYES.items())
def test_rigid_punch_on_a_bonded_layer_of_hayes(ratio, kappa):
    layer = WaveLayer("cartilage", 1e-3, 1000.0, 1e6, 0.45)
    wave = LayeredWave([layer], DiscTool(ratio * 1e-3, "rigid_frictionless"), large_press="linear")
    solution = wave.run("depth", np.array([1.0]), np.array([1e-5]))
    found = (1 - 0.45**2) * solution.force[0] / (2 * ratio * 1e-3 * 1e6 * 1e-5)
    assert found == pytest.approx(kappa, rel=0.0015)


@pytest.mark.parametrize("contact", ["rigid_frictionless", "rigid_bonded"])
@pytest.mark.parametrize("radius", [1e-3, 5e-3])
def test_the_face_under_a_rigid_tool_is_flat_in_exact_elasticity(skin, oracle, contact, radius):
    """The contact traction found is put on the oracle: the surface under it moves by the tool's depth."""
    wave = LayeredWave(skin(), DiscTool(radius, contact), large_press="linear")
    radii = np.array([0.0, 0.3, 0.6, 0.9, 1.05, 1.3, 2.0, 4.0]) * radius
    field = oracle(skin()).deflection(radii, wave.press.field.traction.transform, 1000.0 / radius, 60e-3)[0]
    found, depth = press(wave).profile(0, radii)[0], wave.press.compliance
    np.testing.assert_allclose(field[:4], depth, rtol=0.003)
    np.testing.assert_allclose(found[:4], depth, rtol=0.002)
    np.testing.assert_allclose(found[4:] / depth, field[4:] / depth, atol=0.003)


def test_no_slip_is_stiffer_than_no_friction_and_both_than_pressure(skin):
    depths = [
        LayeredWave(skin(), DiscTool(5e-3, contact), large_press="linear").press.compliance
        for contact in ("rigid_bonded", "rigid_frictionless", "uniform_pressure")
    ]
    assert depths[0] < depths[1] < depths[2]


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_frictionless"])
def test_depth_control_is_the_inverse_of_force_control(skin, contact):
    wave = LayeredWave(skin(), DiscTool(5e-3, contact), large_press="linear")
    time = np.arange(1, 71) * 0.1
    depth = 7e-3 * np.sin(np.pi * time / 7.0) + 1e-4 * np.random.default_rng(2).normal(size=70)
    by_depth = wave.run("depth", time, depth)
    np.testing.assert_allclose(by_depth.depth, depth, rtol=1e-12)
    np.testing.assert_allclose(wave.run("force", time, by_depth.force).depth, depth, rtol=1e-9)
    assert by_depth.integrator == "quasi_static"


def test_solution_names_layers_and_has_the_profile_s_first_value(skin):
    solution = press(LayeredWave(skin(), DiscTool(5e-3), large_press="linear"), 2e-3)
    assert solution.layer_names == ("epidermis", "dermis", "fat")
    np.testing.assert_allclose(solution.profile(0, np.zeros(1))[:, 0], solution.top_deflection[0], rtol=1e-9)
    assert solution.depth[0] == solution.top_deflection[0, 0]


def test_profile_is_empty_outside_the_window_and_refuses_negative_radii(skin):
    wave = LayeredWave(
        skin(), DiscTool(5e-3), discretisation=WaveDiscretisation(window=30e-3, modes=24), large_press="linear"
    )
    profile = press(wave).profile(-1, np.array([14.9e-3, 15.1e-3]))
    assert np.isfinite(profile[:, 0]).all()
    assert np.isnan(profile[:, 1]).all()
    with pytest.raises(WaveError, match="negative"):
        press(wave).profile(0, np.array([-1e-3]))


@pytest.mark.parametrize(("modes", "window"), [(512, 100e-3), (3, 24e-3), (1, 24e-3)])
def test_windows_and_modes_of_the_user_are_kept(skin, modes, window):
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=window, modes=modes, sublayers=(1, 1, 2)),
        large_press="linear",
    )
    assert (wave.modes, wave.window, wave.sublayers) == (modes, window, (1, 1, 2))
    assert wave.unknowns % 16 == 0
    assert press(wave).depth[0] > 0.0


def test_modes_alone_approach_the_corrected_answer(skin):
    """Without the static correction the truncation shows, and fades with the modes."""
    reference = press(
        LayeredWave(
            skin(), DiscTool(5e-3), discretisation=WaveDiscretisation(window=60e-3, modes=48), large_press="linear"
        )
    ).depth[0]
    errors = [
        abs(
            press(
                LayeredWave(
                    skin(),
                    DiscTool(5e-3),
                    discretisation=WaveDiscretisation(window=60e-3, modes=n, static_correction=False),
                    large_press="linear",
                )
            ).depth[0]
            / reference
            - 1
        )
        for n in (8, 24, 128)
    ]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 1e-3


def test_vector_wave_on_the_paper_s_box_has_the_accuracy_of_the_notes(skin, oracle, uniform_load):
    """PHYSICS: 1/1/2 sub-layers on 5 mm of fat and a 24 mm box are right at the peak to 0.5 %, no calibration."""
    wave = LayeredWave(
        skin(5e-3),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=24e-3, modes=48, sublayers=(1, 1, 2)),
        large_press="linear",
    )
    exact = oracle(skin(5e-3)).deflection(np.zeros(1), uniform_load(5e-3), 30e3, 5e-3)[:, 0]
    np.testing.assert_allclose(press(wave).top_deflection[0], exact, rtol=0.005)


def test_free_lower_face_bends_like_a_plate_under_a_wide_load():
    """Kirchhoff's simply supported plate, mode by mode: w = q / (D k^4)."""
    layer = WaveLayer("sheet", 1e-3, 1000.0, 1e5, 0.3)
    wave = LayeredWave(
        [layer],
        DiscTool(20e-3),
        "free",
        WaveDiscretisation(window=200e-3, modes=40, static_correction=False),
        large_press="linear",
    )
    domain = wave.press.field.domain
    bending = 1e5 * 1e-9 / 12 / (1 - 0.3**2)
    k = domain.wavenumber
    x = k * 20e-3
    plate = 2 * j1(x) / x / (bending * k**4)
    assert wave.press.unit[0] @ domain.axis_weight == pytest.approx(plate @ domain.axis_weight, rel=2e-3)


def test_auto_follows_inertia_only_in_fast_presses(skin):
    wave = LayeredWave(
        skin(), DiscTool(5e-3), discretisation=WaveDiscretisation(window=50e-3, modes=16), large_press="linear"
    )
    slow = wave.run("force", np.array([1.0, 2.0]), np.array([1.0, 0.0]))
    fast = wave.run("force", np.array([1e-3, 2e-3]), np.array([1.0, 0.0]))
    assert (slow.integrator, fast.integrator) == ("quasi_static", "exact")
    assert fast.top_deflection[0, 0] < 0.5 * slow.top_deflection[0, 0]


@pytest.mark.parametrize("support", ["hole", "half_space"])
def test_supports_that_are_not_covered(skin, support):
    with pytest.raises(NotCoveredError, match=support) as caught:
        LayeredWave(skin(), DiscTool(5e-3), support, large_press="linear")
    assert support in caught.value.reason


def test_friction_is_not_covered(skin):
    with pytest.raises(NotCoveredError, match="friction"):
        LayeredWave(skin(), DiscTool(5e-3, "rigid_frictional"), large_press="linear")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"support": "floating"}, "'floating'"),
        ({"integrator": "euler"}, "'euler'"),
        ({"discretisation": WaveDiscretisation(window=9e-3)}, "wider than the tool"),
        ({"discretisation": WaveDiscretisation(sublayers=(1, 2))}, "each of the 3 layers"),
        ({"support": "free"}, "window"),
    ],
)
def test_refuses_unusable_options(skin, options, message):
    with pytest.raises(WaveError, match=message):
        LayeredWave(skin(), DiscTool(5e-3), **options)


@pytest.mark.parametrize("options", [{"modes": 4}, {"static_correction": False}])
def test_a_rigid_tool_needs_the_static_correction(skin, options):
    with pytest.raises(WaveError, match="static_correction"):
        LayeredWave(
            skin(), DiscTool(5e-3, "rigid_bonded"), discretisation=WaveDiscretisation(**options), large_press="linear"
        )


def test_refuses_no_layers():
    with pytest.raises(WaveError, match="at least one"):
        LayeredWave([], DiscTool(5e-3), large_press="linear")


PLACE = (7e-3, -4e-3)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_an_off_centre_press_is_the_centred_one_shifted(skin, contact):
    """Far from the border: within what it costs, which is more for the motion in plane."""
    time, force, x = np.ones(1), np.array([0.1]), np.array([-9e-3, 0.0, 5e-3, 12e-3])
    answers, moved = [], []
    for place in ((0.0, 0.0), PLACE):
        wave = LayeredWave(
            skin(),
            DiscTool(5e-3, contact),
            discretisation=WaveDiscretisation(window=90e-3, modes=36, place=place),
            large_press="linear",
        )
        solution = wave.run("force", time, force)
        frame = wave.surface(x, x - 2e-3).frame(solution.faces.snapshot(0))
        answers.append(
            np.concatenate([frame.ravel(), solution.top_deflection.ravel(), solution.profile(0, x[1:]).ravel()])
        )
        moved.append(marker_motion(solution, np.stack([x, x], axis=1), face=1))
    peak = answers[0].max()
    np.testing.assert_allclose(answers[1] / peak, answers[0] / peak, atol=5e-4)
    np.testing.assert_allclose(moved[1] / peak, moved[0] / peak, atol=3e-3)


def test_a_place_on_an_axis_is_the_mirror_image_of_its_opposite(skin):
    x = np.linspace(-10e-3, 10e-3, 5)
    frames = []
    for side in (1.0, -1.0):
        wave = LayeredWave(
            skin(),
            DiscTool(5e-3),
            discretisation=WaveDiscretisation(window=50e-3, modes=24, place=(side * 9e-3, 0.0)),
            large_press="linear",
        )
        frames.append(wave.surface(x, x).frame(wave.static_state(0.1)).copy())
    np.testing.assert_allclose(frames[1], frames[0][:, ::-1], atol=1e-12)


@pytest.mark.parametrize(("place", "word"), [((21e-3, 0.0), "21 mm"), ((np.nan, 0.0), "finite"), ((0.0,), "two")])
def test_a_place_outside_the_window_is_refused(skin, place, word):
    with pytest.raises(WaveError, match=word):
        LayeredWave(
            skin(),
            DiscTool(5e-3),
            discretisation=WaveDiscretisation(window=50e-3, modes=24, place=place),
            large_press="linear",
        )


def test_vertices_outside_the_window_round_a_place_are_refused(skin):
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=50e-3, modes=24, place=(10e-3, 0.0)),
        large_press="linear",
    )
    with pytest.raises(WaveError, match="x reaches 16 mm"):
        wave.surface(np.array([16e-3]), np.zeros(1))
    assert np.isnan(wave.run("force", np.ones(1), np.ones(1)).profile(0, np.array([16e-3]))).all()


def test_a_deep_press_is_followed_in_finite_strain_without_asking(skin):
    deep, time = 3e-3, np.array([0.5, 1.0])
    answers = {
        word: LayeredWave(skin(), DiscTool(5e-3, "rigid_bonded"), **word_of(word)).run("depth", time, time * deep)
        for word in ("default", "corrected", "linear")
    }
    assert answers["default"].force[-1] == answers["corrected"].force[-1]
    assert answers["default"].force[-1] > 1.1 * answers["linear"].force[-1]
    assert not answers["default"].warnings
    assert "small strain" in answers["linear"].warnings[0]


def word_of(word):
    return {} if word == "default" else {"large_press": word}


FREE = {"support": "free", "discretisation": WaveDiscretisation(window=60e-3)}


@pytest.mark.parametrize("options", [{"integrator": "exact"}, {"pretension": 1e3}, FREE])
def test_where_finite_strain_is_not_covered_the_wave_is_that_of_small_strain_and_says_so(skin, options):
    wave = LayeredWave(skin(), DiscTool(5e-3, "rigid_bonded"), **options)
    assert wave.law.large is None
    solution = wave.run("depth", np.array([50.0, 100.0]), np.array([1e-3, 2e-3]))
    assert any("small strain" in warning for warning in solution.warnings)
