"""The page that sets one scenario on several tissues side by side."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.runs.record import RunRecord
from benchmark.runs.report.scenario_section import layer_stack_of, layer_table
from benchmark.runs.tables import tissue_columns
from reports import Column, Download, Fact, Notice, Page, Paragraph, Section, Subsection, Table, Verdict

SHOWN = ("tissue", "layer", "fem_max_mm", "wave_max_mm", "percent_error")


def tissues_page(records: Mapping[str, RunRecord], environment: Mapping[str, Any]) -> Page:
    """Return the page; `records` by the name of the tissue's folder."""
    first = next(iter(records.values()))
    return Page(
        title=f"{first.scenario.name} on {len(records)} tissues",
        subtitle=f"{first.pair.fem.name} and {first.pair.wave.name} on each, with one tool, support and load",
        verdict=_verdict(records),
        facts=(Fact("Made", str(environment["made"])), Fact("Seed", str(environment["seed"]))),
        notices=_notices(records),
        sections=(
            Section("Side by side", (_table(records),)),
            Section("Tissues", [_tissue(name, record) for name, record in records.items()]),
        ),
        downloads=(
            *(Download(f"{name}/report.html", f"the report of {name}", media_type="text/html") for name in records),
            Download("tables/tissues.csv", "the table of this page"),
        ),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _verdict(records: Mapping[str, RunRecord]) -> Verdict:
    """The largest deformation of each tissue's surface."""
    stopped = [name for name, record in records.items() if not record.complete]
    points = [f"{name}: {_surface(record)}" for name, record in records.items()]
    if stopped:
        return Verdict("incomplete", f"A solver stopped early on {', '.join(stopped)}.", points)
    return Verdict("finding", f"One press on {len(records)} tissues.", points)


def _surface(record: RunRecord) -> str:
    found = [
        f"{run.name} {1e3 * record.max_deformation(run.result)[0]:.4g} mm"
        for run in (record.pair.fem, record.pair.wave)
        if run.result is not None
    ]
    return f"maximum of {record.layers[0]}: {', '.join(found) or 'no model has values'}"


def _notices(records: Mapping[str, RunRecord]) -> tuple[Notice, ...]:
    said = [f"{name}: {warning}" for name, record in records.items() for warning in record.warnings]
    return (Notice("warning", "Read these before you quote a figure.", said),) if said else ()


def _table(records: Mapping[str, RunRecord]) -> Table:
    first = next(iter(records.values()))
    fem, wave = first.pair.fem.name, first.pair.wave.name
    columns = (
        "tissue",
        "layer",
        Column(f"{fem} maximum", "mm"),
        Column(f"{wave} maximum", "mm"),
        Column(f"{wave} against {fem} at peak", "%", 3),
    )
    cells = tissue_columns(records)
    return Table(
        "Maximum deformation of each layer's top face on the tool axis",
        columns,
        list(zip(*(cells[name] for name in SHOWN), strict=True)),
        download=Download("tables/tissues.csv", "the same with each layer's properties"),
        folded=False,
    )


def _tissue(name: str, record: RunRecord) -> Subsection:
    scenario = record.scenario
    source = Paragraph(f"Source: {scenario.tissue.citation or 'not stated in the file'}")
    return Subsection(name, (source, layer_stack_of(scenario), layer_table(scenario)))
