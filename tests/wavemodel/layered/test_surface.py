import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, WaveDiscretisation, WaveError


@pytest.fixture
def wave(skin):
    return LayeredWave(
        skin(),
        DiscTool(5e-3, "rigid_frictionless"),
        discretisation=WaveDiscretisation(window=50e-3, modes=24),
        large_press="linear",
    )


def test_a_frame_holds_the_profile_and_is_the_same_all_round(wave):
    solution = wave.run("force", np.array([10.0]), np.array([0.4]))
    axis = np.array([-12e-3, -5e-3, 0.0, 5e-3, 12e-3])
    frame = wave.surface(axis, axis).frame(solution.faces.snapshot(0))
    profile = solution.profile(0, axis[2:])
    tolerance = 2e-3 * solution.depth[0]
    np.testing.assert_allclose(frame[:, 2:, 2], profile, atol=tolerance)
    np.testing.assert_allclose(frame, np.swapaxes(frame, 1, 2), atol=1e-12)
    np.testing.assert_allclose(frame, frame[:, ::-1, ::-1], atol=1e-12)


def test_frames_reuse_their_memory(wave):
    solution = wave.run("force", np.array([10.0, 20.0]), np.array([0.4, 0.0]))
    surface = wave.surface(np.linspace(-20e-3, 20e-3, 9), np.linspace(-10e-3, 10e-3, 5))
    first = surface.frame(solution.faces.snapshot(0))
    assert first.max() > 0.0
    assert surface.frame(solution.faces.snapshot(1)) is first
    np.testing.assert_allclose(first, 0.0, atol=1e-15)


def test_a_static_state_is_what_a_slow_run_comes_to(wave):
    surface = wave.surface(np.array([0.0, 3e-3]), np.zeros(1))
    expected = surface.frame(wave.run("force", np.array([10.0]), np.array([0.4])).faces.snapshot(-1)).copy()
    np.testing.assert_allclose(surface.frame(wave.static_state(0.4)), expected)


def test_without_correction_the_modes_alone(skin):
    wave = LayeredWave(
        skin(),
        DiscTool(5e-3),
        discretisation=WaveDiscretisation(window=50e-3, modes=24, static_correction=False),
        large_press="linear",
    )
    solution = wave.run("force", np.array([10.0]), np.array([0.1]))
    x = np.array([0.0, 7e-3])
    frame = wave.surface(x, np.zeros(1)).frame(solution.faces.snapshot(0))
    np.testing.assert_allclose(frame[:, :, 0], solution.profile(0, x), rtol=1e-9)


def test_refuses_vertices_outside_the_window(wave):
    with pytest.raises(WaveError, match="y reaches 26 mm"):
        wave.surface(np.zeros(1), np.array([0.0, 26e-3]))
