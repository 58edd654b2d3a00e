"""The page's sections on the effects: the ranking, the named ones with their parameters, and what to measure next."""

from __future__ import annotations

import math

from benchmark.discovery.criteria import ENOUGH_TRIALS, Settings
from benchmark.discovery.discovery_result import Candidate, Estimate, NamedEffect
from benchmark.discovery.report.discovery_record import DiscoveryRecord, NextExperiment
from benchmark.discovery.report.words import effect_name
from benchmark.files.units import shown
from reports import Block, Column, Download, Fact, Facts, Listing, Paragraph, Section, Subsection, Table
from reports.figures import RankedCandidate, ranking
from reports.formatting import format_number

MOST_CANDIDATES = 12


def candidates_section(record: DiscoveryRecord) -> Section:
    """Return the ranking of candidates."""
    candidates = record.found.candidates
    if not candidates:
        text = "No candidate was tried: there is nothing that an effect would have to explain."
        return Section("Which effect", [Paragraph(record.labels.get("no_candidates", text))])
    text = (
        "Each candidate was fitted together with the base model and scored on trials that it had not seen. An effect "
        f"is accepted from z = {Settings.accept_z:g} up, with BIC on the effective sample size agreeing."
    )
    figure = ranking([_ranked(each, record) for each in candidates[:MOST_CANDIDATES]])
    return Section("Which effect", [Paragraph(record.labels.get("candidates", text)), figure, _table(record)])


def _ranked(candidate: Candidate, record: DiscoveryRecord) -> RankedCandidate:
    chosen = {effect.slug for effect in record.found.effects} if record.named else set()
    return RankedCandidate(
        " + ".join(map(effect_name, candidate.slugs)),
        candidate.gain,
        candidate.gain_standard_error,
        candidate.z,
        candidate.delta_bic,
        candidate.gap_closed,
        chosen=bool(chosen) and set(candidate.slugs) <= chosen,
    )


def _table(record: DiscoveryRecord) -> Table:
    columns = (
        "candidate", Column("z", "", 3), Column("gain", "a trial", 3), Column("standard error", "", 2),
        Column("ΔBIC", "", 3), Column("gap closed", "%", 3), "constant over conditions",
    )  # fmt: skip
    rows = [
        (
            " + ".join(map(effect_name, each.slugs)),
            each.z,
            each.gain,
            each.gain_standard_error,
            each.delta_bic,
            None if each.gap_closed is None else 100.0 * each.gap_closed,
            each.constant,
        )
        for each in record.found.candidates
    ]
    return Table("All candidates, best first", columns, rows, Download("tables/candidates.csv", "the same"), True)


def effects_section(record: DiscoveryRecord) -> Section:
    """Return what the effects of the answer are; under `outside_catalogue` they are the nearest entries."""
    title = "The effect" if len(record.found.effects) == 1 else "The effects"
    blocks: list[Block] = []
    if not record.named:
        title = "The nearest entries, which are not named"
    for effect in record.found.effects:
        blocks.append(Subsection(effect_name(effect.slug), _effect(effect, record)))
    return Section(title, blocks)


def _effect(effect: NamedEffect, record: DiscoveryRecord) -> list[Block]:
    card = record.cards.get(effect.slug)
    facts = [
        Fact(
            "Confidence",
            f"{format_number(100 * effect.confidence, 3, trim=True)} %, among the candidates within reach of the best",
        )
    ]
    blocks: list[Block] = []
    meanings: dict[str, str] = {}
    if card is not None:
        blocks += [Paragraph(card.sentence), Listing(card.equation, "Its term", folded=False)]
        facts = [Fact("Acts on", card.acts_on), *facts, Fact("Source", card.source)]
        meanings = {parameter.name: parameter.meaning for parameter in card.parameters}
    if effect.lookalikes:
        facts.append(Fact("Not separable from", ", ".join(map(effect_name, effect.lookalikes))))
    return [*blocks, Facts(facts), parameter_table(effect, meanings)]


def parameter_table(effect: NamedEffect, meanings: dict[str, str]) -> Table:
    """The parameters of an effect with their intervals."""
    columns = ("parameter", "meaning", Column("value", "", 4), Column("95 % low"), Column("95 % high"), "unit")
    rows = [_row(estimate, meanings.get(estimate.name, "")) for estimate in effect.parameters]
    return Table(f"Parameters of {effect_name(effect.slug)}", columns, rows, folded=False)


def _row(estimate: Estimate, meaning: str) -> tuple[object, ...]:
    value, unit = shown(estimate.value, estimate.unit)
    low, high = (shown(end, estimate.unit)[0] for end in estimate.ci95)
    return (estimate.name, meaning, value, low, high, unit)


ADVICE = {
    "cannot_tell": f"Repeat the press: at least {ENOUGH_TRIALS} trials in all, two or more of one condition.",
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
