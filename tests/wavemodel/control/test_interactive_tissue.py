"""Tools put anywhere on a tissue, pressed, moved, let go."""

import tracemalloc

import numpy as np
import pytest

from wavemodel import Prony, WaveError
from wavemodel.control import Grid, InteractiveTissue, layered_body


def test_vertices_and_windows():
    grid = Grid(10e-3, 4e-3, 1e-3)
    assert (grid.x.size, grid.y.size) == (11, 5)
    assert grid.window(5e-3, 2e-3, 2e-3) == (3, 8, 0, 5)
    assert grid.window(0.0, 4e-3, 1.5e-3) == (0, 2, 3, 5)
    assert grid.most_vertices(2e-3) == 6 * 5


@pytest.mark.parametrize(
    ("lengths", "word"), [((0.0, 1.0, 0.1), "width"), ((1.0, 1.0, -1.0), "spacing"), ((1.0, 0.5, 0.6), "spacing")]
)
def test_unusable_grids_are_refused(lengths, word):
    with pytest.raises(WaveError, match=word):
        Grid(*lengths)


DT = 1e-3
DEPTH = 0.3e-3


def test_a_patch_is_the_wave_s_surface_moved_to_the_contact(tissue, wave, grid):
    tool = tissue()
    tool.touch(0, 40.3e-3, 29.6e-3, DEPTH)
    frame = tool.frame(DT)
    x, y = grid.x[28:53] - 40.3e-3, grid.y[18:42] - 29.6e-3
    expected = wave.surface(x, y).frame(wave.static_state(DEPTH / wave.law.compliance))
    np.testing.assert_allclose(frame[:, 28:53, 18:42], expected, atol=0.01 * DEPTH)
    assert tool.force[0] == pytest.approx(DEPTH / wave.law.compliance)


def test_contacts_on_vertices_are_one_shifted(tissue):
    frames = []
    for x, y in ((40e-3, 30e-3), (47e-3, 25e-3)):
        tool = tissue()
        tool.touch(0, x, y, DEPTH)
        frames.append(tool.frame(DT))
    np.testing.assert_allclose(frames[1][:, 27:67, 5:45], frames[0][:, 20:60, 10:50], atol=1e-12)


def test_vertices_outside_the_patch_are_untouched_wherever_it_has_been(tissue, grid):
    tool = tissue()
    for x, y in ((0.0, 0.0), (80e-3, 31e-3), (40e-3, 60e-3), (22.5e-3, 30e-3)):
        tool.touch(0, x, y, DEPTH)
        frame = tool.frame(DT)
        outside = (np.abs(grid.x - x) > 20e-3)[:, None] | (np.abs(grid.y - y) > 20e-3)
        assert not frame[:, outside].any()
        assert frame.max() == pytest.approx(DEPTH, rel=0.02)


def test_a_patch_is_clipped_at_the_tissue_s_edge(tissue):
    middle, corner = tissue(), tissue()
    middle.touch(0, 40e-3, 30e-3, DEPTH)
    corner.touch(0, 0.0, 60e-3, DEPTH)
    whole, cut = middle.frame(DT), corner.frame(DT)
    np.testing.assert_allclose(cut[:, :21, 40:], whole[:, 40:61, 10:31], atol=1e-12)


def test_each_of_several_tools_is_as_deep_as_it_is_told(tissue):
    tool = tissue()
    places = [(30e-3, 30e-3, DEPTH), (38e-3, 30e-3, 0.2e-3), (30e-3, 45e-3, 0.1e-3)]
    for index, (x, y, depth) in enumerate(places):
        tool.touch(index, x, y, depth)
    frame = tool.frame(DT)
    for x, y, depth in places:
        assert frame[0, round(x * 1e3), round(y * 1e3)] == pytest.approx(depth, rel=1e-9)
    alone = tissue()
    alone.touch(0, *places[0])
    alone.frame(DT)
    assert tool.force[0] < alone.force[0]
    assert (tool.force[:3] > 0.0).all()


def test_a_tool_that_others_have_sunk_the_surface_away_from_does_not_pull(tissue):
    tool = tissue()
    tool.touch(0, 30e-3, 30e-3, DEPTH)
    tool.touch(1, 36.5e-3, 30e-3, 1e-6)
    tool.frame(DT)
    assert tool.force[1] == 0.0


