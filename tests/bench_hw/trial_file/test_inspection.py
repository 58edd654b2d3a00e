"""Rate, jitter, gaps and losses of one channel."""

import dataclasses

import numpy as np
import pytest

from bench_hw.trial_file import EventRecord, ForceRecord, PositionRecord
from bench_hw.trial_file.inspection import inspect_trial, report_channel
from bench_hw.trial_file.recovery import recover_trial


def test_an_empty_channel_has_no_figures():
    report = report_channel(np.zeros(0), np.zeros(0, dtype=np.int64))
    assert report.rows == 0
    assert report.to_dict()["first_time_s"] is None
    assert report.rate is None


def test_one_row_has_a_time_and_no_rate():
    report = report_channel(np.array([2.5]), np.array([9]))
    assert (report.rows, report.first_time, report.last_time) == (1, 2.5, 2.5)
    assert (report.rate, report.jitter, report.longest_interval) == (None, None, None)


def test_lost_records_do_not_lower_the_rate_of_the_device():
    number = np.delete(np.arange(1000), [200, 201, 202, 500])
    report = report_channel(number / 1000.0, number)
    assert (report.lost, report.gaps, report.reordered) == (4, 2, 0)
    assert report.rate == pytest.approx(1000.0)
    assert report.longest_interval == pytest.approx(0.004)


def test_jitter_is_the_spread_of_intervals_between_neighbours():
    number = np.arange(5000)
    noise = np.random.default_rng(3).normal(0.0, 1e-4, 5000)
    report = report_channel(number / 100.0 + noise, number)
    assert report.jitter == pytest.approx(np.sqrt(2) * 1e-4, rel=0.05)


def test_what_rounding_scatters_is_no_jitter():
    number = np.arange(5000)
    assert report_channel(number / 1000.0, number).jitter == 0.0
    assert report_channel(np.round(number / 30.0, 9), number).jitter == 0.0


def test_a_pause_without_a_number_skipped_is_a_gap_but_nothing_lost():
    number = np.arange(1000)
    time = number / 1000.0 + np.where(number >= 400, 0.06, 0.0)
    report = report_channel(time, number)
    assert (report.lost, report.gaps) == (0, 1)
    short = report_channel(number / 1000.0 + np.where(number >= 400, 0.03, 0.0), number)
    assert short.gaps == 0


def test_a_camera_that_does_not_say_so_is_found_to_drop_frames():
    frame = np.arange(90)
    time = (frame + np.where(frame >= 40, 2, 0) + np.where(frame >= 70, 1, 0)) / 30.0
    silent = report_channel(time, frame, camera=True)
    assert (silent.lost, silent.gaps) == (3, 2)
    honest = report_channel(time, np.rint(time * 30).astype(np.int64), camera=True)
    assert (honest.lost, honest.gaps) == (3, 2)


def test_late_records_are_not_lost():
    number = np.arange(100)
    number[[50, 51]] = number[[51, 50]]
    report = report_channel(np.arange(100) / 100.0, number)
    assert (report.lost, report.reordered, report.gaps) == (0, 1, 0)


def test_a_restart_is_counted_and_the_rate_stays_sound():
    number = np.concatenate([np.arange(5000, 5500), np.arange(1, 501)])
    report = report_channel(np.arange(1000) / 1000.0, number)
    assert (report.restarts, report.lost) == (1, 0)
    assert report.rate == pytest.approx(1000.0)


def test_a_frame_that_came_late_is_not_lost():
    time = np.arange(60) / 30
    time[20] += 0.7 / 30
    late = report_channel(time, np.arange(60), camera=True)
    assert (late.lost, late.gaps) == (0, 0)
    dropped = report_channel(np.delete(time, 40), np.arange(59), camera=True)
    assert (dropped.lost, dropped.gaps) == (1, 1)


def test_a_sound_trial(three_seconds):
    result = inspect_trial(three_seconds).to_dict()
    assert result["schema"] == 1
    assert result["complete"] is True
    assert result["faults"] == []
    assert list(result["channels"]) == ["force", "depth", "camera"]
    force, depth, camera = result["channels"].values()
    assert (force["rows"], depth["rows"], camera["rows"]) == (3000, 301, 90)
    assert (force["first_time_s"], force["last_time_s"]) == (0.0, 2.999)
    for channel, rate in ((force, 1000), (depth, 100), (camera, 30)):
        assert channel["rate_hz"] == pytest.approx(rate, rel=1e-6)
        assert channel["lost"] == channel["gaps"] == channel["reordered"] == channel["duplicates"] == 0
        assert channel["jitter_ms"] < 1e-5
    assert force["saturated"] == 0
    assert result["trial"]["serials"]["force"] == "FT12345"
    assert result["trial"]["synthetic"] is True
    assert result["events"] == [{"time_s": 0.0, "kind": "segment", "level": "info", "message": "begins"}]


