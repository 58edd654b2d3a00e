"""Which effect: the ranking of candidates, and the named ones with equation, parameters and source."""

from __future__ import annotations

from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.report.words import effect_name
from benchmark.discovery.result import Candidate, Estimate, NamedEffect
from benchmark.model_file.units import shown
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
        "is accepted from z = 3 up, with BIC on the effective sample size agreeing."
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
