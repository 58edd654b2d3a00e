"""Compare with FElupe and CalculiX on the same meshes: agreement, whole-process and solve times.

Run `python benchmarks/peers.py [--repeats 5] [--threads 2]`. FElupe comes from PyPI, CalculiX from Debian's
`calculix-ccx`; a program that is missing is left out, and said so. Each repeat runs all programs one after the
other, and ratios are formed within a repeat, so that a change of the machine's load hits all alike. All get the same
number of threads; where other programs compete for the cores, threads wait for each other and 1 is faster.
"""

from __future__ import annotations

import argparse
import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import peer_calculix
from peer_cases import Case, axisymmetric_case, block_case

HERE = Path(__file__).parent
THREAD_VARIABLES = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS")
LINEAR_DENSITIES = {"9k": 1.3, "21k": 1.8, "44k": 2.4, "97k": 3.2}


@dataclass(frozen=True)
class Timing:
    """One run: whole process and solve time in s (NaN where the program does not tell)."""

    process: float
    solve: float
    displacement: np.ndarray


def programs() -> Iterator[str]:
    """What is installed."""
    yield "ours"
    for name, found, how in (
        ("felupe", importlib.util.find_spec("felupe"), "pip install felupe"),
        ("calculix", shutil.which("ccx"), "apt-get install calculix-ccx"),
    ):
        if found:
            yield name
        else:
            print(f"{name} is not installed and left out ({how})")


def run(program: str, case: Case, folder: Path, environment: dict[str, str]) -> Timing:
    """Run one program on a case whose files are in the folder."""
    start = time.perf_counter()
    if program == "calculix":
        output = peer_calculix.run(folder / "case", environment)
        process = time.perf_counter() - start
        found = peer_calculix.read_displacements(folder / "case.dat", len(case.nodes))
        return Timing(process, peer_calculix.total_seconds(output), found[:, : case.nodes.shape[1]])
    command = [sys.executable, str(HERE / f"peer_{program}.py"), str(folder / "case.npz"), str(folder / "out.npz")]
    subprocess.run(command, check=True, env={**os.environ, **environment}, stdout=subprocess.DEVNULL)
    process = time.perf_counter() - start
    with np.load(folder / "out.npz") as data:
        return Timing(process, float(data["seconds"]), data["displacement"])


def spread(values: list[float]) -> str:
    """Median and range."""
    return f"{np.median(values):7.2f} [{min(values):.2f}, {max(values):.2f}]"


def compare(label: str, case: Case, names: list[str], repeats: int, environment: dict[str, str]) -> float:
    """Run all programs in alternation and print; the median of our whole-process time in s."""
    runs: dict[str, list[Timing]] = {name: [] for name in names}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        case.save(folder / "case.npz")
        peer_calculix.write_input(case, folder / "case.inp")
        for _ in range(repeats):
            for program in names:
                runs[program].append(run(program, case, folder, environment))
    print(
        f"\n{label}: {case.unknowns} unknowns, {case.elements.shape[1]} elements, {case.steps} steps, {repeats} repeats"
    )
    reference = runs["ours"][0].displacement
    for program in names:
        process, solve = ([getattr(t, part) for t in runs[program]] for part in ("process", "solve"))
        ratio = [peer.process / own.process for peer, own in zip(runs[program], runs["ours"], strict=True)]
        ratio_solve = [peer.solve / own.solve for peer, own in zip(runs[program], runs["ours"], strict=True)]
        off = np.nanmax(np.abs(runs[program][0].displacement - reference)) / np.abs(reference).max()
        print(
            f"  {program:9s} process {spread(process)} s, solve {spread(solve)} s; times ours: process {spread(ratio)},"
            f" solve {spread(ratio_solve)}; largest difference {off:.1e}"
        )
    return float(np.median([t.process for t in runs["ours"]]))


def main() -> None:
    """Run all cases."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--threads", type=int, default=2, help="for every program; 1 on a busy machine")
    arguments = parser.parse_args()
    environment = {name: str(arguments.threads) for name in THREAD_VARIABLES}
    names = list(programs())
    seconds = {}
    for label, density in LINEAR_DENSITIES.items():
        case = block_case(density)
        few = names if case.unknowns < 60_000 else [name for name in names if name != "felupe"]
        seconds[case.unknowns] = compare(f"linear, C3D20R, {label}", case, few, arguments.repeats, environment)
    sizes = np.array([size for size in seconds if size >= 15_000])
    exponent = np.polyfit(np.log(sizes), np.log([seconds[int(size)] for size in sizes]), 1)[0]
    print(f"\ngrowth of our whole-process time from {sizes[0]} to {sizes[-1]} unknowns: exponent {exponent:.2f}")
    note = "hyperelastic, axisymmetric, Q2/P0 (CalculiX: CAX8R, another element)"
    compare(note, axisymmetric_case(), names, arguments.repeats, environment)


if __name__ == "__main__":
    main()
