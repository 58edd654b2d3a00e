"""Whatever goes wrong: the tool goes back, the trial can be read, and the fault is named in it."""

import json
import os
import signal

import numpy as np
import pytest

from bench_hw.capture import trial as trial_module
from bench_hw.capture.loop import Loop
from bench_hw.capture.progress import stop_on_signals, stopped_by
from bench_hw.capture.session_folder import SessionFolder
from bench_hw.devices.http_camera import HttpCamera
from bench_hw.devices.lac import LacActuator
from bench_hw.errors import DeviceError, TrialFileError
from bench_hw.simulated.netft_box import NetFTBox
from bench_hw.simulated.twins import Twins
from bench_hw.trial_file import read_trial_mcap
from bench_hw.trial_file.inspection import inspect_trial


def assert_safe(outcome, session, kind, depth_at_fault=None):
    """One unfinished trial: fault named, tool going back in it, not listed as a good one."""
    assert outcome.fault.kind == kind
    assert outcome.fault.retracted
    assert outcome.trials == ()
    assert not (session / "session.toml").exists()
    path = session / "trial_001.mcap"
    inspection = inspect_trial(path).to_dict()
    assert any(kind in json.dumps(fault) for fault in inspection["faults"])
    trial = read_trial_mcap(path)
    deepest = int(np.argmax(trial.depth))
    assert trial.depth[-1] < trial.depth[deepest] - 1e-3
    log = json.loads((session / "capture.json").read_text())
    assert log["trials"][0]["fault"]["kind"] == kind
    return trial


def timed(kind, at, **more):
    return {"simulation": {"faults": [{"kind": kind, "at": at, **more}]}}


def test_over_the_force_limit(record, session):
    outcome = record(rig={"safety": {"force_limit": "1 N"}}, trials=3)
    trial = assert_safe(outcome, session, "force_limit")
    assert "is above the limit of 1 N" in outcome.fault.message
    assert 1.0 < trial.force.max() < 1.2


def test_silent_force_data(record, session):
    outcome = record(rig=timed("force_stall", "1.0 s", duration="10 s"))
    assert outcome.fault.kind == "force_stale"
    assert "no new force data for" in outcome.fault.message
    found = inspect_trial(session / "trial_001.mcap").to_dict()["channels"]
    assert found["force"]["last_time_s"] < found["depth"]["last_time_s"] - 0.9


def test_a_simulated_box_held_up_by_a_busy_machine_is_no_fault(record, monkeypatch):
    """From 1 s on its thread gets no turn: it sends only what the loop lets it catch up with."""
    tick = NetFTBox.tick
    catching_up = []

    def held_up(self, now):
        if now < 1.0 or catching_up:
            tick(self, now)

    def catch_up(self):
        catching_up.append(True)
        self.box.tick(self.clock.now())
        catching_up.clear()

    monkeypatch.setattr(NetFTBox, "tick", held_up)
    monkeypatch.setattr(Twins, "catch_up", catch_up)
    assert record().fault is None


def test_repeating_force_data(record, session):
    assert_safe(record(rig=timed("force_freeze", "1.5 s")), session, "force_stale")


def test_a_reading_that_stays_the_same_under_new_numbers(record, session):
    trial = assert_safe(record(rig=timed("force_constant", "1.5 s")), session, "force_frozen")
    last_change = trial.time[np.flatnonzero(np.diff(trial.force))[-1] + 1]
    events = inspect_trial(session / "trial_001.mcap").events
    fault = next(event for event in events if event["level"] == "fault")
    assert fault["time_s"] - last_change == pytest.approx(0.25, abs=0.01)


def test_a_simulated_sensor_without_noise_may_stay_the_same(record):
    assert record(rig={"force": {"noise": "0 N"}}).fault is None


def test_a_saturated_sensor(record, session):
    assert_safe(record(rig=timed("force_saturated", "1.5 s", duration="0.2 s")), session, "force_saturated")


def test_usb_unplugged_and_back(record, session):
    outcome = record(rig=timed("usb_unplug", "1.5 s", duration="0.5 s"))
    assert_safe(outcome, session, "actuator_lost")
    assert "unplugged" in outcome.fault.message


