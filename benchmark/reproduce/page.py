"""The page: every printed number beside what it should be, and the figures redrawn."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmark.comparison import describe_equivalence, describe_t_test
from benchmark.reproduce.evidence import Evidence
from benchmark.reproduce.figures import redrawn
from benchmark.reproduce.item import Item
from benchmark.reproduce.table import NO_BREAK, by_basis, headline, numbers
from benchmark.reproduce.table_two import surface_test
from reports import (
    Block,
    Download,
    Fact,
    Figure,
    Notice,
    Page,
    Paragraph,
    Section,
    Subsection,
    Table,
    Verdict,
)

ITEMS = "tables/items.csv"
SAME = "as above"
AGREES = (
    "A number agrees if the recomputed one rounds to it at its last printed digit, every input taken as it is printed. "
    'Where the rounding of the inputs alone explains a difference, the reason says so. The column "from" names what a '
    "value was recomputed from: print, the article's other numbers; session, the shipped synthetic trials; 5 N run, "
    "FEM and wave model run here."
)
GROUPS = {
    "Table 1 and equations (5) and (6)": "Table 1",
    "Equations (7) and (8)": "Eq.",
    "Table 2": "Table 2",
    "Numbers of the text": "Section",
}
SYNTHETIC = (
    "The trials behind Figures 7, 8 and 10 and behind every line from the session were computed, not measured: "
    "they are of another specimen than the article's. They show that the chain works."
)
CIRCULAR = (
    "The article's comparison feeds the FEM's maximum into eq. (8) and reads it off eq. (7). Its lines are marked "
    "circular; those marked predicted use nothing of the FEM."
)
SUBJECTS = {
    7: "displacement of each marker",
    8: "markers and the circle around the tool",
    10: "the circle over time",
    11: "animation of eq. (7)",
    12: "maximum displacement of both models",
    13: "normal distributions of both models",
}


def reproduce_page(items: Sequence[Item], evidence: Evidence, environment: Mapping[str, Any], csv: str) -> Page:
    """Return the page.

    Parameters
    ----------
    items
        In the order of the article.
    evidence
        What was run for them.
    environment
        Versions and machine, as `describe_environment` gives them.
    csv
        Text of the table of items.
    """
    sections = [
        Section(title, _part(title, [item for item in items if item.item.startswith(start)], evidence))
        for title, start in GROUPS.items()
    ]
    notices = [Notice("synthetic", SYNTHETIC)] if evidence.chain.synthetic else []
    warnings = tuple(dict.fromkeys((*evidence.table_2.warnings, *evidence.press.warnings)))
    return Page(
        title="The article's numbers and figures",
        subtitle="Printed, recomputed, and why they differ",
        verdict=Verdict(
            "finding", f"{headline(items)}.", [f"{line}." for line in (*by_basis(items), *_findings(items))]
        ),
        facts=(Fact("Made", str(environment["made"])), Fact("Processor", str(environment["processor"]))),
        notices=[
            *notices,
            Notice("circular", CIRCULAR),
            *([Notice("warning", "What the models say of the press to 5 N.", warnings)] if warnings else []),
        ],
        sections=[*sections, Section("Figures", _figures(evidence))],
        downloads=(
            Download(ITEMS, "every number", csv),
            Download("reproduce.json", "every number for programs", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _part(title: str, items: Sequence[Item], evidence: Evidence) -> list[Block]:
    blocks: list[Block] = [Paragraph(AGREES)] if title == next(iter(GROUPS)) else []
    blocks.append(_table(title, items))
    if title == "Table 2":
        blocks += _tests(evidence)
    return blocks


def _table(title: str, items: Sequence[Item]) -> Table:
    columns = ("item", "printed", "recomputed", "difference", "unit", "agrees", "from", "reason")
    rows = []
    before = ""
    for item in items:
        name = item.item.removeprefix("Table 1: ").removeprefix("Table 2: ")
        reason = SAME if item.reason == before else item.reason
        before = item.reason
        rows.append((name, *numbers(item), item.unit, item.agrees, item.basis.replace(" ", NO_BREAK), reason))
    return Table(f"{title} of the article, printed and recomputed", columns, rows, folded=False)


def _tests(evidence: Evidence) -> list[Block]:
    """What the t-test of Table 2 can show, and the test that can show agreement."""
    found = evidence.table_2.comparisons[0].statistics
    if found is None:
        return []
    return [
        Paragraph(describe_t_test(surface_test(evidence.table_2), found.passing, found.power)),
        Paragraph(describe_equivalence(found.equivalence)),
    ]


def _figures(evidence: Evidence) -> list[Block]:
    return [
        Subsection(f"Figure {number} of the article: {SUBJECTS[number]}", _kept(figures))
        for number, figures in redrawn(evidence).items()
    ]


def _kept(figures: Sequence[Figure]) -> Sequence[Block]:
    return figures or (Paragraph("Nothing to draw: a model or the film has no values."),)


def _findings(items: Sequence[Item]) -> list[str]:
    """The differences that change what the article's wave says."""
    return [f"{item.item}: {_said(item)} instead of {numbers(item)[0]}" for item in items if item.item in TOLD]


def _said(item: Item) -> str:
    return "no value" if item.recomputed is None else f"{numbers(item)[1]}{NO_BREAK}{item.unit}".rstrip()


TOLD = (
    "Table 1: B_11 (eq. 3 with eqs. 4 to 6)",
    "Eq. (7): depth in the middle at t = 0, against the press of section 3.3.3",
)
