"""Text files of instruments to cells: encoding, delimiter and decimal sign found out from the file itself, and told.

What the cells mean is for `blocks`.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final

from bench_hw.errors import TableError
from bench_hw.instrument_files.told import Told, asking_key
from bench_hw.instrument_files.vocabulary import UNITS, clock_seconds, label_and_unit, role_of, unit_of
from bench_hw.storage.regular_file import TABLE, read_regular

Cell = str | float
"""A cell: text without blanks around it (`""` if empty), or the number a workbook holds."""

Counts = Callable[[Cell, str], bool]
"""Whether a cell counts as a number, under a decimal sign."""

DELIMITERS: Final = ("\t", ";", ",", "|", " ")
NAMES: Final = {"\t": "tab", ";": "semicolon", ",": "comma", "|": "bar", " ": "blanks"}
SAMPLE: Final = 400
"""Lines that delimiter and decimal sign are found out from."""
_BOMS: Final = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF32_LE, "utf-32"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
NANOSCOPE: Final = re.compile(rb"\\\*(?:Force )?[Ff]ile list")
"""How the header of Bruker's NanoScope begins, before counts of its own."""
_BYTE_ENCODINGS: Final = ("gb18030", "shift_jis", "cp1250", "cp1252")
_MARKS: Final = (
    "'\N{RIGHT SINGLE QUOTATION MARK} \N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}\N{THIN SPACE}\N{FIGURE SPACE}"
)
"""What stands between thousands besides the other decimal sign, in Switzerland and France; no thousands begin by 0."""
_WRITTEN: Final = {
    decimal: rf"[+-]?(?:[1-9]\d{{0,2}}(?:[{other}{_MARKS}]\d{{3}})+|\d+)?(?:[{decimal}]\d*)?(?:[eE][+-]?\d+)?"
    for decimal, other in ((".", ","), (",", "."))
}
_NUMBER: Final = {decimal: re.compile(written, re.ASCII) for decimal, written in _WRITTEN.items()}
_QUANTITY: Final = {
    decimal: re.compile(rf"({written})\s*([^\d\s.,+'-]\S*)", re.ASCII) for decimal, written in _WRITTEN.items()
}
_UNMARKED: Final = {
    decimal: str.maketrans({",": "."} | dict.fromkeys(f"{other}{_MARKS}"))
    for decimal, other in ((".", ","), (",", "."))
}
MINUS: Final = "\N{MINUS SIGN}"
"""What Scandinavian settings write before a number."""
_INFINITE: Final = ("inf", "+inf", "-inf", "infinity", "-infinity", "1.#inf", "-1.#inf")
_ERRORS: Final = ("#n/a", "#nv", "#div/0!", "#num!", "#zahl!", "#value!", "#wert!", "1.#ind", "-1.#ind", "1.#qnan")
ABSENT: Final = frozenset(("nan", "-nan", "n/a", "null", "--", "---", *_INFINITE, *_ERRORS))
"""What stands, in any case of letters, where a program had no number: a cell of a column, never the name of one."""
ONE_UNIT: Final = "the same known unit behind every number of a column, or in its name alone"
_TERNARY = re.compile(r"[+-]?[1-9]\d{0,2}([.,])\d{3}", re.ASCII)


class NoNumbersError(TableError):
    """A text without rows of numbers: notes beside the trials, perhaps."""


@dataclass(frozen=True, eq=False)
class Sheet:
    """The cells of one sheet.

    Parameters
    ----------
    name : str
        Of the sheet; "" for a text file.
    rows : sequence of sequence of Cell
        As many cells as each row has.
    lines : sequence of int
        The row of the file that each stands in, counted from 1.
    decimal : str
        The decimal sign of cells that are text.
    told : str
        How the file was read, for people.
    """

    name: str
    rows: Sequence[Sequence[Cell]]
    lines: Sequence[int]
    decimal: str = "."
    told: str = ""


def is_number(cell: Cell, decimal: str) -> bool:
    """Whether a cell is a number or a time of the clock, with or without its day."""
    if not isinstance(cell, str):
        return True
    if not cell or cell[0] not in "0123456789+-.,":
        return False
    digits = any(letter.isdigit() for letter in cell[:4])
    return bool(digits and _NUMBER[decimal].fullmatch(cell)) or clock_seconds(cell) is not None


