"""Measures of motion against cases worked by hand, and against figures of the authors of two of them."""

from itertools import pairwise

import numpy as np
import pytest

from benchmark.assessment.attempt_measures import (
    SPECTRAL,
    Attempt,
    bimanual_correlation,
    economy_of_motion,
    log_dimensionless_jerk,
    motion_frequency,
    path_length,
    read_attempt,
    root_mean_square,
    spectral_arc_length,
    speed_of,
    tremor,
)
from reports import write_csv

EXACT = {"rel": 1e-9, "abs": 1e-15}


def test_a_path_by_hand():
    position = np.array([[0.0, 0.0, 0.0], [3.0, 4.0, 0.0], [3.0, 4.0, 12.0]])
    assert path_length(position) == pytest.approx(17.0, **EXACT)
    np.testing.assert_allclose(speed_of(position, 10.0), [50.0, 120.0], rtol=1e-15)


def test_economy_by_hand():
    position = np.array([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [3.0, 4.0, 0.0]])
    assert economy_of_motion(position, position[-1:]) == pytest.approx(5.0 / 7.0, **EXACT)
    assert economy_of_motion(position, position[1:]) == pytest.approx(1.0, **EXACT)
    assert np.isnan(economy_of_motion(np.zeros((3, 3)), np.ones((1, 3))))


GAUSSIAN = np.exp(-5.0 * np.arange(-1.0, 1.0, 0.01) ** 2)


def test_smoothness_has_its_authors_own_figures():
    """The examples in the program that Balasubramanian et al. published with their article."""
    assert f"{spectral_arc_length(GAUSSIAN, 100.0):.5f}" == "-1.41403"
    assert f"{log_dimensionless_jerk(GAUSSIAN, 100.0):.5f}" == "-5.81636"


def test_jerk_by_hand():
    count, rate = 50, 20.0
    speed = (np.arange(count) / rate) ** 2
    whole = (count / rate) ** 3 * 4.0 * (count - 2) / rate
    expected = -np.log(whole / ((count - 1) / rate) ** 4)
    assert log_dimensionless_jerk(speed, rate) == pytest.approx(expected, **EXACT)
    assert np.isnan(log_dimensionless_jerk(np.zeros(9), rate))


def test_smoothness_does_not_depend_on_size_or_pace():
    for measure in (log_dimensionless_jerk, spectral_arc_length):
        assert measure(7.0 * GAUSSIAN, 100.0) == pytest.approx(measure(GAUSSIAN, 100.0), rel=1e-9)
    assert log_dimensionless_jerk(GAUSSIAN, 50.0) == pytest.approx(log_dimensionless_jerk(GAUSSIAN, 100.0), rel=1e-9)


def test_an_arc_by_hand():
    """The spectrum of one sample among none is flat: the curve is a straight line of length one."""
    speed = np.zeros(64)
    speed[0] = 3.0
    assert spectral_arc_length(speed, 20.0) == pytest.approx(-1.0, **EXACT)
    assert np.isnan(spectral_arc_length(np.zeros(64), 20.0))


def test_more_stops_are_less_smooth():
    thrice = np.concatenate([GAUSSIAN] * 3)
    assert spectral_arc_length(thrice, 100.0) < spectral_arc_length(GAUSSIAN, 100.0)
    assert log_dimensionless_jerk(thrice, 100.0) < log_dimensionless_jerk(GAUSSIAN, 100.0)


def waves(count, rate, **parts):
    """Positions (count + 1, 3) along x: sines of whole periods within `count` samples, by "fHz" amplitude."""
    time = np.arange(count + 1) / rate
    x = sum(amplitude * np.sin(2.0 * np.pi * float(name[1:]) * time) for name, amplitude in parts.items())
    return np.column_stack([x, np.zeros(time.size), np.zeros(time.size)])


def test_the_motion_frequency_of_sines():
    assert motion_frequency(waves(500, 100.0, f2=1.0), 100.0) == pytest.approx(2.0, **EXACT)
    slow = waves(500, 100.0, f2=1.0, f8=0.05)  # power of speed 4 % at 8 Hz
    shaken = waves(500, 100.0, f2=1.0, f8=0.08)  # 9 %
    assert motion_frequency(slow, 100.0) == pytest.approx(2.0, **EXACT)
    assert motion_frequency(shaken, 100.0) == pytest.approx(8.0, **EXACT)
    assert np.isnan(motion_frequency(np.ones((50, 3)), 100.0))


