"""Section: the statistics, in the form of the article's Table 2 and beyond it."""

from __future__ import annotations

from benchmark.comparison import LayerComparison, describe_equivalence, describe_t_test, statistics_columns
from benchmark.runs.record import RunRecord
from benchmark.runs.report.values import fem_mm, pair_names, wave_mm
from reports import Block, Column, Download, Figure, Paragraph, Section, Subsection, Table
from reports.figures.normal_fit import Normal, normal_fit

INTRODUCTION = (
    "The observations are each layer's maximum deformations over the load history. The two-sample t-test is the one "
    "the article used; that it does not reject is no agreement. The equivalence test (TOST) is the one that can show "
    "agreement, within the margin stated before the run."
)


def statistics_section(record: RunRecord) -> Section:
    """Return the section on tests and normal fits."""
    blocks: list[Block] = [Paragraph(INTRODUCTION)]
    blocks.extend(_layer(comparison, record) for comparison in record.comparisons if comparison.statistics is not None)
    if not any(comparison.statistics for comparison in record.comparisons):
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
                f"Statistics of {comparison.layer}, deformations in mm (Table 2 of the article is test t_pooled)",
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
