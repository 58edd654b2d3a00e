"""A sweep by one and by two local workers in turn: `python -m tests.performance.sweep --points 200 --repeats 2`.

Wall times count the turns of other programs. So the CPU time of every process is told too, and what it says of two free
cores: command before and after the points, then the longest of the workers, as if nothing of the command ran beside
them.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import psutil

QUICK = ("fem.mesh=coarse", "load.observations=4", "load.peak=0.5 N")
PAUSE = 0.1


@dataclass(frozen=True)
class Timed:
    """One sweep: its wall time, the CPU time of the command itself and of each worker in s, and the load average."""

    workers: int
    wall: float
    command: float
    each: tuple[float, ...]
    load: float

    @property
    def alone(self) -> float:
        """Seconds that the sweep would take if every process had a core, the command beside nobody."""
        return self.command + max(self.each)

    def words(self) -> str:
        """One line."""
        crew = " and ".join(f"{cpu:.1f} s" for cpu in self.each)
        return (
            f"{self.workers} workers: {self.wall:.1f} s; CPU: command {self.command:.1f} s, workers {crew}; "
            f"on free cores {self.alone:.1f} s (load average {self.load:.1f})"
        )


def main() -> None:
    """Run the sweeps and print their times and ratios."""
    parser = argparse.ArgumentParser(description="A sweep by one and by two local workers, in turn.")
    parser.add_argument("--points", type=int, default=200)
    parser.add_argument("--repeats", type=int, default=2)
    parser.add_argument("--scenario", default="skin-5N")
    parser.add_argument("--set", nargs="*", default=QUICK, help="settings of the scenario (a quick point)")
    options = parser.parse_args()
    found: dict[int, list[Timed]] = {1: [], 2: []}
    for repeat in range(options.repeats):
        for workers in (1, 2) if repeat % 2 == 0 else (2, 1):
            found[workers].append(time_sweep(options.scenario, options.set, options.points, workers))
            print(found[workers][-1].words(), flush=True)
    wall, alone = (
        statistics.median(first / second for first, second in zip(*pairs, strict=True))
        for pairs in (
            [[each.wall for each in found[workers]] for workers in (1, 2)],
            [[each.alone for each in found[workers]] for workers in (1, 2)],
        )
    )
    print(f"{options.points} points, one worker over two: {wall:.2f} by wall time, {alone:.2f} on free cores")


def time_sweep(scenario: str, settings: list[str], points: int, workers: int) -> Timed:
    """Run one sweep over tool radii and follow the CPU times of its processes."""
    with tempfile.TemporaryDirectory(prefix="sweep-") as folder:
        command = [sys.executable, "-m", "benchmark", "sweep", scenario, "--quiet"]
        command += ["--vary", f"tool.radius=3 mm:6 mm:{points}", "--workers", str(workers)]
        command += [word for setting in settings for word in ("--set", setting)]
        command += ["--out", str(Path(folder) / "sweep")]
        started = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
        own, crew = _followed(psutil.Process(process.pid))
        code = process.wait()
        if code:
            sys.exit(f"the sweep ended with exit code {code}")
    busiest = sorted(crew.values(), reverse=True)[:workers]
    return Timed(workers, time.perf_counter() - started, own, tuple(busiest), os.getloadavg()[0])


def _followed(process: psutil.Process) -> tuple[float, dict[int, float]]:
    """CPU seconds of a process and of each of its children, as last seen before they ended."""
    own, crew = 0.0, {}
    while process.is_running() and process.status() != psutil.STATUS_ZOMBIE:
        try:
            own = _cpu(process)
            for child in process.children():
                crew[child.pid] = _cpu(child)
        except psutil.NoSuchProcess:
            continue
        time.sleep(PAUSE)
    return own, crew


def _cpu(process: psutil.Process) -> float:
    times = process.cpu_times()
    return float(times.user + times.system)


if __name__ == "__main__":
    main()
