"""Whole sessions with simulated devices, in simulated time."""

import json
import re
import tomllib
from dataclasses import replace
from typing import ClassVar

import numpy as np
import pytest

from bench_hw.capture.order import check_order
from bench_hw.capture.session import capture
from bench_hw.clock import SimulatedClock
from bench_hw.devices.lac import LacActuator
from bench_hw.devices.netft import NetFTSensor
from bench_hw.devices.netft_network import RdtSocket
from bench_hw.errors import DeviceError, InputError
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.rig_file import load_rig
from bench_hw.simulated.specimen import Response
from bench_hw.trial_file import read_trial_mcap
from bench_hw.trial_file.inspection import inspect_trial
from bench_hw.trial_file.reading import read_contents


def channels(path):
    return inspect_trial(path).to_dict()["channels"]


def test_a_session_of_three_trials(record, session):
    outcome = record(trials=3)
    assert outcome.fault is None
    assert [path.name for path in outcome.trials] == ["trial_001.mcap", "trial_002.mcap", "trial_003.mcap"]
    listed = tomllib.loads((session / "session.toml").read_text())
    assert (listed["schema"], listed["name"], listed["synthetic"]) == (1, "session", True)
    assert listed["trials"] == [{"file": f"trial_00{k}.mcap", "condition": "quick"} for k in (1, 2, 3)]
    assert not list(session.glob("*.part"))


def test_what_was_measured_is_the_press(record):
    (path,) = record().trials
    trial = read_trial_mcap(path)
    assert np.all(np.diff(trial.time) > 0.0)
    assert trial.depth[0] == pytest.approx(-2e-3, abs=2e-4)
    peak = trial.depth.max()
    assert peak == pytest.approx(2.05e-3, abs=2e-4)  # 2 mm from a touch of 0.05 N, less the dead band
    held = trial.force[np.argmax(trial.depth) + 150]
    assert held == pytest.approx(600 * peak * (1 + peak / 6e-3), rel=0.05)
    in_air = trial.force[trial.depth < -0.5e-3]
    assert np.abs(in_air).max() < 0.015


def test_every_channel_is_gapless_on_one_clock(record):
    (path,) = record(camera=True).trials
    found = channels(path)
    assert [found[name]["lost"] for name in ("force", "depth", "camera")] == [0, 0, 0]
    assert found["force"]["rate_hz"] == pytest.approx(1000.0, rel=1e-3)
    assert found["depth"]["rate_hz"] == pytest.approx(100.0, rel=0.02)
    assert found["camera"]["rate_hz"] == pytest.approx(30.0, rel=0.01)
    ends = [found[name]["last_time_s"] for name in ("force", "depth", "camera")]
    assert max(ends) - min(ends) < 0.06
    assert min(found[name]["first_time_s"] for name in found) >= 0.0


def test_devices_and_fingerprints_are_kept(record, session):
    (path,) = record(camera=True).trials
    trial = inspect_trial(path).to_dict()["trial"]
    assert trial["serials"] == {"force": "FT00000", "actuator": "LAC00001"}
    assert {device: len(mark) for device, mark in trial["calibrations"].items()} == {"force": 64, "camera": 64}
    assert trial["synthetic"] is True
    log = json.loads((session / "capture.json").read_text())
    assert log["devices"]["force"]["serial"] == "FT00000"
    assert log["trials"][0]["fault"] is None
    assert log["trials"][0]["force"]["lost"] == 0
    assert log["trials"][0]["camera"]["received"] > 30


def test_the_same_seed_gives_the_same_noise(record, tmp_path):
    def in_air(name, **options):
        return read_trial_mcap(record(out=tmp_path / name, **options).trials[0]).force[:200]

    first, second, other = in_air("a"), in_air("b"), in_air("c", seed=9)
    assert len(np.intersect1d(first, second)) > 180  # the machine may deliver a record a turn later
    assert len(np.intersect1d(first, other)) < 40  # a few coincide: they are whole counts


