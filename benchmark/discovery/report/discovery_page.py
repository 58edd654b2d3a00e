"""The page of a discovery: one story, from the verdict to what to measure next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmark.discovery import criteria
from benchmark.discovery.discovery_result import Discovery, SetupEstimate, TrialValues
from benchmark.discovery.report.disagreement_sections import (
    comparison_section,
    gap_section,
    remains_section,
    where_section,
)
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.discovery.report.effect_sections import (
    candidates_section,
    effects_section,
    loop_section,
    next_section,
)
from benchmark.discovery.report.refit_section import refit_section
from benchmark.discovery.report.story import story
from benchmark.discovery.report.words import channel_name, sized
from reports import Block, Column, Download, Fact, Facts, Notice, Page, Paragraph, Section, Table, Verdict

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
SYNTHETIC = "These trials were computed, not measured. They show that the chain works."
DESCRIPTIONS = {
    "where.csv": "places that are significant",
    "contrasts.csv": "one question at a time",
    "candidates.csv": "every candidate and its evidence",
    "gap.csv": "the gap before and after",
    "refitted.csv": "the effects in the FEM and the wave model, on unseen trials",
    "trials.csv": "what each trial has of its own",
    "parameters.csv": "base and effects with intervals",
    "layers.csv": "the gap of each layer",
}


def discovery_page(record: DiscoveryRecord, environment: Mapping[str, Any], tables: Sequence[str]) -> Page:
    """Return the page.

    Parameters
    ----------
    record : DiscoveryRecord
        What was found.
    environment : mapping
        Content of `environment.json`.
    tables : sequence of str
        File names of the tables in the result folder.
    """
    sections: list[Section] = [comparison_section(record), where_section(record), candidates_section(record)]
    sections += [effects_section(record)] if record.found.effects else []
    sections += [gap_section(record)] if record.found.gap or record.layers else []
    sections += [refit_section(record)] if record.refits else []
    sections += [loop_section(record)] if record.grown is not None else []
    sections += [remains_section(record), next_section(record)]
    sections += [_own_section(record)] if record.found.own else []
    sections.append(Section("How this was found", [Facts(_facts(record, environment))]))
    return Page(
        title=f"{record.name}: what the model lacks",
        subtitle=_subtitle(record),
        verdict=discovery_verdict(record),
        story=story(record),
        notices=_notices(record),
        sections=sections,
        downloads=_downloads(record, tables),
        footer=f"tissuebench {environment['packages']['tissuebench']}",
    )


def _subtitle(record: DiscoveryRecord) -> str:
    if record.source == "run":
        return "The wave model against the FEM of a finished run"
    found = record.found
    conditions = f"{len(found.conditions)} condition{'s' * (len(found.conditions) != 1)}"
    kind = "synthetic trials" if record.synthetic else "trials"
    return f"{len(found.trials)} {kind}, {conditions}, against the elastic model of {record.tissue}"


def _base(record: DiscoveryRecord) -> str:
    if record.source == "run":
        return "the wave of small strain" if record.large_press == "linear" else "the wave of the layers' finite strain"
    return "finite elements of the set-up" + (
        "" if record.model == "fem" else "; a warning where the wave model goes on"
    )


def _facts(record: DiscoveryRecord, environment: Mapping[str, Any]) -> tuple[Fact, ...]:
    return (
        Fact("Made", str(environment["made"])),
        Fact("Channels", ", ".join(map(channel_name, record.found.channels))),
        Fact("Elastic model", _base(record)),
        Fact("Seed", str(record.seed)),
        Fact("Time", f"{record.found.seconds:.1f} s"),
        Fact("Fingerprint", record.fingerprint[:16]),
    )


def _notices(record: DiscoveryRecord) -> tuple[Notice, ...]:
    """What must be known before any figure: origin of the data, and warnings."""
    notices = [Notice("synthetic", SYNTHETIC)] if record.synthetic and record.source == "session" else []
    if "notice" in record.labels:
        notices.append(Notice("assumption", record.labels["notice"]))
    if record.found.warnings:
        notices.append(Notice("warning", "Read these before you quote a figure.", record.found.warnings))
    return tuple(notices)


def _downloads(record: DiscoveryRecord, tables: Sequence[str]) -> tuple[Download, ...]:
    files = [Download(f"tables/{name}", DESCRIPTIONS.get(name, "")) for name in tables]
    toml = [Download("model.toml", "the model with what was found; for --model", media_type="application/toml")]
    if record.proposal is not None:
        toml.append(Download("next_experiment.toml", "the protocol to run next", media_type="application/toml"))
    return (
        *files,
        *toml,
        Download("discovery.json", "the answer for programs", media_type="application/json"),
        Download("environment.json", "versions and machine", media_type="application/json"),
    )


STATUS = {"no_discrepancy": "good", "named": "good", "cannot_tell": "unknown"}
"""Of the verdicts that are no finding."""
MEANING = {
    "cannot_tell": "Verdict cannot_tell: neither a disagreement nor agreement is shown.",
    "no_discrepancy": "Verdict no_discrepancy: what is left between model and measurement is no more than chance.",
    "named": "Verdict named: one answer, and it holds on a condition that it was not fitted to.",
    "conditional": "Verdict conditional: the effect stands out here, but transfer to another condition is not shown.",
    "lookalikes": "Verdict lookalikes: these data cannot rule out any effect in the set.",
    "partly_explained": "Verdict partly_explained: a real gain, and something significant is left.",
    "outside_catalogue": "Verdict outside_catalogue: a real disagreement that no entry of the catalogue describes.",
    "instrument_first": "Verdict instrument_first: the rig or a sensor could do this as well as the tissue. Calibrate.",
}


def discovery_verdict(record: DiscoveryRecord) -> Verdict:
    """Return the verdict of the page."""
    found = record.found
    status = STATUS.get(found.verdict, "finding")
    if status == "good" and not found.within_tolerance:
        status = "finding"
    points = [MEANING[found.verdict]]
    if found.where and _largest_share(found) < criteria.SMALL_IN_PRACTICE:
        points.append(
            f"All of it lies below {criteria.SMALL_IN_PRACTICE:g} % of the signal: visible, but small in practice."
        )
    points.extend(_sizes(record))
    if found.verdict == "no_discrepancy" and found.smallest_visible:
        smallest = ", ".join(
            f"{sized(name, size)} in {channel_name(name)}" for name, size in found.smallest_visible.items()
        )
        points.append(f"The smallest disagreement these data could have shown: {smallest}.")
    return Verdict(status, found.statement, points)


def _largest_share(found: Discovery) -> float:
    """The most of a channel's signal, %, that a place is off in its mean, or that the effects add at any instant.

    A short pull or snap is a small part of the phase that it is in.
    """
    shares = [abs(place.percent_of_signal) for place in found.where]
    for trace in found.traces:
        added, signal = np.abs(trace.after - trace.before), np.abs(trace.measured)
        if np.isfinite(added).any() and np.isfinite(signal).any():
            shares.append(float(100.0 * np.nanmax(added) / max(np.nanmax(signal), 1e-300)))
    return max(shares)


def _sizes(record: DiscoveryRecord) -> list[str]:
    """Channels that the model of the answer misses by more than the stated tolerance."""
    beyond = [
        f"{channel_name(each.channel)} by {sized(each.channel, each.after)} (tolerance "
        f"{sized(each.channel, each.tolerance)})"
        for each in record.found.sizes
        if not each.within
    ]
    return [f"The model still misses {', '.join(beyond)}."] if beyond else []


def _own_section(record: DiscoveryRecord) -> Section:
    """Return the fitted set-up and the trials' own values."""
    found = record.found
    blocks: list[Block] = []
    if found.setup:
        columns = (
            "parameter", Column("change", "", 3), Column("95 % low"), Column("95 % high"),
            Column("known to", "", 2), Column("standard deviations", "", 2), "named",
        )  # fmt: skip
        blocks += [
            Paragraph(SETUP),
            Table("The set-up", columns, [_setup_row(each) for each in found.setup], folded=False),
        ]
    heads = (
        "trial", Column("gain", "", 4), Column("zero", "N", 3), Column("late", "ms", 3), Column("touch", "mm", 3),
        Column("thicker", "%", 2), "at its bound",
    )  # fmt: skip
    rows = [_own_row(each) for each in found.own]
    download = Download("tables/trials.csv", "the same")
    return Section("Fitted beside it", [*blocks, Paragraph(TRIALS), Table("The trials", heads, rows, download, True)])


def _setup_row(each: SetupEstimate) -> tuple[object, ...]:
    return (each.key, each.change, *each.ci95, each.prior, each.of_prior, each.named)


def _own_row(each: TrialValues) -> tuple[object, ...]:
    own = (each.gain, each.zero, 1e3 * each.late, 1e3 * each.touch, 1e2 * each.thicker)
    return (each.trial, *own, ", ".join(each.at_bound))
