"""Force and depth of a trial joined: on the force sensor's stamps, gaps left gaps."""

import dataclasses

import numpy as np
import pytest

from bench_hw.errors import TrialFileError
from bench_hw.tables import read_trial_csv, write_trial_csv
from bench_hw.trial_file import ForceRecord, PositionRecord, read_trial_mcap

EPOCH = 50.0


def sample(number: int, time: float, status: int = 0, press: float = 1.0) -> ForceRecord:
    return ForceRecord(EPOCH + time, number, 7 * number, status, (0.1, 0.2, -press), (1.0, 2.0, 3.0))


def steady(seconds: float = 1.0, rate: int = 100) -> list[ForceRecord]:
    return [sample(n, n / rate, press=n * 0.01) for n in range(round(seconds * rate))]


def depths(times) -> list[PositionRecord]:
    return [PositionRecord(EPOCH + time, 1e-3 * time) for time in times]


def test_the_rows_are_the_force_samples_themselves(record):
    table = read_trial_mcap(record([*steady(), *depths(np.arange(0, 1.01, 0.02))]))
    np.testing.assert_array_equal(table.time, np.arange(100) / 100)
    np.testing.assert_array_equal(table.force, np.arange(100) * 0.01)
    np.testing.assert_allclose(table.depth, 1e-3 * table.time, atol=1e-15)
    assert list(table.extra) == ["force_x", "force_y", "force_z", "torque_x", "torque_y", "torque_z"]
    np.testing.assert_array_equal(table.extra["force_z"], -table.force)
    np.testing.assert_array_equal(table.extra["torque_y"], 2.0)


@pytest.mark.parametrize(
    ("axis", "press"), [("+x", 0.1), ("-x", -0.1), ("+y", 0.2), ("-y", -0.2), ("+z", -1.0), ("-z", 1.0)]
)
def test_the_press_axis_picks_component_and_sign(record, header, tmp_path, axis, press, monkeypatch):
    from bench_hw.trial_file import open_trial

    changed = dataclasses.replace(header, press_axis=axis)
    with open_trial(tmp_path / "axis.mcap", changed) as writer:
        for n in range(50):
            writer.write_force(sample(n, n / 100))
        for item in depths(np.arange(0, 0.51, 0.02)):
            writer.write_position(item)
    np.testing.assert_array_equal(read_trial_mcap(tmp_path / "axis.mcap").force, press)


def test_there_is_no_row_before_the_first_or_after_the_last_position(record):
    table = read_trial_mcap(record([*steady(), *depths(np.arange(0.2, 0.701, 0.02))]))
    assert table.time[0] == 0.2
    assert table.time[-1] == pytest.approx(0.7)


def test_a_gap_in_the_positions_is_a_gap_in_the_rows(record):
    times = [*np.arange(0, 0.301, 0.02), *np.arange(0.5, 1.0, 0.02)]
    table = read_trial_mcap(record([*steady(), *depths(times)]))
    inside = (table.time > 0.3001) & (table.time < 0.4999)
    assert not inside.any()
    assert len(table.time) == 31 + 49


def test_slow_positions_are_neighbours_by_their_own_period(record):
    table = read_trial_mcap(record([*steady(3.0), *depths(np.arange(0, 3.01, 0.2))]))
    assert len(table.time) == 300


def test_lost_force_samples_are_not_made_up(record):
    kept = [item for item in steady() if item.rdt_sequence not in range(40, 60)]
    table = read_trial_mcap(record([*kept, *depths(np.arange(0, 1.01, 0.02))]))
    assert len(table.time) == 80
    assert np.diff(table.time).max() == pytest.approx(0.21)


def test_late_doubled_faulty_and_nan_samples_are_left_out(record):
    samples = steady()
    samples[20], samples[21] = sample(21, 0.20), sample(20, 0.21)
    samples[30] = sample(29, 0.30)
    samples[40] = sample(40, 0.40, status=0x80020000)
    samples[41] = sample(41, 0.41, status=0x40000000)
    samples[42] = sample(42, 0.42, status=0x80000000)
    samples[50] = dataclasses.replace(sample(50, 0.50), force=(0.0, 0.0, float("nan")))
    samples[60] = sample(60, 0.60, status=0x80010000)
    samples[70] = sample(70, 0.69)
    table = read_trial_mcap(record([*samples, *depths(np.arange(0, 1.01, 0.02))]))
    missing = sorted(set(np.round(np.arange(100) / 100, 2)) - set(np.round(table.time, 2)))
    assert missing == [0.21, 0.30, 0.40, 0.41, 0.42, 0.50, 0.70]
    assert (np.diff(table.time) > 0).all()


def test_a_table_reads_back_from_csv(three_seconds, tmp_path):
    table = read_trial_mcap(three_seconds)
    read = read_trial_csv(write_trial_csv(tmp_path / "trial.csv", table))
    np.testing.assert_array_equal(read.time, table.time)
    np.testing.assert_allclose(read.depth, table.depth, rtol=1e-11, atol=1e-18)
    np.testing.assert_allclose(read.force, table.force, rtol=1e-11, atol=1e-15)
    assert read.extra_units == table.extra_units
    assert list(read.extra) == list(table.extra)


def test_the_press_of_the_fixture_comes_back(three_seconds):
    table = read_trial_mcap(str(three_seconds))
    press = 1 - np.abs(2 * table.time / 3.0 - 1)
    np.testing.assert_allclose(table.force, 4 * press, atol=1e-12)
    np.testing.assert_allclose(table.depth, 2e-3 * press, atol=1e-6)
    assert len(table.time) == 3000


def test_too_few_rows_no_positions_and_no_force_are_refused(record):
    for number, records in enumerate(
        ([*steady(0.19), *depths([0, 0.02, 0.04, 1.0])], steady(), depths(np.arange(0, 1, 0.02)), [])
    ):
        with pytest.raises(TrialFileError, match=r"rows with force and depth; allowed: at least 20"):
            read_trial_mcap(record(records, f"trial_{number}.mcap"))


def test_a_cut_trial_is_refused_with_the_way_out(three_seconds, tmp_path):
    content = three_seconds.read_bytes()
    path = tmp_path / "cut off.mcap"
    path.write_bytes(content[: len(content) // 2])
    with pytest.raises(TrialFileError, match=r"damaged or cut.*bench_hw recover '.*/cut off\.mcap' --out NEW\.mcap"):
        read_trial_mcap(path)
    with pytest.raises(TrialFileError, match="No such file"):
        read_trial_mcap(tmp_path / "none.mcap")
