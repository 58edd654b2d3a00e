"""The measure of the house: modules, lines, rooms, names and functions of the product's packages.

`python tests/house.py [ROOT]` prints it for a checkout, so that two states can be set side by side; `test_house.py`
holds the limits that `make test` keeps.
"""

import ast
import statistics
import sys
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

PACKAGES = ("fem", "wavemodel", "bench_hw", "reports", "benchmark")
HERE = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class House:
    """What was counted: lines by module, modules by room, files by name, and the length of each function's body."""

    modules: dict[str, int]
    rooms: Counter[str]
    names: Counter[str]
    functions: dict[str, int]

    def root(self, package: str) -> int:
        """Modules directly in a package."""
        return self.rooms[package]


def measure(root: Path = HERE) -> House:
    """Count a checkout; `__init__.py` are no modules."""
    files = [
        file for package in PACKAGES for file in sorted((root / package).rglob("*.py")) if file.name != "__init__.py"
    ]
    modules = {file.relative_to(root).as_posix(): len(file.read_text(encoding="utf-8").splitlines()) for file in files}
    functions = {name: length for file in files for name, length in _functions(file, root)}
    rooms = Counter(Path(module).parent.as_posix() for module in modules)
    return House(modules, rooms, Counter(Path(module).name for module in modules), functions)


def _functions(file: Path, root: Path):
    """Each function's place and the lines of its body, its docstring apart."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            body = node.body[1:] if ast.get_docstring(node) else node.body
            if body:
                place = f"{file.relative_to(root).as_posix()}:{node.lineno}:{node.name}"
                yield place, body[-1].end_lineno - body[0].lineno + 1


def table(house: House) -> list[tuple[str, str]]:
    """Rows of what was counted, for people."""
    lines, bodies = sorted(house.modules.values()), sorted(house.functions.values())
    small = sum(length <= 60 for length in lines)
    return [
        ("modules", f"{len(lines)}"),
        ("lines in modules", f"{sum(lines)}"),
        ("median module", f"{statistics.median(lines):g} lines"),
        ("modules of 60 lines or fewer", f"{small} ({100 * small / len(lines):.0f} %)"),
        ("longest module", f"{lines[-1]} lines"),
        *((f"modules in the root of {package}", f"{house.root(package)}") for package in PACKAGES),
        ("largest room", "{} ({} modules)".format(*house.rooms.most_common(1)[0])),
        ("most used module name", "{} ({} times)".format(*house.names.most_common(1)[0])),
        ("functions", f"{len(bodies)}"),
        ("lines in a function", f"median {statistics.median(bodies):g}, 90 % within {bodies[int(0.9 * len(bodies))]}"),
        ("functions over 40 lines", f"{sum(length > 40 for length in bodies)}"),
    ]  # fmt: skip


if __name__ == "__main__":
    for what, value in table(measure(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE)):
        print(f"{what:34} {value}")
