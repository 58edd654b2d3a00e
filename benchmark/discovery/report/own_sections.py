"""The page's section on what was fitted beside the effects: the set-up against what was told, and each trial's own."""

from __future__ import annotations

from benchmark.discovery.own_values import SetupEstimate, TrialValues
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from reports import Block, Column, Download, Paragraph, Section, Table

SETUP = (
    "How the set-up lies against what was told, with the answer's effects in the model: shares of the told value, of a "
    "modulus the logarithm of its factor, of a clamp or contact the share of the way to the other one. One or two "
    "standard deviations are what people are usually wrong by."
)
TRIALS = (
    "What each trial has of its own. A zero lies within what the sensor shows at rest, a touch not beyond where the "
    "force has risen over its noise, and force and frames are late by a sample or two at most. Where trials differ as "
    "specimens of unlike thickness do, each has a thickness of its own, by which the base's force and field follow."
)


def own_section(record: DiscoveryRecord) -> Section:
    """Return the fitted set-up and the trials' own values."""
    found = record.found
    blocks: list[Block] = []
    if found.setup:
        columns = (
            "parameter", Column("change", "", 3), Column("95 % low"), Column("95 % high"),
            Column("known to", "", 2), Column("standard deviations", "", 2), "named",
        )  # fmt: skip
        blocks += [Paragraph(SETUP), Table("The set-up", columns, [_setup(each) for each in found.setup], folded=False)]
    heads = (
        "trial", Column("gain", "", 4), Column("zero", "N", 3), Column("late", "ms", 3), Column("touch", "mm", 3),
        Column("thicker", "%", 2), "at its bound",
    )  # fmt: skip
    rows = [_own(each) for each in found.own]
    download = Download("tables/trials.csv", "the same")
    return Section("Fitted beside it", [*blocks, Paragraph(TRIALS), Table("The trials", heads, rows, download, True)])


def _setup(each: SetupEstimate) -> tuple[object, ...]:
    return (each.key, each.change, *each.ci95, each.prior, each.of_prior, each.named)


def _own(each: TrialValues) -> tuple[object, ...]:
    own = (each.gain, each.zero, 1e3 * each.late, 1e3 * each.touch, 1e2 * each.thicker)
    return (each.trial, *own, ", ".join(each.at_bound))
