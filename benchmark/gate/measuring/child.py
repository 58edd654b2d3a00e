"""The measured process, started by its path with the tree to measure first on PYTHONPATH.

    python -P child.py GATE TREE

It takes `benchmark.gate` from the folder GATE and everything else from the tree, so that two revisions are measured by
the same code, even where one of them has no gate yet. Commands come as lines of JSON on stdin, answers go to stdout;
what the measured code prints goes to stderr.
"""

from __future__ import annotations

import importlib.util
import json
import os
import sys
from pathlib import Path


def adopt(gate: Path, tree: Path) -> None:
    """Make the package at `gate` the `benchmark.gate` of this process, and see that the rest is that of `tree`."""
    import benchmark

    found = Path(benchmark.__file__).resolve().parents[1]
    if found != tree.resolve():
        sys.exit(f"{tree} has no package benchmark, the one in {found} would be measured instead")
    spec = importlib.util.spec_from_file_location(
        "benchmark.gate", gate / "__init__.py", submodule_search_locations=[str(gate)]
    )
    assert spec is not None, "a file of that name makes a spec"
    assert spec.loader is not None, "a Python file has a loader"
    module = importlib.util.module_from_spec(spec)
    sys.modules["benchmark.gate"] = module
    spec.loader.exec_module(module)
    vars(benchmark)["gate"] = module


def main() -> None:
    """Answer commands until stdin ends."""
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    # no time: begin
    commands = os.dup(0)  # what is measured, and programs that it starts, find an empty stdin and none of these
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    nothing = os.fdopen(0, encoding="utf-8", closefd=False)
    sys.stdin = os.fdopen(commands, encoding="utf-8")
    # no time: end
    adopt(Path(sys.argv[1]), Path(sys.argv[2]))
    from benchmark.gate.measuring.costs import CostClock
    from benchmark.gate.measuring.service import Service

    with CostClock() as clock:
        service = Service(clock)
        for line in sys.stdin:
            # no time: begin
            sys.stdin = nothing
            # no time: end
            answers.write(json.dumps(service.answer(json.loads(line))) + "\n")
            answers.flush()


if __name__ == "__main__":
    main()
