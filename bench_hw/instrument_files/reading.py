"""An instrument's file as trials: opened by its format, its records read, and told to a person before they are used."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from bench_hw.errors import TableError
from bench_hw.instrument_files.blocks import Block, blocks_of, joined, side_by_side
from bench_hw.instrument_files.column_choice import is_record, takes
from bench_hw.instrument_files.containers import OPENERS, ending_of, open_container
from bench_hw.instrument_files.press_record import PressRecord, phases, record_of
from bench_hw.instrument_files.text_sheet import text_sheet
from bench_hw.instrument_files.told import Told, parse_source
from bench_hw.instrument_files.vocabulary import (
    DIMENSIONS,
    FACT_DIMENSIONS,
    FACTS,
    SPHERE,
    TA_PROBE,
    HeaderFact,
    plain,
    role_of,
    unit_scale,
)
from bench_hw.tables.columns import MINIMUM_ROWS

TEXT_ENDINGS: Final = (".csv", ".txt", ".tsv", ".tab", ".dat", ".asc", ".tra", ".lvm")
ENDINGS: Final = (*TEXT_ENDINGS, *OPENERS)
"""Of the files that this reads."""
FACT_LIMITS: Final = {"tool_radius": (1e-9, 1.0), "height": (1e-7, 1.0), "area": (1e-14, 1.0)}
"""What a header may tell, m and m2: other values are no tool and no specimen (0 for `not entered`)."""
DIVIDED: Final[dict[str, tuple[tuple[str, ...], str]]] = {
    "height": (("displacement", "depth"), "strain"),
    "area": (("force",), "stress"),
}
"""Columns of which an instrument divided one by the specimen's height or cross-section to give the other."""
PROPORTIONAL: Final = 3e-3
"""Of the range, within which one column must be a constant times the other."""


@dataclass(frozen=True)
class Reading:
    """What a header tells of tool and specimen, with the words that say so.

    Parameters
    ----------
    tool_radius : float or None
        m.
    spherical : bool
        Whether the tool is a ball.
    height : float or None
        Of the specimen, m.
    area : float or None
        Of the specimen, m2.
    sources : tuple of str
        The header lines, one a value.
    """

    tool_radius: float | None = None
    spherical: bool = False
    height: float | None = None
    area: float | None = None
    sources: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class InstrumentFile:
    """A file as it was read.

    Parameters
    ----------
    path : pathlib.Path
        The file.
    what : str
        Its format, for people.
    records : tuple of PressRecord
        The trials in it, in the file's order.
    header : Reading
        What it tells of tool and specimen.
    notes : tuple of str
        What was left aside.
    """

    path: Path
    what: str
    records: tuple[PressRecord, ...]
    header: Reading
    notes: tuple[str, ...]


def read_instrument_file(path: Path | str, told: Told | None = None) -> InstrumentFile:
    """Read the trials of a file as an instrument wrote it.

    Parameters
    ----------
    path : path-like
        Text (csv, txt, tsv, tab, dat, asc, tra) of any layout, or one of the containers in `OPENERS`.
    told : Told, optional
        What the file does not say itself.

    Raises
    ------
    TableError
        It cannot be read, holds no trial, or leaves open what only a person can say; the message names the option.
    """
    path, told = Path(path), told or Told()
    if ending_of(path) in OPENERS:
        what, blocks = OPENERS[ending_of(path)][0], open_container(path)
    else:
        sheet = text_sheet(path, told)
        what, blocks = f"text, {sheet.told}", blocks_of(path, sheet)
    records, header, aside = _records(path, blocks, told)
    return InstrumentFile(path, what, tuple(records), header, tuple(aside))


def _chosen(path: Path, parts: Sequence[Block], told: Told) -> list[Block]:
    """The parts to read: all, or those that were named."""
    names = list(dict.fromkeys(part.name for part in parts))
    for name in told.sheets:
        if name not in names:
            listed = ", ".join(map(repr, names)) or "none"
            raise TableError(path, f"import.sheets: no sheet {name!r} with numbers", f"some of {listed}")
    return [part for part in parts if not told.sheets or part.name in told.sheets]


