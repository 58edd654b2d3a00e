import numpy as np
import pytest

from wavemodel import DiscTool, WaveLayer
from wavemodel.sheet.carrier import carrier
from wavemodel.sheet.sheet import sheet


def test_first_frequency_of_a_thin_clamped_plate():
    """10.2158 sqrt(D / m) / R^2 (Leissa, Vibration of plates, table 2.1)."""
    layer = WaveLayer("sheet", 1e-4, 1000.0, 1e5, 0.3)
    wave = carrier(sheet([layer], DiscTool(5e-3), 30e-3, 12))
    bending = 1e5 * 1e-12 / 12 / 0.91
    assert wave.first_frequency == pytest.approx(10.2158 / (2 * np.pi * 9e-4) * np.sqrt(bending / 0.1), rel=0.012)


def test_a_tool_s_mass_slows_it(pressed_sheet):
    bare, heavy = (carrier(pressed_sheet("rigid_bonded"), mass).first_frequency for mass in (0.0, 0.1))
    assert heavy < 0.3 * bare


def test_rest_under_force_and_depth_agree_and_are_stationary(pressed_sheet):
    wave = carrier(pressed_sheet("rigid_bonded"))
    x, force, pull = wave.at_rest(2.0)
    assert pull == pytest.approx(wave.pull(x), rel=1e-9)
    assert wave.at_rest(float(wave.pressed @ x), True)[1] == pytest.approx(2.0, rel=1e-9)
    residual = x + pull * (wave.tension @ x) + pull * wave.push - force * wave.pressed
    assert np.abs(residual).max() < 1e-9 * np.abs(x).max()


def test_force_is_the_derivative_of_the_energy(pressed_sheet):
    wave = carrier(pressed_sheet("rigid_bonded"))
    still = np.zeros(wave.inertia.size)
    low, here, high = (wave.at_rest(depth, True) for depth in (3.999e-3, 4e-3, 4.001e-3))
    assert (wave.energy(high[0], still) - wave.energy(low[0], still)) / 2e-6 == pytest.approx(here[1], rel=1e-6)