def test_usb_unplugged_for_good_says_that_the_tool_stands(record, session):
    outcome = record(rig=timed("usb_unplug", "1.5 s"))
    assert outcome.fault.kind == "actuator_lost"
    assert not outcome.fault.retracted
    assert "could NOT be sent back within 3 s" in outcome.fault.message
    assert "cut the actuator's power" in outcome.fault.message
    found = inspect_trial(session / "trial_001.mcap").to_dict()
    assert found["channels"]["force"]["rows"] > 3000  # force went on being recorded meanwhile
    assert found["faults"]


def test_usb_that_does_not_answer(record, session):
    assert_safe(record(rig=timed("usb_timeout", "1.5 s", duration="0.05 s")), session, "actuator_lost")


def test_a_lost_camera(record, session):
    outcome = record(rig=timed("camera_unplug", "1.5 s"), camera=True)
    assert_safe(outcome, session, "camera_lost")


def test_a_frozen_camera_is_counted_and_no_fault(record, session):
    outcome = record(rig=timed("camera_freeze", "1.0 s", duration="0.3 s"), camera=True)
    assert outcome.fault is None
    log = json.loads((session / "capture.json").read_text())
    assert log["trials"][0]["camera"]["frozen"] >= 8


def test_what_a_camera_complains_of_once_is_no_delay(record, session, monkeypatch):
    read, turns = HttpCamera.read, []

    def complain_once(self):
        turns.append(1)
        if len(turns) == 500:
            raise DeviceError("gives 320 x 240 pixels")
        return read(self)

    monkeypatch.setattr(HttpCamera, "read", complain_once)
    outcome = record(camera=True)
    assert_safe(outcome, session, "camera_lost")
    assert "gives 320 x 240 pixels" in outcome.fault.message


def test_a_camera_that_stays_frozen_is_a_fault(record, session):
    outcome = record(rig=timed("camera_freeze", "0.8 s"), camera=True)
    assert_safe(outcome, session, "camera_frozen")
    assert "the one before to the byte for 1.0 s" in outcome.fault.message


def test_a_simulated_camera_without_noise_may_repeat_its_picture(record):
    assert record(rig={"camera": {"noise": 0.0}} | timed("camera_freeze", "0.8 s"), camera=True).fault is None


def test_a_slow_camera_is_not_lost_between_two_pictures(record, session):
    assert record(rig={"camera": {"rate": "0.6 Hz"}}, camera=True).fault is None
    assert inspect_trial(session / "trial_001.mcap").to_dict()["channels"]["camera"]["rows"] >= 1


def test_ctrl_c(record, session, watcher):
    def press_ctrl_c(snapshot):
        if snapshot.depth > 1.5e-3 and not pressed:
            pressed.append(snapshot.depth)
            os.kill(os.getpid(), signal.SIGINT)

    pressed = []
    before = signal.getsignal(signal.SIGINT)
    outcome = record(progress=watcher(press_ctrl_c), trials=5)
    assert_safe(outcome, session, "interrupted")
    assert signal.getsignal(signal.SIGINT) is before


def test_ctrl_c_between_two_trials(record, session, monkeypatch):
    add_trial = SessionFolder.add_trial

    def add_and_press_ctrl_c(self, file, condition):
        add_trial(self, file, condition)
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(SessionFolder, "add_trial", add_and_press_ctrl_c)
    outcome = record(trials=3, pause=1.0)
    assert (outcome.fault.kind, outcome.fault.retracted) == ("interrupted", True)
    assert len(outcome.trials) == 1
    assert [path.name for path in session.glob("trial_*")] == ["trial_001.mcap"]


def test_a_second_ctrl_c_interrupts_whatever_hangs():
    with stop_on_signals() as stop:
        os.kill(os.getpid(), signal.SIGINT)
        assert stop.wait(5.0)
        with pytest.raises(KeyboardInterrupt):
            os.kill(os.getpid(), signal.SIGINT)


@pytest.mark.parametrize(("number", "by"), [(signal.SIGINT, "Ctrl-C"), (signal.SIGTERM, "SIGTERM")])
def test_what_stops_a_capture_is_told(number, by):
    with stop_on_signals() as stop:
        os.kill(os.getpid(), number)
        assert stop.wait(5.0)
        assert stopped_by(stop) == by


