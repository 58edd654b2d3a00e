import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.sheet.edge import TOOL_SOFTENING, clamp, edge_law, plate_at, tool_edge
from wavemodel.sheet.section import section


def unit(poisson_ratio=0.49):
    return [WaveLayer("sheet", 1.0, 1.0, 1.0, poisson_ratio)]


def test_clamp_and_tool_are_one_edge_turned_round_where_it_is_straight():
    layers = unit()
    outer, inner = (
        clamp(layers, section(layers), 1e3).compliance,
        tool_edge(layers, section(layers), 1e3, "rigid_bonded").compliance,
    )
    turn = np.diag([-1.0, 1.0, -1.0])
    np.testing.assert_allclose(turn @ outer @ turn, inner, rtol=3e-3, atol=1e-3)
    assert (np.linalg.eigvalsh(outer) > 0.0).all()


def test_disc_under_a_tool_without_friction_stretches_like_a_membrane():
    """u / N = (1 - nu) a / (E h), and the turn does not follow the stretch."""
    layers = unit(0.3)
    edge = tool_edge(layers, section(layers), 1.25, "rigid_frictionless")
    assert edge.compliance[0, 0] == pytest.approx(0.7 * 1.25, rel=1e-6)
    assert edge.compliance[0, 1] == pytest.approx(0.0, abs=1e-9)
    assert edge.stretch[0] == pytest.approx(0.7, rel=1e-6)


def test_held_face_does_not_move_and_both_sides_meet_at_the_edge():
    layers = unit()
    edge, load, at = (
        tool_edge(layers, section(layers), 1.25, "rigid_bonded"),
        np.array([0.3, 0.1, -0.2]),
        np.array([1.25]),
    )
    np.testing.assert_allclose(edge.behind(0, load, np.linspace(0, 1.25, 5)), 0.0, atol=1e-12)
    displacement = plate_at(edge.strip, 1.25)[0]
    ends = np.concatenate([edge.compliance @ load, load / edge.strip.scale])
    for node in (0, 5, edge.strip.z.size - 1):
        plate = (displacement @ ends)[2 * node : 2 * node + 2]
        np.testing.assert_allclose(
            plate + edge.before(node, load, at)[:, 0], edge.behind(node, load, at)[:, 0], atol=2e-4
        )


def test_end_effects_decay_within_a_few_thicknesses():
    layers = unit()
    edge = clamp(layers, section(layers), 30.0)
    field = edge.before(0, np.array([1.0, 1.0, 1.0]), np.array([30.0, 28.0, 25.0]))
    assert np.abs(field[:, 2]).max() < 1e-6 * np.abs(field[:, 0]).max()


def test_compliance_scales_with_thickness_and_modulus():
    small, large = unit(), [WaveLayer("sheet", 2.0, 1.0, 5.0, 0.49)]
    one = clamp(small, section(small), 7.5).compliance
    two = clamp(large, section(large), 15.0).compliance
    scale = np.diag([1.0, 0.5, 1.0])
    np.testing.assert_allclose(two, scale @ one @ scale / 5.0, rtol=1e-6)


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
