import numpy as np
import pytest

from wavemodel import WaveLayer
from wavemodel.plate.edge import clamp, plate_at, tool_edge
from wavemodel.plate.section import section


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