def _records(path: Path, blocks: Sequence[Block], told: Told) -> tuple[list[PressRecord], Reading, list[str]]:
    """The trials of all blocks, what the headers tell, and which blocks are none."""
    parts = [part for block in blocks for part in side_by_side(block)]
    parts = _chosen(path, joined(parts), told)
    trials = [part for part in parts if is_record(part, told) and part.rows >= MINIMUM_ROWS]
    if not trials:
        _refuse(path, parts, told)
    results = [fact for part in parts if part.rows < MINIMUM_ROWS for fact in _table_facts(part)]
    header = _with_faces(header_reading([*(fact for part in trials for fact in part.facts), *results]), trials)
    known = replace(
        told,
        height=told.height or header.height,
        area=told.area or header.area,
        tool=told.tool or header.tool_radius is not None,
    )
    records = [record_of(_with_all_words(part), known) for part in trials]
    taken = {part.name for part in trials}
    if (
        len(records) == 1 and records[0].name.isdigit()
    ):  # the number of a table among the file's own, which names nothing
        records = [replace(records[0], name="")]
    aside = [
        f"{part.name!r} holds no record of a press and is left aside"
        for part in parts
        if part.name not in taken and part.rows >= 2
    ]
    return records, header, list(dict.fromkeys(aside))


def _with_faces(header: Reading, trials: Sequence[Block]) -> Reading:
    """What the header tells, and where it is silent the height and cross-section by which its columns were divided."""
    tall, height = _told_or_divided("height", header.height, trials, 1e3, "mm")
    wide, area = _told_or_divided("area", header.area, trials, 1e6, "mm2")
    return replace(header, height=height, area=area, sources=(*header.sources, *tall, *wide))


def _told_or_divided(
    key: str, told: float | None, trials: Sequence[Block], scale: float, unit: str
) -> tuple[list[str], float | None]:
    """What was told, or else the median quotient of the blocks' columns, with its words."""
    quotients = _quotients(trials, *DIVIDED[key]) if told is None else []
    value = _within(key, float(np.median([each for each, _ in quotients]))) if quotients else None
    if value is None:
        return [], told
    return [f"{quotients[0][1]}: {scale * value:.4g} {unit}"], value


def _quotients(trials: Sequence[Block], above: tuple[str, ...], below: str) -> list[tuple[float, str]]:
    """Of each block in which one column is another times a constant, that constant in SI and its words."""
    out = []
    for block in trials:
        over, under = (_column(block, roles) for roles in (above, (below,)))
        if over is None or under is None:
            continue
        rows = np.flatnonzero(~block.lacking(over[0]) & ~block.lacking(under[0]))
        a, b = (scale * block.numbers(column, rows) for column, scale in (over, under))
        slope = float(a @ b) / max(float(b @ b), 1e-300)
        if slope > 0.0 and float(np.abs(a - slope * b).max()) < PROPORTIONAL * float(np.ptp(a)):
            out.append((slope, f"{block.names[over[0]]} over {block.names[under[0]]}"))
    return out


def _column(block: Block, roles: Sequence[str]) -> tuple[int, float] | None:
    """The first column that means one of some quantities in a unit of its own, and the unit's SI value."""
    for role in roles:
        for column, (name, unit) in enumerate(zip(block.names, block.units, strict=True)):
            meaning = role_of(name, unit)
            scale = unit_scale(unit, DIMENSIONS[role]) if unit and meaning is not None and meaning[0] == role else None
            if scale is not None:
                return column, scale
    return None


def _with_all_words(block: Block) -> Block:
    """A block whose words are also those of the header lines that other sheets hold."""
    return replace(block, spoken=" ".join((block.spoken, *(f"{fact.key} {fact.value}" for fact in block.facts))))


def _table_facts(table: Block) -> Iterator[HeaderFact]:
    """What the columns of a short table tell, a table of results or parameters, where all its rows agree."""
    for column, (name, unit) in enumerate(zip(table.names, table.units, strict=True)):
        if name and not table.lacking(column).any():
            values = set(table.numbers(column).tolist())
            if len(values) == 1:
                yield HeaderFact(name, f"{values.pop():g}", unit)


def _refuse(path: Path, parts: Sequence[Block], told: Told) -> None:
    """Say of the longest table why it is no trial."""
    if not parts:
        raise TableError(path, "no rows of numbers were found", "at least 20 rows with time, force and depth")
    best = max(parts, key=lambda part: (is_record(part, told), part.rows))
    if best.rows < MINIMUM_ROWS:
        problem = f"the longest table has {best.rows} rows of numbers"
        raise TableError(path, problem, f"at least {MINIMUM_ROWS} rows", row=int(best.lines[-1]))
    record_of(best, told)
    raise TableError(path, "no table is a trial", f"columns of time, force and depth; it has {best.header}")


