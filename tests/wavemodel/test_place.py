"""A tool anywhere in its window."""

import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, WaveError, marker_motion

PLACE = (7e-3, -4e-3)


@pytest.mark.parametrize("contact", ["uniform_pressure", "rigid_bonded"])
def test_an_off_centre_press_is_the_centred_one_shifted(skin, contact):
    """Far from the border: within what it costs, which is more for the motion in plane."""
    time, force, x = np.ones(1), np.array([0.1]), np.array([-9e-3, 0.0, 5e-3, 12e-3])
    answers, moved = [], []
    for place in ((0.0, 0.0), PLACE):
        wave = LayeredWave(skin(), DiscTool(5e-3, contact), window=90e-3, modes=36, place=place)
        solution = wave.run("force", time, force)
        frame = wave.surface(x, x - 2e-3).frame(solution.snapshot(0))
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
        wave = LayeredWave(skin(), DiscTool(5e-3), window=50e-3, modes=24, place=(side * 9e-3, 0.0))
        frames.append(wave.surface(x, x).frame(wave.static_state(0.1)).copy())
    np.testing.assert_allclose(frames[1], frames[0][:, ::-1], atol=1e-12)


@pytest.mark.parametrize(("place", "word"), [((21e-3, 0.0), "21 mm"), ((np.nan, 0.0), "finite"), ((0.0,), "two")])
def test_a_place_outside_the_window_is_refused(skin, place, word):
    with pytest.raises(WaveError, match=word):
        LayeredWave(skin(), DiscTool(5e-3), window=50e-3, modes=24, place=place)


def test_vertices_outside_the_window_round_a_place_are_refused(skin):
    wave = LayeredWave(skin(), DiscTool(5e-3), window=50e-3, modes=24, place=(10e-3, 0.0))
    with pytest.raises(WaveError, match="x reaches 16 mm"):
        wave.surface(np.array([16e-3]), np.zeros(1))
    assert np.isnan(wave.run("force", np.ones(1), np.ones(1)).profile(0, np.array([16e-3]))).all()
