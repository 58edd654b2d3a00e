"""Cells to blocks: where the rows of numbers are, which row names their columns, which gives units, what stands above.

A block is one table of a sheet. Which of its columns are time, depth and force is for `column_choice`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from bench_hw.errors import TableError
from bench_hw.instrument_files.text_sheet import Cell, Sheet, is_absent, is_number, number_text
from bench_hw.instrument_files.vocabulary import (
    UNITS,
    HeaderFact,
    clock_seconds,
    label_and_unit,
    plain,
    role_of,
    unit_of,
)
from bench_hw.tables.columns import numbers_of
from bench_hw.tables.units import FloatArray

KEY_END: Final = re.compile("[:=;]")
"""What parts a header's key from its value in one cell."""
HEADER_ROWS: Final = 4
"""Rows above the first numbers that may name the columns."""


@dataclass(frozen=True, eq=False)
class Block:
    """Named columns.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    name : str
        Of the sheet, group or test; "" where there is but one.
    names, units : tuple of str
        Of the columns: as the file writes them without the unit, and the unit, "" where none stands there.
    headers : tuple of str
        Of the columns, as the file writes them.
    columns : tuple
        Cells of each column, all of one length; or numbers (n,) where a container holds such.
    lines : ndarray of int, shape (n,)
        The row of the file of each row.
    decimal : str
        The decimal sign of cells that are text.
    facts : tuple of HeaderFact
        What stands above the block.
    spoken : str
        The words above the block, for what they say of the kind of test.
    contradicted : Mapping[int, str]
        Of columns whose name and units row (or a container's unit) tell two different units, the one not in `units`.
    """

    path: Path
    name: str
    names: tuple[str, ...]
    units: tuple[str, ...]
    headers: tuple[str, ...]
    columns: tuple[Sequence[Cell] | FloatArray, ...]
    lines: NDArray[np.int64]
    decimal: str = "."
    facts: tuple[HeaderFact, ...] = ()
    spoken: str = ""
    contradicted: Mapping[int, str] = field(default_factory=dict)

    @property
    def rows(self) -> int:
        """Their number."""
        return len(self.lines)

    @property
    def header(self) -> str:
        """The columns for a message, with units."""
        shown = (f"{name} [{unit}]" if unit else name for name, unit in zip(self.names, self.units, strict=True))
        return ", ".join(f"#{number} {each!r}" if each else f"#{number}" for number, each in enumerate(shown, start=1))

    def numbers(self, column: int, rows: NDArray[np.int64] | None = None) -> FloatArray:
        """A column's numbers in the file's unit, or those of some rows; raises TableError at the first that is none."""
        kept = np.arange(self.rows) if rows is None else rows
        cells = self.columns[column]
        if isinstance(cells, np.ndarray):
            return np.asarray(cells[kept], dtype=np.float64)
        name = self.names[column] or f"#{column + 1}"
        texts = [number_text(cells[row], self.decimal) for row in kept.tolist()]
        return numbers_of(self.path, name, texts, self.lines[kept], empty=False)

    def clock(self, column: int) -> str:
        """The first cell of a column of times of the clock, with or without a day; "" where it is none."""
        cells = self.columns[column]
        first = "" if isinstance(cells, np.ndarray) else next((cell for cell in cells if cell != ""), "")
        return first if isinstance(first, str) and clock_seconds(first) is not None else ""

    def lacking(self, column: int) -> NDArray[np.bool_]:
        """(n,): where a column has no number."""
        cells = self.columns[column]
        if isinstance(cells, np.ndarray):
            return ~np.isfinite(cells)
        return np.array([not is_number(cell, self.decimal) for cell in cells], dtype=bool)


def blocks_of(path: Path, sheet: Sheet) -> list[Block]:
    """The blocks of a sheet from above, each with what its header says.

    Raises
    ------
    TableError
        A row of text stands amid rows of numbers.
    """
    data = [_is_data(row, sheet.decimal) for row in sheet.rows]
    spans = list(_spans(path, sheet, data))
    above = 0
    found = []
    for first, last in spans:
        found.append(_block(path, sheet, above, first, last))
        above = last
    return found


def block_of_arrays(
    path: Path, name: str, columns: Mapping[str, np.ndarray], units: Mapping[str, str], facts: Sequence[HeaderFact] = ()
) -> Block:
    """A block of columns that are numbers already, all of one length; a unit in the name counts where none is given."""
    split = [label_and_unit(each) for each in columns]
    said = [units.get(each, "") or unit for each, (_, unit) in zip(columns, split, strict=True)]
    names = [each if units.get(each) else label for each, (label, _) in zip(columns, split, strict=True)]
    arrays = tuple(np.asarray(values, dtype=np.float64).ravel() for values in columns.values())
    lines = np.arange(1, len(arrays[0]) + 1)
    odd = _contradicted(said, [unit for _, unit in split])
    return Block(
        path,
        name,
        tuple(names),
        tuple(said),
        tuple(columns),
        arrays,
        lines,
        facts=tuple(facts),
        spoken=name,
        contradicted=odd,
    )


