"""The page: every printed number beside what it should be, and the article's figures redrawn, by their numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from bench_hw.vision.displacement import fit_circles, largest_sample, moving_average
from benchmark.comparison import TwoSampleT, describe_equivalence, describe_t_test
from benchmark.reproduce import article_statistics as printed
from benchmark.reproduce.article_statistics import surface_test
from benchmark.reproduce.article_wave import EQUATIONS
from benchmark.reproduce.evidence import Chain, Evidence
from benchmark.reproduce.items import NO_BREAK, Item, by_basis, headline, numbers
from benchmark.runs.record import RunRecord
from benchmark.runs.report.deformation_section import layer_deformations
from benchmark.runs.report.published_section import LABELS, published_animation
from benchmark.runs.report.statistics_section import normal_fits
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
from reports.blocks import Column
from reports.figures.markers import Ring, circle_radius, marker_circle, marker_motion
from reports.formatting import format_number

ITEMS = "tables/items.csv"
SAME = "as above"
AGREES = (
    "A number agrees if the recomputed one rounds to it at its last printed digit, every input taken as it is printed. "
    '"Input rounding" stands where it does not, but the rounding of the printed inputs alone leaves room for it; "no" '
    'where it leaves none. The column "from" names what a '
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
TOLD = (
    "Table 1: B_11 (eq. 3 with eqs. 4 to 6)",
    "Eq. (7): depth in the middle at t = 0, against the press of section 3.3.3",
)
MM = 1e3
PREDICTED = "Skin under 5 N (scenario skin-5N); the wave model predicts, nothing of the FEM is fed in."
FILTER = "A moving average over the last ten frames was taken, as in the article."


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
    blocks += EQUATIONS.get(title, ())
    if title == "Table 2":
        blocks.append(_as_printed(surface_test(evidence.table_2)))
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
        rows.append((name, *numbers(item), item.unit, item.verdict, item.basis.replace(" ", NO_BREAK), reason))
    return Table(f"{title} of the article, printed and recomputed", columns, rows, folded=False)


def _as_printed(test: TwoSampleT) -> Table:
    """Table 2 in the article's layout, with the same test of the models run here beside it."""
    both = (Column("FEA", "printed", 6), Column("Wave Equation", "printed", 6))
    here = (Column("FEA", "here", 6), Column("Wave Equation", "here", 6))
    fem, wave = test.fem, test.wave
    rows = [
        ("Mean", printed.MEAN_FEM, printed.MEAN_WAVE, fem.mean, wave.mean),
        ("Variance", printed.VARIANCE_FEM, printed.VARIANCE_WAVE, fem.variance, wave.variance),
        ("Observations", printed.OBSERVATIONS, printed.OBSERVATIONS, float(fem.observations), float(wave.observations)),
        ("Hypothesized Mean Difference", printed.HYPOTHESISED_DIFFERENCE, None, 0.0, None),
        ("P(T<=t) two-tail", printed.P_VALUE, None, test.p_value, None),
        ("t Stat", printed.T, None, test.t, None),
        ("t Critical two-tail", printed.T_CRITICAL, None, test.t_critical, None),
    ]
    caption = "Table 2 in the article's layout (mm): as printed, and from the two models run here, the wave predicting"
    return Table(caption, ("Table 2", *both, *here), [_row_of_texts(row) for row in rows], folded=False)


def _row_of_texts(row: tuple[str, *tuple[float | None, ...]]) -> tuple[str | None, ...]:
    """Numbers as they are printed: each row of the article has its own digits."""
    return row[0], *(None if each is None else format_number(each, 6, trim=True) for each in row[1:])


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


def redrawn(evidence: Evidence) -> Mapping[int, tuple[Figure, ...]]:
    """Return the figures by the article's number."""
    chain = evidence.chain
    return {
        7: (_motion(chain),),
        8: (*_still(chain), _overlay(chain)),
        10: (_growth(chain),),
        11: tuple(_titled(published_animation(variant), f"Eq. (7), {label}") for variant, label in LABELS.items()),
        12: (_titled(layer_deformations(evidence.press), "Maximum displacements", PREDICTED),),
        13: _normals(evidence.press),
    }


def _titled(figure: Figure, title: str, more: str = "") -> Figure:
    return replace(figure, title=title, caption=f"{figure.caption} {more}".rstrip())


def _name(chain: Chain) -> str:
    return f"{chain.shown.trial} (synthetic)" if chain.synthetic else chain.shown.trial


def _motion(chain: Chain) -> Figure:
    moved = moving_average(chain.shown.moved, mode="causal")
    return _titled(marker_motion(_name(chain), chain.shown.time, MM * moved), "Displacement of each marker", FILTER)


def _still(chain: Chain) -> tuple[Figure, ...]:
    if chain.tracked is None or chain.tracked.still is None:
        return ()
    caption = f"{_name(chain)} as the camera sees it at its farthest motion, with the markers that were found."
    alt = "The picture of the markers with circles around each."
    return (Figure.of_picture(chain.tracked.still, caption, alt, "The markers found"),)


def _overlay(chain: Chain) -> Figure:
    block, shown = chain.shown.block, chain.shown
    assert block is not None  # the shipped session's grid has one
    circles = fit_circles(chain.places[:, block.nine])
    largest = largest_sample(shown.time, shown.radius_nine).frame
    first = int(np.isfinite(shown.radius_nine).argmax())
    rings = [
        Ring(name, *(float(MM * each[frame]) for each in (*circles.centre.T, circles.radius)))
        for name, frame in (("at rest", first), ("at its largest", largest))
    ]
    nine, places = [int(number) for number in block.nine], MM * chain.places[largest]
    return _titled(marker_circle(_name(chain), places, nine, block.centre, *rings), "The circle around the tool")


def _growth(chain: Chain) -> Figure:
    shown = chain.shown
    radii = (MM * shown.radius_nine, MM * shown.radius_ring)
    return _titled(circle_radius(_name(chain), shown.time, *radii, MM * chain.depth), "The circle over the press")


def _normals(record: RunRecord) -> tuple[Figure, ...]:
    figure = normal_fits(record)
    return () if figure is None else (_titled(figure, "Normal distributions", PREDICTED),)
