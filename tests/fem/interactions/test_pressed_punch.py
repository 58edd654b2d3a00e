"""A rigid punch with a rounded edge by real contact: force, depth, energy, friction, lift-off and adhesion."""

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.analysis import limit_points, stepping
from fem.interactions.punch import Punch

SKIN = ((1e-4, 1e6), (1.5e-3, 1e5), (1e-2, 2e4))


def model(contact="rigid_frictionless", edge_radius=5e-4, layers=((1e-2, 2e4),), **tool):
    stack = tuple(fem.Layer(f"layer {n}", h, 1e3, fem.NeoHookean(E, 0.48)) for n, (h, E) in enumerate(layers))
    punch = fem.Tool(5e-3, contact, edge_radius, **tool)
    return fem.prepare(fem.Problem(stack, punch, fem.Support("bonded"), "finite", fem.Discretisation("coarse")))


def test_gap_of_face_edge_and_wall():
    gap = Punch(5.0, 1.0).gap(np.array([[2.0, 4.0 + np.sqrt(2), 6.0], [-0.5, 1.0 - np.sqrt(2), 3.0]]))
    np.testing.assert_allclose(gap.distance, [0.5, 1.0, 1.0])
    np.testing.assert_allclose(gap.normal.T, [[0, -1], [np.sqrt(0.5), -np.sqrt(0.5)], [1, 0]], atol=1e-15)
    np.testing.assert_allclose(gap.path[0], [2.0, 4.0 + np.pi / 4, 4.0 + np.pi / 2 + 2.0])
    assert Punch(5.0, 1.0).gap(np.array([[2.0], [1.5]])) is None


def test_derivatives_of_the_gap():
    punch, step = Punch(5.0, 1.0), 1e-5
    place = np.array([[3.0, 4.5, 4.8, 6.0], [-0.2, 0.1, -0.1, 2.0]])
    gap = punch.gap(place)
    for axis, way in enumerate(step * np.eye(2)[:, :, None]):
        ahead, behind = punch.gap(place + way), punch.gap(place - way)
        np.testing.assert_allclose((ahead.distance - behind.distance) / (2 * step), gap.normal[axis], atol=1e-9)
        np.testing.assert_allclose((ahead.path - behind.path) / (2 * step), gap.along[:, axis], atol=1e-9)
        turned = (ahead.normal - behind.normal) / (2 * step)
        np.testing.assert_allclose(turned, gap.bend[axis : axis + 2], atol=1e-8)


@pytest.mark.parametrize(("edge", "power", "most"), [(5e-3, 1.5, 1.2e-3), (1e-3, 1.0, 5e-4)])
def test_the_force_hardly_jumps_as_nodes_come_into_touch(edge, power, most):
    """It left a smooth curve over depth by 0.27 % under a sphere, 0.07 to 0.09 % under an edge of 1 mm."""
    layer = fem.Layer("gel", 8e-3, 1e3, fem.NeoHookean(12e3, 0.49))
    tool = fem.Tool(5e-3, "rigid_frictionless", edge)
    share = np.arange(1, 25) / 24
    pressed = fem.prepare(fem.Problem((layer,), tool, fem.Support("bonded"))).run(
        fem.Load("depth", share, 2e-4 * share)
    )
    curve, rest = np.log(pressed.force / pressed.depth**power)[3:], share[3:]
    assert np.std(curve - np.polyval(np.polyfit(rest, curve, 4), rest)) < most


@pytest.mark.parametrize("control", ["force", "depth"])
def test_the_reaction_is_the_force_and_unloading_retraces_loading(control):
    peak = 2.0 if control == "force" else 1.5e-3
    k = np.arange(1, 21)
    value = peak * np.minimum(k, 20 - k) / 10
    solution = model(layers=SKIN).run(fem.Load(control, k / 20, value))
    assert solution.complete
    np.testing.assert_allclose(solution.reaction, solution.force, atol=1e-6 * solution.force.max())
    np.testing.assert_allclose(getattr(solution, control), value, atol=1e-9 * peak)
    other = solution.depth if control == "force" else solution.force
    np.testing.assert_allclose(other[10:19], other[8::-1], rtol=1e-6)
    work = np.trapezoid(np.append(0.0, solution.force), np.append(0.0, solution.depth))
    assert abs(work) < 1e-6 * solution.force.max() * solution.depth.max()