def header_reading(facts: Sequence[HeaderFact]) -> Reading:
    """What header lines tell of tool and specimen; lines that contradict each other tell nothing, and say so."""
    values: dict[str, dict[float, str]] = {}
    for fact in facts:
        kind = next((name for name, pattern in FACTS.items() if pattern.fullmatch(plain(fact.key))), None)
        value = None if kind is None else _value(fact, FACT_DIMENSIONS[kind])
        if kind is not None and value is not None:
            values.setdefault(kind, {})[value] = f"{fact.key}: {fact.value}{f' {fact.unit}' if fact.unit else ''}"
    spherical = any(SPHERE.search(f"{fact.key} {fact.value}") for fact in facts)
    for fact in facts:
        if plain(fact.key) in ("probe", "ta probe", "product") and (found := TA_PROBE.search(fact.value)):
            values.setdefault("tool_diameter", {})[1e-3 * float(found["size"].replace(",", "."))] = (
                f"{fact.key}: {fact.value}"
            )
    single = {kind: next(iter(said.items())) for kind, said in values.items() if len(said) == 1}
    unclear = tuple(f"{' and '.join(said.values())} contradict each other" for said in values.values() if len(said) > 1)
    radius, why_r = single.get("tool_radius", (None, ""))
    if radius is None and "tool_diameter" in single:
        radius, why_r = single["tool_diameter"][0] / 2.0, single["tool_diameter"][1]
    height, why_h = single.get("height", (None, ""))
    area, why_a = single.get("area", (None, ""))
    if area is None and "specimen_diameter" in single:
        area, why_a = math.pi * (single["specimen_diameter"][0] / 2.0) ** 2, single["specimen_diameter"][1]
    radius, height, area = _within("tool_radius", radius), _within("height", height), _within("area", area)
    sources = [why for value, why in ((radius, why_r), (height, why_h), (area, why_a)) if value is not None]
    tip = radius is not None and ("tip" in plain(why_r) or spherical)
    return Reading(radius, tip, height, area, (*sources, *unclear))


def _within(kind: str, value: float | None) -> float | None:
    least, most = FACT_LIMITS[kind]
    return value if value is not None and least <= value <= most else None


def _value(fact: HeaderFact, dimension: str) -> float | None:
    """The SI value of a header line, `20`, `20 mm`, `20,0 mm`; None where number or unit is missing."""
    number, _, unit = fact.value.strip().replace(",", ".").partition(" ")
    scale = unit_scale(fact.unit or unit.strip(), dimension) if (fact.unit or unit.strip()) else None
    try:
        return None if scale is None else round(float(number) * scale, 15)
    except ValueError:
        return None


def preview(file: InstrumentFile) -> list[str]:
    """What was read, a line each, for a person to look at before anything is computed."""
    lines = [f"{file.path.name}: {file.what}"]
    for record in file.records:
        presses, dwell = phases(record.table)
        table = record.table
        name = f" {record.name!r}:" if record.name else ""
        rate = (len(table.time) - 1) / max(float(table.time[-1] - table.time[0]), 1e-12)
        held = f", held {dwell:.3g} s" if dwell > 0.2 else ""
        counted = f"{presses} press{'es' if presses != 1 else ''}"
        lines.append(
            f" {name} {len(table.time)} rows at {rate:.4g} Hz, {counted}{held}, "
            f"to {1e3 * float(table.depth.max()):.4g} mm and {float(table.force.max()):.4g} N"
        )
        lines.append("    " + ", ".join(f"{role} from {shown}" for role, shown in record.columns.items()))
        lines += [f"    {note}" for note in record.notes]
    lines += [f"  from its header: {source}" for source in file.header.sources]
    return [*lines, *(f"  {note}" for note in file.notes)]


def is_plain_trial(path: Path) -> bool:
    """Whether a text file is the bench's own trial table by its first line: read strictly, without recognition."""
    return {"time_s", "depth_mm", "force_N"} <= _first_names(path)


def _first_names(path: Path) -> set[str]:
    """The names in the first line of a text file, separated by commas; none where it is no such text."""
    try:
        with path.open("rb") as stream:
            first = stream.readline(100_000)
        return {name.strip().strip('"') for name in first.decode("utf-8-sig").rstrip("\r\n").split(",")}
    except (OSError, UnicodeDecodeError):
        return set()


def is_told_of(path: Path, told: Told) -> bool:
    """Whether a person said how a trial table of the bench is to be read: a column of it, a rate, rows to leave out."""
    sources = [parse_source(role, text).name for role, text in told.columns.items()]
    named = not _first_names(path).isdisjoint(sources) or any(name.startswith("#") for name in sources)
    return named or told.drop_empty or told.rate is not None


__all__ = [
    "ENDINGS",
    "InstrumentFile",
    "Reading",
    "header_reading",
    "is_plain_trial",
    "is_told_of",
    "preview",
    "read_instrument_file",
    "takes",
]