def unit_in(cell: Cell, decimal: str) -> str | None:
    """The known unit that stands behind the number of a cell, as in `1.2 mm`; None for any other cell."""
    if not isinstance(cell, str) or cell[:1] not in "0123456789+-.," or is_number(cell, decimal):
        return None
    found = _QUANTITY[decimal].fullmatch(cell)
    return unit_of(found[2]) if found and is_number(found[1], decimal) else None


def is_absent(cell: Cell) -> bool:
    """Whether a cell says that there is no number."""
    return not math.isfinite(cell) if not isinstance(cell, str) else cell.casefold() in ABSENT


def number_text(cell: Cell, decimal: str) -> str:
    """A cell as a number with a point, thousands unmarked, a clock in seconds; other text as it is."""
    if not isinstance(cell, str):
        return repr(float(cell))
    if (seconds := clock_seconds(cell)) is not None:
        return repr(seconds)
    if not _NUMBER[decimal].fullmatch(cell):
        return cell
    return cell.translate(_UNMARKED[decimal])


def text_sheet(path: Path, told: Told) -> Sheet:
    """Decode and split a text file.

    Raises
    ------
    TableError
        The file is missing, unreadable, empty, in no known encoding, or its commas can mean two things.
    """
    text, encoding = _decoded(path, _bytes(path), told.encoding)
    lines = [line.rstrip("\r\n") for line in text.replace(MINUS, "-").splitlines()]
    if not any(line.strip() for line in lines):
        raise NoNumbersError(path, "the file is empty", "a header and rows of numbers")
    delimiter, decimal = _signs(path, lines, told)
    rows = [_cells(path, number, line, delimiter) for number, line in enumerate(lines, start=1)]
    said = f"{encoding}, cells separated by {NAMES.get(delimiter, repr(delimiter))}, decimal {_sign_name(decimal)}"
    if _units_to_names(path, rows, decimal):
        said += ", units behind the numbers of cells"
    if not told.decimal:
        _check_ternary(path, rows, decimal)
    return Sheet("", rows, range(1, len(rows) + 1), decimal, said)


def sheet_of_cells(path: Path, name: str, rows: list[list[Cell]]) -> Sheet:
    """A workbook's sheet, whose cells of text may be numbers with one decimal sign or the other, and with units."""
    texts = [cell for row in rows for cell in row if isinstance(cell, str) and cell]
    points, commas = (sum(_is_loose(cell, sign) for cell in texts) for sign in (".", ","))
    decimal = "," if commas > points else "."
    if max(points, commas) > SAMPLE // 10 and len(_rows_of(rows, _is_loose, decimal)) > SAMPLE // 20:
        _units_to_names(path, rows, decimal)
        marked = [cell for cell in texts if "," in cell and _TERNARY.fullmatch(cell)]
        if marked and points == commas:
            problem, allowed = "the comma may stand before decimals or thousands", "numbers as numbers, not as text"
            raise TableError(path, problem, allowed, value=marked[0])
    return Sheet(name, rows, range(1, len(rows) + 1), decimal)


def _sign_name(decimal: str) -> str:
    return "comma" if decimal == "," else "point"


def _bytes(path: Path) -> bytes:
    try:
        return read_regular(path, TABLE)
    except OSError as error:
        raise TableError(path, f"the file cannot be read ({error.strerror})", "a readable file") from error


def _decoded(path: Path, raw: bytes, told: str) -> tuple[str, str]:
    """The text of a file and the name of its encoding: told, by its mark, by its zeros, or by its words."""
    allowed = f"an encoding that the file is in, for instance {asking_key('encoding', 'latin-1')}"
    if told:
        try:
            return raw.decode(told).removeprefix("\ufeff"), told
        except (LookupError, UnicodeDecodeError) as error:
            raise TableError(path, f"the file is no {told} text ({error})", allowed) from error
    for mark, encoding in _BOMS:
        if raw.startswith(mark):
            return _strict(path, raw, encoding, allowed).removeprefix("\ufeff"), encoding.removesuffix("-sig")
    head = raw[:4000]
    if NANOSCOPE.match(head):
        allowed = "the name it was saved under, NAME.spm or NAME.000, by which it is read"
        raise TableError(path, f"this is a Bruker NanoScope file with the ending {path.suffix!r}", allowed)
    even, odd = head[::2].count(0), head[1::2].count(0)
    if max(even, odd) > len(head) // 4 and min(even, odd) <= len(head) // 100:  # letters of two bytes, one of them 0
        return _strict(path, raw, "utf-16-be" if head[:2].startswith(b"\0") else "utf-16-le", allowed), "utf-16"
    if b"\0" in head:
        raise TableError(path, "this is no text and no format that is known", "a format that docs/own-trials.md lists")
    try:
        return raw.decode("utf-8"), "utf-8"
    except UnicodeDecodeError:
        return _by_words(path, raw, allowed)


