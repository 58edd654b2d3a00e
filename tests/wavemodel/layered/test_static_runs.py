"""The layered wave with a large press and with options of the body."""

import numpy as np
import pytest

from wavemodel import Damping, DiscTool, LayeredWave, NotCoveredError, Prony, WaveError
from wavemodel.layered.static_runs import ElasticLaw
from wavemodel.physics.contact import Adhesion, PermanentSet
from wavemodel.physics.elastic import StressSoftening
from wavemodel.physics.quasi_static_press import Physics, QuasiStaticPress
from wavemodel.physics.time_dependent import ViscousDamping


def test_without_a_correction_it_is_linear_both_ways():
    law = ElasticLaw(2e-3)
    np.testing.assert_allclose(law(np.array([-1e-3, 0.0, 4e-3])), [-0.5, 0.0, 2.0])
    np.testing.assert_allclose(law.depth_at(np.array([2.0])), [4e-3])


TIME = np.arange(1, 31) * 0.1
CYCLE = 2e-3 * np.sin(np.pi * TIME / 1.5) ** 2


@pytest.fixture(scope="module")
def corrected(skin):
    return LayeredWave(skin(), DiscTool(5e-3), large_press="corrected")


def test_frames_agree_with_the_profile_and_the_profile_with_the_axis(corrected):
    solution = corrected.run("force", np.array([1.0, 2.0]), np.array([0.6, 1.2]))
    x = np.linspace(0.0, 0.018, 10)
    frame = corrected.surface(x, np.zeros(1)).frame(solution.faces.snapshot(1))[:, :, 0]
    np.testing.assert_allclose(frame, solution.profile(1, x), atol=1e-3 * solution.depth[1])
    np.testing.assert_allclose(solution.profile(1, np.zeros(1))[:, 0], solution.top_deflection[1], rtol=1e-9)
    assert solution.depth[1] == pytest.approx(solution.top_deflection[1, 0], rel=1e-9)


def test_a_large_press_relaxes_by_the_series_and_keeps_its_shape(skin, corrected):
    """Quasi-linear: under a held depth the force is G(t) times the elastic one, the field that of the depth."""
    series = Prony((0.4,), (0.8,))
    wave = LayeredWave(skin(), DiscTool(5e-3), large_press="corrected", relaxation=series)
    time = np.array([1e-6, 0.5, 2.0, 50.0])
    held = wave.run("depth", time, np.full(4, 3e-3))
    elastic = corrected.law(np.array(3e-3))
    np.testing.assert_allclose(held.force, elastic * series.modulus(time), rtol=1e-5)
    np.testing.assert_allclose(held.top_deflection, np.tile(held.top_deflection[0], (4, 1)), rtol=1e-12)


def test_layers_that_relax_each_in_its_own_way_keep_the_depth(skin):
    series = [None, Prony((0.2,), (0.3,)), Prony((0.4,), (1.0,))]
    wave = LayeredWave(skin(), DiscTool(5e-3), large_press="corrected", relaxation=series)
    held = wave.run("depth", TIME, CYCLE)
    np.testing.assert_allclose(held.depth, CYCLE, rtol=1e-9, atol=1e-15)
    pressed = held.force > 0.0
    assert pressed.sum() > 20
    np.testing.assert_allclose(held.top_deflection[pressed, 0], CYCLE[pressed], rtol=1e-9, atol=1e-15)
    assert (held.top_deflection[~pressed, 0] > CYCLE[~pressed]).all()


def test_options_have_the_force_of_the_quasi_static_press(skin):
    physics = Physics(softening=StressSoftening(0.3), permanent_set=PermanentSet(0.05))
    wave = LayeredWave(skin(), DiscTool(5e-3), physics=physics, large_press="linear")
    solution = wave.run("depth", TIME, CYCLE)
    np.testing.assert_array_equal(solution.force, QuasiStaticPress(wave.law, physics).force(TIME, CYCLE))
    assert solution.integrator == "quasi_static"
    where = np.maximum(CYCLE, 0.05 * np.maximum.accumulate(CYCLE))
    np.testing.assert_allclose(solution.top_deflection[:, 0], where, rtol=1e-3)


