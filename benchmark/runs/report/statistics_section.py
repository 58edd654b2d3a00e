"""Sections: statistics as in the article's Table 2 and beyond it, errors and their uncertainties, growth of time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmark.comparison import LayerComparison, describe_equivalence, describe_t_test, statistics_columns
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import fem_mm, pair_names, wave_mm
from reports import Block, Column, Download, Figure, Paragraph, Section, Subsection, Table
from reports.figures.normal_fit import Normal, normal_fit
from reports.figures.style import Pair
from reports.figures.timing import growth

INTRODUCTION = (
    "The observations are each layer's maximum deformations over the load history; where the depth is prescribed, the "
    "force as well. The two-sample t-test is the one the article used; that it does not reject is no agreement. The "
    "equivalence test (TOST) is the one that can show agreement, within the margin stated before the run."
)


def statistics_section(record: RunRecord) -> Section:
    """Return the section on tests and normal fits."""
    blocks: list[Block] = [Paragraph(INTRODUCTION)]
    blocks.extend(_layer(comparison, record) for comparison in record.judged if comparison.statistics is not None)
    if not any(comparison.statistics for comparison in record.judged):
        blocks.append(Paragraph("There is nothing to test: one of the models has no values here."))
    figure = normal_fits(record)
    if figure is not None:
        blocks.append(figure)
    return Section("Statistics", blocks)


def _layer(comparison: LayerComparison, record: RunRecord) -> Subsection:
    """Tests of one layer."""
    found = comparison.statistics
    assert found is not None
    table = statistics_columns([comparison])
    rows = list(zip(table["test"], table["quantity"], table["fem"], table["wave"], table["value"], strict=True))
    unit = "in N" if comparison is record.force_comparison else "deformations in mm"
    columns = (
        "test",
        "quantity",
        Column(record.pair.fem.name, digits=6),
        Column(record.pair.wave.name, digits=6),
        Column("value", digits=6),
    )
    return Subsection(
        comparison.layer,
        (
            Paragraph(describe_t_test(found.pooled, found.passing, found.power)),
            Paragraph(describe_equivalence(found.equivalence)),
            Table(
                f"Statistics of {comparison.layer}, {unit} (Table 2 of the article is test t_pooled)",
                columns,
                rows,
                download=Download("tables/statistics.csv", "all layers"),
                row_headings=False,
                folded=True,
            ),
        ),
    )


def normal_fits(record: RunRecord) -> Figure | None:
    """Fig. 13: None where the FEM has no fit."""
    fem = [comparison.fem_fit for comparison in record.comparisons]
    wave = [comparison.wave_fit for comparison in record.comparisons]
    if not fem or any(fit is None or fit.std == 0.0 for fit in fem):
        return None
    whole = all(fit is not None and fit.std > 0.0 for fit in wave)
    return normal_fit(
        record.layers,
        fem_mm(record),
        [Normal(fit.mean, fit.std) for fit in fem if fit is not None],
        wave_mm(record) if whole else None,
        [Normal(fit.mean, fit.std) for fit in wave if fit is not None] if whole else (),
        pair_names(record),
    )


Columns = Mapping[str, Sequence[Any]]
WORDS = (
    "E is simulation minus data (ASME V&V 20). u_num is the standard uncertainty from coarser and finer runs (grid "
    "convergence index over 1.15), u_input that of the fitted stiffness, u_D the standard error over replicate trials "
    "(of several conditions within them: what these differ by is an error of the model, told by condition), "
    "u_val their root sum of squares, which there is not beside trials of which none is a replicate. The model error "
    "lies within E plus or minus u_val; |E| below u_val means that the validation cannot see a model error, not that "
    "there is none. Code to code nothing is measured, and u_val "
    "holds numerical uncertainties alone. The area metric is the area between the distributions of simulated and "
    "measured peak forces. A protocol marked circular compares a model with the trials it was fitted to."
)
GROWTH = "One timed execution a level, alone in a process with one thread; on a busy machine a single one scatters."


def validation_section(columns: Columns, conditions: Columns | None = None) -> Section:
    """Return the section on errors and their uncertainties."""
    names = ("quantity", "protocol", "simulation", "measure", "value", "unit")
    heads = ("quantity", "protocol", "simulation", "measure", Column("value"), "unit")
    cells = zip(*(columns[name] for name in names), strict=True)
    table = Table(
        "Errors beside their uncertainties",
        heads,
        [tuple(cell or None if isinstance(cell, str) else cell for cell in row) for row in cells],
        download=Download("tables/validation.csv"),
        row_headings=False,
    )
    each = [] if conditions is None else [_by_condition(conditions)]
    return Section("Validation", (Paragraph(WORDS), table, *each))


def _by_condition(columns: Columns) -> Table:
    parts = [Column(name.removesuffix("_N"), "N") for name in columns if name.endswith("_N")]
    rows = zip(*columns.values(), strict=True)
    return Table(
        "Peak force, condition by condition",
        ("condition", "protocol", "simulation", "trials", *parts),
        [tuple(cell or None if isinstance(cell, str) else cell for cell in row) for row in rows],
        download=Download("tables/validation_conditions.csv"),
        row_headings=False,
    )


def growth_section(columns: Columns, pair: Pair) -> Section:
    """Return the section on refined runs and their cost."""
    cells = {name: values for name, values in columns.items() if name not in ("layer", "max_mm")}
    cells["level"] = [str(level) for level in columns["level"]]
    rows = list(dict.fromkeys(zip(*cells.values(), strict=True)))
    heads = (
        "model", "refined", "level", Column("unknowns"), Column("load steps"), Column("set-up", "s"),
        Column("wall", "s"), Column("CPU", "s"), Column("wall per load step", "ms"),
    )  # fmt: skip
    sizes = [row for row in rows if row[1] != "load steps" and row[3]]
    models = dict.fromkeys(row[0] for row in sizes)
    lines = {name: ([r[3] for r in sizes if r[0] == name], [r[8] for r in sizes if r[0] == name]) for name in models}
    table = Table(
        "Coarser and finer runs", heads, rows, download=Download("tables/refinement.csv", "with values"), folded=False
    )
    figures = [growth(lines, pair)] if lines else []
    return Section("Growth with unknowns", (Paragraph(GROWTH), *figures, table))
