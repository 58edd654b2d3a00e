from itertools import pairwise

import numpy as np
import pytest

from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.trials.rows import bin_means, bin_sizes, fractions
from benchmark.discovery.trials.segments import (
    at_steady,
    forced,
    reversals,
    scatter_of,
    segments,
    stages,
    steadied,
    without_dwells,
)


def test_reversals_are_found_through_noise():
    rng = np.random.default_rng(0)
    time = np.linspace(0.0, 3.0, 601)
    depth = 1e-3 * np.abs((time + 1.0) % 2.0 - 1.0) + rng.normal(0.0, 1e-5, time.size)
    assert [round(float(time[row])) for row in reversals(depth, 1e-4)] == [1, 2]


def test_a_press_with_a_hold_has_its_segments(quick_session):
    time, depth = quick_session.motion(2e-3)
    pieces = segments(time, depth)
    assert [piece.kind for piece in pieces] == [
        "rest", "press", "rest", "retract", "rest", "press", "rest", "retract", "rest",
    ]  # fmt: skip
    assert [piece.cycle for piece in pieces] == [0, 1, 1, 1, 1, 2, 2, 2, 2]
    assert pieces[0].first == 0
    assert pieces[-1].last == time.size
    assert all(a.last == b.first for a, b in pairwise(pieces))


def test_a_triangle_has_no_hold():
    time = np.linspace(0.0, 10.0, 501)
    depth = 5e-3 - np.abs(time - 5.0) * 1e-3
    assert [piece.kind for piece in segments(time, depth)] == ["press", "retract"]


def test_nothing_moving_has_no_segments():
    assert segments(np.arange(5.0), np.zeros(5)) == []


def way(*knots, rate=50.0):
    """Time (n,) s and depth (n,) m through knots (s, mm), with an encoder's 2 um."""
    times, depths = np.array(knots, dtype=float).T
    time = np.arange(0.0, times[-1], 1.0 / rate)
    return time, 2e-6 * np.round(500.0 * np.interp(time, times, depths))


def kinds(pieces):
    return [piece.kind for piece in pieces]


STAIRS = ((0, 0), (1, 1), (11, 1), (12, 2), (22, 2), (23, 3), (33, 3))


def test_steps_of_a_staircase_are_rests_of_one_press():
    pieces = segments(*way(*STAIRS))
    assert kinds(pieces) == ["press", "rest"] * 3
    assert {piece.cycle for piece in pieces} == {1}
    assert [0.02 * piece.first for piece in pieces[1:]] == pytest.approx([1, 11, 12, 22, 23], abs=0.2)


def test_steps_on_the_way_back_are_rests_where_they_are():
    pieces = segments(*way(*STAIRS, (34, 1.5), (44, 1.5), (46, -0.2)))
    assert kinds(pieces) == [*["press", "rest"] * 3, "retract", "rest", "retract"]
    assert 0.02 * pieces[-2].first == pytest.approx(34, abs=0.2)
    assert 0.02 * pieces[-1].first == pytest.approx(44, abs=0.2)
    assert all(a.last == b.first for a, b in pairwise(pieces))


@pytest.mark.parametrize("slow", [0.2, 1.0], ids=["to the press", "in the press"])
def test_a_change_of_speed_is_no_dwell(slow):
    assert kinds(segments(*way((0, -2), (0.5, slow - 1), (20, 3), (22, -2)))) == ["press", "retract"]


def test_a_pause_in_air_is_no_hold():
    assert kinds(segments(*way((0, -3), (2, -1), (10, -1), (14, 3), (18, -1)))) == ["press", "retract"]


def test_dwells_count_to_their_strokes_again():
    time, depth = way(*STAIRS, (34, 1.5), (44, 1.5), (46, -0.2))
    whole = without_dwells(segments(time, depth))
    assert kinds(whole) == ["press", "rest", "retract"]
    assert whole[0].first == 0
    assert whole[-1].last == time.size


def test_a_way_through_air_hides_no_hold():
    assert kinds(segments(*way((0, -20), (46, 3), (51, 3), (67, -5)))) == ["press", "rest", "retract"]


def test_phases_follow_the_depth(quick_session):
    time, depth = quick_session.motion(2e-3)
    pieces = segments(time, depth)
    number = np.concatenate([[k] * (p.last - p.first) for k, p in enumerate(pieces)])
    phase, cycle, _ = stages(pieces, number, depth)
    names = np.array(PHASES)[phase]
    assert set(names) == set(PHASES)
    assert (depth[names == "approach"] <= 0.0).all()
    assert (depth[names == "unload_high"] >= 0.5 * depth.max()).all()
    assert cycle.max() == 2