def test_tremor_is_the_effective_value_within_its_band():
    position = waves(500, 100.0, f1=20e-3, f10=3e-5)[:-1]
    assert tremor(position, 100.0) == pytest.approx(3e-5 / np.sqrt(2.0), rel=1e-9)
    assert tremor(waves(500, 100.0, f1=20e-3, f14=3e-5)[:-1], 100.0) < 1e-15


def shaken(time, frequency):
    """Positions (n, 3), m: a reach of 30 mm with a tremor of 50 um about each axis."""
    share = time / time[-1]
    reach = 10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5
    slow = np.stack([30e-3 * reach, 10e-3 * np.sin(np.pi * share), 2e-3 * np.sin(np.pi * share) ** 2])
    return (slow + 5e-5 * np.sin(2.0 * np.pi * frequency * time + np.array([[3.2], [5.9], [0.9]]))).T


def recorded(path, time, position):
    """The record of one tool at times (n,) and positions (n, 3), read."""
    columns = dict(zip(("x_mm", "y_mm", "depth_mm"), 1e3 * position.T, strict=True))
    write_csv(path, {"time_s": time, "tool": 0 * time, **columns, "force_N": 0.0 * time})
    return read_attempt(path)


EVEN = 0.01 * np.arange(401)


@pytest.mark.parametrize(
    ("rate", "frequency", "close"),
    [(30, 8.0, 0.02), (30, 9.5, 0.005), (30, 12.0, 0.045)]
    + [(rate, frequency, 1e-3) for rate in (60, 100, 250) for frequency in (8.0, 9.5, 12.0)],
)
def test_the_rate_of_a_record_does_not_change_what_it_tells(tmp_path, rate, frequency, close):
    """Against the same motion taken at 100 Hz; straight lines lost 29 % of a tremor of 9.5 Hz at 30 rows a second."""
    known = Attempt("", "", EVEN, {0: shaken(EVEN, frequency)}, {0: 0.0 * EVEN}).measures()
    time = np.arange(4 * rate + 1) / rate
    found = recorded(tmp_path / "one.csv", time, shaken(time, frequency))
    assert found.warnings == ()
    measures = found.measures()
    assert measures["tremor_um"] == pytest.approx(known["tremor_um"], rel=close)
    assert measures["log_dimensionless_jerk"] == pytest.approx(known["log_dimensionless_jerk"], abs=2.0 * close)
    assert measures["spectral_arc_length"] == pytest.approx(known["spectral_arc_length"], abs=2.0 * close)
    assert measures["motion_frequency_hz"] == known["motion_frequency_hz"]


@pytest.mark.parametrize("change", ["uneven", "lost", "in bursts"])
def test_rows_need_not_be_even(tmp_path, change):
    """At 60 Hz: off by up to 0.3 of a row, ten of 241 lost, or each tenth sent twice, 0.1 ms apart and 20 um off."""
    rng, time, known = np.random.default_rng(4), np.arange(241) / 60.0, shaken(EVEN, 9.5)
    if change == "uneven":
        time[1:-1] += rng.uniform(-0.3, 0.3, 239) / 60.0
    if change == "lost":
        time = np.delete(time, np.arange(10, 240, 24))
    position = shaken(time, 9.5)
    if change == "in bursts":
        time = np.insert(time, np.arange(10, 240, 10), time[9:239:10] + 1e-4)
        position = np.insert(position, np.arange(10, 240, 10), position[9:239:10] + 2e-5, axis=0)
    found = recorded(tmp_path / "one.csv", time, position)
    expected = Attempt("", "", EVEN, {0: known}, {0: 0.0 * EVEN}).measures()
    assert found.warnings == ()
    assert found.measures()["tremor_um"] == pytest.approx(expected["tremor_um"], rel=5e-3)


