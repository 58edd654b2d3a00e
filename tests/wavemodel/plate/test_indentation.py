import numpy as np
import pytest

from wavemodel import DiscTool
from wavemodel.plate.indentation import indentation
from wavemodel.plate.sheet import face_bulge, sheet


def test_is_local_and_squeezes_the_sheet(silicone):
    layers = silicone()
    made = sheet(layers, DiscTool(5e-3), 30e-3, 8)
    dent = indentation(layers, made.section, face_bulge(made.clamp, made.section), 5e-3)
    field = dent.deflection(np.array([0.0, 2e-3, 12e-3, 25e-3]))
    assert field[0, 0] > 0.0 > field[1, 0]
    assert np.abs(field[:, 2:]).max() < 0.02 * field[0, 0]


def test_a_small_tool_dents_a_thick_sheet_like_a_half_space(silicone):
    """The faces approach by w = 2 (1 - nu^2) p a / E (Timoshenko and Goodier, section 139)."""
    layers, radius = silicone(), 0.1e-3
    made = sheet(layers, DiscTool(radius), 30e-3, 8)
    dent = indentation(layers, made.section, face_bulge(made.clamp, made.section), radius)
    half_space = 2 * (1 - 0.49**2) / (np.pi * radius * 4e5)
    top, bottom = dent.deflection(np.zeros(1))[:, 0]
    assert top - bottom == pytest.approx(half_space, rel=0.05)