def _strict(path: Path, raw: bytes, encoding: str, allowed: str) -> str:
    try:
        return raw.decode(encoding)
    except UnicodeDecodeError as error:
        problem = f"the file begins as {encoding} and breaks off at byte {error.start}"
        raise TableError(path, problem, f"a whole file; or {allowed}") from error


def _by_words(path: Path, raw: bytes, allowed: str) -> tuple[str, str]:
    """Of the encodings that can be, the one in which most names of columns are known words."""
    found = []
    for encoding in _BYTE_ENCODINGS:
        try:
            text = raw.decode(encoding)
        except UnicodeDecodeError:
            continue
        found.append((_known_words(text), encoding, text))
    if not found:
        raise TableError(path, "the file is in no encoding that can be found out", allowed)
    known, encoding, text = max(found, key=lambda each: (each[0], each[1] == "cp1252"))
    return text, f"{encoding} (by its words)" if known else f"{encoding} (taken, since nothing tells)"


def _known_words(text: str) -> int:
    cells = (cell for line in islice(text.splitlines(), SAMPLE) for cell in re.split(r"[\t;,|]", line))
    strange = [cell.strip(' "') for cell in cells if not cell.isascii()]
    return sum(role_of(label_and_unit(cell)[0]) is not None for cell in strange if cell)


def _cells(path: Path, number: int, line: str, delimiter: str) -> list[Cell]:
    if delimiter == " ":
        return list(line.split())
    if '"' not in line:
        return [cell.strip() for cell in line.split(delimiter)]
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=delimiter, strict=True))]
    except csv.Error as error:
        allowed = f"cells separated by one sign, quotes closed; or {asking_key('delimiter', 'tab')}"
        raise TableError(path, f"the row cannot be split ({error})", allowed, row=number) from error


def _signs(path: Path, lines: Sequence[str], told: Told) -> tuple[str, str]:
    """Delimiter and decimal sign under which most cells of rows alike are numbers."""
    sample = [line for line in lines[:SAMPLE] if line.strip()] + [line for line in lines[-SAMPLE:] if line.strip()]
    delimiters = [_delimiter(told.delimiter)] if told.delimiter else list(DELIMITERS)
    decimals = [told.decimal] if told.decimal else [".", ","]
    signs = [
        (delimiter, decimal)
        for delimiter in delimiters
        for decimal in decimals
        if delimiter != decimal or any('"' in line for line in sample)
    ]
    if not told.delimiter and any(_is_table(sample, *each) for each in signs):
        signs = [each for each in signs if each[0] != " "]  # which stands between thousands there
    best = _best(sample, signs, _is_plain)
    if best[0] == 0:
        best = _best(sample, [each for each in signs if each[0] != " "], _is_loose)
    if best[0] == 0:
        _no_numbers(path, lines, told)
    _check_one_comma(path, lines, best[2], told)
    return best[2], best[3]


def _best(sample: Sequence[str], signs: Sequence[tuple[str, str]], counts: Counts) -> tuple[int, int, str, str]:
    """The largest score, its order, delimiter and decimal sign; of equal ones the first delimiter and the point."""
    scored = [
        (_score(sample, delimiter, decimal, counts)[0], -order, delimiter, decimal)
        for order, (delimiter, decimal) in enumerate(signs)
    ]
    return max(scored, default=(0, 0, "", ""))


def _is_table(sample: Sequence[str], delimiter: str, decimal: str) -> bool:
    """Whether tabs, or another sign than blanks that splits a row of words as often, leave cells that are numbers."""
    if delimiter == " ":
        return False
    score, width = _score(sample, delimiter, decimal, _is_loose)
    words = (line.split(delimiter) for line in sample)
    return score > 0 and (
        delimiter == "\t"
        or any(len(row) == width and not any(_is_loose(cell, decimal) for cell in row) for row in words)
    )


