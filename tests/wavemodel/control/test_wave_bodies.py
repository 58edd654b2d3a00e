"""Finite strain and the sheet under interactive tools."""

import numpy as np
import pytest

from wavemodel import DiscTool, LayeredWave, PlateSettings, PlateWave, WaveError
from wavemodel.control import InteractiveTissue, layered_body, sheet_body


def test_a_large_press_is_the_corrected_wave(skin, grid):
    wave = LayeredWave(skin(), DiscTool(5e-3), large_press="corrected")
    tool = InteractiveTissue(layered_body(wave, grid), grid)
    tool.touch(0, 40e-3, 30e-3, 3e-3)
    frame = tool.frame(1e-3)
    solution = wave.run("depth", np.ones(1), np.array([3e-3]))
    assert tool.force[0] == pytest.approx(solution.force[0])
    np.testing.assert_allclose(frame[:, 40:61, 30], solution.profile(0, grid.x[:21]), atol=0.002 * 3e-3)
    with pytest.raises(WaveError, match="depth ="):
        tool.touch(0, 40e-3, 30e-3, 1.01 * wave.law.large.deepest)


@pytest.mark.slow
def test_a_sheet_follows_the_plate(silicone, grid):
    wave = PlateWave(silicone(), DiscTool(5e-3, "rigid_bonded"), settings=PlateSettings(reach=6e-3), hole_radius=30e-3)
    tool = InteractiveTissue(sheet_body(wave, grid, 6e-3), grid)
    for depth in (0.05e-3, 2.3e-3, 5.97e-3):
        tool.touch(0, 40e-3, 30e-3, depth)
        frame = tool.frame(1e-3)
        expected = wave.field(depth, grid.x[:30])[1, :-1]
        np.testing.assert_allclose(frame[:, 40:70, 30], expected, atol=0.004 * depth)
        assert tool.force[0] == pytest.approx(wave.force_of_depth(np.array([depth]))[0], rel=0.01)
    with pytest.raises(WaveError, match="deepest"):
        sheet_body(wave, grid, 0.0)
