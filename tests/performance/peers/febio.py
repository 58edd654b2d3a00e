"""Cases of FEBio from their `.feb` files: `python -m tests.performance.peers.febio FOLDER`.

Prints a row a file: what was solved, the norm of the displacements that are solved for, and, where the folder has the
suite's table of expected results (`*GoldStandards.py`, its last column), theirs and the difference. The suite is at
github.com/febiosoftware/TestSuite and no part of this repository.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

from benchmark.errors import InputError
from benchmark.exchange.febio_input import read_febio_case

ROW = re.compile(r"'(\w+)':\s*\[[^\]]*'([-+.\de]+)'\]")


def expected(folder: Path) -> dict[str, float]:
    """Theirs by the file's name."""
    return {
        name: float(value)
        for table in sorted(folder.glob("*GoldStandards.py"))
        for name, value in ROW.findall(table.read_text(encoding="utf-8"))
    }


def row(path: Path, theirs: dict[str, float]) -> str:
    """One line of the table."""
    try:
        case = read_febio_case(path)
        ours = case.norm()
    except (InputError, ArithmeticError) as error:
        return f"| {path.stem} | not run: {str(error).removeprefix(f'{path}: ')} | | | | |"
    body, their = case.body, theirs.get(path.stem)
    what = f"{body.elements.shape[1]} {body.element}, {int(body.free.sum())} unknowns"
    compared = ("-", "-") if their is None else (f"{their:.12g}", f"{100.0 * (ours / their - 1.0):+.1e}")
    return f"| {path.stem} | {', '.join(case.materials)} | {what} | {ours:.12g} | {compared[0]} | {compared[1]} |"


def main(folder: Path) -> None:
    """Print the table, Markdown."""
    theirs = expected(folder)
    print("| case | material | body | ours | theirs | difference % |\n|---|---|---|---|---|---|")
    for path in sorted(folder.glob("*.feb")):
        print(row(path, theirs), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