def test_a_simulated_camera_leaves_its_true_optics(record, session):
    record(camera=True)
    camera = tomllib.loads((session / "camera.toml").read_text())
    assert camera["image_size"] == [640, 480]
    assert camera["plane"]["mm_per_px"] == pytest.approx(70.0 / 582.0)
    assert set(camera["distortion"]) == {"k1", "k2", "p1", "p2", "k3"}
    listed = tomllib.loads((session / "session.toml").read_text())
    assert listed["camera"] == {
        "marker_rows": 3, "marker_columns": 6, "marker_spacing": "8 mm", "file": "camera.toml",
        "distance": "70 mm",
    }  # fmt: skip
    assert listed["support"] == {"kind": "hole", "hole_radius": "30 mm"}


def test_a_rigs_own_calibration_is_copied(record, session, tmp_path):
    calibration = tmp_path / "camera.toml"
    calibration.write_text("schema = 1\n")
    record(camera=True, rig={"camera": {"calibration": str(calibration)}})
    assert (session / "camera.toml").read_text() == "schema = 1\n"


def test_keys_of_the_session_file_can_be_given(record, session):
    record(specimen=None, session_keys={"tool.radius": "5 mm", "drive.channel": "depth", "camera.centre_marker": "3"})
    listed = tomllib.loads((session / "session.toml").read_text())
    assert listed["tool"] == {"radius": "5 mm"}
    assert listed["drive"] == {"channel": "depth"}
    assert listed["camera"] == {"centre_marker": 3}


def test_depth_zero_is_found_by_touching_where_the_rig_does_not_say(order, watcher):
    asked = order(rig={"simulation": {"contact": "7.5 mm"}})
    rig = asked.rig.rig
    silent = rig.model_copy(update={"actuator": rig.actuator.model_copy(update={"contact": None})})
    seen = watcher()
    outcome = capture(replace(asked, rig=replace(asked.rig, rig=silent)), seen)
    assert "touching once to find depth zero" in seen.said[0]
    trial = read_trial_mcap(outcome.trials[0])
    pressed = trial.depth[trial.force > 0.2]
    assert 0.0 < pressed.min() < 0.5e-3
    assert trial.depth.max() == pytest.approx(2e-3, abs=2e-4)


REST = 'schema = 1\nname = "rest"\n[[segments]]\nkind = "rest"\nduration = "0.3 s"\n'


@pytest.mark.parametrize(("contact", "depth"), [(None, 0.0), ("1 mm", -1e-3)])
def test_a_protocol_that_only_rests_stays_where_the_tool_is(order, watcher, tmp_path, contact, depth):
    path = tmp_path / "rest.toml"
    path.write_text(REST)
    actuator = {} if contact is None else {"contact": contact}
    rig = {"actuator": {"kind": "simulated", "stroke": "50 mm", **actuator}}
    resting = order(rig=rig, protocol=load_protocol(path))
    if contact is None:
        resting = replace(resting, rig=replace(resting.rig, rig=without_contact(resting.rig.rig)))
    seen = watcher()
    (file,) = capture(resting, seen).trials
    found = read_contents(file).depth
    assert not seen.said
    assert np.isnan(found.target).all()  # it was never told to go anywhere
    assert np.abs(found.depth - depth).max() == 0.0


def without_contact(rig):
    return rig.model_copy(update={"actuator": rig.actuator.model_copy(update={"contact": None})})


def test_a_specimen_of_ones_own(record):
    def spring(time, depth, start):
        force = np.zeros((len(depth) - start, 3))
        force[:, 2] = 1500.0 * np.maximum(depth[start:], 0.0)
        return Response(force, np.zeros((len(depth) - start, 1, 3)))

    trial = read_trial_mcap(record(specimen=spring).trials[0])
    assert trial.force.max() == pytest.approx(1500.0 * trial.depth.max(), rel=0.05)


