"""Peak memory of `fit` on large data: `python -m tests.performance.large_fit [TRIALS] [ROWS]`, 10,000 and 5 million.

Two synthetic sessions are written beside, and removed again: so many trials of 500 rows in one folder, and one record
of so many rows with 500 cycles of depth. Each is fitted by a process of its own, as a person would; printed are its
exit code, its largest resident memory, CPU and wall time.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

ROWS_OF_A_TRIAL, CYCLES = 500, 500
STIFFNESS, EXPONENT, NOISE = 1.1, 1.25, 2e-3
"""N at 1 mm, of the depth, and N."""
ROOT = Path(__file__).parents[2]


def main(trials: int, rows: int) -> int:
    """Write, fit and print."""
    with tempfile.TemporaryDirectory(dir=".") as place:
        folder = Path(place)
        for number in range(trials):
            write(folder / "many" / f"press_{number:05d}.csv", press(ROWS_OF_A_TRIAL, 1, number))
        print(f"{trials} trials of {ROWS_OF_A_TRIAL} rows: {fitted(folder, 'many')}", flush=True)
        write(folder / "long" / "cycles.csv", press(rows, CYCLES, 0))
        print(f"{rows} rows with {CYCLES} cycles: {fitted(folder, 'long')}", flush=True)
    return 0


def press(rows: int, cycles: int, seed: int) -> NDArray[np.float64]:
    """(rows, 3) time in s, depth in mm and force in N of presses to 2 mm."""
    within = cycles * np.arange(rows) / rows % 1.0
    depth = 2.0 * (1.0 - np.abs(2.0 * within - 1.0))
    force = STIFFNESS * depth**EXPONENT + np.random.default_rng(seed).normal(0.0, NOISE, rows)
    return np.column_stack([0.01 * np.arange(rows), depth, force])


def write(path: Path, table: NDArray[np.float64]) -> None:
    """As CSV."""
    path.parent.mkdir(exist_ok=True)
    with path.open("w") as stream:
        stream.write("time_s,depth_mm,force_N\n")
        for part in np.array_split(table, max(1, len(table) // 100_000)):
            stream.write("".join(f"{t:.2f},{d:.6f},{f:.5f}\n" for t, d, f in part.tolist()))


def fitted(folder: Path, name: str) -> str:
    """A fit of a session by a process of its own, in words."""
    began = time.monotonic()
    command = [sys.executable, "-m", "benchmark", "fit", name, "--out", f"{name}-fit", "--quiet"]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}
    process = subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    seconds = used.ru_utime + used.ru_stime
    return (
        f"exit code {os.waitstatus_to_exitcode(status)}, peak {1024 * used.ru_maxrss / 1e6:.0f} MB, "
        f"{seconds:.0f} s of CPU in {time.monotonic() - began:.0f} s"
    )


if __name__ == "__main__":
    wanted = [int(word) for word in sys.argv[1:]]
    sys.exit(main(*wanted) if wanted else main(10_000, 5_000_000))
