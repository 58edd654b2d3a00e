"""A process killed while it records, at moments it did not choose: half a second is lost at most, no zeros appear."""

import mmap
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from bench_hw.trial_file.inspection import inspect_trial
from bench_hw.trial_file.reading import read_contents, read_trial_mcap
from bench_hw.trial_file.recovery import recover_trial

RECORDER = """
import mmap, os, struct, sys, time
from bench_hw.trial_file import PositionRecord, ForceRecord, FrameRecord, TrialHeader, open_trial

ledger = mmap.mmap(os.open(sys.argv[2], os.O_RDWR), 16)
epoch = time.monotonic()
picture = os.urandom(40_000)
writer = open_trial(sys.argv[1], TrialHeader("killed", "", epoch, synthetic=True), background=sys.argv[3] == "1")
number = 0
while True:
    number += 1
    now = time.monotonic()
    press = 1.0 + number * 0.001
    writer.write_force(ForceRecord(now, number, 7 * number, 0, (press, press, -press), (press, press, press)))
    if number % 10 == 0:
        writer.write_position(PositionRecord(now, press * 1e-3))
    if number % 33 == 0:
        writer.write_frame(FrameRecord(now, number // 33, picture))
    ledger[:] = struct.pack("<qd", number, now - epoch)
    time.sleep(max(0.0, epoch + number * 0.001 - time.monotonic()))
"""


def kill_after(seconds: float, folder: Path, background: bool) -> tuple[Path, int, float]:
    """Record until killed; give the file, the number of the last sample handed over, and its time."""
    ledger = folder / "ledger"
    ledger.write_bytes(bytes(16))
    trial = folder / "trial_001.mcap"
    command = [sys.executable, "-c", RECORDER, str(trial), str(ledger), str(int(background))]
    with subprocess.Popen(command) as process:
        deadline = time.monotonic() + 30
        with ledger.open("r+b") as file, mmap.mmap(file.fileno(), 16) as view:
            while struct.unpack("<qd", view[:])[1] < seconds and time.monotonic() < deadline:
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
            process.wait(timeout=30)
            number, last = struct.unpack("<qd", view[:])
    return trial.with_name("trial_001.mcap.part"), number, last


def check_killed(folder: Path, seconds: float, background: bool) -> float:
    """Kill, recover, inspect; give the time that was lost, s."""
    part, number, last = kill_after(seconds, folder, background)
    inspection = inspect_trial(part)
    recovery = recover_trial(part, folder / "recovered.mcap")
    assert not inspection.complete
    assert not recovery.whole
    assert "stops without its end" in recovery.reason
    assert not inspect_trial(folder / "recovered.mcap").complete
    force = read_contents(folder / "recovered.mcap").force
    assert len(force.time) == recovery.kept["force"] == inspection.channels["force"].rows
    np.testing.assert_array_equal(force.rdt_sequence, np.arange(1, len(force.time) + 1))
    press = 1.0 + np.arange(1, len(force.time) + 1) * 0.001
    np.testing.assert_array_equal(force.force, np.stack([press, press, -press], axis=1))
    table = read_trial_mcap(folder / "recovered.mcap")
    assert (table.force >= 1.0).all()
    assert (table.depth >= 1.0e-3).all()
    assert len(force.time) <= number
    return last - float(force.time[-1])


@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
@pytest.mark.parametrize("background", [False, True])
def test_a_killed_recording_loses_half_a_second_at_most(tmp_path, background):
    assert check_killed(tmp_path, 1.2, background) <= 0.5


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="needs SIGKILL")
def test_twenty_recordings_killed_at_random_moments(tmp_path):
    random = np.random.default_rng(20)
    lost = []
    for run, seconds in enumerate(random.uniform(0.6, 3.0, size=20)):
        folder = tmp_path / f"run_{run}"
        folder.mkdir()
        lost.append(check_killed(folder, float(seconds), background=run % 2 == 0))
    print(f"lost at most {max(lost):.3f} s, median {np.median(lost):.3f} s of 20 kills")
    assert max(lost) <= 0.5