def test_a_specimen_that_scatters_lies_anew_for_every_trial(record):
    class Shifting:
        laid: ClassVar[list[float]] = []

        def __call__(self, time, depth, start):
            force = np.zeros((len(depth) - start, 3))
            force[:, 2] = 1500.0 * np.maximum(depth[start:], 0.0)
            return Response(force, np.zeros((len(depth) - start, 1, 3)))

        def laid_anew(self, rng):
            self.laid.append(2e-4 * rng.standard_normal())
            return self, self.laid[-1]

    touches = []
    for path in record(specimen=Shifting(), trials=3).trials:
        trial = read_trial_mcap(path)
        rising = slice(0, int(np.argmax(trial.force)))
        touches.append(np.interp(0.5, trial.force[rising], trial.depth[rising]) - 0.5 / 1500.0)
    assert touches == pytest.approx(Shifting.laid, abs=3e-5)
    assert np.ptp(touches) > 1e-4


@pytest.mark.parametrize(("bias", "in_air"), [(True, 0.0), (False, 0.03)])
def test_force_is_zeroed_in_air_before_each_trial_if_the_rig_says_so(record, bias, in_air):
    def with_offset(time, depth, start):
        force = np.zeros((len(depth) - start, 3))
        force[:, 2] = 0.03 + 600.0 * np.maximum(depth[start:], 0.0)
        return Response(force, np.zeros((len(depth) - start, 1, 3)))

    outcome = record(specimen=with_offset, trials=2, rig={"force": {"bias": bias}})
    for path in outcome.trials:
        trial = read_trial_mcap(path)
        assert trial.force[trial.depth < -1e-3].mean() == pytest.approx(in_air, abs=5e-3)


def test_a_sensor_that_delivers_too_seldom_is_refused_before_anything_moves(record, session):
    rig = {"force": {"mode": "buffered", "rate": "20 Hz"}}
    with pytest.raises(InputError, match=r"delivers every 50 ms in this mode; allowed is 0\.5 of safety"):
        record(rig=rig)
    assert not session.exists()


def test_buffered_mode_records_the_same_press(record):
    (path,) = record(rig={"force": {"mode": "buffered"}}).trials
    found = channels(path)["force"]
    assert found["lost"] == found["gaps"] == 0
    assert found["rate_hz"] == pytest.approx(1000.0, rel=0.01)


def test_trials_of_another_condition_can_be_appended(record, session):
    record(trials=2, condition="slow")
    first = (session / "trial_001.mcap").read_bytes()
    record(trials=1, condition="fast", append=True)
    listed = tomllib.loads((session / "session.toml").read_text())
    assert [trial["condition"] for trial in listed["trials"]] == ["slow", "slow", "fast"]
    assert listed["trials"][2]["file"] == "trial_003.mcap"
    assert (session / "trial_001.mcap").read_bytes() == first
    assert {"capture.json", "capture-2.json"} <= {path.name for path in session.iterdir()}


@pytest.mark.parametrize("seed", [None, 7])
def test_appended_trials_are_no_copies(record, seed):
    found = [read_trial_mcap(record(append=more, seed=seed).trials[0]).force[:200] for more in (False, True, True)]
    for first, second in ((0, 1), (0, 2), (1, 2)):
        assert len(np.intersect1d(found[first], found[second])) < 40


def test_an_existing_session_is_not_touched(record, session):
    record()
    before = {path.name: path.read_bytes() for path in session.iterdir()}
    with pytest.raises(InputError, match="not empty and nothing in it is overwritten"):
        record()
    assert {path.name: path.read_bytes() for path in session.iterdir()} == before


def test_what_is_lost_is_said_after_each_trial(record, watcher):
    seen = watcher()
    faults = [{"kind": "camera_freeze", "at": "1 s", "duration": "0.3 s"}]
    rig = {"force": {"loss": 0.2}, "camera": {"loss": 0.2}, "simulation": {"faults": faults}}
    record(progress=seen, rig=rig, camera=True, trials=2)
    said = [each for each in seen.said if each.startswith("trial_00")]
    words = ("force records are lost", "pictures are lost", "pictures are the one before to the byte")
    assert [sum(word in each for each in said) for word in words] == [2, 2, 1]
    lost, whole = map(int, said[0].removeprefix("trial_001: ").split(" force")[0].split(" of "))
    assert lost / whole == pytest.approx(0.2, abs=0.03)


