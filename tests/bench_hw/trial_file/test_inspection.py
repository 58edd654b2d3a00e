"""The verdict on a recording."""

import dataclasses

import pytest

from bench_hw.trial_file import DepthRecord, EventRecord, ForceRecord
from bench_hw.trial_file.inspection import inspect_trial
from bench_hw.trial_file.recovery import recover_trial


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
    records.append(EventRecord(52.5, "force_limit", "6.1 N is over the limit of 6 N", "fault"))
    result = inspect_trial(record(records)).to_dict()
    assert result["complete"] is True
    assert result["channels"]["force"]["saturated"] == 3
    assert result["faults"] == [
        "force_limit at 2.500 s: 6.1 N is over the limit of 6 N",
        "force sensor: transducer saturated in 3 rows, first at 0.100 s",
    ]


def test_drift_is_the_unloaded_force_after_less_before(record):
    def press(time: float) -> float:
        return 0.05 + (0.12 if time > 3.0 else 0.0) + (3.0 if 1.0 < time < 3.0 else 0.0)

    def depth(time: float) -> float:
        return 2e-3 if 1.0 < time < 3.0 else 0.0

    force = [ForceRecord(n / 100, n, n, 0, (0.0, 0.0, -press(n / 100)), (0.0, 0.0, 0.0)) for n in range(401)]
    depths = [DepthRecord(n / 50, depth(n / 50)) for n in range(201)]
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