def test_losses_that_were_injected_are_reported(make_records, record):
    dropped = {200, 201, 202, 500}
    records = [
        item for item in make_records(2.0) if not (isinstance(item, ForceRecord) and item.rdt_sequence in dropped)
    ]
    force = inspect_trial(record(records)).to_dict()["channels"]["force"]
    assert (force["rows"], force["lost"], force["gaps"]) == (1996, 4, 2)
    assert force["rate_hz"] == pytest.approx(1000)


def test_faults_name_what_the_capture_saw_and_what_the_sensor_said(make_records, record):
    records = make_records(2.0)
    for number, item in enumerate(records):
        if isinstance(item, ForceRecord) and 100 < item.rdt_sequence <= 103:
            records[number] = dataclasses.replace(item, status=0x80020000)
        if isinstance(item, ForceRecord) and item.rdt_sequence == 900:
            records[number] = dataclasses.replace(item, status=0x80010000)
        if isinstance(item, ForceRecord) and item.rdt_sequence == 950:
            records[number] = dataclasses.replace(item, status=0x80000000)
    records.append(EventRecord(52.5, "force_limit", "6.1 N is over the limit of 6 N", "fault"))
    result = inspect_trial(record(records)).to_dict()
    assert result["complete"] is True
    assert result["channels"]["force"]["saturated"] == 3
    assert result["faults"] == [
        "force_limit at 2.500 s: 6.1 N is over the limit of 6 N",
        "force sensor: an error whose cause is not named in 1 rows, first at 0.949 s",
        "force sensor: transducer saturated in 3 rows, first at 0.100 s",
    ]


def test_drift_is_the_unloaded_force_after_less_before(record):
    def press(time: float) -> float:
        return 0.05 + (0.12 if time > 3.0 else 0.0) + (3.0 if 1.0 < time < 3.0 else 0.0)

    def depth(time: float) -> float:
        return 2e-3 if 1.0 < time < 3.0 else 0.0

    force = [ForceRecord(n / 100, n, n, 0, (0.0, 0.0, -press(n / 100)), (0.0, 0.0, 0.0)) for n in range(401)]
    depths = [PositionRecord(n / 50, depth(n / 50)) for n in range(201)]
    there_and_back = [dataclasses.replace(item, time=item.time + 50) for item in (*force, *depths)]
    result = inspect_trial(record(there_and_back)).to_dict()
    assert result["channels"]["force"]["drift_N"] == pytest.approx(0.12)
    staying = [item for item in there_and_back if item.time < 52.9]
    result = inspect_trial(record(staying, "trial_002.mcap")).to_dict()
    assert result["channels"]["force"]["drift_N"] is None


def test_a_cut_trial_and_its_recovery_are_not_complete(three_seconds, tmp_path):
    content = three_seconds.read_bytes()
    cut = tmp_path / "trial_009.mcap.part"
    cut.write_bytes(content[: len(content) // 2])
    before = inspect_trial(cut).to_dict()
    assert before["complete"] is False
    assert "stops without its end" in before["faults"][-1]
    recover_trial(cut, tmp_path / "new.mcap")
    after = inspect_trial(tmp_path / "new.mcap").to_dict()
    assert after["complete"] is False
    assert after["channels"] == before["channels"]
    assert after["trial"] == before["trial"]
    assert "recovered from one that had lost something" in after["faults"][0]
    again = recover_trial(tmp_path / "new.mcap", tmp_path / "again.mcap")
    assert again.whole
    assert inspect_trial(tmp_path / "again.mcap").complete is False


def test_a_trial_without_a_camera_has_no_such_channel(make_records, record):
    result = inspect_trial(record(make_records(1.0, fps=0))).to_dict()
    assert list(result["channels"]) == ["force", "depth"]


def test_a_trial_in_which_nothing_came_is_complete_and_empty(record):
    result = inspect_trial(record([])).to_dict()
    assert (result["complete"], result["channels"]) == (True, {})
