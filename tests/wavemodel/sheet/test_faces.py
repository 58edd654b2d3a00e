import numpy as np
import pytest

from wavemodel import DiscTool
from wavemodel.integrators.equilibrium_path import EquilibriumState
from wavemodel.sheet.faces import Faces, indentation
from wavemodel.sheet.force_depth import PlateBody, sheet_path
from wavemodel.sheet.sheet import face_bulge, sheet


@pytest.mark.parametrize("contact", ["rigid_bonded", "rigid_frictionless"])
def test_linear_table_is_the_limit_of_small_deflections(pressed_sheet, contact):
    sheet = pressed_sheet(contact)
    faces, radius = Faces(sheet), np.array([0.0, 3e-3, 5.5e-3, 12e-3, 29e-3])
    state = sheet_path(PlateBody(Faces(sheet)), (EquilibriumState(0.0, np.zeros(sheet.unknowns)),), np.array([1e-7]))[
        -1
    ].state
    table = faces.linear(radius) @ np.append(state, 1e-7)
    np.testing.assert_allclose(table, faces.displacement(state, 1e-7, radius), atol=1e-12)


def test_surface_is_continuous_under_the_tool_s_edge(pressed_sheet):
    sheet = pressed_sheet("rigid_bonded")
    state = sheet_path(PlateBody(Faces(sheet)), (EquilibriumState(0.0, np.zeros(sheet.unknowns)),), np.array([1e-5]))[
        -1
    ].state
    inside, outside = np.moveaxis(Faces(sheet).displacement(state, 1e-5, np.array([5e-3 - 1e-9, 5e-3 + 1e-9])), 2, 0)
    np.testing.assert_allclose(inside, outside, atol=5e-8)


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