def test_bins_are_small_at_the_ends_and_add_up():
    sizes = bin_sizes(400, 40)
    assert sum(sizes) == 400
    assert len(sizes) <= 40
    assert sizes[0] == sizes[-1] == 1
    assert max(sizes) > 10


def test_means_keep_a_straight_line():
    rows = np.column_stack([np.arange(50.0), 3.0 * np.arange(50.0)])
    means, counts = bin_means(rows, 0, 50, fractions(bin_sizes(50, 12)))
    assert means[:, 1] == pytest.approx(3.0 * means[:, 0])
    assert counts.sum() == 50


STIFFNESS = 1500.0
"""N/m."""


def scattering(seed, *, rate=50.0, jitter=0.0, speed=1e-4):
    """A press of 0.4 mm, held for 3 s: time, true depth, what a sensor reads that scatters by 5 um, force."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 11.6, 1.0 / rate)
    time = time + rng.uniform(-jitter, jitter, time.size) / rate
    depth = np.interp(time, [0.0, 0.3, 0.3 + 4.6e-4 / speed, 3.3 + 4.6e-4 / speed, 3.3 + 9.2e-4 / speed],
                      [-6e-5, -6e-5, 4e-4, 4e-4, -6e-5])  # fmt: skip
    force = STIFFNESS * np.maximum(depth, 0.0)
    return time, depth, depth + 5e-6 * rng.normal(size=time.size), force + 2e-3 * rng.normal(size=time.size)


@pytest.mark.parametrize("jitter", [0.0, 0.4])
@pytest.mark.parametrize("seed", range(4))
def test_a_sensor_that_scatters_is_made_steady(seed, jitter):
    time, depth, read, force = scattering(seed, jitter=jitter)
    steady = steadied(time, read, force)
    pressed = depth > 0.0
    assert np.std((steady - depth)[pressed]) < 1.5e-6
    assert np.abs(steady - depth)[pressed].max() < 7.5e-6
    assert [piece.kind for piece in segments(time, steady) if piece.cycle == 1][:3] == ["press", "rest", "retract"]


@pytest.mark.parametrize("seed", range(4))
def test_no_delay_gains_by_a_steady_depth(seed):
    """Half a row's delay meets the mean of two readings: beside the reading itself it gains, and is no clock's."""
    time, _, read, force = scattering(seed)

    def best(depth):
        delays = 1e-3 * np.arange(-15.0, 16.0)
        told = [STIFFNESS * np.maximum(np.interp(time - delay, time, depth), 0.0) for delay in delays]
        return delays[np.argmin([np.std(force - each) for each in told])]

    assert abs(best(read)) > 7e-3
    assert abs(best(steadied(time, read, force))) < 6e-3


def test_a_motion_that_the_force_follows_stays():
    time, _, read, _ = scattering(1)
    force = STIFFNESS * np.maximum(read, 0.0) + 2e-3 * np.random.default_rng(2).normal(size=time.size)
    assert steadied(time, read, force) is read


def test_a_motion_that_the_force_follows_stays_however_long_the_air_before_it_was():
    """In the air the force follows nothing."""
    rng, time = np.random.default_rng(6), np.arange(0.0, 16.0, 0.02)
    read = np.interp(time, [0.0, 10.0, 13.0, 16.0], [-4e-4, -1e-4, 4e-4, -1e-4]) + 5e-6 * rng.normal(size=time.size)
    force = STIFFNESS * np.maximum(read, 0.0) + 1e-4 * rng.normal(size=time.size)
    assert steadied(time, read, force) is read


def test_a_stroke_that_bends_is_no_line():
    rng, time = np.random.default_rng(7), np.arange(0.0, 10.0, 0.02)
    depth = 2e-4 * (1.0 - np.cos(0.2 * np.pi * time))
    force = STIFFNESS * depth + 2e-3 * rng.normal(size=time.size)
    steady = steadied(time, depth + 5e-6 * rng.normal(size=time.size), force)
    assert np.std(steady - depth) < 2.5e-6


def test_a_scatter_below_what_the_force_shows_stays():
    time, depth, _, force = scattering(1)
    rng = np.random.default_rng(3)
    read = depth + 1e-7 * rng.normal(size=time.size)
    assert steadied(time, read, force) is read
    assert steadied(time, depth, force) is depth
    air = 5e-6 * rng.normal(size=time.size) - 1e-4
    assert steadied(time, air, force) is air


def test_a_stroke_of_a_few_rows_stays_as_it_is():
    time = np.arange(12.0)
    read = 1e-3 * np.concatenate([np.arange(6.0), np.arange(6.0)[::-1]])
    read[::2] += 1e-4
    force = np.zeros(12)
    force[5] = 1.0
    assert steadied(time, read, force)[:5].tolist() == read[:5].tolist()
    assert scatter_of(np.array([0.0, 1e-3, 0.0])) == 0.0


def weighed(seed, *, scatter=5e-6, steps=3):
    """Weights put on one by one for 4 s, and taken off, on a gel that creeps: time, true depth, reading, force."""
    rng = np.random.default_rng([seed, 11])
    time = np.arange(0.0, 4.0 * steps + 5.0, 0.08)
    put = 1.0 + 4.0 * np.arange(steps)
    force = np.clip((time[:, None] - put) / 0.2, 0.0, 1.0).sum(axis=1) / steps
    force = 0.09 * np.where(time > put[-1] + 4.0, 0.05, force)
    slow = np.zeros(time.size)
    for row in range(1, time.size):
        slow[row] = slow[row - 1] + 0.04 * (force[row] - slow[row - 1])
    depth = (force + 0.5 * slow) / 230.0
    read, shown = depth + scatter * rng.normal(size=time.size), force + 3e-4 * rng.normal(size=time.size)
    return time, depth, read, shown


@pytest.mark.parametrize("seed", range(4))
def test_segments_under_a_prescribed_force_are_those_of_the_force(seed):
    """By the depth the creep after a step is a stroke, and so is the noise of a short rest before the first step."""
    time, _, _, force = weighed(seed)
    pieces = forced(time, force)
    assert kinds(pieces) == ["rest", *("press", "rest") * 3, "retract", "rest"]
    assert time[pieces[1].first] == pytest.approx(1.0, abs=0.1)
    assert [time[pieces[k].first] for k in (2, 4, 6)] == pytest.approx([1.2, 5.2, 9.2], abs=0.1)


@pytest.mark.parametrize("seed", range(4))
def test_a_scattering_depth_is_made_steady_between_the_turns_of_a_prescribed_force(seed):
    time, depth, read, force = weighed(seed)
    steady = steadied(time, read, force, forced(time, force))
    held = np.concatenate([np.arange(each.first, min(each.last, time.size)) for each in forced(time, force)[::2]])
    assert np.std((steady - depth)[held]) < 2.5e-6
    assert np.abs(steady - depth).max() < 1.8e-5  # a stroke of three rows keeps what it scatters by


@pytest.mark.parametrize("seed", range(4))
def test_a_prescribed_force_at_the_steady_depth_has_the_depths_scatter_as_white_noise(seed):
    """Without it the rows of a hold share one error, beside a force that scatters by a quarter as much."""
    time, depth, read, force = weighed(seed)
    steady = steadied(time, read, force, forced(time, force))
    stiffness = np.ptp(force) / read.max()
    noise = at_steady(force, read, steady) - force + stiffness * (steady - depth)
    inside = noise[np.abs(time - 7.0) < 1.8]
    assert np.std(inside) == pytest.approx(5e-6 * stiffness, rel=0.35)
    assert abs(np.corrcoef(inside[1:], inside[:-1])[0, 1]) < 0.45


@pytest.mark.parametrize("seed", range(4))
def test_a_tool_that_sticks_while_a_prescribed_force_falls_keeps_the_corner_of_its_depth(seed):
    """A stroke of the force from turn to turn rounded it, and a friction of its own stood as a set."""
    rng, time = np.random.default_rng([seed, 13]), np.arange(0.0, 24.0, 0.08)
    force = 0.09 * np.interp(time, [1.0, 11.0, 21.0], [0.0, 1.0, 0.0])
    reached = np.zeros(time.size)
    for row in range(1, time.size):
        reached[row] = np.clip(reached[row - 1], force[row] - 0.0045, force[row] + 0.0045)
    depth = reached / 230.0
    read, shown = depth + 1e-6 * rng.normal(size=time.size), force + 3e-4 * rng.normal(size=time.size)
    steady = steadied(time, read, shown, forced(time, shown))
    assert np.std((steady - depth)[(time > 10.0) & (time < 13.0)]) < 1.05e-6
