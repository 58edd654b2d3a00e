"""What to measure next."""

from __future__ import annotations

import math

from benchmark.discovery.record import DiscoveryRecord, NextExperiment
from benchmark.discovery.report.words import effect_name
from reports import Column, Download, Listing, Paragraph, Section, Table

ADVICE = {
    "no_discrepancy": "Nothing needs to be added. A smaller disagreement would need more trials: its size falls with "
    "the root of their number.",
    "conditional": "Measure a second condition (another rate, depth or tool) and run this again with both: only then "
    "can the effect be named.",
    "partly_explained": "Look at the places that stay significant; a condition that isolates them tells most.",
    "outside_catalogue": "Measure where the disagreement is largest with one thing changed at a time (rate, depth, "
    "rest between presses), or add an effect of your own with --effects.",
    "instrument_first": "Calibrate first: a rigid block under the tool, a picture of a ruler, a rest in air.",
    "named": "Nothing more is needed to name it. A further condition tests whether its parameters stay the same.",
    "lookalikes": "The session does not say which of the set it is; a condition in which they differ would.",
}


def next_section(record: DiscoveryRecord) -> Section:
    """Return the proposed experiment, or advice in words."""
    proposal = record.proposal
    if proposal is None:
        return Section("What to measure next", [Paragraph(record.labels.get("next", ADVICE[record.found.verdict]))])
    first, second = map(effect_name, proposal.rivals)
    text = (
        f"{proposal.words} Expected distance of {first} and {second}: "
        f"{proposal.separation:.1f} standard deviations instead of {proposal.separation_now:.1f}, in "
        f"{proposal.minutes:.0f} minutes at the bench."
    )
    listing = Listing(proposal.toml, "next_experiment.toml, for python -m bench_hw capture")
    return Section("What to measure next", [Paragraph(text), _menu(proposal), listing])


def _menu(proposal: NextExperiment) -> Table:
    columns = (
        "experiment", Column("separation", "standard deviations", 3), Column("bench time", "min", 3),
        Column("separation² a minute", "", 3),
    )  # fmt: skip
    rows = [
        (name, separation, minutes if math.isfinite(minutes) else None, separation**2 / minutes if minutes else None)
        for name, (separation, minutes) in proposal.menu.items()
    ]
    download = Download("next_experiment.toml", "the protocol", media_type="application/toml")
    return Table("What was weighed", columns, rows, download, False)
