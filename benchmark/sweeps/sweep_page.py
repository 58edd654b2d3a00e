"""The report of a sweep: what varied, what came of it, which points failed and why."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmark.sweeps.parameter import Parameter
from benchmark.sweeps.plan import SweepPlan
from benchmark.sweeps.point import FAILED, MODELS, SECONDS, PointResult, headline
from benchmark.sweeps.sensitivity import Sensitivity, SweepFindings
from benchmark.sweeps.sweep_folder import Columns, point_columns
from reports import (
    Block,
    Column,
    Download,
    Fact,
    Listing,
    Notice,
    Page,
    Paragraph,
    Section,
    Table,
    Verdict,
)
from reports.figures.studies import ParameterAxis, over_parameters
from reports.formatting import format_number

MOST_WARNINGS = 5
DESIGNS = {
    "grid": "every combination of the values",
    "lhs": "a Latin hypercube sample",
    "sobol": "a scrambled Sobol sequence",
    "saltelli": "Saltelli's design for Sobol indices",
}
INDICES = (
    "Part of the variance of each result over the varied ranges that a parameter explains alone (first order) and with "
    "all its interactions (total order), with half-widths of 95 % bootstrap intervals. They belong to these ranges: a "
    "wider one makes its parameter matter more."
)


def sweep_page(
    plan: SweepPlan, rows: Sequence[PointResult], found: SweepFindings, environment: Mapping[str, Any]
) -> Page:
    """Return the page of a finished sweep."""
    sensitivity = found.sensitivity
    columns = point_columns(plan.parameters, plan.points, rows)
    sections = [Section("What varied", (Paragraph(_design(plan)), _varied(plan.parameters)))]
    sections += [Section("Results", _results(plan, columns))]
    sections += [] if sensitivity is None else [_sensitivity(sensitivity)]
    sections += [_failures(plan, rows), _method(plan, environment)]
    downloads = [Download("points.parquet", "one row a point", media_type="application/vnd.apache.parquet")]
    if sensitivity is not None:
        downloads.append(Download("sensitivity.csv", "Sobol indices with intervals"))
    return Page(
        title=f"{plan.scenario.name}: sweep",
        subtitle=f"{len(rows)} points over {', '.join(parameter.key for parameter in plan.parameters)}",
        verdict=_verdict(plan, rows, columns, found.without_effect),
        facts=(Fact("Made", str(environment["made"])), Fact("Seed", str(plan.design.seed))),
        notices=_notices(rows, sensitivity),
        sections=[section for section in sections if section.blocks],
        downloads=(
            *downloads,
            Download("scenario.toml", "the scenario before anything varies", media_type="application/toml"),
            Download("environment.json", "versions and machine", media_type="application/json"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _verdict(plan: SweepPlan, rows: Sequence[PointResult], columns: Columns, without_effect: Sequence[str]) -> Verdict:
    failures = sum(row.status == FAILED for row in rows)
    quantity, unit = headline(plan.scenario.load.control)
    shown = [
        (f"{name}, {quantity} at peak load", f"{model}_{quantity}_{unit}", unit)
        for model, name in (("fem", "FEM"), ("wave", "wave model"))
    ]
    shown.append((f"wave model against FEM, error in the {quantity}", "error_percent", "%"))
    points = [f"{name}: {_span(columns[column])} {each}" for name, column, each in shown if column in columns]
    if failures == len(rows):
        return Verdict("failed", f"None of the {len(rows)} points has results.", points)
    said = f"{failures} of {len(rows)} points failed" if failures else f"All {len(rows)} points have results"
    said += f"; no result depends on {', '.join(without_effect)}" if without_effect else ""
    return Verdict("finding", f"{said}.", points)


def _span(values: Sequence[float | None]) -> str:
    present = [value for value in values if value is not None]
    return f"{format_number(min(present))} to {format_number(max(present))}"


def _notices(rows: Sequence[PointResult], found: Sensitivity | None) -> tuple[Notice, ...]:
    """Warnings of the points, each kind once: of how many points, and as the first of them has it."""
    kinds: dict[str, list[PointResult]] = {}
    for row in rows:
        if row.warnings:
            kinds.setdefault(re.sub(r"[0-9.]+(e[-+]?[0-9]+)?", "", row.warnings), []).append(row)
    most = sorted(kinds.values(), key=len, reverse=True)[:MOST_WARNINGS]
    said = [f"{_whose(alike)}: {alike[0].warnings}" for alike in most]
    said += list(found.warnings) if found is not None else []
    return (
        (Notice("warning", "Read these before you quote a figure; the table has them in full.", said),) if said else ()
    )


def _whose(alike: Sequence[PointResult]) -> str:
    """Which points have a warning of one kind, the first by its number."""
    first, others = f"point {alike[0].point}", len(alike) - 1
    return f"{first}, and {others} more with figures of their own" if others else first


def _design(plan: SweepPlan) -> str:
    return f"{len(plan.points)} points: {DESIGNS[plan.design.kind]}."


def _varied(parameters: Sequence[Parameter]) -> Table:
    rows = [
        (
            parameter.key,
            parameter.texts[0] if parameter.ranged else ", ".join(parameter.texts),
            parameter.texts[1] if parameter.ranged else None,
            {"lin": "linear", "log": "logarithmic"}[parameter.scale] if parameter.ranged else "list",
        )
        for parameter in parameters
    ]
    return Table("Varied keys of the scenario", ("key", "from", "to", "scale"), rows)


def _results(plan: SweepPlan, columns: Columns) -> list[Block]:
    """The pictures of the free quantity and its error, and the table of all points."""
    axes = [
        ParameterAxis(
            parameter.key,
            columns[parameter.column if parameter.numbers is not None else parameter.key],
            parameter.unit,
            parameter.scale == "log",
        )
        for parameter in plan.parameters
    ]
    quantity, unit = headline(plan.scenario.load.control)
    shown = {model: f"{model}_{quantity}_{unit}" for model in MODELS}
    present = {model: _numbers(columns[name]) for model, name in shown.items() if name in columns}
    blocks: list[Block] = []
    if present:
        blocks.append(
            over_parameters(axes, present, f"{quantity} at peak load ({unit})", f"{quantity.title()} at peak load")
        )
    if "error_percent" in columns:
        errors = {"wave model against FEM": _numbers(columns["error_percent"])}
        blocks.append(over_parameters(axes, errors, f"error in the {quantity} (%)", "Wave model against FEM"))
    return [*blocks, _points(columns)]


def _numbers(values: Sequence[float | None]) -> list[float]:
    return [np.nan if value is None else value for value in values]


def _points(columns: Columns) -> Table:
    """Every point; words that repeat the numbers, times and warnings are left to the file."""
    left_out = {name for name in columns if name.endswith(SECONDS)} | {"warnings", "reason"}
    names = [name for name in columns if name not in left_out]
    rows = list(zip(*(columns[name] for name in names), strict=True))
    return Table(
        "Points with their varied keys, results and status",
        [Column(name) for name in names],
        rows,
        download=Download("points.parquet", "all points, columns and reasons"),
        folded=True,
    )


def _sensitivity(found: Sensitivity) -> Section:
    columns = (
        "result",
        "parameter",
        Column("first order", digits=3),
        Column("95 % ±", digits=2),
        Column("total order", digits=3),
        Column("95 % ±", digits=2),
    )
    rows = [
        (index.result, index.parameter, index.first, index.first_ci95, index.total, index.total_ci95)
        for index in found.indices
    ]
    table = Table(
        f"Sobol indices from {found.base_samples} base samples",
        columns,
        rows,
        download=Download("sensitivity.csv", "the same with all digits"),
        folded=False,
    )
    return Section("Sensitivity", (Paragraph(INDICES), table))


def _failures(plan: SweepPlan, rows: Sequence[PointResult]) -> Section:
    lines = [(row.point, *plan.points[row.point - 1], row.reason) for row in rows if row.status == FAILED]
    if not lines:
        return Section("Failed points", ())
    keys = [parameter.key for parameter in plan.parameters]
    return Section("Failed points", (Table("Points that failed, with the reason", ("point", *keys, "reason"), lines),))


def _method(plan: SweepPlan, environment: Mapping[str, Any]) -> Section:
    text = (
        "Each point is a run of both models with the same layers, tool, support and load, one thread, no repeats; no "
        "value of the FEM is fed into the wave model. Timings are indicative only; points ran in parallel."
    )
    versions = "\n".join(f"{name} {version}" for name, version in environment["packages"].items())
    listings = (Listing(versions, "Versions"), Listing(plan.scenario.to_toml(), "The scenario before anything varies"))
    return Section("Method", (Paragraph(text), *listings))
