from itertools import pairwise

import numpy as np
import pytest

from benchmark.discovery.discovery_result import PHASES
from benchmark.discovery.trials.rows import bin_means, bin_sizes, fractions
from benchmark.discovery.trials.segments import reversals, segments, stages, without_dwells


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
