"""`make test-torture`: kills, malformed files, full disks and bad surroundings in bounded time, a table of each.

With two workers the parts run in two processes, kills and files in one, disks and surroundings in the other. The parts
of a process share its time by their weights; what one leaves over goes to those after it. What was not reached is said.
"""

from __future__ import annotations

import argparse
import importlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")

from tests.torture import disks, inputs, kills, places
from tests.torture.commands import COMMANDS
from tests.torture.journal import Journal
from tests.torture.scene import complete_scene, make_scene

MODULES = {
    "fit": ("benchmark.runs.fit_run",),
    "run": ("benchmark.runs.requests",),
    "report": ("benchmark.runs.finished.carrying_out",),
    "verify": ("benchmark.verification.cases", "benchmark.verification.verification_page"),
    "sweep": ("benchmark.sweeps.sweep_run",),
    "discover": ("benchmark.discovery.discovery_request",),
    "check": ("benchmark.gate.checking",),
    "blind": ("benchmark.blind.running", "benchmark.blind.blind_folder"),
    "reproduce": ("benchmark.reproduce.reproduction",),
    "capture": ("bench_hw.capture.session",),
    "assess": ("benchmark.assessment.skill_comparison",),
    "press": ("benchmark.press.press_page",),
    "dossier": ("benchmark.dossier",),
    "session": ("benchmark.files.sessions",),
    "simulate": ("bench_hw.capture.session",),
    "track": ("bench_hw.vision.tracking.film",),
}
"""By the first word of a command."""
WEIGHTS = {"kills": 3.0, "inputs": 1.0, "disks": 2.0, "surroundings": 1.5}
"""Of the parts, for their times."""
HALVES = (("kills", "inputs"), ("disks", "surroundings"))
PLACES = ("faults", "outside")


def main() -> int:
    """Run the parts that were asked for; return the exit code."""
    asked = _asked()
    halves = [[name for name in half if name in asked.only] for half in HALVES]
    if asked.workers > 1 and all(halves):
        return _beside(halves)
    _warm([each.verb for each in COMMANDS] if "inputs" in asked.only else asked.verbs)
    folder = Path(tempfile.mkdtemp(prefix="torture-"))
    until = time.monotonic() + 60.0 * asked.minutes
    try:
        scene = make_scene(folder / "scene")
        scratch = folder / "temporary"
        scratch.mkdir()
        os.environ["TMPDIR"] = tempfile.tempdir = str(scratch)
        complete_scene(scene, [each.verb for each in COMMANDS] if "inputs" in asked.only else asked.verbs)
        journal, failures = Journal(asked.log), 0
        for name in (each for each in WEIGHTS if each in asked.only):
            weights = [weight for other, weight in WEIGHTS.items() if other in asked.only]
            weights = weights[[other for other in WEIGHTS if other in asked.only].index(name) :]
            now = time.monotonic()
            failures += _part(name, scene, asked, journal, now + (until - now) * weights[0] / sum(weights))
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 1 if failures else 0


def _asked() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.torture", description=__doc__)
    parser.add_argument("--minutes", type=float, default=24.0, help="for all parts of a process together")
    parser.add_argument("--workers", type=int, choices=(1, 2), default=2, help="processes")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=45, help="moments over all verbs")
    parser.add_argument("--each", type=int, default=10, help="files of each kind")
    parser.add_argument("--kinds", nargs="*", help="of the malformed files, those whose names begin so; all without")
    parser.add_argument("--only", nargs="*", choices=tuple(WEIGHTS), default=tuple(WEIGHTS), help="parts")
    parser.add_argument(
        "--verbs", nargs="*", default=[each.verb for each in COMMANDS], help="of kills, disks and surroundings"
    )
    parser.add_argument("--places", nargs="*", choices=PLACES, default=PLACES, help="kinds of surroundings")
    parser.add_argument("--points", type=int, default=3, help="of a disk that fills")
    parser.add_argument("--log", type=Path, help="a file of the kills, added to: a torture that stopped goes on")
    return parser.parse_args()


def _beside(halves: list[list[str]]) -> int:
    """Each half in a process of its own, what it prints in one piece; the larger exit code."""
    command = [sys.executable, "-m", "tests.torture", *sys.argv[1:], "--workers", "1", "--only"]
    running = [subprocess.Popen([*command, *half], stdout=subprocess.PIPE, text=True) for half in halves]
    for each in running:
        sys.stdout.write(each.communicate()[0])
        sys.stdout.flush()
    return max(each.returncode for each in running)


def _part(name: str, scene: Path, asked: argparse.Namespace, journal: Journal, until: float) -> int:
    """One part, its table, its failures and what was not reached on standard output; how many failures there were."""
    commands = [each.verb for each in COMMANDS if each.verb in asked.verbs]
    if name == "kills":
        kills.torture(scene, until, asked.seed, asked.kills, asked.verbs, journal)
        table, failed, wanted = kills.rows(journal), {"kills": kills.failures(journal)}, commands
    elif name == "inputs":
        counts = inputs.torture(scene / "fuzzed", until, asked.seed, asked.each, tuple(asked.kinds or ("",)))
        table, failed = inputs.rows(counts), {kind: each.failures for kind, each in counts.items()}
        wanted = [kind for kind, each in counts.items() if not each.files]
        shutil.rmtree(scene / "fuzzed", ignore_errors=True)
    elif name == "disks":
        filled = disks.torture(scene, until, asked.verbs, asked.points)
        table, failed = disks.rows(filled), {verb: each.failures for verb, each in filled.items()}
        wanted = [verb for verb in commands if verb != "clean"]
    else:
        found, wanted = places.torture(scene, until, asked.verbs, asked.places)
        table, failed = places.rows(found), {place: each.failures for place, each in found.items()}
    print(f"\n{name}, seed {asked.seed}")
    _show(table)
    reached = {row[0] for row in table if name != "inputs"}
    missed = [each for each in wanted if each not in reached]
    if missed:
        print(f"NOT REACHED: {', '.join(missed)}")
    for what, texts in failed.items():
        for text in texts:
            print(f"FAILED {what}: {text}")
    sys.stdout.flush()
    return sum(map(len, failed.values()))


def _show(table: list[tuple[str, ...]]) -> None:
    widths = [max(len(row[k]) for row in table) for k in range(len(table[0]))]
    for row in table:
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |")


def _warm(verbs: list[str]) -> None:
    """Import what the commands import, so that each fork of this process begins to work at once."""
    for verb in verbs:
        for module in ("benchmark.cli.app", "bench_hw.cli", *MODULES.get(verb.split()[0].strip(","), ())):
            importlib.import_module(module)


if __name__ == "__main__":
    sys.exit(main())