def test_datagrams_that_are_no_records_are_told_of(record, watcher, monkeypatch):
    receive = RdtSocket.receive

    def half(self):
        datagrams = receive(self)
        self.malformed += len(datagrams)
        return datagrams

    monkeypatch.setattr(RdtSocket, "receive", half)
    seen = watcher()
    record(progress=seen)
    (said,) = (each for each in seen.said if "were no records" in each)
    assert re.fullmatch(r"trial_001: \d{3,} datagrams of the force sensor were no records", said)


def test_what_is_lost_while_nobody_reads_is_none_of_the_next_trial(record, session, watcher, monkeypatch):
    """A pause is longer than the socket's buffer holds: here, of a hundred datagrams at a time ten are kept."""
    receive = RdtSocket.receive

    def overflow(self):
        datagrams = receive(self)
        return datagrams[:5] + datagrams[-5:] if len(datagrams) > 100 else datagrams

    monkeypatch.setattr(RdtSocket, "receive", overflow)
    seen = watcher()
    record(progress=seen, trials=2, pause=5.0)
    log = json.loads((session / "capture.json").read_text())["trials"]
    assert [trial["force"]["lost"] for trial in log] == [0, 0]
    rows = channels(session / "trial_002.mcap")["force"]["rows"]
    assert log[1]["force"]["received"] == pytest.approx(rows, abs=5)
    assert not [each for each in seen.said if "trial_002" in each]


def test_another_rate_than_the_sensor_tells_is_said(record, watcher, monkeypatch):
    monkeypatch.setattr(NetFTSensor, "rate", 500.0)
    seen = watcher()
    record(progress=seen)
    (said,) = (each for each in seen.said if each.startswith("trial_001"))
    assert said.startswith("trial_001: force came at 1000 Hz, and the sensor tells of 500 Hz")


def test_a_board_that_answers_late_is_said(record, watcher, monkeypatch):
    """On a clock that passes while the board is asked."""
    position = LacActuator.position

    def late(self):
        clock.sleep(0.04)
        return position(self)

    class Noted(SimulatedClock):
        def __init__(self, **options):
            nonlocal clock
            super().__init__(**options)
            clock = self

    clock = SimulatedClock()
    monkeypatch.setattr("bench_hw.capture.session.SimulatedClock", Noted)
    monkeypatch.setattr(LacActuator, "position", late)
    seen = watcher()
    record(progress=seen)
    (said,) = (each for each in seen.said if each.startswith("trial_001"))
    assert re.match(r"trial_001: depth came at 2\d(\.\d)? Hz, and the rig asks for 100 Hz \(actuator\.rate\)", said)


def test_pictures_of_a_camera_calibrated_otherwise_are_not_appended(record, session):
    record(camera=True)
    before = sorted(path.name for path in session.iterdir())
    with pytest.raises(InputError, match=r"camera\.toml is another calibration than that of the rig's camera"):
        record(camera=True, rig={"camera": {"distance": "90 mm"}}, append=True)
    assert sorted(path.name for path in session.iterdir()) == before
    record(camera=True, append=True)
    record(append=True)  # without a camera there is nothing to read by it


def test_the_set_up_is_kept_where_a_fault_ends_the_first_trial(order, record, session, watcher):
    """In the trial and the log; what is appended then makes the session's file."""
    keys, limit = {"tool.radius": "3.21 mm"}, {"safety": {"force_limit": "0.3 N"}}
    capture(order(rig=limit, specimen="skin_forearm", session_keys=keys), watcher())
    assert not (session / "session.toml").exists()
    told = json.loads((session / "capture.json").read_text())["session"]
    assert (told["specimen"], told["tool"]["radius"]) == ("skin_forearm", "3.21 mm")
    assert json.loads(read_contents(session / "trial_001.mcap").header.settings["session"]) == told
    with pytest.raises(InputError, match=r"--set tool.radius=4 mm: .* has '3.21 mm', which stays with --append"):
        record(append=True, session_keys={"tool.radius": "4 mm"})
    record(append=True)
    listed = tomllib.loads((session / "session.toml").read_text())
    assert [trial["file"] for trial in listed.pop("trials")] == ["trial_002.mcap"]
    assert listed == told


