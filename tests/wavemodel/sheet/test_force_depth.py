import numpy as np
import pytest

from wavemodel.integrators.equilibrium_path import EquilibriumState
from wavemodel.sheet.faces import Faces
from wavemodel.sheet.force_depth import EquilibriumCurve, PlateBody, sheet_path


def test_follows_to_the_loads_and_balances_forces(pressed_sheet):
    sheet = pressed_sheet("rigid_bonded")
    rest = (EquilibriumState(0.0, np.zeros(sheet.unknowns)),)
    path = sheet_path(PlateBody(Faces(sheet)), rest, np.array([1e-3, 6e-3]))
    assert [point.load for point in path] == [0.0, 1e-3, 6e-3]
    for point in path:
        assert np.abs(sheet.residual(point.state, point.load, 0.0)[0]).max() < 1e-6
        clamp, tool = point.state[-4], point.state[-1]
        np.testing.assert_allclose(clamp, -tool, atol=1e-9)


def test_stops_where_there_is_no_equilibrium(pressed_sheet):
    """A pressure of a thousand newtons tears the sheet out of any reasonable shape: what was found is kept."""
    sheet = pressed_sheet("uniform_pressure")
    rest = (EquilibriumState(0.0, np.zeros(sheet.unknowns)),)
    path = sheet_path(PlateBody(Faces(sheet)), rest, np.array([0.5, 1e7]))
    assert [point.load for point in path] == [0.0, 0.5]


DEPTH = np.linspace(0.0, 2.0, 30)
CURVE = EquilibriumCurve(DEPTH, DEPTH + DEPTH**3, np.outer(DEPTH, [1.0, 2.0]), DEPTH[:, None] ** 2)


def test_interpolates_and_inverts():
    depth = np.linspace(0.0, 2.0, 101)
    np.testing.assert_allclose(CURVE.force_at(depth), depth + depth**3, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(CURVE.depth_at(CURVE.force_at(depth)), depth, rtol=1e-12, atol=1e-13)
    np.testing.assert_allclose(CURVE.state_at(0.7), [0.7, 1.4])
    assert CURVE.reach == (2.0, 10.0)


def test_a_pull_mirrors_a_press():
    assert CURVE.force_at(np.array([-1.0])) == pytest.approx([-2.0], rel=1e-6)
    assert CURVE.axis_at(np.array([-1.0]))[0] == pytest.approx(-CURVE.axis_at(np.array([1.0]))[0])
