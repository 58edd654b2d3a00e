"""Which column of a block is time, travel and force: by the words of its name, or by what a person told.

What two columns could be, and a unit that stands nowhere, are asked for by naming the option.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from bench_hw.errors import TableError
from bench_hw.instrument_files.blocks import Block
from bench_hw.instrument_files.text_sheet import is_number
from bench_hw.instrument_files.told import ColumnSource, Told, asking, asking_key, parse_source
from bench_hw.instrument_files.vocabulary import CLOCK, DIMENSIONS, UNITS, role_of, unit_of, unit_scale

TRAVEL: Final = ("depth", "displacement", "gap", "position")
"""Quantities that say how far the tool went, the plainest first."""
_EXAMPLES: Final = {"time": "s", "force": "N", "depth": "mm", "gap": "mm", "stress": "kPa", "strain": "%"}


@dataclass(frozen=True)
class Taken:
    """A column that is used: its number, the quantity it holds, its SI scale, its sign (0: found out), how it reads."""

    column: int
    role: str
    scale: float
    sign: int
    shown: str


def takes(block: Block, told: Told) -> dict[str, Taken]:
    """Which columns of a block are time, travel and force (or strain and stress); what is not there is left out.

    Raises
    ------
    TableError
        A column that was named is missing, two could be meant, or a unit is missing.
    """
    found = {role: _told(block, role, parse_source(role, text)) for role, text in told.columns.items()}
    kinds = {"depth": TRAVEL}
    for role in ("time", "force", "depth", "gap"):
        if role not in found and not (role == "time" and told.rate):
            for kind in kinds.get(role, (role,)):
                if (taken := _by_word(block, role, kind)) is not None:
                    found[role] = taken
                    break
    if "time" not in found and not told.rate and (stamped := _stamped(block)) is not None:
        found["time"] = _taken(block, "time", "time", stamped, "s", 0)
    if "force" not in found and "depth" not in found:
        _check_contradiction(block)
    if "force" not in found or "depth" not in found:
        found |= {
            role: taken for role in ("stress", "strain") if role not in found and (taken := _by_word(block, role, role))
        }
    return found


def _told(block: Block, role: str, source: ColumnSource) -> Taken:
    matching = [k for k, name in enumerate(block.names) if source.name in (name, block.headers[k])]
    number = source.name.removeprefix("#")
    if source.name.startswith("#") and number.isdecimal() and 0 < int(number) <= len(block.names):
        matching = [int(number) - 1]
    if len(matching) != 1:
        problem = f"import.{role}: " + (
            "no column is called so" if not matching else f"{len(matching)} columns are called so"
        )
        raise TableError(block.path, problem, f"one of {block.header}, by its name or its place #N", column=source.name)
    if not source.unit:
        _check_one_unit(block, role, matching[0])
    unit = source.unit or _unit(block, matching[0])
    return _taken(block, role, role, matching[0], unit, source.sign)


def _by_word(block: Block, role: str, kind: str) -> Taken | None:
    """The column whose name plainly means a quantity; of some that do as plainly, those that say the same are one."""
    candidates = []
    for k, name in enumerate(block.names):
        meaning = role_of(name, block.units[k])
        dimension = _dimension(block.units[k])
        if meaning is not None and meaning[0] == kind and (not block.units[k] or dimension in (DIMENSIONS[kind], None)):
            candidates.append((meaning[1], k))
    if not candidates:
        return None
    best = [k for rank, k in sorted(candidates) if rank == min(candidates)[0]]
    first = best[0]
    for other in best[1:]:
        if not _same(block, first, other):
            names = " and ".join(repr(_shown(block, k)) for k in (first, other))
            example = f"#{first + 1}:{_unit(block, first) or _EXAMPLES[role]}"
            problem = f"two columns could be the {role}: {names}"
            raise TableError(block.path, problem, f"name one, {asking(role, example)}", row=header_line(block))
    _check_one_unit(block, role, first)
    return _taken(block, role, kind, first, _unit(block, first), 0)


def _check_one_unit(block: Block, role: str, column: int) -> None:
    """Refuse a column whose name and units row tell two units, where nobody says which it is."""
    if (other := block.contradicted.get(column)) is None:
        return
    name, unit = block.headers[column], block.units[column]
    problem = f"the unit of the {role} is told as {unit} and as {other}, by the column's name and the units beside it"
    one, two = (f"#{column + 1}:{each}" for each in (unit, other))
    allowed = f"one unit; where {unit} is right, {asking(role, one)}, where {other} is, {asking(role, two)}"
    raise TableError(block.path, problem, allowed, row=header_line(block), column=name)


def _unit(block: Block, column: int) -> str:
    """The unit of a column, which needs none where it holds times of the clock."""
    return block.units[column] or ("s" if block.clock(column) else "")


def _stamped(block: Block) -> int | None:
    """The first column that holds days with times of the clock, whatever its name; None where none does."""
    clocks = (CLOCK.fullmatch(block.clock(k)) for k in range(len(block.names)))
    return next((k for k, clock in enumerate(clocks) if clock is not None and clock["day"]), None)


def _check_contradiction(block: Block) -> None:
    """Refuse a depth in a unit of force beside a force in one of length, as exchanged names or numbers are."""
    odd: dict[str, int] = {}
    for k, name in enumerate(block.names):
        meaning, dimension = role_of(name), _dimension(block.units[k])
        if meaning is not None and meaning[0] == "force" and dimension == DIMENSIONS["depth"]:
            odd.setdefault("force", k)
        elif meaning is not None and meaning[0] in TRAVEL and dimension == DIMENSIONS["force"]:
            odd.setdefault("depth", k)
    if len(odd) < 2:
        return
    force, depth = odd["force"], odd["depth"]
    problem = f"{_shown(block, depth)!r} and {_shown(block, force)!r}: names and units contradict each other"
    of_units = f"#{depth + 1}:{block.units[depth]}", f"#{force + 1}:{block.units[force]}"
    of_names = f"#{force + 1}:{block.units[depth]}", f"#{depth + 1}:{block.units[force]}"
    by_units, by_names = (f"{asking('force', one)} and {asking('depth', two)}" for one, two in (of_units, of_names))
    allowed = f"where the units are right, {by_units}; where the names are, {by_names}"
    raise TableError(block.path, problem, allowed, row=header_line(block))


def _dimension(unit: str) -> str | None:
    known = unit_of(unit)
    return None if known is None else UNITS[known][1]


SAME_UNITS = 0.02
"""How far two columns of one measurement may be from what their units say: rounded, and by other pounds and grams."""


def _same(block: Block, first: int, other: int) -> bool:
    """Whether two columns are the same measurement in two units: their numbers are proportional, by what units say."""
    rows = np.flatnonzero(~block.lacking(first) & ~block.lacking(other))
    if len(rows) < 3:
        return False
    a, b = block.numbers(first, rows), block.numbers(other, rows)
    spread = float(np.abs(a).max() * np.abs(b).max())
    ratio = float(a @ b) / max(float(a @ a), 1e-300)
    units = [unit_of(block.units[k]) for k in (first, other)]
    if units[0] and units[1]:
        (one, dimension), (two, another) = (UNITS[unit] for unit in units if unit)
        if dimension != another or not math.isclose(abs(ratio) * two, one, rel_tol=SAME_UNITS):
            return False
    return bool(spread > 0.0 and np.allclose(b, ratio * a, rtol=0.0, atol=2e-3 * float(np.abs(b).max())))


def header_line(block: Block) -> int:
    """The row of the file that an error about its columns names."""
    return max(int(block.lines[0]) - 1, 1)


def _shown(block: Block, column: int) -> str:
    unit = block.units[column]
    return f"{block.names[column]} [{unit}]" if unit else block.names[column]


def _taken(block: Block, role: str, kind: str, column: int, unit: str, sign: int) -> Taken:
    example = f"{block.names[column] or f'#{column + 1}'}:{_EXAMPLES[role]}"
    if block.lacking(column).all():
        _refuse_words(block, role, kind, column)
    if not unit:
        problem = f"the unit of the {kind} stands neither in its column's name nor in a line below it"
        raise TableError(
            block.path, problem, f"say it, {asking(role, example)}", row=header_line(block), column=block.names[column]
        )
    scale = unit_scale(unit, DIMENSIONS[kind])
    if scale is None:
        problem = f"{unit!r} is no unit of the {kind}"
        raise TableError(
            block.path,
            problem,
            f"a unit of {kind}, {asking(role, example)}",
            row=header_line(block),
            column=block.names[column],
        )
    named = block.names[column] or f"column #{column + 1}"
    return Taken(column, kind, scale, sign, f"{named} [{unit}]")


def _refuse_words(block: Block, role: str, kind: str, column: int) -> None:
    """Refuse a column without any number."""
    check_decimal(block, column, 0)
    problem, value = f"no cell of the column is a number, which would be the {kind}", str(block.columns[column][0])
    place = int(block.lines[0])
    raise TableError(block.path, problem, kinds(role), row=place, column=block.names[column], value=value)


def check_decimal(block: Block, column: int, row: int) -> None:
    """Refuse a cell that is a number with another decimal sign than the file's; raises TableError."""
    value, other = str(block.columns[column][row]), "," if block.decimal == "." else "."
    if not is_number(value, block.decimal) and is_number(value, other):
        problem = f"the number has the decimal sign {other!r}, others have {block.decimal!r}"
        allowed = "one decimal sign in all cells: export it anew"
        place = int(block.lines[row])
        raise TableError(block.path, problem, allowed, row=place, column=block.names[column], value=value)


def kinds(role: str) -> str:
    """What may stand in a column of which most cells are no numbers."""
    if role != "time":
        return f"numbers, in another column, {asking(role, f'COLUMN:{_EXAMPLES[role]}')}"
    clocks = "12:00:01.50 or 2024-03-01 12:00:01.50"
    return f"seconds, or a clock as {clocks}; or rows per second, {asking_key('rate', '100 Hz')}"


def is_record(block: Block, told: Told) -> bool:
    """Whether a block can be a trial: by the words of its columns, or by what was told."""
    words = {meaning[0] for name in block.names if (meaning := role_of(name)) is not None}
    forced, moved = words & {"force", "stress"}, words & {*TRAVEL, "strain"}
    return bool((forced or "force" in told.columns) and (moved or "depth" in told.columns))
