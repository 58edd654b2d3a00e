"""The one-file example of a user's model against the closed form that it is built from."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmark.models import UncoveredError, read_user_file
from benchmark.models.user_file import UserCode
from benchmark.models.user_model import UserLayer, UserSupport, UserTool

FILE = read_user_file(Path(__file__).parents[2] / "examples" / "own_model.py")
TOOL, BONDED = UserTool(5e-3, "uniform_pressure", None), UserSupport("bonded", None)
THICK = UserLayer("ground", 10.0, 1000.0, 20e3, 0.3, ())


def deform(layers, force=(1.0, 2.0), support=BONDED):
    return UserCode(FILE).call("deform", layers, TOOL, support, np.array([1.0, 2.0]), np.array(force))


def test_a_thick_layer_sinks_like_a_half_space() -> None:
    pressure = 2.0 / (np.pi * TOOL.radius**2)
    boussinesq = 2 * (1 - 0.3**2) * pressure * TOOL.radius / THICK.youngs_modulus
    assert deform((THICK,))[1, 0] == pytest.approx(boussinesq, rel=1e-3)


def test_a_layer_cut_in_two_sinks_as_before() -> None:
    halves = tuple(replace(THICK, name=name, thickness=5.0) for name in "ab")
    np.testing.assert_allclose(deform(halves)[:, 0], deform((THICK,))[:, 0], rtol=1e-12)
    assert (deform(halves)[:, 1] < deform(halves)[:, 0]).all()


def test_press_is_the_inverse_of_deform() -> None:
    depth = deform((THICK,))[:, 0]
    force = UserCode(FILE).call("press", (THICK,), TOOL, BONDED, np.array([1.0, 2.0]), depth)
    np.testing.assert_allclose(force, [1.0, 2.0], rtol=1e-12)


def test_it_declines_a_hole() -> None:
    with pytest.raises(UncoveredError, match="hole"):
        deform((THICK,), support=UserSupport("hole", 0.03))
