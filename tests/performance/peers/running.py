"""Running the programs on a case, in turn, and what was measured."""

from __future__ import annotations

import importlib.util
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.performance.peers import calculix
from tests.performance.peers.case import Case

ROOT = Path(__file__).parents[3]
THREAD_VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@dataclass(frozen=True)
class Timing:
    """One run: wall and CPU time of the whole process and solve time in s (NaN where the program does not tell)."""

    process: float
    cpu: float
    solve: float
    displacement: np.ndarray


def programs() -> Iterator[str]:
    """What is installed, ours first."""
    yield "ours"
    for name, found, how in (
        ("felupe", importlib.util.find_spec("felupe"), "pip install felupe"),
        ("calculix", shutil.which("ccx"), "apt-get install calculix-ccx"),
    ):
        if found:
            yield name
        else:
            print(f"{name} is not installed and left out ({how})")


def run_in_turn(case: Case, names: Sequence[str], repeats: int, threads: int) -> dict[str, list[Timing]]:
    """Timings of all programs, one after the other in each repeat."""
    environment = {**os.environ, **{name: str(threads) for name in THREAD_VARIABLES}}
    runs: dict[str, list[Timing]] = {name: [] for name in names}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case.save(folder / "case.npz")
        calculix.write_input(case, folder / "case.inp")
        for _ in range(repeats):
            for program in names:
                runs[program].append(_run(program, case, folder, environment))
    return runs


def _run(program: str, case: Case, folder: Path, environment: Mapping[str, str]) -> Timing:
    """Run one program on a case whose files are in the folder."""
    start, cpu = time.perf_counter(), _children_seconds()
    if program == "calculix":
        output = calculix.run(folder / "case", environment)
        process, cpu = time.perf_counter() - start, _children_seconds() - cpu
        found = calculix.read_displacements(folder / "case.dat", len(case.nodes))
        return Timing(process, cpu, calculix.total_seconds(output), found[:, : case.nodes.shape[1]])
    out = folder / f"{program}.npz"
    command = [sys.executable, "-m", f"tests.performance.peers.{program}", str(folder / "case.npz"), str(out)]
    subprocess.run(command, check=True, cwd=ROOT, env=environment, stdout=subprocess.DEVNULL)
    process, cpu = time.perf_counter() - start, _children_seconds() - cpu
    with np.load(out) as data:
        return Timing(process, cpu, float(data["seconds"]), data["displacement"])


def _children_seconds() -> float:
    """CPU time in s of all processes that have ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