def test_half_a_press_returns_in_the_stated_steps(tissue):
    tool = tissue()
    tool.touch(0, 40e-3, 30e-3, 0.5 * DEPTH)
    tool.frame(DT)
    tool.release(0, steps=5)
    depths = [tool.frame(DT)[0].max() for _ in range(6)]
    np.testing.assert_allclose(depths, 0.5 * DEPTH * np.array([0.8, 0.6, 0.4, 0.2, 0.0, 0.0]), atol=1e-12)
    assert tool.force[0] == 0.0


def test_an_elastic_tissue_returns_at_once_and_a_damped_one_in_its_time(tissue):
    for retardation, left in ((0.0, 0.0), (20e-3, np.exp(-10e-3 / 20e-3))):
        tool = tissue(retardation=retardation)
        tool.touch(0, 40e-3, 30e-3, DEPTH)
        tool.frame(DT)
        tool.release(0)
        depths = [tool.frame(DT)[0].max() for _ in range(10)]
        assert depths[-1] == pytest.approx(left * DEPTH, abs=1e-12)


def test_a_held_press_relaxes_and_creeps_back_by_its_closed_form(tissue, wave):
    """One term: the force after long is 1 - g; let go, e springs to g and creeps back with tau / (1 - g)."""
    g, tau = 0.4, 50e-3
    tool = tissue(series=Prony((g,), (tau,)))
    tool.touch(0, 40e-3, 30e-3, DEPTH)
    for _ in range(2000):
        tool.frame(DT)
    assert tool.force[0] == pytest.approx((1 - g) * DEPTH / wave.law.compliance, rel=1e-6)
    tool.release(0)
    depths = np.array([tool.frame(DT)[0].max() for _ in range(60)])
    expected = g * DEPTH * np.exp(-(1 - g) * np.arange(1, 61) * DT / tau)
    np.testing.assert_allclose(depths, expected, rtol=1e-6)


def unilateral(depths, stiffness, g, tau):
    """Force (n,) of one term under a tool that only pushes, by small steps: y' = (g e - y) / tau, e - y >= 0."""
    lag, fine, out = 0.0, 50, []
    for before, after in zip(np.append(0.0, depths[:-1]), depths, strict=True):
        for k in range(fine):
            elastic = max(stiffness * (before + (k + 1) / fine * (after - before)), lag)
            lag += DT / fine * (g * elastic - lag) / tau
        out.append(elastic - lag)
    return np.array(out)


def test_a_tool_withdrawn_faster_than_the_tissue_creeps_loses_it_and_meets_it_where_it_stands(tissue, wave):
    g, tau = 0.5, 0.3
    turns = [0.0, 0.05, 1.05, 1.06, 1.36, 1.37, 1.6]
    time = DT * np.arange(1, 1601)
    depths = np.interp(time, turns, DEPTH * np.array([0, 1, 1, 0.05, 0.05, 1, 1]))
    tool, forces = tissue(series=Prony((g,), (tau,))), []
    for depth in depths:
        tool.touch(0, 40e-3, 30e-3, float(depth))
        tool.advance(DT)
        forces.append(tool.force[0])
    expected = unilateral(depths, 1.0 / wave.law.compliance, g, tau)
    assert max(forces[1070:1300]) < 1e-12
    np.testing.assert_allclose(forces, expected, atol=2e-3 * expected.max())


def pressed_long(tool, steps=2000):
    tool.touch(0, 40e-3, 30e-3, DEPTH)
    for _ in range(steps):
        tool.advance(DT)
    return tool


def test_a_dent_is_met_where_it_is_and_elsewhere_the_tissue_is_new(tissue, wave):
    for away, stands in ((2e-3, True), (4e-3, False)):
        tool = pressed_long(tissue(series=Prony((0.4,), (0.2,))))
        tool.release(0)
        dent = tool.frame(DT)[0].max()
        tool.touch(0, 40e-3 + away, 30e-3, 0.05 * DEPTH)
        after = tool.frame(DT)[0].max()
        assert 0.39 * DEPTH < dent < 0.41 * DEPTH
        assert after == pytest.approx(dent if stands else 0.05 * DEPTH, rel=5e-3)
        assert (tool.force[0] == pytest.approx(0.0, abs=1e-15)) == stands