def test_the_tissue_does_not_enter_the_punch():
    solution = model(layers=SKIN).run(fem.Load("force", np.arange(1.0, 6.0), np.arange(1.0, 6.0) * 0.6))
    top = solution.mesh.interfaces[0]
    r, z = (solution.mesh.nodes[top] + solution.displacement[-1, top]).T
    gap = Punch(5e-3, 5e-4).gap(np.stack((r, z + solution.depth[-1]))).distance
    assert gap.min() > -1e-6
    assert (gap < 1e-6).sum() > 10


def test_a_light_touch_is_the_flat_punch_of_small_strain():
    """Pressed by little, the rounded punch is as stiff as a flat one between its face's and its own radius."""
    force = model().run(fem.Load("depth", [1.0], [1e-5])).force[0]
    layer = fem.Layer("layer", 1e-2, 1e3, fem.NeoHookean(2e4, 0.48))
    bounds = [
        fem.prepare(fem.Problem((layer,), fem.Tool(radius, "rigid_frictionless"), fem.Support("bonded"), "linear"))
        .run(fem.Load("depth", [1.0], [1e-5]))
        .force[0]
        for radius in (4.5e-3, 5e-3)
    ]
    assert bounds[0] < force < bounds[1]


def test_without_adhesion_the_tool_leaves_the_tissue():
    solution = model().run(fem.Load("depth", np.arange(1.0, 6.0), [1e-3, 5e-4, 0.0, -5e-4, 5e-4]))
    assert solution.complete
    np.testing.assert_allclose(solution.force[2:4], 0.0, atol=1e-7)
    assert np.abs(solution.displacement[3]).max() < 1e-8
    assert solution.force[4] == pytest.approx(solution.force[1], rel=1e-6)
    assert "comes off" in solution.warnings[0]


def test_with_adhesion_the_tissue_follows_until_the_pull_is_too_much():
    depth = 1e-4 * np.array([5.0, 2.0, -1.0, -2.0, -3.0, -10.0, -2.0, 5.0])
    time = np.arange(1.0, 9.0)
    held = model(adhesion_force=100.0).run(fem.Load("depth", time, depth)).force
    assert held[2] < 0
    assert held[5] < held[4] < held[3] < held[2]
    weak = model(adhesion_force=1.2 * abs(held[2])).run(fem.Load("depth", time, depth))
    assert weak.complete
    assert weak.force[2] == pytest.approx(held[2], rel=1e-6)
    np.testing.assert_allclose(weak.force[4:7], 0.0, atol=1e-7)
    assert weak.force[7] == pytest.approx(held[0], rel=1e-6)


def test_a_pull_that_is_not_held_ends_with_the_last_good_state():
    solution = model().run(fem.Load("force", [1.0, 2.0, 3.0], [0.3, 0.1, -0.2]))
    assert not solution.complete
    assert solution.failure.step == 3
    assert len(solution.force) == 2
    assert "lets go of the tissue: it is pulled by more than 0 N" in solution.failure.reason


def test_a_pull_beyond_adhesion_ends_where_the_tool_lets_go_and_one_that_is_held_goes_on():
    load = fem.Load("force", np.arange(1.0, 5.0), [0.1, 0.0, -0.049, 0.0])
    assert model(adhesion_force=0.05).run(load).complete
    solution = model(adhesion_force=0.05).run(replace(load, value=np.array([0.1, 0.0, -0.051, 0.0])))
    assert solution.failure.step == 3
    assert -0.05 < solution.failure.reached < -0.0495
    assert "lets go of the tissue: it is pulled by more than 0.05 N" in solution.failure.reason


def test_friction_lies_between_frictionless_and_stuck():
    load = fem.Load("force", [1.0, 2.0, 3.0, 4.0], [0.2, 0.4, 0.6, 0.8])
    free, some, much = (model("rigid_frictional", friction_coefficient=mu).run(load) for mu in (0.0, 0.1, 0.5))
    assert free.depth[-1] > some.depth[-1] > much.depth[-1]
    np.testing.assert_allclose(some.reaction, load.value, rtol=1e-6)
    none = model().run(load).depth
    np.testing.assert_allclose(free.depth, none, rtol=1e-9)
    top = much.mesh.interfaces[0]
    inside = top[much.mesh.nodes[top, 0] < 3e-3]
    slid = [np.abs(s.displacement[-1, inside, 0]).max() for s in (free, much)]
    assert slid[1] < 0.3 * slid[0]


def test_friction_loses_energy_in_a_cycle():
    k = np.arange(1, 11)
    solution = model("rigid_frictional", friction_coefficient=0.2).run(
        fem.Load("depth", k / 10.0, 1e-3 * np.minimum(k, 10 - k) / 5)
    )
    assert solution.complete
    work = np.trapezoid(np.append(0.0, solution.force), np.append(0.0, solution.depth))
    assert work > 1e-4 * solution.force.max() * solution.depth.max()


