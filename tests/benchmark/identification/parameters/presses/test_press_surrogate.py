"""One press of a set-up, with the values that a fit tries."""

from types import SimpleNamespace

import numpy as np
import pytest

from benchmark.errors import SolverError
from benchmark.identification.parameters.presses import press_surrogate
from benchmark.identification.parameters.presses.press_surrogate import Press, StopsError, surrogate


def pressed(monkeypatch, force, reach=1.0):
    """The surrogate of a press to 1 mm whose model has forces (n,), N, at even depths up to a share of that."""
    depth = reach * np.linspace(0.0, 1e-3, len(force))
    ramp = SimpleNamespace(depth=depth, force=np.array(force), by={}, failure=None)
    ramp.mesh_error = ramp.at_edge = ramp.face = None
    monkeypatch.setattr(press_surrogate, "differentiated_ramp", lambda *_, **__: ramp)
    monkeypatch.setattr(press_surrogate, "with_values", lambda setup, values, law: setup)
    press = Press(0, None, (SimpleNamespace(name="gel"), None, None), 1e-3)
    return surrogate(press, (), np.zeros(0), None, (), "fem")


def test_a_force_that_rises_is_read_off_smoothly(monkeypatch):
    found = pressed(monkeypatch, [0.0, 0.1, 0.3, 0.7])
    assert found.force_at(np.zeros(0))[-1] == pytest.approx(0.7)


@pytest.mark.parametrize("force", [[0.0, 1e-3, 1e-3, 2e-3, 1940.0], [0.0, 0.1, np.nan, 0.3, 0.4]])
def test_a_force_that_no_curve_goes_through_is_no_press(monkeypatch, force):
    """A law near its locking swung its spline below nought, whose logarithm ended a fit with an index out of bounds."""
    with pytest.raises(SolverError, match=r"the force of 'gel' does not go smoothly with the depth"):
        pressed(monkeypatch, force)


def test_a_press_that_stops_tells_how_far_it_came(monkeypatch):
    with pytest.raises(StopsError, match=r"0.8 of 1 mm"):
        pressed(monkeypatch, [0.0, 0.1, 0.3, 0.7], reach=0.8)