def test_a_session_file_that_cannot_be_written_leaves_the_trial_and_no_tool_in_the_specimen(
    record, session, monkeypatch
):
    sent = []
    retract = LacActuator.retract
    monkeypatch.setattr(LacActuator, "retract", lambda self: (sent.append("back"), retract(self)))
    monkeypatch.setattr("bench_hw.capture.session_folder.write_text", refuse_session_file)
    with pytest.raises(OSError, match="No space left") as caught:
        record(trials=2)
    assert caught.value.__notes__ == [
        f"{session / 'trial_001.mcap'} is whole; what stands beside it (session.toml, capture.json) is behind"
    ]
    assert sent
    assert inspect_trial(session / "trial_001.mcap").to_dict()["complete"]


def test_a_full_disk_is_told_with_the_trial_it_ended(record, session, monkeypatch):
    """Neither the trial nor the log finds room: the fault is the answer, not the log."""

    def refuse(self, record):
        raise TrialFileError(session / "trial_001.mcap.part", "the disk is full")

    def full(path, text, check=None):
        raise OSError(28, "No space left on device")

    from bench_hw.trial_file.writer import McapTrialWriter

    monkeypatch.setattr(McapTrialWriter, "write_position", refuse)
    monkeypatch.setattr("bench_hw.capture.session_folder.write_text", full)
    fault = record().fault
    assert (fault.kind, fault.retracted) == ("disk", True)
    assert "trial_001.mcap.part: the disk is full" in fault.message
    assert "capture.json cannot be written either (No space left on device)" in fault.message


def test_a_second_ctrl_c_closes_the_file_with_its_fault(record, session, watcher):
    def press_ctrl_c_twice(snapshot):
        if snapshot.depth > 1.5e-3:
            os.kill(os.getpid(), signal.SIGINT)

    def interrupt(self, duration):
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Loop, "coast", interrupt)
        with pytest.raises(KeyboardInterrupt):
            record(progress=watcher(press_ctrl_c_twice))
    assert not list(session.glob("*.part"))
    inspection = inspect_trial(session / "trial_001.mcap")
    assert inspection.complete
    assert "interrupted" in inspection.faults[0]


def refuse_session_file(path, text, check=None):
    if path.name == "session.toml":
        raise OSError(28, "No space left on device")
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
    return path


def test_a_tool_that_never_touches(record, session):
    outcome = record(rig={"simulation": {"contact": "40 mm"}})
    assert outcome.fault.kind == "motion"
    assert "no touch of 0.05 N" in outcome.fault.message
    assert_safe(outcome, session, "motion")


def test_a_disk_that_refuses(record, session, monkeypatch):
    def refuse(self, record):
        if record.depth > 1e-3:
            raise TrialFileError(session / "trial_001.mcap.part", "the disk is full")
        original(self, record)

    from bench_hw.trial_file.writer import McapTrialWriter

    original = McapTrialWriter.write_position
    monkeypatch.setattr(McapTrialWriter, "write_position", refuse)
    outcome = record()
    assert outcome.fault.kind == "disk"
    assert outcome.fault.retracted
    assert "the disk is full" in outcome.fault.message


def test_a_mistake_in_the_program_sends_the_tool_back_too(record, session, watcher):
    def stumble(snapshot):
        if snapshot.depth > 1e-3:
            raise ZeroDivisionError("a mistake")

    with pytest.raises(ZeroDivisionError):
        record(progress=watcher(stumble))
    inspection = inspect_trial(session / "trial_001.mcap").to_dict()
    assert "unexpected" in json.dumps(inspection["faults"])
    depth = read_trial_mcap(session / "trial_001.mcap").depth
    assert depth[-1] < depth.max() - 1e-3


def test_a_fault_ends_the_session_after_its_good_trials(record, session):
    outcome = record(rig=timed("force_stall", "4.5 s"), trials=5)
    assert len(outcome.trials) >= 1
    assert outcome.fault.kind == "force_stale"
    assert len(list(session.glob("trial_*.mcap"))) == len(outcome.trials) + 1


def test_a_fault_before_the_first_trial_leaves_no_trial(record, session):
    with pytest.raises(DeviceError, match="no new force data"):
        record(rig=timed("force_stall", "0.1 s"))
    assert not list(session.glob("trial_*"))


def test_recording_goes_on_for_a_moment_after_a_fault(record, session):
    record(rig={"safety": {"force_limit": "1 N"}})
    inspection = inspect_trial(session / "trial_001.mcap").to_dict()
    fault = next(event for event in inspection["events"] if event["level"] == "fault")
    assert inspection["channels"]["depth"]["last_time_s"] - fault["time_s"] == pytest.approx(
        trial_module._COAST, abs=0.05
    )