def test_memory_goes_with_a_return_in_stated_steps(tissue, wave):
    """Half way back half of what was forgotten is left: pressed again, half of the loss is felt."""
    g, tool = 0.4, pressed_long(tissue(series=Prony((0.4,), (0.05,))))
    tool.release(0, steps=10)
    for _ in range(5):
        tool.advance(1e-6)
    tool.touch(0, 40e-3, 30e-3, DEPTH)
    tool.advance(1e-6)
    assert tool.force[0] == pytest.approx((1.0 - 0.5 * g) * DEPTH / wave.law.compliance, rel=1e-4)


def test_damping_is_felt_while_pressing_on(tissue, wave):
    tool, speed = tissue(retardation=10e-3), 1e-3
    for step in range(1, 21):
        tool.touch(0, 40e-3, 30e-3, speed * step * DT)
        tool.frame(DT)
    expected = (20 * DT + 10e-3) * speed / wave.law.compliance
    assert tool.force[0] == pytest.approx(expected, rel=1e-9)


def test_frames_allocate_nothing_that_grows_with_the_tissue(wave):
    """Only NumPy's own buffers, at most 8192 numbers an operand; one patch here has 77763."""
    fine = Grid(80e-3, 60e-3, 0.25e-3)
    tool = InteractiveTissue(layered_body(wave, fine), fine, series=Prony((0.3,), (0.1,)), retardation=1e-3)
    tool.touch(0, 40e-3, 30e-3, DEPTH)
    tool.touch(1, 52e-3, 30e-3, DEPTH)
    first = tool.frame(DT)
    tracemalloc.start()
    for step in range(20):
        tool.touch(0, 30e-3 + step * 0.37e-3, 30e-3, DEPTH)
        frame = tool.frame(DT)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert frame is first
    assert peak < 3 * 8 * 8192


@pytest.mark.parametrize(
    ("request_", "word"),
    [
        (lambda tool: tool.touch(0, 81e-3, 30e-3, DEPTH), "outside the tissue"),
        (lambda tool: tool.touch(0, 40e-3, np.nan, DEPTH), "outside the tissue"),
        (lambda tool: tool.touch(0, 40e-3, 30e-3, 12e-3), "depth = 12 mm"),
        (lambda tool: tool.touch(0, 40e-3, 30e-3, -1e-6), "depth ="),
        (lambda tool: tool.touch(0, 40e-3, 30e-3, np.nan), "depth ="),
        (lambda tool: tool.touch(1, 33e-3, 30e-3, DEPTH), "two tool radii"),
        (lambda tool: tool.touch(4, 10e-3, 30e-3, DEPTH), "contact = 4"),
        (lambda tool: tool.release(1), "does not press"),
        (lambda tool: tool.release(0, steps=0), "steps = 0"),
        (lambda tool: tool.frame(0.0), "dt = 0"),
        (lambda tool: tool.frame(np.nan), "dt = nan"),
    ],
)
def test_bad_input_is_one_error_and_changes_nothing(tissue, snapshot, request_, word):
    tried, left = (tissue(series=Prony((0.3,), (0.1,))) for _ in range(2))
    for tool in (tried, left):
        tool.touch(0, 30e-3, 30e-3, DEPTH)
        tool.frame(DT)
    with pytest.raises(WaveError, match=word):
        request_(tried)
    for ours, theirs in zip(snapshot(tried), snapshot(left), strict=True):
        np.testing.assert_array_equal(ours, theirs)


def test_tools_side_by_side_may_touch_whatever_their_places_round_to(tissue):
    tool = tissue()
    radius = tool.body.tool_radius
    apart = np.nextafter(30e-3 + 2.0 * radius, 0.0)
    assert apart - 30e-3 < 2.0 * radius
    tool.touch(0, 30e-3, 30e-3, DEPTH)
    tool.touch(1, apart, 30e-3, DEPTH)
    with pytest.raises(WaveError, match="two tool radii"):
        tool.touch(2, 30e-3, 30e-3 + 2.0 * radius * (1.0 - 1e-6), DEPTH)


@pytest.mark.parametrize(("options", "word"), [({"contacts": 0}, "contacts"), ({"retardation": -1.0}, "retardation")])
def test_unusable_options_are_refused(tissue, options, word):
    with pytest.raises(WaveError, match=word):
        tissue(**options)
