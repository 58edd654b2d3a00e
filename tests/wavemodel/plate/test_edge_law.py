import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.plate.edge import tool_edge
from wavemodel.plate.edge_law import TOOL_SOFTENING, edge_law
from wavemodel.plate.section import section

LAYERS = [WaveLayer("sheet", 1.0, 1.0, 1.0, 0.49)]
ACROSS = section(LAYERS)
LAW = edge_law(tool_edge(LAYERS, ACROSS, 1.25, "rigid_bonded").compliance, -0.5, 1.25, ACROSS, TOOL_SOFTENING)


def test_place_and_give_are_consistent_with_their_derivatives():
    end, load, step = np.array([0.1, 0.4, -0.2]), np.array([0.3, 0.5, -0.4]), 1e-6
    place, slope, curve = LAW.place(end, load)
    energy, moved, given = LAW.give(load)
    for i in range(3):
        change = step * np.eye(3)[i]
        np.testing.assert_allclose((LAW.place(end + change, load)[0] - place) / step, slope[:, i], atol=1e-5)
        assert (LAW.give(load + change)[0] - energy) / step == pytest.approx(moved[i], rel=1e-4)
        np.testing.assert_allclose((LAW.give(load + change)[1] - moved) / step, given[:, i], rtol=1e-3, atol=1e-4)
    turned = LAW.place(end + np.array([0.0, step, 0.0]), load)[1]
    assert load @ (turned - slope)[:, 1] / step == pytest.approx(curve, rel=1e-4)


def test_section_turns_about_the_corner():
    """The corner stays where it is when the section turns round it."""
    phi = 0.7
    end = np.array([0.5 * np.sin(phi), phi, -0.5 * (1 - np.cos(phi))])
    np.testing.assert_allclose(LAW.place(end, np.zeros(3))[0], [0.0, phi, 0.0], atol=1e-12)


def test_softening_is_cubic_and_then_linear():
    turn = TOOL_SOFTENING.turn
    assert turn(2e-3)[1] / turn(1e-3)[1] == pytest.approx(8.0, rel=1e-4)
    assert turn(40.0)[1] / turn(20.0)[1] == pytest.approx(2.0, rel=1e-2)
    assert turn(0.3)[1] == -turn(-0.3)[1]
    assert (turn(0.3 + 1e-6)[0] - turn(0.3 - 1e-6)[0]) / 2e-6 == pytest.approx(turn(0.3)[1], rel=1e-6)