@pytest.mark.parametrize(
    ("rate", "lost", "word"), [(25, 0, "40 ms"), (100, 20, "up to 0.21 s"), (40, 0, ""), (29, 0, "")]
)
def test_what_lies_between_rows_too_far_apart_is_left_blank(tmp_path, rate, lost, word):
    time = np.delete(np.arange(4 * rate + 1) / rate, np.s_[50 : 50 + lost])
    found = recorded(tmp_path / "one.csv", time, shaken(time, 9.5))
    blank = [name for name, value in found.measures().items() if name in SPECTRAL and np.isnan(value)]
    assert blank == (list(SPECTRAL) if word else [])
    assert [f"rows are {word} apart: no jerk" in one for one in found.warnings] == [True] * bool(word)
    assert found.measures()["path_length_mm"] > 30.0


def test_a_tool_that_comes_late_is_not_known_before(tmp_path):
    time = np.concatenate([EVEN, EVEN[200:]])
    position = np.vstack([shaken(EVEN, 9.5), shaken(EVEN[200:], 9.5)])
    columns = dict(zip(("x_mm", "y_mm", "depth_mm"), 1e3 * position.T, strict=True))
    tools = np.repeat([0, 1], [401, 201])
    write_csv(tmp_path / "two.csv", {"time_s": time, "tool": tools, **columns, "force_N": 0.0 * time})
    found = read_attempt(tmp_path / "two.csv")
    assert "tool 1: rows are up to 2 s apart" in found.warnings[0]
    assert np.isnan(found.measures()["tremor_um"])


def test_depth_and_way_do_not_swing_where_a_press_stops_short(tmp_path):
    """A ramp that ends in a hold, at 60 Hz: the spline goes 0.03 mm deeper, the depth and path told do not."""
    time = np.arange(121) / 60.0
    depth = np.minimum(20e-3 * time, 10e-3)
    found = recorded(tmp_path / "one.csv", time, np.column_stack([0.0 * time, 0.0 * time, depth]))
    assert found.position[0][:, 2].max() == pytest.approx(10e-3, rel=1e-12)
    assert found.motion[0][:, 2].max() > 10.01e-3
    assert found.measures()["path_length_mm"] == pytest.approx(10.0, rel=1e-9)


def test_hands_together_by_hand():
    first = np.array([1.0, 2.0, 3.0, 2.0])
    assert bimanual_correlation(first, 2.0 * first + 1.0) == pytest.approx(1.0, **EXACT)
    assert bimanual_correlation(first, -first) == pytest.approx(-1.0, **EXACT)
    other = np.array([1.0, 0.0, 0.0, 1.0])
    assert bimanual_correlation(first, other) == pytest.approx(-1.0 / np.sqrt(2.0), **EXACT)
    assert np.isnan(bimanual_correlation(first, np.ones(4)))


def test_accuracy_by_hand():
    assert root_mean_square(np.array([3.0, -4.0])) == pytest.approx(np.sqrt(12.5), **EXACT)
    assert np.isnan(root_mean_square(np.empty(0)))


def test_an_attempt_by_hand():
    """A tool straight to two targets: 40 mm across, 2.5 mm down, up, 30 mm along, 2.8 mm down; 51 samples each way."""
    ways = [(0, 0, 0), (40, 0, 0), (40, 0, 2.5), (40, 0, 0), (40, 30, 0), (40, 30, 2.8)]
    share = np.linspace(0.0, 1.0, 52)[1:, None]
    pieces = [1e-3 * (np.array(a) + share * np.subtract(b, a)) for a, b in pairwise(ways)]
    position = np.vstack([np.zeros((1, 3)), *pieces])
    force = np.where(position[:, 1] < 1e-3, 1.0, 2.0) * (position[:, 2] > 0.0)
    target = 1e-3 * np.array([[41.0, 0.0, 2.0], [40.0, 29.0, 3.0]])
    wanted = np.array([1.2, 1.9])
    time = 0.01 * np.arange(len(position))
    found = Attempt("one", "", time, {0: position}, {0: force}, target, wanted).measures()
    assert found["time_s"] == pytest.approx(2.55, **EXACT)
    assert found["path_length_mm"] == pytest.approx(40.0 + 2.5 + 2.5 + 30.0 + 2.8, **EXACT)
    straight = np.sqrt(41.0**2 + 2.0**2) + np.sqrt(1.0 + 29.0**2 + 1.0)
    assert found["economy_of_motion"] == pytest.approx(straight / 77.8, **EXACT)
    assert found["depth_error_mm"] == pytest.approx(np.sqrt((0.5**2 + 0.2**2) / 2.0), **EXACT)
    assert found["force_error_N"] == pytest.approx(np.sqrt((0.2**2 + 0.1**2) / 2.0), **EXACT)
    both = Attempt("two", "", time, {0: position, 1: position}, {0: force, 1: force}, target, wanted).measures()
    assert both["path_length_mm"] == pytest.approx(2.0 * 77.8, **EXACT)
    assert both["bimanual_correlation"] == pytest.approx(1.0, **EXACT)
    assert (found["targets_reached"], both["targets_reached"]) == (1.0, 1.0)


