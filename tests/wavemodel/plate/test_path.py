import numpy as np

from wavemodel.plate.path import Equilibrium, follow


def test_follows_to_the_loads_and_balances_forces(pressed_sheet):
    sheet = pressed_sheet("rigid_bonded")
    rest = (Equilibrium(0.0, np.zeros(sheet.unknowns)),)
    path = follow(sheet, rest, np.array([1e-3, 6e-3]))
    assert [point.load for point in path] == [0.0, 1e-3, 6e-3]
    for point in path:
        assert np.abs(sheet.residual(point.state, point.load, 0.0)[0]).max() < 1e-6
        clamp, tool = point.state[-4], point.state[-1]
        np.testing.assert_allclose(clamp, -tool, atol=1e-9)


def test_stops_where_there_is_no_equilibrium(pressed_sheet):
    """A pressure of a thousand newtons tears the sheet out of any reasonable shape: what was found is kept."""
    sheet = pressed_sheet("uniform_pressure")
    rest = (Equilibrium(0.0, np.zeros(sheet.unknowns)),)
    path = follow(sheet, rest, np.array([0.5, 1e7]))
    assert [point.load for point in path] == [0.0, 0.5]