def _is_plain(cell: Cell, decimal: str) -> bool:
    """A number without blanks, which may as well stand between two cells."""
    return is_number(cell, decimal) and " " not in str(cell)


def _is_loose(cell: Cell, decimal: str) -> bool:
    """A number with blanks between thousands or a unit behind it, too."""
    return is_number(cell, decimal) or unit_in(cell, decimal) is not None


def _delimiter(told: str) -> str:
    named = {name: sign for sign, name in NAMES.items()} | {"space": " ", "blank": " "}
    return named.get(told, told[:1])


def _score(sample: Sequence[str], delimiter: str, decimal: str, counts: Counts) -> tuple[int, int]:
    """Numeric cells in rows of the commonest width from two on, none where other cells are text; and that width."""
    rows = []
    for line in sample:
        try:
            cells = _cells(Path(), 0, line, delimiter)
        except TableError:
            continue
        numeric = sum(counts(cell, decimal) for cell in cells)
        if numeric >= 2:
            rows.append((len(cells), 2 * numeric - sum(cell != "" for cell in cells)))
    if not rows:
        return 0, 0
    width = Counter(width for width, _ in rows).most_common(1)[0][0]
    return max(0, sum(numeric for each, numeric in rows if each == width)), width


def _no_numbers(path: Path, lines: Sequence[str], told: Told) -> None:
    first = next(number for number, line in enumerate(lines, start=1) if line.strip())
    options = {"the delimiter": told.delimiter, "the decimal sign": told.decimal}
    said = " and ".join(f"{option} {value!r}" for option, value in options.items() if value)
    problem = f"no rows of numbers were found{f' with {said}, as told' if said else ''}"
    allowed = f"rows of at least two numbers, separated by tab, semicolon, comma or blanks; or {_ASK_DELIMITER}"
    first = next((number for number, line in enumerate(lines, start=1) if _UNKNOWN.search(line)), first)
    if _UNKNOWN.search(lines[first - 1]):
        allowed += f"; behind a number nothing but a known unit, {ONE_UNIT}"
    if alone := next((number for number, line in enumerate(lines[:SAMPLE], start=1) if _UNIT_ALONE.search(line)), 0):
        first, allowed = (
            alone,
            "no columns of units beside the numbers: take them out, and say `Depth (mm)` in the name",
        )
    raise NoNumbersError(path, problem, allowed, row=first, value=lines[first - 1].strip())


_UNKNOWN: Final = re.compile(r"(?:^|[\t;,|])\s*[+-]?\d[\d.,]*\s*[^\W\d_]+\s*(?:$|[\t;,|])")
"""A cell with letters behind its number, none of which is a known unit where no rows are found."""
_UNIT_ALONE: Final = re.compile(
    r"(?:^|[\t;,|])\s*[+-]?\d[\d.,]*\s*[\t;,|]\s*(?:[µu]?m|[cm]m|[mk]?N|[mk]?g|s|ms)\s*(?:$|[\t;,|])"
)
"""A unit in a cell of its own behind a number."""
_ASK_DELIMITER: Final = asking_key("delimiter", "tab")


def _check_one_comma(path: Path, lines: Sequence[str], delimiter: str, told: Told) -> None:
    """Refuse rows in which the comma separates cells and decimals alike: twice as many cells as names."""
    if delimiter != "," or told.delimiter:
        return
    widths = [(number, len(line.split(","))) for number, line in enumerate(lines, start=1) if '"' not in line]
    numbers = [(number, width) for number, width in widths if is_number(lines[number - 1].split(",")[0].strip(), ".")]
    if not numbers:
        return
    first, width = numbers[0]
    header = next((width for number, width in reversed(widths) if number < first and width > 1), width)
    wide = (number for number, width in numbers if width > header and _THOUSANDS.search(lines[number - 1]))
    if any(width == header for _, width in numbers) and (number := next(wide, 0)):
        found = len(lines[number - 1].split(","))
        problem = f"the row has {found} cells, its header {header}: the comma seems to stand between thousands, too"
        raise TableError(path, problem, _ANOTHER_SIGN, row=number, value=lines[number - 1])
    if width == 2 * header and len({each for _, each in numbers}) == 1:
        problem = (
            f"the row has {width} cells, its header {header}: the comma seems to stand between cells and in numbers"
        )
        raise TableError(path, problem, _ANOTHER_SIGN, row=first, value=lines[first - 1])