def test_force_and_depth_control_agree_with_options_and_a_large_press(skin):
    physics = Physics(softening=StressSoftening(0.3), adhesion=Adhesion(0.1))
    wave = LayeredWave(
        skin(), DiscTool(5e-3), physics=physics, large_press="corrected", relaxation=Prony((0.3,), (0.5,))
    )
    time, force = TIME[:12], np.minimum(TIME[:12], 1.3 - TIME[:12])
    driven = wave.run("force", time, force)
    np.testing.assert_allclose(wave.run("depth", time, driven.depth).force, force, atol=1e-9)


def test_options_that_are_off_change_nothing(skin):
    plain, other = (LayeredWave(skin(), DiscTool(5e-3), physics=p, large_press="linear") for p in (None, Physics()))
    for control, value in (("depth", CYCLE), ("force", 500.0 * CYCLE)):
        one, two = plain.run(control, TIME, value), other.run(control, TIME, value)
        np.testing.assert_allclose(two.force, one.force, rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(two.top_deflection, one.top_deflection, rtol=1e-9, atol=1e-15)


def test_damping_and_relaxation_of_the_wave_take_part(skin):
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        physics=Physics(),
        relaxation=Prony((0.3,), (0.5,)),
        damping=Damping(0.0, 0.1),
        large_press="linear",
    )
    linear = LayeredWave(
        skin(), DiscTool(5e-3), relaxation=Prony((0.3,), (0.5,)), damping=Damping(0.0, 0.1), large_press="linear"
    )
    up = np.linspace(1e-4, 2e-3, 30)
    np.testing.assert_allclose(wave.run("depth", TIME, up).force, linear.run("depth", TIME, up).force, rtol=1e-9)


def test_too_deep_is_one_error_and_the_wave_goes_on(corrected):
    before = corrected.run("depth", TIME, CYCLE).force
    with pytest.raises(WaveError, match="beyond the range of this tool and stack"):
        corrected.run("depth", TIME, 10.0 * CYCLE)
    with pytest.raises(WaveError, match="beyond the range of this tool and stack"):
        corrected.run("force", TIME, np.full(30, 1e3))
    np.testing.assert_array_equal(corrected.run("depth", TIME, CYCLE).force, before)


@pytest.mark.parametrize(
    ("tool", "inside", "outside"),
    [
        (DiscTool(5e-3), 0.39 * 11.6e-3, 0.41 * 11.6e-3),
        (DiscTool(2e-3), 3.4e-3, 3.6e-3),  # 1.75 radii of a small tool come before 0.4 of the stack
        (DiscTool(5e-3, "rigid_bonded"), 0.29 * 11.6e-3, 0.31 * 11.6e-3),
    ],
)
def test_says_where_the_correction_is_not_verified(skin, tool, inside, outside):
    wave = LayeredWave(skin(), tool, large_press="corrected")
    assert wave.run("depth", np.array([1.0]), np.array([inside])).warnings == ()
    (said,) = wave.run("depth", np.array([1.0]), np.array([outside])).warnings
    assert "verified" in said


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"integrator": "exact"}, NotCoveredError, "inertia"),
        ({"relaxation": [None, None, Prony((0.3,), (1.0,))]}, NotCoveredError, "one relaxation for all"),
        ({"relaxation": Prony((0.3,), (1.0,))}, WaveError, "relaxation is given twice"),
        ({"damping": Damping(0.0, 0.1)}, WaveError, "damping is given twice"),
    ],
)
def test_refuses(skin, options, error, message):
    physics = Physics(relaxation=Prony((0.1,), (2.0,)), damping=ViscousDamping(0.1))
    with pytest.raises(error, match=message):
        LayeredWave(skin(), DiscTool(5e-3), physics=physics, **options)
