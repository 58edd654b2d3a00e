import numpy as np
import pytest

from wavemodel.plate.faces import Faces
from wavemodel.plate.path import Equilibrium, follow


@pytest.mark.parametrize("contact", ["rigid_bonded", "rigid_frictionless"])
def test_linear_table_is_the_limit_of_small_deflections(pressed_sheet, contact):
    sheet = pressed_sheet(contact)
    faces, radius = Faces(sheet), np.array([0.0, 3e-3, 5.5e-3, 12e-3, 29e-3])
    state = follow(sheet, (Equilibrium(0.0, np.zeros(sheet.unknowns)),), np.array([1e-7]))[-1].state
    table = faces.linear(radius) @ np.append(state, 1e-7)
    np.testing.assert_allclose(table, faces.displacement(state, 1e-7, radius), atol=1e-12)


def test_surface_is_continuous_under_the_tool_s_edge(pressed_sheet):
    sheet = pressed_sheet("rigid_bonded")
    state = follow(sheet, (Equilibrium(0.0, np.zeros(sheet.unknowns)),), np.array([1e-5]))[-1].state
    inside, outside = np.moveaxis(Faces(sheet).displacement(state, 1e-5, np.array([5e-3 - 1e-9, 5e-3 + 1e-9])), 2, 0)
    np.testing.assert_allclose(inside, outside, atol=5e-8)
