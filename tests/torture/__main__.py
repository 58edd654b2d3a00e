"""`make test-torture`: kills, malformed files and bad surroundings in bounded time, a table of each."""

from __future__ import annotations

import argparse
import importlib
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", MKL_NUM_THREADS="1")

from tests.torture import inputs, kills, places
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
PARTS = ("kills", "inputs", "places")
PLACES = ("disks", "faults", "outside")


def main() -> int:
    """Run the parts that were asked for; return the exit code."""
    parser = argparse.ArgumentParser(prog="python -m tests.torture", description=__doc__)
    parser.add_argument("--minutes", type=float, default=8.0, help="for each part")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--moments", type=int, default=45, help="kills over all verbs")
    parser.add_argument("--each", type=int, default=10, help="files of each kind")
    parser.add_argument("--kinds", nargs="*", help="of the malformed files, those whose names begin so; all without")
    parser.add_argument("--only", nargs="*", choices=PARTS, default=PARTS)
    parser.add_argument(
        "--verbs", nargs="*", default=[each.verb for each in COMMANDS], help="of the kills and the surroundings"
    )
    parser.add_argument("--places", nargs="*", choices=PLACES, default=PLACES, help="kinds of surroundings")
    parser.add_argument("--points", type=int, default=3, help="of a disk that fills")
    parser.add_argument("--log", type=Path, help="a file of what was tried, added to: a torture that stopped goes on")
    asked = parser.parse_args()
    journal = Journal(asked.log)
    _warm([each.verb for each in COMMANDS] if "inputs" in asked.only else asked.verbs)
    folder = Path(tempfile.mkdtemp(prefix="torture-"))
    try:
        scene = make_scene(folder / "scene")
        scratch = folder / "temporary"
        scratch.mkdir()
        os.environ["TMPDIR"] = tempfile.tempdir = str(scratch)
        complete_scene(scene, [each.verb for each in COMMANDS] if "inputs" in asked.only else asked.verbs)
        failures = [_part(name, scene, asked, journal) for name in asked.only]
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return 1 if any(failures) else 0


def _part(name: str, scene: Path, asked: argparse.Namespace, journal: Journal) -> int:
    """One part, its table and its failures on standard output; how many there were."""
    until = time.monotonic() + 60.0 * asked.minutes
    if name == "kills":
        kills.torture(scene, until, asked.seed, asked.moments, asked.verbs, journal)
        table, failed = kills.rows(journal), {"kills": kills.failures(journal)}
    elif name == "inputs":
        counts = inputs.torture(scene / "fuzzed", until, asked.seed, asked.each, tuple(asked.kinds or ("",)))
        table, failed = inputs.rows(counts), {kind: each.failures for kind, each in counts.items()}
        shutil.rmtree(scene / "fuzzed", ignore_errors=True)
    else:
        found = places.torture(scene, until, asked.verbs, asked.places, asked.points)
        table, failed = places.rows(found), {place: each.failures for place, each in found.items()}
    widths = [max(len(row[k]) for row in table) for k in range(len(table[0]))]
    print(f"\n{name}, seed {asked.seed}")
    for row in table:
        print("| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |")
    for what, texts in failed.items():
        for text in texts:
            print(f"FAILED {what}: {text}")
    sys.stdout.flush()
    return sum(map(len, failed.values()))


def _warm(verbs: list[str]) -> None:
    """Import what the commands import, so that each fork of this process begins to work at once."""
    for verb in verbs:
        for module in ("benchmark.cli.app", "bench_hw.cli", *MODULES.get(verb.split()[0].strip(","), ())):
            importlib.import_module(module)


if __name__ == "__main__":
    sys.exit(main())
