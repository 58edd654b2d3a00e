"""Compare with FElupe and CalculiX on the same meshes: agreement, whole-process, CPU and solve times.

FElupe comes from PyPI, CalculiX from Debian's `calculix-ccx`; a program that is missing is left out, and said so.
Each repeat runs all programs one after the other, and ratios are formed within a repeat, so that a change of the
machine's load hits all alike. All get the same number of threads; where other programs compete for the cores,
threads wait for each other and 1 is faster.
"""

from __future__ import annotations

import argparse
import os

from tests.performance.peers.bars import Bar, bars
from tests.performance.peers.case import Case
from tests.performance.peers.cases import CASES
from tests.performance.peers.comparison import Compared, compare
from tests.performance.peers.running import programs, run_in_turn

FELUPE_LIMIT = 60_000  # unknowns beyond which FElupe's solve takes minutes


def main() -> int:
    """Run all cases; 1 where a program disagrees with ours beyond its bar."""
    parser = argparse.ArgumentParser(prog="python -m tests.performance.peers", description=__doc__)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--threads", type=int, default=2, help="for every program; 1 on a busy machine")
    parser.add_argument("--cases", nargs="*", choices=list(CASES), default=list(CASES))
    arguments = parser.parse_args()
    names = list(programs())
    print(f"{arguments.threads} threads, {arguments.repeats} repeats, load {os.getloadavg()[0]:.1f} at the start")
    found: dict[str, dict[str, Compared]] = {}
    unknowns = {}
    for name in arguments.cases:
        case = CASES[name]()
        unknowns[name] = case.unknowns
        runs = run_in_turn(case, _suited(names, case), arguments.repeats, arguments.threads)
        found[name] = compare(runs)
        print(f"\n{name}: {case.unknowns} unknowns, {case.elements.shape[1]} elements, {case.steps} steps")
        print("\n".join(str(compared) for compared in found[name].values()), flush=True)
    held = list(bars(found, unknowns))
    print("\nbars", *held, f"load {os.getloadavg()[0]:.1f} at the end", sep="\n")
    return int(any(_disagrees(bar) for bar in held))


def _suited(names: list[str], case: Case) -> list[str]:
    return [name for name in names if name != "felupe" or case.unknowns < FELUPE_LIMIT]


def _disagrees(bar: Bar) -> bool:
    return "difference" in bar.name and not bar.held


if __name__ == "__main__":
    raise SystemExit(main())
