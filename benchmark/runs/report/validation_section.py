"""Sections from `validation.csv` and `refinement.csv`: errors against uncertainties, growth of time with unknowns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from reports import Column, Download, Paragraph, Section, Table
from reports.figures.growth import growth
from reports.figures.pair import Pair

Columns = Mapping[str, Sequence[Any]]
WORDS = (
    "E is simulation minus data (ASME V&V 20). u_num is the standard uncertainty from coarser and finer runs (grid "
    "convergence index over 1.15), u_input that of the fitted stiffness, u_D the standard error over replicate trials, "
    "u_val their root sum of squares. The model error lies within E plus or minus u_val; |E| below u_val means that "
    "the validation cannot see a model error, not that there is none. Code to code nothing is measured, and u_val "
    "holds numerical uncertainties alone. The area metric is the area between the distributions of simulated and "
    "measured peak forces. A protocol marked circular compares a model with the trials it was fitted to."
)
GROWTH = "One timed execution a level, alone in a process with one thread; on a busy machine a single one scatters."


def validation_section(columns: Columns) -> Section:
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
    return Section("Validation", (Paragraph(WORDS), table))


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
