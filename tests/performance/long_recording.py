"""Peak memory of a long recording: `python -m tests.performance.long_recording [MINUTES]`, 60 by default.

The writer of trial files is fed with as many records as the simulated bench gives in that time (1000 forces, 100 places
and 30 pictures a second, pictures of 52 kB that cannot be compressed), as fast as it takes them. Printed are its
resident memory at each tenth, the peak, and the bytes of the file, which is removed. No device is in it.
"""

from __future__ import annotations

import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from bench_hw.trial_file import open_trial
from bench_hw.trial_file.records import ForceRecord, FrameRecord, PositionRecord, TrialHeader

FORCE_RATE, DEPTHS, FRAMES = 1000, 100, 30
PICTURE = 52_000
MB = 1e6


def main(minutes: float) -> int:
    """Record and print."""
    pictures = [np.random.default_rng(seed).bytes(PICTURE) for seed in range(30)]
    seconds, began = int(60 * minutes), time.monotonic()
    with tempfile.TemporaryDirectory(dir=".") as folder:
        path = Path(folder) / "trial_001.mcap"
        with open_trial(path, TrialHeader(name="long", started="", clock_epoch=0.0, synthetic=True), False) as writer:
            for second in range(seconds):
                for k in range(FORCE_RATE):
                    at, number = second + k / FORCE_RATE, second * FORCE_RATE + k
                    force = (0.01 * k, 0.0, -1.0 - 1e-3 * k)
                    writer.write_force(ForceRecord(at, number, number, 0, force, (0.0, 0.0, 0.0), None))
                    if k % (FORCE_RATE // DEPTHS) == 0:
                        writer.write_position(PositionRecord(at, 1e-6 * k, k, 1e-3))
                for k in range(FRAMES):
                    frame = FrameRecord(second + 0.999 + 1e-5 * k, second * FRAMES + k, pictures[k], "jpeg")
                    writer.write_frame(frame)
                if second % max(seconds // 10, 1) == 0:
                    print(f"{second / 60:5.1f} min: {_resident() / MB:.0f} MB", flush=True)
        peak = 1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        size, took = path.stat().st_size, time.monotonic() - began
    print(f"{minutes:g} min: peak {peak / MB:.0f} MB, file {size / MB:.0f} MB, in {took:.0f} s")
    return 0


def _resident() -> float:
    """Bytes of this process that are in memory."""
    return 4096.0 * int(Path("/proc/self/statm").read_text().split()[1])


if __name__ == "__main__":
    sys.exit(main(float(sys.argv[1]) if len(sys.argv) > 1 else 60.0))
