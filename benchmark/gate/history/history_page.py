"""The page of a history: where times and values stepped, by commit, and every check."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmark.errors import InputError
from benchmark.gate.history.history_file import HistoryEntry, read_history
from benchmark.gate.history.trend import Trend, trend_figure, trends, value_trends
from benchmark.runs.output.destination import claimed, destination, file_name
from benchmark.runs.output.document import describe_environment
from reports import (
    Block,
    Column,
    Download,
    Notice,
    Page,
    Paragraph,
    Section,
    Table,
    Verdict,
    write_csv,
    write_json,
    write_page,
    write_whole,
)
from reports.formatting import counted

HOW = (
    "A step is where a partition of the checks into levels, with a penalty for each further one, costs least (optimal "
    "partitioning, Jackson et al. 2005). A level of times has two checks at least, so the last check alone makes none. "
    "Times are compared on one processor only, and stored baselines apart from revisions measured in the same minutes."
)
MOST_NAMED = 5


@dataclass(frozen=True)
class HistoryOutcome:
    """The page of a history on disk: folder, headline, the object for programs, and what it warns of."""

    folder: Path
    headline: str
    document: dict[str, Any]
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class Alike:
    """Times that can be compared: the processor, whether another revision was measured beside, and the trends."""

    machine: str
    against: bool
    trends: list[Trend]

    @property
    def title(self) -> str:
        """What stands over them."""
        return f"{self.machine}, {'beside another revision' if self.against else 'against a stored baseline'}"


def write_history(path: Path, out: Path | None) -> HistoryOutcome:
    """Write `report.html`, `history.json` and `tables/steps.csv` of a history.

    Raises
    ------
    InputError
        It has no check that can be read, or the folder cannot be used.
    OSError
        Where the file system refuses.
    """
    with claimed(out, "report"):
        destination(out, "", (path,))
        entries, unread = read_history(path)
        if not entries:
            raise InputError(f"{path} holds no check of schema 1; `python -m benchmark check` adds one a check")
        page, document, steps = history_page(path.name, entries, unread)
        target = destination(out, file_name(path.stem), (path,))

        def fill(new: Path) -> None:
            write_json(new / "history.json", document)
            write_csv(new / "tables" / "steps.csv", steps)
            write_page(new / "report.html", page)

        write_whole(target, fill)
    return HistoryOutcome(target, page.verdict.headline, document, tuple(f"{path}: {each}" for each in _unread(unread)))


def history_page(
    name: str, entries: Sequence[HistoryEntry], unread: int = 0
) -> tuple[Page, dict[str, Any], Mapping[str, list[Any]]]:
    """Return the page of a history, the object for programs, and the columns of its steps.

    Parameters
    ----------
    name
        Of the file.
    entries
        At least one check, oldest first.
    unread
        Lines that could not be read.
    """
    times, values = _times(entries), value_trends(entries)
    rows = [row for each in times for row in _steps(each.trends, each.title)] + _steps(values, "")
    environment = describe_environment(seed=0)
    page = Page(
        title=f"Regression history: {name}",
        subtitle=f"{counted(len(entries), 'check')}, {entries[0].made[:10]} to {entries[-1].made[:10]}",
        verdict=_verdict(entries, rows),
        notices=[Notice("warning", words, ()) for words in _unread(unread)],
        sections=[_step_section(rows), *_time_sections(times), _value_section(values), _checks(entries)],
        downloads=(
            Download("tables/steps.csv", "the steps"),
            Download("history.json", "the same for programs", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )
    columns = {column: [row[place] for row in rows] for place, column in enumerate(STEP_COLUMNS)}
    steps = [dict(zip(STEP_COLUMNS, row, strict=True)) for row in rows]
    document = {"schema": 1, "name": name, "checks": len(entries), "unread_lines": unread, "steps": steps}
    return page, document, columns


def _unread(unread: int) -> tuple[str, ...]:
    """What is said of lines that could not be read."""
    return (f"{counted(unread, 'line')} of the file cannot be read: left out here.",) if unread else ()


STEP_COLUMNS = ("quantity", "commit", "change_percent", "check", "machine")


def _steps(found: Sequence[Trend], machine: str) -> list[tuple[Any, ...]]:
    """A row a step; the last column is empty for values."""
    return [
        (trend.quantity, point.revision, trend.step_percent(step), point.number, machine)
        for trend in found
        for step in trend.steps
        for point in (trend.points[step.place],)
    ]


def _times(entries: Sequence[HistoryEntry]) -> list[Alike]:
    """The trends of the timed quantities, for each processor and way of comparing, the last used first."""
    kinds = dict.fromkeys((each.machine, each.against is not None) for each in reversed(entries))
    found = [Alike(machine, against, trends(entries, machine, against=against)) for machine, against in kinds]
    return [each for each in found if each.trends]


def _verdict(entries: Sequence[HistoryEntry], rows: Sequence[tuple[Any, ...]]) -> Verdict:
    red = sum(each.passed is False for each in entries)
    headline = f"{counted(len(rows), 'step')} in {counted(len(entries), 'check')}, {red} of them red."
    named = sorted(rows, key=lambda row: row[3], reverse=True)[:MOST_NAMED]
    points = [f"{quantity}: {change:+.3g} % at {commit}" for quantity, commit, change, *_ in named]
    return Verdict("finding" if rows else "good", headline, points)


def _step_section(rows: Sequence[tuple[Any, ...]]) -> Section:
    if not rows:
        return Section("Steps", (Paragraph("Nothing changed its level."), Paragraph(HOW)))
    columns = ("quantity", "first commit", Column("change", "%", 3), Column("check", digits=4), "measured on")
    return Section("Steps", (Table("Every step, values last", columns, rows, folded=False), Paragraph(HOW)))


def _time_sections(times: Sequence[Alike]) -> list[Section]:
    if not times:
        return [Section("Times", (Paragraph("A trend begins with the second check on one machine."),))]
    return [Section(f"Times: {each.title}", (trend_figure(each.trends, each.title),)) for each in times]


def _value_section(values: Sequence[Trend]) -> Section:
    moved = [each for each in values if each.steps]
    words = f"{len(values) - len(moved)} of {len(values)} gated values never moved."
    blocks: list[Block] = [Paragraph(words)]
    return Section("Values", (*blocks, *([trend_figure(moved, "Values that moved")] if moved else [])))


def _checks(entries: Sequence[HistoryEntry]) -> Section:
    rows = [
        (number, each.made[:16].replace("T", " "), each.revision, each.against, each.machine, VERDICTS[each.passed])
        for number, each in enumerate(entries, start=1)
    ]
    columns = (Column("check", digits=6), "made (UTC)", "commit", "beside", "machine", "verdict")
    return Section("Checks", (Table("Every check of the file, oldest first", columns, rows, folded=True),))


VERDICTS = {True: "passed", False: "red", None: "baseline accepted"}
