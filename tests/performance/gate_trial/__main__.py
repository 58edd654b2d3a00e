"""Put the regression gate on trial: unchanged copies of the product, and copies that were made slower or wrong.

    python -m tests.performance.gate_trial --runs 20 --together --log trial.jsonl

Unchanged and faulty copies take turns, so that all meet the same states of the machine. With `--against` each copy is
compared with the commit it was made from, without it with a baseline that is stored once at the beginning.

With `--log` the copies and the baseline stay in a folder beside the log, and the same command goes on where it was
stopped; a later change of the product is not in them.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from tests.performance.gate_trial.copies import PRODUCT, make_copy, make_faulty, run_check, times_gate, values_gate
from tests.performance.gate_trial.faults import HOWS, Fault, deflections, slowdowns
from tests.performance.gate_trial.log import Log
from tests.performance.gate_trial.summary import TOGETHER, UNCHANGED, summary

BASELINE = "tissuebench-baseline.json"


def main(arguments: list[str] | None = None) -> int:
    """Run the trial and print what it has shown."""
    options = _parser().parse_args(arguments)
    log = Log(options.log)
    with _folder(options.log) as folder:
        trees, work = _trees(folder, options.product, _groups(options)), folder / "work"
        work.mkdir(exist_ok=True)

        def gate(tree: Path) -> list[str]:
            against = ["--against", "HEAD"] if options.against else []
            chosen = values_gate if options.values else times_gate if options.times else None
            return [*against, *(["--gate", str(chosen(tree))] if chosen is not None else [])]

        if not options.against and not (work / BASELINE).exists():
            accepted = run_check("accept", trees[UNCHANGED], work, "--accept", *gate(trees[UNCHANGED]))
            print(accepted.message or "baseline made", flush=True)
        for run in range(1, options.runs + 1):
            for name, tree in trees.items():
                if log.checks_of(name) < run:
                    log.add(run_check(name, tree, work, "--out", "out", *gate(tree)))
    print("\n".join(summary(log.rows)))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Put the regression gate on trial.")
    parser.add_argument("--runs", type=int, default=20, help="checks of each copy (20)")
    parser.add_argument("--share", type=float, default=0.25, help="how much slower (0.25)")
    parser.add_argument("--how", choices=HOWS, default="work", help="how it is slower (work)")
    parser.add_argument("--off", type=float, default=0.0, help="instead: deflections off by this share, such as 0.01")
    parser.add_argument("--values", action="store_true", help="values alone: the same gate without its times")
    parser.add_argument("--times", action="store_true", help="times alone: the same gate with a single value")
    parser.add_argument("--only", nargs="*", default=[""], help="only faults with one of these in their names")
    parser.add_argument("--together", action="store_true", help="one copy with all faults, each counted by itself")
    parser.add_argument("--against", action="store_true", help="compare with the commit instead of a baseline")
    parser.add_argument("--product", type=Path, default=PRODUCT, help="the product to copy (this one)")
    parser.add_argument("--log", type=Path, help="file that each check is appended to, and that is gone on from")
    return parser


def _groups(options: argparse.Namespace) -> list[list[Fault]]:
    """The faults of each faulty copy."""
    faults = deflections(1.0 + options.off) if options.off else slowdowns(options.share, options.how)
    chosen = [each for each in faults if any(only in each.name for only in options.only)]
    return [chosen] if options.together else [[each] for each in chosen]


@contextmanager
def _folder(log: Path | None) -> Iterator[Path]:
    """A folder for the copies and the baseline: beside the log, where it stays, or for the time being."""
    if log is not None:
        folder = log.resolve().with_suffix(".work")
        folder.mkdir(parents=True, exist_ok=True)
        yield folder
        return
    with tempfile.TemporaryDirectory(prefix="gate-trial-") as temporary:
        yield Path(temporary)


def _trees(folder: Path, product: Path, groups: list[list[Fault]]) -> dict[str, Path]:
    """The unchanged copy and the faulty ones by name; those that are there already stay."""
    good = folder / "good"
    if not good.exists():
        make_copy(good, product)
    trees = {UNCHANGED: good}
    for number, faults in enumerate(groups):
        tree = folder / f"faulty-{number}"
        if not tree.exists():
            make_faulty(tree, good, faults)
        trees[TOGETHER.join(fault.name for fault in faults)] = tree
    return trees


if __name__ == "__main__":
    sys.exit(main())
