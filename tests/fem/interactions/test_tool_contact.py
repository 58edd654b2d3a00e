"""The contact of nodes: its stiffness is the derivative of its force; the node on the axis; entry between nodes."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.interactions.active_set import Friction
from fem.interactions.punch import Punch, standing
from fem.interactions.tool_contact import MOST_ENTRY, ToolContact

NODES, STEP = 6, 1e-7


def contact(friction, tilt):
    """Six nodes under the face, the edge and outside, all free."""
    rng = np.random.default_rng(3)
    place = np.stack((np.linspace(-4.0, 5.2, NODES), rng.uniform(-1.0, 1.0, NODES), np.zeros(NODES)))
    rows = 5 if friction == 0.0 else 7
    moving = np.arange(3 * NODES).reshape(3, NODES)
    multipliers = 3 * NODES + 1 + np.arange((rows - 4) * NODES).reshape(rows - 4, NODES)
    unknowns = np.concatenate((moving, np.full((1, NODES), 3 * NODES), multipliers))
    punch = standing(Punch(5.0, 1.0, friction), (0.0, 0.0), tilt)
    anchor = punch.gap(place).path
    resistance = Friction(rng.uniform(1.0, 2.0, NODES), np.full(NODES, 0.4 * friction), anchor)
    return ToolContact(punch, place, unknowns, resistance)


def total(found, unknowns, count):
    out = np.zeros(count)
    np.add.at(out, unknowns, found.force)
    return out


def matrix(found, made, count):
    out = np.zeros((count, count))
    for (i, j), entry in zip(made.pairs, found.stiffness, strict=True):
        for row, column, value in zip(made.own[i], made.own[j], entry, strict=True):
            out[row, column] += value
            if i != j:
                out[column, row] += value
    return out


@pytest.mark.parametrize("tilt", [0.0, 0.3])
def test_stiffness_without_friction(tilt):
    made = contact(0.0, tilt)
    y = 0.05 * np.random.default_rng(5).standard_normal(made.own.max() + 1)
    y[made.tool] = -0.8
    found = made.touch(y)
    assert 0 < (found.push != 0.0).sum() < NODES
    stiffness = matrix(found, made, len(y))
    for n in range(len(y)):
        more = STEP * np.eye(len(y))[n]
        change = total(made.touch(y + more), made.own, len(y)) - total(made.touch(y - more), made.own, len(y))
        np.testing.assert_allclose(stiffness[n], change / (2 * STEP), atol=1e-6)


def test_stiffness_of_nodes_that_stick():
    """On the flat face, whose directions do not turn."""
    made = contact(0.5, 0.2)
    y = 1e-3 * np.random.default_rng(5).standard_normal(made.own.max() + 1)
    y[made.tool] = -0.8
    found, under = made.touch(y), made.punch.under_face(made.place)
    stiffness = matrix(found, made, len(y))
    for n in made.own[:, under].ravel():
        if n == made.tool:
            continue
        more = STEP * np.eye(len(y))[n]
        change = total(made.touch(y + more), made.own, len(y)) - total(made.touch(y - more), made.own, len(y))
        np.testing.assert_allclose(stiffness[n], change / (2 * STEP), atol=1e-6)


def test_the_punch_presses_by_what_the_nodes_push():
    made = contact(0.5, 0.2)
    y = 1e-3 * np.random.default_rng(5).standard_normal(made.own.max() + 1)
    found = made.touch(y)
    assert found.press == pytest.approx(-found.force[3].sum())
    assert found.press == pytest.approx(found.force[2].sum())


def row(axis):
    """Five nodes in axial symmetry; unknowns (2, 5), the punch's, multipliers (5,)."""
    place = np.array([[0.0, 2.0, 4.0, 4.5, 5.0], [0.0, 0.0, 0.0, 0.0, 0.0]])
    own = np.concatenate((np.arange(10).reshape(2, 5), np.full((1, 5), 10), 11 + np.arange(5)[None]))
    return ToolContact(Punch(5.0, 1.0), place, own, Friction(np.ones(5), np.zeros(5), place[:1]), axis=axis)