def test_trials_of_another_rig_are_appended_with_a_word(order, record, watcher):
    seen = watcher()
    record()
    record(append=True, progress=seen)
    assert seen.said == []
    asked = order(append=True)
    other = asked.rig.rig.model_copy(update={"name": "the other"})
    capture(replace(asked, rig=replace(asked.rig, rig=other)), seen)
    assert seen.said == [
        "--append: the session's trials were recorded with the rig 'simulated', these are with 'the other'; they are "
        "read as trials of one bench"
    ]


def test_appending_needs_a_session(record):
    with pytest.raises(InputError, match="no session to append to; leave --append out"):
        record(append=True)


def test_a_folder_with_trials_of_no_session_is_to_be_left_alone(record, session):
    record()
    (session / "session.toml").unlink()  # as a first trial leaves the folder that ended with a fault
    with pytest.raises(InputError, match="no session to append to; give another --out, without --append"):
        record(append=True)
    with pytest.raises(InputError, match=r"give another --out$"):
        record()


def test_what_a_killed_first_trial_left_is_told_with_how_to_get_at_it(record, session):
    record()
    (session / "session.toml").unlink()
    (session / "trial_001.mcap").rename(session / "trial_001.mcap.part")
    said = (
        r"trial_001\.mcap\.part was cut off; python -m bench_hw recover .*part --out .*trial_001_recovered\.mcap writes"
    )
    for append in (True, False):
        with pytest.raises(InputError, match=said):
            record(append=append)


@pytest.mark.parametrize(
    ("rig", "says"),
    [
        ({"force": {"serial": "FT1"}}, "the rig asks for 'FT1'"),
        ({"actuator": {"serial": "LAC9"}}, "the rig asks for 'LAC9'"),
    ],
)
def test_a_wrong_device_leaves_no_folder_behind(record, session, rig, says):
    with pytest.raises(DeviceError, match=says):
        record(rig=rig)
    assert not session.exists()


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"trials": 0}, "--trials 0"),
        ({"rig": {"actuator": {"max_speed": "5 mm/s"}}}, "a speed of 10 mm/s; allowed is up to"),
        ({"rig": {"safety": {"travel": ["0 mm", "6 mm"]}}}, r"depth 2 mm is position 7\.00 mm"),
        ({"rig": {"safety": {"travel": ["4 mm", "20 mm"]}}}, r"depth -2 mm is position 3\.00 mm"),
    ],
)
def test_what_cannot_be_done_is_refused_before_anything_is_opened(record, session, options, says):
    with pytest.raises(InputError, match=says):
        record(**options)
    assert not session.exists()


def test_simulated_time_is_for_simulated_devices_only(order, tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(
        'schema = 1\nname = "r"\n[force]\nkind = "netft"\nhost = "192.0.2.1"\n'
        '[actuator]\nkind = "simulated"\nstroke = "50 mm"\n'
    )
    with pytest.raises(InputError, match=r"--fast: .*has real devices \(netft\)"):
        check_order(replace(order(), rig=load_rig(path)))


def test_loss_reported_equals_loss_injected(record):
    (path,) = record(rig={"force": {"drop": "1000-1009,1200"}}).trials
    assert channels(path)["force"]["lost"] == 11


@pytest.mark.parametrize("name", ["paper_press"])
def test_the_shipped_paper_press_runs(record, name):
    outcome = record(protocol=load_protocol(name))
    assert outcome.fault is None
    assert read_trial_mcap(outcome.trials[0]).depth.max() == pytest.approx(2.0e-3, abs=1.5e-4)