def test_a_frictional_press_that_goes_back_to_no_force_leaves_the_tool_where_it_first_touched():
    k = np.arange(1.0, 11.0)
    value = 2.0 * np.minimum(k, 10.0 - k) / 5.0
    solution = model("rigid_frictional", layers=SKIN, friction_coefficient=0.3).run(fem.Load("force", k, value))
    assert solution.complete
    np.testing.assert_allclose(solution.force, value, atol=1e-9)
    assert abs(solution.depth[-1]) < 1e-9
    assert np.abs(solution.displacement[-1]).max() < 1e-9


@pytest.mark.parametrize(
    ("contact", "tool", "message"),
    [
        ("rigid_frictionless", {"edge_radius": None}, "edge_radius is missing"),
        ("rigid_frictional", {"edge_radius": None, "friction_coefficient": 0.3}, "edge_radius is missing"),
        ("rigid_frictional", {}, "friction_coefficient is missing"),
        ("rigid_frictional", {"friction_coefficient": 11.0}, "from 0 to 10"),
        ("rigid_bonded", {"edge_radius": None, "adhesion_force": 1.0}, "adhesion_force"),
        ("rigid_frictionless", {"adhesion_force": -1.0}, "from 0 to 1000"),
        ("rigid_frictionless", {"edge_radius": 5e-3, "adhesion_force": 1.0}, "flat face"),
    ],
)
def test_what_a_punch_needs(contact, tool, message):
    with pytest.raises(fem.FemError, match=message):
        model(contact, **tool)


def test_real_contact_is_for_finite_strain():
    layer = fem.Layer("layer", 1e-2, 1e3, fem.NeoHookean(2e4, 0.48))
    tool = fem.Tool(5e-3, "rigid_frictional", 5e-4, friction_coefficient=0.3)
    with pytest.raises(fem.FemError, match="kinematics = 'finite' only"):
        fem.prepare(fem.Problem((layer,), tool, fem.Support("bonded"), "linear"))


SNAPS = fem.Load("depth", np.arange(1, 4) / 3, 0.15e-3 * np.arange(1, 4))


def soft_pad(edge=3.5e-4):
    """1 mm of 5 kPa, whose surface snaps past the tool's edge at 0.32 mm."""
    pad = fem.Layer("pad", 1e-3, 1e3, fem.NeoHookean(5e3, 0.45))
    tool = fem.Tool(5e-3, "rigid_frictionless", edge)
    return fem.prepare(
        fem.Problem((pad,), tool, fem.Support("bonded"), discretisation=fem.Discretisation("coarse")),
    )


def test_a_press_goes_over_limit_points_and_tells_what_that_lost(tmp_path, monkeypatch):
    whole = soft_pad().run(SNAPS)
    assert whole.complete
    assert any("snapped past the tool's edge (once at 0.41" in text for text in whole.warnings)
    np.testing.assert_allclose(whole.depth, SNAPS.value, rtol=1e-9)
    assert (np.diff(whole.reaction) > 0.0).all()

    def stop_at_the_last(report):
        if report.step == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        soft_pad().run(SNAPS, stop_at_the_last, tmp_path / "steps.kept")
    resumed = soft_pad().run(SNAPS, checkpoint=tmp_path / "steps.kept")
    np.testing.assert_array_equal(resumed.reaction, whole.reaction)
    assert resumed.warnings == whole.warnings

    monkeypatch.setattr(stepping, "AHEAD", ())
    stopped = soft_pad().run(SNAPS)
    assert stopped.failure.step == 3
    np.testing.assert_array_equal(stopped.reaction, whole.reaction[:2])


def test_a_press_within_limits_ends_at_the_first(monkeypatch):
    ended = soft_pad().within_limits.run(SNAPS)
    assert not ended.complete
    assert ended.warnings == ()
    monkeypatch.setattr(stepping, "AHEAD", ())
    joined = soft_pad().run(SNAPS)
    np.testing.assert_array_equal(ended.reaction, joined.reaction[: len(ended.reaction)])


@pytest.mark.parametrize(("module", "bound", "value"), [(limit_points, "MOST_LOST", 1e-9), (stepping, "MOST_OVER", 1)])
def test_a_press_ends_where_too_much_would_be_lost_or_too_often(monkeypatch, module, bound, value):
    pad = soft_pad(2.5e-4)
    assert any("(2 times, " in text for text in pad.run(SNAPS).warnings)
    monkeypatch.setattr(module, bound, value)
    assert not pad.run(SNAPS).complete
