"""A recorded trial replayed as a bench: the record comes again, its faults with it. What is recorded is synthetic."""

import io
import re

import numpy as np
import pytest
from rich.console import Console

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.progress import Silent, TerminalLine
from bench_hw.capture.session import capture
from bench_hw.clock import SimulatedClock
from bench_hw.errors import DeviceError, InputError
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.opening import open_bench
from bench_hw.rig.rig_file import load_rig, simulated_rig
from bench_hw.trial_file.encoding import CAMERA, decode_frame
from bench_hw.trial_file.inspection import inspect_trial
from bench_hw.trial_file.reading import read_contents
from bench_hw.trial_file.scan import read_messages, scan_trial

RIG = """
schema = 1
name = "rehearsal"
[replay]
trial = "{trial}"
[force]
kind = "replay"
[actuator]
kind = "replay"
stroke = "50 mm"
accuracy = 1
{camera}
"""
CAMERA_TABLE = '[camera]\nkind = "replay"'
FAULTY = {"force": {"loss": 0.01}, "camera": {"loss": 0.2, "jitter": "8 ms"}}
PRESS = """
schema = 1
name = "short"
[[segments]]
kind = "approach"
touch_force = "0.05 N"
speed = "10 mm/s"
max_depth = "15 mm"
[[segments]]
kind = "move"
depth = "2 mm"
speed = "10 mm/s"
[[segments]]
kind = "hold"
duration = "0.2 s"
[[segments]]
kind = "retract"
depth = "-2 mm"
speed = "10 mm/s"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with a recorded trial of a faulty rig, and rigs that replay it with and without its camera."""
    folder = tmp_path_factory.mktemp("bench")
    (folder / "short.toml").write_text(PRESS)
    made = capture(
        CaptureOrder(load_protocol(folder / "short.toml"), simulated_rig(FAULTY), folder / "session", fast=True),
        Silent(),
    )
    assert made.fault is None
    for name, camera in (("rehearsal.toml", CAMERA_TABLE), ("blind.toml", "")):
        (folder / name).write_text(RIG.format(trial="session/trial_001.mcap", camera=camera))
    return folder


def rehearse(folder, out, rig="blind.toml", protocol="short.toml", **options):
    """Capture from the record."""
    order = CaptureOrder(load_protocol(folder / protocol), load_rig(folder / rig), out, fast=True, **options)
    return capture(order, Silent())


def pictures(path):
    return [decode_frame(0.0, message.data).data for message in read_messages(scan_trial(path), (CAMERA.topic,))]


def test_every_sample_comes_again_with_its_number_and_its_time_and_so_do_the_faults(folder, tmp_path):
    recorded, outcome = folder / "session" / "trial_001.mcap", rehearse(folder, tmp_path / "again", "rehearsal.toml")
    assert outcome.fault is None
    then, now = (read_contents(path) for path in (recorded, *outcome.trials))
    shared = np.isin(then.force.rdt_sequence, now.force.rdt_sequence)
    assert np.count_nonzero(~shared) <= 3  # the protocol may end a turn earlier
    rows = slice(0, int(shared.sum()))
    for name in ("rdt_sequence", "ft_sequence", "status", "force", "torque"):
        assert np.array_equal(getattr(then.force, name)[rows], getattr(now.force, name)[rows]), name
    assert np.abs(then.force.time[rows] - now.force.time[rows]).max() < 2e-9
    frames = min(len(then.camera.time), len(now.camera.time))
    assert frames > 10
    assert np.array_equal(then.camera.frame[:frames], now.camera.frame[:frames])
    assert np.abs(then.camera.time[:frames] - now.camera.time[:frames]).max() < 2e-9
    assert pictures(recorded)[:frames] == pictures(*outcome.trials)[:frames]
    depths = min(len(then.depth.time), len(now.depth.time))
    assert depths > 50
    assert np.array_equal(then.depth.counts[:depths], now.depth.counts[:depths])
    assert np.abs(then.depth.depth[:depths] - now.depth.depth[:depths]).max() < 1e-9
    lost = [inspect_trial(path).to_dict()["channels"] for path in (recorded, *outcome.trials)]
    assert lost[0]["force"]["lost"] == lost[1]["force"]["lost"] > 5
    assert abs(lost[1]["camera"]["lost"] - lost[0]["camera"]["lost"]) <= 1  # one may fall after the last turn
    assert lost[0]["camera"]["lost"] > 2