@pytest.mark.parametrize(("beside", "touches"), [(1e-3, True), (-1e-3, False)])
def test_beyond_limits_the_node_on_the_axis_touches_where_the_next_one_does(beside, touches):
    """Its own multiplier pulls a little, which says nothing of the pressure there."""
    y = np.zeros(16)
    y[11:13] = -1e-4, beside
    y[[6, 5]] = -beside, 1e-4
    joined = row((0, 1)).beyond_limits()
    assert joined.is_beyond
    assert joined.beyond_limits() is None
    assert joined.active(y)[:2].tolist() == [touches, touches]
    assert not row((0, 1)).active(y)[0]
    assert row(None).beyond_limits() is None
    again = row((0, 1)).as_settled(joined.settled)
    assert again.joined


def test_an_axisymmetric_tool_knows_its_node_on_the_axis():
    layer = fem.Layer("gel", 4e-3, 1e3, fem.NeoHookean(1e4, 0.48))
    model = fem.prepare(fem.Problem((layer,), fem.Tool(5e-3, "rigid_frictionless", 5e-4), fem.Support("bonded")))
    made = model.equilibrium.system.items[0]
    first, second = made.axis
    assert made.place[0, first] == 0.0
    assert made.place[0, second] == np.sort(made.place[0])[1]


@pytest.mark.parametrize(("share", "sound"), [(0.9, True), (1.1, False)])
def test_a_surface_that_enters_between_its_nodes_is_not_sound(share, sound):
    """An element whose middle node is in the face: its parabola enters by three quarters of that half way."""
    y = np.zeros(16)
    y[6] = share * MOST_ENTRY / 0.75
    assert row((0, 1)).is_sound(y) == sound


def test_touch_and_limits_are_those_of_how_far_nodes_are_inside():
    """A node's multiplier is its entry; the nodes of a face that adheres may be outside and held."""
    made = row((0, 1))
    y = np.zeros(16)
    y[5:8], y[10] = (0.02, -0.01, 0.03), 0.0
    rubs = replace(made, punch=Punch(5.0, 1.0, 0.5))
    put, there = rubs.pressed_as(y, rubs, y, pressed=False)
    np.testing.assert_allclose(put[11:14], [0.02, 0.0, 0.03], atol=1e-12)
    np.testing.assert_allclose(there.friction.limit[:3], [0.01, 0.0, 0.015], atol=1e-12)
    assert not there.pressed
    holds = replace(made, punch=Punch(5.0, 1.0, adhesion=1.0))
    put, there = holds.pressed_as(y, holds, y, pressed=True)
    np.testing.assert_allclose(put[11:14], [0.02, -0.01, 0.03], atol=1e-12)
    assert there.pressed


def test_a_pull_is_held_by_adhesion_of_a_tool_that_pressed():
    holds = replace(row((0, 1)), punch=Punch(5.0, 1.0, adhesion=2.0), peak=4.0)
    assert "more than 0 N" in holds.lets_go(-1.0)
    assert holds.lets_go(-1e-9) == holds.lets_go(0.0) == ""
    pressed = replace(holds, pressed=True)
    assert pressed.lets_go(-2.0) == pressed.lets_go(-2.0 - 1e-9) == ""
    assert "more than 2 N" in pressed.lets_go(-2.1)


def test_between_another_meshs_nodes_how_far_nodes_are_inside_is_linear():
    """In whatever order that mesh has its nodes; one that is deep inside tells nothing."""
    mine = row((0, 1))
    order = np.array([4, 2, 0, 3, 1])
    moved = np.array([[0.0, 1.0, 3.0, 4.0, 5.0], np.zeros(5)])[:, order]
    theirs = replace(mine, place=moved)
    y = np.zeros(16)
    y[5:10] = np.array([0.02, 0.04, 0.03, 0.01, 0.0])[order]
    put, there = mine.pressed_as(np.zeros(16), theirs, y, pressed=True)
    np.testing.assert_allclose(put[11:14], [0.02, 0.035, 0.01], atol=1e-12)
    assert there.pressed
    y[5:10] = 20.0
    kept, same = mine.pressed_as(put, theirs, y, pressed=True)
    assert kept is put
    assert same is mine


def test_after_a_way_of_another_mesh_nodes_stick_where_they_are():
    y = np.zeros(16)
    y[:5] = 0.1
    np.testing.assert_allclose(row((0, 1)).led(y).friction.anchor[0, :2], [0.1, 2.1])
