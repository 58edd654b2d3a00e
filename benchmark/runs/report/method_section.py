"""Section: how the numbers were made."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.runs.record import RunRecord
from reports import Block, Fact, Facts, Listing, Paragraph, Section

PROTOCOL = (
    "Protocol: prediction. Both models get the same layers, tool, support and load; no value of the {fem} is fed into "
    "the {wave}."
)


def method_section(record: RunRecord, environment: Mapping[str, Any]) -> Section:
    """Return the section on models, versions and the resolved scenario."""
    blocks: list[Block] = [Paragraph(PROTOCOL.format(fem=record.pair.fem.name, wave=record.pair.wave.name))]
    for run in (record.pair.fem, record.pair.wave):
        label = f"{run.name[0].upper()}{run.name[1:]}"
        if run.result is None:
            blocks.append(Paragraph(f"{label}: no values; {run.declined}."))
            continue
        notes = [Fact(f"{label}: {name}", text) for name, text in run.result.notes.items()]
        unknowns = "not stated" if run.result.unknowns is None else str(run.result.unknowns)
        blocks.append(Facts((Fact(f"{label}: unknowns", unknowns), *notes)))
    versions = "\n".join(f"{name} {version}" for name, version in environment["packages"].items())
    blocks.append(Listing(versions, "Versions"))
    blocks.append(Listing(record.scenario.to_toml(), "The resolved scenario (scenario.toml)"))
    return Section("Method", blocks)