def _is_data(row: Sequence[Cell], decimal: str) -> bool:
    """Two numbers or more, or words that there is none, and no less of them than of other cells that hold anything."""
    numeric = sum(_is_numeric(cell, decimal) for cell in row)
    return numeric >= 2 and 2 * numeric >= sum(cell != "" for cell in row)


def _is_numeric(cell: Cell, decimal: str) -> bool:
    return is_number(cell, decimal) or is_absent(cell)


def _spans(path: Path, sheet: Sheet, data: Sequence[bool]) -> Iterator[tuple[int, int]]:
    """First row and the row behind the last of each block; blank rows within one are passed over."""
    start: int | None = None
    last = 0
    for row, numeric in enumerate(data):
        blank = not any(cell != "" for cell in sheet.rows[row])
        if numeric and start is not None and row > last and not _names_above(sheet, last, row):
            _check_gap(path, sheet, last, row, row - start)
        if numeric and start is None:
            start = row
        elif not numeric and not blank and start is not None and _ends(sheet, data, row):
            yield start, last
            start = None
        if numeric:
            last = row + 1
    if start is not None:
        yield start, last


def _ends(sheet: Sheet, data: Sequence[bool], row: int) -> bool:
    """Whether a row of text ends a block: a header or the end follows, not just more of the same numbers."""
    following = next((each for each in range(row + 1, len(data)) if data[each]), None)
    return following is None or _names_above(sheet, row, following)


def _names_above(sheet: Sheet, first: int, row: int) -> bool:
    """Whether names of columns stand between two rows."""
    names, _ = _header_rows(sheet, first, row)
    return names is not None and sum(cell != "" for cell in sheet.rows[names]) >= 2


def _check_gap(path: Path, sheet: Sheet, last: int, row: int, rows: int) -> None:
    """Refuse text between rows of numbers; a few rows that are no table yet may have it."""
    for each in range(last, row):
        cells = [cell for cell in sheet.rows[each] if cell != "" and not _is_numeric(cell, sheet.decimal)]
        if cells and rows >= HEADER_ROWS:
            problem = "a row of text stands amid rows of numbers"
            allowed = "rows of numbers without a break; take the row out, or export the tests apart"
            raise TableError(path, problem, allowed, row=sheet.lines[each], value=str(cells[0]))


def _header_rows(sheet: Sheet, above: int, first: int) -> tuple[int | None, int | None]:
    """The rows of names and of units above a block that begins at `first`; None where there are none."""
    candidates = [row for row in range(first - 1, above - 1, -1) if any(cell != "" for cell in sheet.rows[row])]
    width = len(sheet.rows[first])
    units = None
    for row in candidates[:HEADER_ROWS]:
        cells = [str(cell) for cell in sheet.rows[row] if cell != ""]
        if units is None and len(cells) >= 2 and _all_units(cells):
            units = row
        elif _are_names(sheet, row, width):
            return row, units
        elif units is None and len(cells) < 2:
            return None, None
    return None, units


def _all_units(cells: Sequence[str]) -> bool:
    """Units, or text in brackets of which half is."""
    known = [unit_of(cell) is not None for cell in cells]
    return all(known) or (all(cell[0] in "([" for cell in cells) and 2 * sum(known) >= len(cells))


def _are_names(sheet: Sheet, row: int, width: int) -> bool:
    """Two texts or more, as many as columns at most, half of the cells at least; one known word at least where few."""
    cells = [cell for cell in sheet.rows[row] if cell != ""]
    texts = [cell for cell in cells if not is_number(cell, sheet.decimal)]
    known = sum(role_of(label_and_unit(str(cell))[0]) is not None for cell in texts)
    return len(texts) >= 2 and 2 * len(texts) >= len(cells) and (known >= 1 or 2 * len(texts) >= width)


def _block(path: Path, sheet: Sheet, above: int, first: int, last: int) -> Block:
    names_row, units_row = _header_rows(sheet, above, first)
    kept = [row for row in range(first, last) if any(cell != "" for cell in sheet.rows[row])]
    width = max(len(sheet.rows[row]) for row in kept)
    raw = (
        [str(cell).strip() for cell in _padded(sheet.rows[names_row], width)] if names_row is not None else [""] * width
    )
    said = (
        [str(cell).strip() for cell in _padded(sheet.rows[units_row], width)] if units_row is not None else [""] * width
    )
    split = [
        _named(name.lstrip("#% ") if name.startswith(("#", "%")) else name, unit)
        for name, unit in zip(raw, said, strict=True)
    ]
    columns = tuple([_cell(sheet.rows[row], column) for row in kept] for column in range(width))
    head = first if names_row is None else min(names_row, first if units_row is None else units_row)
    rows = sheet.rows[above:head]
    return Block(
        path,
        sheet.name,
        tuple(name for name, _ in split),
        tuple(unit for _, unit in split),
        tuple(raw),
        columns,
        np.array([sheet.lines[row] for row in kept], dtype=np.int64),
        sheet.decimal,
        tuple(header_facts(rows)),
        " ".join(str(cell) for row in (*rows, raw) for cell in row if isinstance(cell, str)),
        _contradicted([unit for _, unit in split], said),
    )