def test_a_recorded_silence_ends_the_trial_as_it_did(order, tmp_path, watcher):
    stall = {
        "simulation": {
            "seed": 1,
            "contact": "5 mm",
            "faults": [{"kind": "force_stall", "at": "1.2 s", "duration": "5 s"}],
        }
    }
    first = order(rig=stall)
    outcome = capture(first, watcher())
    assert outcome.fault.kind == "force_stale"
    (recorded,) = (tmp_path / "session").glob("*.mcap")
    path = tmp_path / "rehearsal.toml"
    path.write_text(RIG.format(trial=recorded.relative_to(tmp_path), camera=""))
    again = capture(CaptureOrder(first.protocol, load_rig(path), tmp_path / "again", fast=True), watcher())
    assert again.fault.kind == "force_stale"
    assert again.fault.retracted
    times = [
        read_contents(next(folder.glob("*.mcap"))).events[-1].time
        for folder in (tmp_path / "session", tmp_path / "again")
    ]
    assert times[1] == pytest.approx(times[0], abs=0.004)


def test_a_rehearsal_is_labelled(folder, tmp_path):
    outcome = rehearse(folder, tmp_path / "again")
    trial = inspect_trial(outcome.trials[0]).to_dict()["trial"]
    assert trial["synthetic"] is True
    assert trial["serials"] == {"force": "FT00000", "actuator": "LAC00001"}
    assert trial["settings"]["force.replayed"] == "trial_001.mcap"
    assert "synthetic = true" in (tmp_path / "again" / "session.toml").read_text()


def test_another_protocol_is_refused(folder, tmp_path):
    (folder / "other.toml").write_text('schema = 1\nname = "other"\n[[segments]]\nkind = "rest"\nduration = "1 s"\n')
    with pytest.raises(InputError, match=r"recorded with another protocol.*replay\.trial"):
        rehearse(folder, tmp_path / "again", protocol="other.toml")
    assert not list(tmp_path.rglob("*.mcap*"))


def test_a_terminal_shows_one_line_that_is_drawn_again(folder, tmp_path):
    shown = io.StringIO()
    order = CaptureOrder(
        load_protocol(folder / "short.toml"), load_rig(folder / "rehearsal.toml"), tmp_path / "again", fast=True
    )
    capture(order, TerminalLine(Console(file=shown, force_terminal=True, width=120)))
    text = shown.getvalue()
    assert text.count("\n") == 1  # the line is left standing at the end
    last = text.rsplit("\x1b[2K", 1)[-1]
    assert re.search(r"trial 1/1 \d\.\d/\d\.\d s  depth [+-]\d\.\d{3} mm  force [+-]\d\.\d{3} N", last)
    assert re.search(r"camera \d\d\.\d/s dropped [1-9]\d*  lost [1-9]", last)


def test_one_trial_only(folder, tmp_path):
    with pytest.raises(InputError, match="replays one trial; allowed is 1"):
        rehearse(folder, tmp_path / "again", trials=2)


@pytest.mark.parametrize(
    "text",
    [
        RIG.format(trial="t.mcap", camera="").replace("[replay]\ntrial", "[safety]\nforce_limit = '6 N'\n#"),
        RIG.format(trial="t.mcap", camera='[camera]\nkind = "http"\nurl = "http://127.0.0.1:9/"'),
    ],
)
def test_a_replay_is_of_all_devices_and_names_its_trial(tmp_path, text):
    path = tmp_path / "rig.toml"
    path.write_text(text)
    with pytest.raises(InputError, match="replay is of every device together"):
        load_rig(path)


def test_a_tool_that_was_sent_back_leaves_the_record(folder):
    clock = SimulatedClock(step=2e-3)
    with open_bench(load_rig(folder / "blind.toml"), clock) as bench:
        bench.begin_trial(clock.now())
        clock.sleep(0.5)
        assert bench.actuator.position() > 5e-3
        bench.actuator.retract()
        clock.sleep(1.0)
        assert bench.actuator.position() == 0.0


def test_the_end_of_the_record_is_a_fault(folder):
    clock = SimulatedClock(step=2e-3)
    with open_bench(load_rig(folder / "blind.toml"), clock) as bench:
        bench.begin_trial(clock.now())
        clock.sleep(5.0)
        with pytest.raises(DeviceError, match=r"trial_001\.mcap ends at .* s, and the protocol goes on"):
            bench.force.read()
