"""Put the regression gate on trial: unchanged copies of the product, and copies that were made slower or wrong.

    python -m benchmarks.gate_trial --runs 20 --log trial.jsonl

Unchanged and faulty copies take turns, so that all meet the same states of the machine. With `--against` each copy is
compared with the commit it was made from, without it with a baseline that is stored once at the beginning.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path

from benchmarks.gate_trial.copies import PRODUCT, Check, make_copy, make_faulty, run_check, values_gate
from benchmarks.gate_trial.faults import HOWS, Fault, deflections, slowdowns
from benchmarks.gate_trial.summary import UNCHANGED, summary


def main(arguments: list[str] | None = None) -> int:
    """Run the trial and print what it has shown."""
    options = _parser().parse_args(arguments)
    faults = deflections(1.0 + options.off) if options.off else slowdowns(options.share, options.how)
    chosen = [each for each in faults if any(only in each.name for only in options.only)]
    rows = []
    with tempfile.TemporaryDirectory(prefix="gate-trial-") as folder:
        trees = _trees(Path(folder), options.product, chosen)
        work = Path(folder) / "work"
        work.mkdir()

        def gate(tree: Path) -> list[str]:
            against = ["--against", "HEAD"] if options.against else []
            return [*against, *(["--gate", str(values_gate(tree))] if options.values else [])]

        if not options.against:
            accepted = run_check("accept", trees[UNCHANGED], work, "--accept", *gate(trees[UNCHANGED]))
            print(accepted.message or "baseline made", flush=True)
        for _ in range(options.runs):
            for name, tree in trees.items():
                found = run_check(name, tree, work, "--out", "out", *gate(tree))
                rows.append(found.to_dict())
                _log(options.log, found)
    print("\n".join(summary(rows)))
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description="Put the regression gate on trial.")
    parser.add_argument("--runs", type=int, default=20, help="checks of each copy (20)")
    parser.add_argument("--share", type=float, default=0.25, help="how much slower (0.25)")
    parser.add_argument("--how", choices=HOWS, default="work", help="how it is slower (work)")
    parser.add_argument("--off", type=float, default=0.0, help="instead: deflections off by this share, such as 0.01")
    parser.add_argument("--values", action="store_true", help="values alone: the same gate without its times")
    parser.add_argument("--only", nargs="*", default=[""], help="only faults with one of these in their names")
    parser.add_argument("--against", action="store_true", help="compare with the commit instead of a baseline")
    parser.add_argument("--product", type=Path, default=PRODUCT, help="the product to copy (this one)")
    parser.add_argument("--log", type=Path, help="file that each check is appended to")
    return parser


def _trees(folder: Path, product: Path, faults: list[Fault]) -> dict[str, Path]:
    """The unchanged copy and the faulty ones by name."""
    good = make_copy(folder / "good", product)
    trees = {UNCHANGED: good}
    for number, fault in enumerate(faults):
        trees[fault.name] = make_faulty(folder / f"faulty-{number}", good, fault)
    return trees


def _log(path: Path | None, check: Check) -> None:
    """Say how a check ended, and keep it."""
    print(f"{check.copy}: exit {check.code} in {check.seconds:.0f} s", flush=True)
    if path is not None:
        with path.open("a", encoding="utf-8") as stream:
            stream.write(json.dumps(check.to_dict()) + "\n")


if __name__ == "__main__":
    sys.exit(main())
