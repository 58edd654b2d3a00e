"""Captures as processes in real time: the same files as in simulated time, killed, interrupted, out of disk."""

import json
import random
import resource
import signal
import subprocess
import sys
import time
import tomllib
from datetime import datetime

import numpy as np
import pytest

from bench_hw.capture.order import CaptureOrder
from bench_hw.capture.progress import Silent
from bench_hw.capture.session import capture
from bench_hw.motion.protocol_file import load_protocol
from bench_hw.rig.rig_file import load_rig
from bench_hw.trial_file import read_trial_mcap
from bench_hw.trial_file.inspection import inspect_trial

pytestmark = pytest.mark.slow

RIG = """
schema = 1
name = "simulated without camera"
[force]
kind = "simulated"
rate = "1000 Hz"
[actuator]
kind = "simulated"
stroke = "50 mm"
accuracy = 1
contact = "5 mm"
[safety]
travel = ["0 mm", "20 mm"]
"""


@pytest.fixture
def command(tmp_path):
    """The command line of a capture of the paper's ten presses in one trial (44 s)."""
    rig = tmp_path / "rig.toml"
    rig.write_text(RIG)
    out = tmp_path / "session"
    arguments = ["capture", "paper_ten_presses", "--rig", str(rig), "--out", str(out), "--json"]
    return [sys.executable, "-m", "bench_hw", *arguments], out


def start(command, **options):
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options)


def wait_for(path, timeout=20.0):
    deadline = time.monotonic() + timeout
    while not path.exists():
        assert time.monotonic() < deadline, f"{path} did not appear"
        time.sleep(0.01)


def recorded(path):
    """Channels of a trial, whole or not, and the wall-clock time of its start."""
    found = inspect_trial(path).to_dict()
    return found, datetime.fromisoformat(found["trial"]["started"]).timestamp()


def test_ten_trials_of_the_paper_in_real_and_in_simulated_time(tmp_path):
    def session(name, *, fast):
        order = CaptureOrder(load_protocol("paper_press"), load_rig("simulated"), tmp_path / name, 10, fast=fast)
        began = time.monotonic()
        outcome = capture(order, Silent())
        assert outcome.fault is None
        return time.monotonic() - began

    took = {name: session(name, fast=name == "fast") for name in ("fast", "real")}
    files = {name: sorted(path.name for path in (tmp_path / name).iterdir()) for name in took}
    assert files["fast"] == files["real"]
    assert len([name for name in files["real"] if name.endswith(".mcap")]) == 10
    listed = {name: tomllib.loads((tmp_path / name / "session.toml").read_text()) for name in took}
    assert {**listed["fast"], "name": ""} == {**listed["real"], "name": ""}
    for number in range(1, 11):
        trials = [read_trial_mcap(tmp_path / name / f"trial_{number:03d}.mcap") for name in took]
        durations = [trial.time[-1] - trial.time[0] for trial in trials]
        assert durations[0] == pytest.approx(durations[1], abs=0.5)
        assert trials[0].depth.max() == pytest.approx(trials[1].depth.max(), abs=1.1e-4)
        assert trials[0].force.max() == pytest.approx(trials[1].force.max(), abs=0.15)
    recorded_time = 10 * 7.9
    print(f"ten trials ({recorded_time:.0f} s of motion): {took['fast']:.1f} s fast, {took['real']:.1f} s real")
    assert took["fast"] < recorded_time


def test_killed_at_twenty_random_moments(command, tmp_path):
    moments = random.Random(7)
    arguments, out = command
    losses = []
    for repeat in range(20):
        folder = out.with_name(f"killed_{repeat}")
        changed = [str(folder) if part == str(out) else part for part in arguments]
        process = start(changed)
        part = folder / "trial_001.mcap.part"
        wait_for(part)
        time.sleep(moments.uniform(0.8, 4.0))
        process.kill()
        killed = time.time()
        process.communicate()
        found, started = recorded(part)
        assert found["complete"] is False
        force = found["channels"]["force"]
        losses.append(killed - started - force["last_time_s"])
        assert force["lost"] == 0
        recovered = folder / "recovered.mcap"
        ran = subprocess.run(
            [sys.executable, "-m", "bench_hw", "recover", str(part), "--out", str(recovered), "--json"],
            capture_output=True, text=True, check=True,
        )  # fmt: skip
        assert json.loads(ran.stdout)["kept"]["force"] == force["rows"]
        trial = read_trial_mcap(recovered)
        assert np.isfinite(trial.force).all()
        in_air = trial.force[trial.depth < -0.5e-3]
        assert 1e-4 < in_air.std() < 0.01  # noise everywhere: no silent zeros
    print(f"killed 20 times: lost {np.median(losses):.3f} s median, {max(losses):.3f} s worst")
    assert max(losses) <= 0.5


def test_ctrl_c_in_mid_press(command):
    arguments, out = command
    process = start(arguments)
    wait_for(out / "trial_001.mcap.part")
    time.sleep(4.5)
    process.send_signal(signal.SIGINT)
    output, errors = process.communicate(timeout=20)
    assert process.returncode == 5
    assert "stopped by Ctrl-C; the tool was sent back" in errors
    assert json.loads(output)["fault"]["kind"] == "interrupted"
    found, _ = recorded(out / "trial_001.mcap")
    assert found["faults"]
    depth = read_trial_mcap(out / "trial_001.mcap").depth
    assert depth[-1] < depth.max() - 1e-3


def test_a_disk_that_is_full(command):
    def limit_files():
        resource.setrlimit(resource.RLIMIT_FSIZE, (150_000, 150_000))

    arguments, out = command
    process = start(arguments, preexec_fn=limit_files)
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 5
    assert json.loads(output)["fault"]["kind"] == "disk"
    assert json.loads(output)["fault"]["retracted"] is True
    assert "recover" in errors
    part = out / "trial_001.mcap.part"
    assert recorded(part)[0]["channels"]["force"]["rows"] > 500