_ANOTHER_SIGN: Final = (
    "another sign between cells (semicolon or tab), or numbers in quotes or with a point: export it anew"
)
_THOUSANDS: Final = re.compile(r"(?:^|,)\s*[+-]?[1-9]\d{0,2},\d{3}(?:\.\d*)?\s*(?:,|$)", re.ASCII)
"""A number whose thousands a comma marks, among cells that commas separate."""


def _units_to_names(path: Path, rows: list[list[Cell]], decimal: str) -> bool:
    """Take a unit that stands in every cell of a column to the column's name; whether there was any.

    A column with cells of several units, or some without, stays as it is where other columns are numbers, and is
    refused where it is needed; where no row is numbers without it, it is refused here.
    """
    data, only = _rows_of(rows, is_number, decimal), False
    if not data:
        data, only = _rows_of(rows, _is_loose, decimal), True
    taken = False
    for column in range(max((len(rows[row]) for row in data), default=0)):
        filled = [row for row in data if len(rows[row]) > column and rows[row][column] != ""]
        if not only and not (filled and unit_in(rows[filled[0]][column], decimal)):
            continue
        units = {row: unit_in(rows[row][column], decimal) for row in filled}
        spelt = {unit and UNITS[unit] for unit in units.values()}
        if spelt == {None} or not spelt:
            continue
        if len(spelt) == 1:
            _name_unit(path, rows, (data[0], column), str(units[filled[0]]))
            for row in filled:
                found = _QUANTITY[decimal].fullmatch(str(rows[row][column]))
                rows[row][column] = "" if found is None else found[1]
            taken = True
        elif only:
            row = next(row for row in filled if units[row] != units[filled[0]])
            first = f"row {filled[0] + 1} has {units[filled[0]] or 'no unit'}"
            problem = f"the cells of column #{column + 1} are not in one unit: {first}"
            raise TableError(path, problem, ONE_UNIT, row=row + 1, value=str(rows[row][column]))
    return taken


def _rows_of(rows: Sequence[Sequence[Cell]], counts: Counts, decimal: str) -> list[int]:
    """The rows of the commonest width that hold two numeric cells or more, and no less of them than of other cells."""
    found = []
    for row, cells in enumerate(rows):
        numeric = sum(counts(cell, decimal) for cell in cells)
        if numeric >= 2 and 2 * numeric >= sum(cell != "" for cell in cells):
            found.append(row)
    width = Counter(len(rows[row]) for row in found).most_common(1)
    return [row for row in found if len(rows[row]) == width[0][0]]


def _name_unit(path: Path, rows: list[list[Cell]], first: tuple[int, int], unit: str) -> None:
    """Write the unit of a column's cells to its name; refuses another one that is told above its `first` cell."""
    top, column = first
    above = [row for row in range(top - 1, max(-1, top - 5), -1) if sum(cell != "" for cell in rows[row]) >= 2]
    for row in above:
        cell = str(rows[row][column]) if len(rows[row]) > column else ""
        told = unit_of(cell) or label_and_unit(cell)[1]
        if told:
            if UNITS[told] != UNITS[unit]:
                problem = f"the cells of column #{column + 1} are in {unit}, its name in row {row + 1} says {told}"
                raise TableError(path, problem, ONE_UNIT, row=top + 1, value=str(rows[top][column]))
            return
    if above and len(rows[above[0]]) > column:
        rows[above[0]][column] = f"{rows[above[0]][column]} [{unit}]".strip()


def _check_ternary(path: Path, rows: Sequence[Sequence[Cell]], decimal: str) -> None:
    """Refuse numbers like 1,234 throughout, which are thousands to one country and decimals to another."""
    other = "," if decimal == "." else "."
    marked = [
        (number, cell)
        for number, row in enumerate(rows, start=1)
        for cell in row
        if isinstance(cell, str) and ("," in cell or "." in cell) and is_number(cell, decimal) and ":" not in cell
    ]
    odd = [(number, cell) for number, cell in marked if _TERNARY.fullmatch(cell)]
    if marked and len(odd) == len(marked) and len({cell[-4] for _, cell in odd}) == 1:
        number, cell = odd[0]
        problem = f"{cell[-4]!r} is followed by three digits in every number: thousands or decimals"
        sign = asking_key("decimal", cell[-4])
        raise TableError(path, problem, f"{sign}, or {other!r} there", row=number, value=cell)
