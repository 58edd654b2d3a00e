"""Text files of instruments to cells: encoding, delimiter and decimal sign found out from the file itself, and told.

What the cells mean is for `blocks`.
"""

from __future__ import annotations

import codecs
import csv
import math
import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Final

from bench_hw.errors import TableError
from bench_hw.instrument_files.told import Told, asking_key
from bench_hw.instrument_files.vocabulary import label_and_unit, role_of
from bench_hw.storage.regular_file import TABLE, read_regular

Cell = str | float
"""A cell: text without blanks around it (`""` if empty), or the number a workbook holds."""

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
_MARKS: Final = "'\N{RIGHT SINGLE QUOTATION MARK}\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}"
"""What stands between thousands besides the other decimal sign, in Switzerland and France."""
_NUMBER: Final = {
    decimal: re.compile(
        rf"[+-]?(?:\d{{1,3}}(?:[{other}{_MARKS}]\d{{3}})+|\d+)?(?:[{decimal}]\d*)?(?:[eE][+-]?\d+)?", re.ASCII
    )
    for decimal, other in ((".", ","), (",", "."))
}
_UNMARKED: Final = {
    decimal: str.maketrans({",": "."} | dict.fromkeys(f"{other}{_MARKS}"))
    for decimal, other in ((".", ","), (",", "."))
}
CLOCK: Final = re.compile(r"(?:(\d+):)?(\d{1,2}):(\d{2}(?:[.,]\d+)?)", re.ASCII)
MINUS: Final = "\N{MINUS SIGN}"
"""What Scandinavian settings write before a number."""
_INFINITE: Final = ("inf", "+inf", "-inf", "infinity", "-infinity", "1.#inf", "-1.#inf")
_ERRORS: Final = ("#n/a", "#nv", "#div/0!", "#num!", "#zahl!", "#value!", "#wert!", "1.#ind", "-1.#ind", "1.#qnan")
ABSENT: Final = frozenset(("nan", "-nan", "n/a", "null", "--", "---", *_INFINITE, *_ERRORS))
"""What stands, in any case of letters, where a program had no number: a cell of a column, never the name of one."""
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
    """Whether a cell is a number or a time of the clock."""
    if not isinstance(cell, str):
        return True
    if not cell or cell[0] not in "0123456789+-.,":
        return False
    digits = any(letter.isdigit() for letter in cell[:4])
    return bool(digits and _NUMBER[decimal].fullmatch(cell)) or bool(CLOCK.fullmatch(cell))


def is_absent(cell: Cell) -> bool:
    """Whether a cell says that there is no number."""
    return not math.isfinite(cell) if not isinstance(cell, str) else cell.casefold() in ABSENT


def number_text(cell: Cell, decimal: str) -> str:
    """A cell as a number with a point, thousands unmarked, a clock in seconds; other text as it is."""
    if not isinstance(cell, str):
        return repr(float(cell))
    if (clock := CLOCK.fullmatch(cell)) is not None:
        hours, minutes, seconds = clock.groups()
        return repr(3600.0 * int(hours or 0) + 60.0 * int(minutes) + float(seconds.replace(",", ".")))
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
    if not told.decimal:
        _check_ternary(path, rows, decimal)
    said = f"{encoding}, cells separated by {NAMES.get(delimiter, repr(delimiter))}, decimal {_sign_name(decimal)}"
    return Sheet("", rows, range(1, len(rows) + 1), decimal, said)


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
    scored = [
        (_score(sample, delimiter, decimal), -order, delimiter, decimal)
        for order, delimiter in enumerate(delimiters)
        for decimal in decimals
        if delimiter != decimal or any('"' in line for line in sample)
    ]
    best = max(scored)
    if best[0] == 0:
        _no_numbers(path, lines, told)
    _check_one_comma(path, lines, best[2], told)
    return best[2], best[3]


def _delimiter(told: str) -> str:
    named = {name: sign for sign, name in NAMES.items()} | {"space": " ", "blank": " "}
    return named.get(told, told[:1])


def _score(sample: Sequence[str], delimiter: str, decimal: str) -> int:
    """Numeric cells in rows of the commonest width from two cells on; none where other cells of them are text."""
    rows = []
    for line in sample:
        try:
            cells = _cells(Path(), 0, line, delimiter)
        except TableError:
            continue
        numeric = sum(is_number(cell, decimal) for cell in cells)
        if numeric >= 2:
            rows.append((len(cells), 2 * numeric - sum(cell != "" for cell in cells)))
    if not rows:
        return 0
    width = Counter(width for width, _ in rows).most_common(1)[0][0]
    return max(0, sum(numeric for each, numeric in rows if each == width))


def _no_numbers(path: Path, lines: Sequence[str], told: Told) -> None:
    first = next(number for number, line in enumerate(lines, start=1) if line.strip())
    options = {"the delimiter": told.delimiter, "the decimal sign": told.decimal}
    said = " and ".join(f"{option} {value!r}" for option, value in options.items() if value)
    problem = f"no rows of numbers were found{f' with {said}, as told' if said else ''}"
    allowed = f"rows of at least two numbers, separated by tab, semicolon, comma or blanks; or {_ASK_DELIMITER}"
    raise NoNumbersError(path, problem, allowed, row=first, value=lines[first - 1].strip())


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
    if width == 2 * header and len({each for _, each in numbers}) == 1:
        problem = (
            f"the row has {width} cells, its header {header}: the comma seems to stand between cells and in numbers"
        )
        allowed = "another sign between cells (semicolon or tab), or numbers in quotes or with a point: export it anew"
        raise TableError(path, problem, allowed, row=first, value=lines[first - 1])


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