def _contradicted(units: Sequence[str], others: Sequence[str]) -> dict[int, str]:
    """Of the columns whose two units are both known and differ, the other one; a dash is none."""
    known = [(unit_of(unit), unit_of(other)) for unit, other in zip(units, others, strict=True)]
    return {
        k: other
        for k, (unit, other) in enumerate(known)
        if unit and other and not {unit, other} & {"-", "1"} and UNITS[unit] != UNITS[other]
    }


def _named(name: str, unit: str) -> tuple[str, str]:
    label, own = label_and_unit(name)
    below = unit_of(unit) or unit.strip("()[] ") if unit else ""
    return (label, own) if own else (name, below)


def _padded(row: Sequence[Cell], width: int) -> list[Cell]:
    return [*row[:width], *[""] * (width - len(row))]


def _cell(row: Sequence[Cell], column: int) -> Cell:
    return row[column] if column < len(row) else ""


def header_facts(rows: Sequence[Sequence[Cell]]) -> Iterator[HeaderFact]:
    """Keys with their values in header rows: `key: value`, a key and a value in cells side by side, its unit behind.

    An equals sign or a semicolon parts them as a colon does.
    """
    for row in rows:
        cells = [str(cell) if isinstance(cell, str) else f"{cell:g}" for cell in row if cell != ""]
        for key, rest in ((cell, cells[number + 1 :]) for number, cell in enumerate(cells)):
            before, *behind_sign = KEY_END.split(key.rstrip(":=; "), maxsplit=1)
            after = "".join(behind_sign)
            if after and not (rest and after.strip()[:1].isalpha() and rest[0][:1].isdigit()):
                inner, own = label_and_unit(before.strip(" #"))
                yield HeaderFact(inner, after.strip(), own)
            elif rest:
                label, unit = label_and_unit((after or before).strip(" #"))
                behind = rest[1] if len(rest) > 1 and unit_of(rest[1]) else ""
                yield HeaderFact(label, rest[0].lstrip(":=; "), unit or behind)


def side_by_side(block: Block) -> Iterator[Block]:
    """The tests of a block that holds several side by side: its names begin again, each as long as it is filled."""
    starts = [k for k, name in enumerate(block.names) if name and _key(block, k) == _key(block, 0)]
    width = starts[1] if len(starts) > 1 else 0
    names = [_key(block, k) for k in range(len(block.names))]
    if width < 2 or any(names[k] != names[k % width] for k in range(len(names)) if names[k] != ("", "")):
        yield block
        return
    for number, start in enumerate(starts, start=1):
        yield _part(block, number, start, width)


def _key(block: Block, column: int) -> tuple[str, str]:
    return plain(block.names[column]), block.units[column]


def _part(block: Block, number: int, start: int, width: int) -> Block:
    columns = range(start, min(start + width, len(block.names)))
    filled = np.flatnonzero(~np.logical_or.reduce([block.lacking(k) for k in columns]))
    rows = int(filled[-1]) + 1 if len(filled) else 0
    return replace(
        block,
        name=f"{block.name} {number}".strip(),
        names=tuple(block.names[k] for k in columns),
        headers=tuple(block.headers[k] for k in columns),
        units=tuple(block.units[k] for k in columns),
        columns=tuple(block.columns[k][:rows] for k in columns),
        lines=block.lines[:rows],
        contradicted={k - start: unit for k, unit in block.contradicted.items() if k in columns},
    )


def joined(parts: Sequence[Block]) -> list[Block]:
    """Blocks of one record that the instrument wrote in pieces: the same names again, and time that goes on."""
    out: list[Block] = []
    for part in parts:
        if out and _goes_on(out[-1], part):
            out[-1] = _append(out[-1], part)
        else:
            out.append(part)
    names = [part.name for part in out]
    return [
        part
        if names.count(part.name) == 1
        else _renamed(part, f"{part.name} {names[: k + 1].count(part.name)}".strip())
        for k, part in enumerate(out)
    ]


def _renamed(block: Block, name: str) -> Block:
    return replace(block, name=name)


def _goes_on(before: Block, after: Block) -> bool:
    if before.names != after.names or before.units != after.units or not before.rows or not after.rows:
        return False
    time = next((k for k, name in enumerate(before.names) if (name and _is_time(name))), None)
    if time is None or before.lacking(time)[-1] or after.lacking(time)[0]:
        return False
    last = before.numbers(time, np.array([before.rows - 1]))[0]
    return bool(after.numbers(time, np.array([0]))[0] > last)


def _is_time(name: str) -> bool:
    meaning = role_of(name)
    return meaning is not None and meaning[0] == "time"


def _append(before: Block, after: Block) -> Block:
    columns = tuple(
        np.concatenate([a, b]) if isinstance(a, np.ndarray) and isinstance(b, np.ndarray) else [*a, *b]
        for a, b in zip(before.columns, after.columns, strict=True)
    )
    lines = np.concatenate([before.lines, after.lines])
    return replace(before, columns=columns, lines=lines, facts=(*before.facts, *after.facts))