def way_through(*points, pace=50):
    """An attempt of one tool straight from point to point, mm, in so many samples each."""
    share = np.linspace(0.0, 1.0, pace + 1)[1:, None]
    pieces = [1e-3 * (np.array(a) + share * np.subtract(b, a)) for a, b in pairwise(points)]
    return np.vstack([[1e-3 * np.array(points[0])], *pieces])


def attempt_at(position, *targets):
    target = 1e-3 * np.array(targets)
    count = len(position)
    return Attempt(
        "", "", 0.01 * np.arange(count), {0: position}, {0: np.zeros(count)}, target, np.full(len(target), 1.0)
    )


NEAR_ONE, FAR_ONE, LAST_ONE = (30.0, 0.0, 2.0), (30.0, 20.0, 1.5), (0.0, 20.0, 2.5)


def test_skipped_targets_make_no_economy():
    """A tool that only stirs where it is had an economy of 12; one that goes to the first of three, 3."""
    stirred = attempt_at(way_through((0, 0, 0.1), (2, 0, 0.1), (-2, 0, 0.1)), NEAR_ONE, FAR_ONE, LAST_ONE)
    first = attempt_at(way_through((0, 0, 0), NEAR_ONE, (30, 1, 2)), NEAR_ONE, FAR_ONE, LAST_ONE)
    every = attempt_at(way_through((0, 0, 0), NEAR_ONE, FAR_ONE, LAST_ONE), NEAR_ONE, FAR_ONE, LAST_ONE)
    found = [one.measures() for one in (stirred, first, every)]
    assert [one["targets_reached"] for one in found] == pytest.approx([0.0, 1.0 / 3.0, 1.0])
    assert [np.isnan(one["economy_of_motion"]) for one in found] == [True, True, False]
    assert found[2]["economy_of_motion"] == pytest.approx(1.0)
    assert "3 of 3 targets not pressed" in stirred.warnings[0]
    assert "2 of 3 targets not pressed: time and path are of a shorter task" in first.warnings[0]
    assert every.warnings == ()


def test_targets_in_another_order_are_reached_but_no_economy():
    """From the far end back the way is 60 mm less than through the targets as they were shown."""
    shown = ((50.0, 0.0, 1.0), (10.0, 0.0, 1.0), (30.0, 0.0, 1.0))
    back = attempt_at(way_through((0, 0, 1), (50, 0, 1)), *shown)
    assert back.measures()["targets_reached"] == 1.0
    assert np.isnan(back.measures()["economy_of_motion"])
    assert "another order" in back.warnings[0]
    again = attempt_at(way_through((0, 0, 1), (50, 0, 1), (10, 0, 1), (30, 0, 1)), *shown)
    assert again.measures()["economy_of_motion"] == pytest.approx(1.0)


def test_a_target_that_is_flown_over_is_not_reached():
    over = attempt_at(way_through((0, 0, 0), (30, 0, 0), (30, 20, 0)), NEAR_ONE, FAR_ONE)
    assert over.measures()["targets_reached"] == 0.0
    assert np.isnan(over.measures()["depth_error_mm"])
    air = attempt_at(way_through((0, 0, -20), (30, 0, -10)), (30.0, 0.0, -9.0), (0.0, 0.0, -1.0))
    np.testing.assert_array_equal(air.reached, [True, False])


def test_without_targets_none_is_reached_or_missed():
    free = attempt_at(way_through((0, 0, 0), (30, 0, 0)))
    assert np.isnan(free.measures()["targets_reached"])
    assert free.warnings == ()
