"""The page's sections on the effects: the ranking, the named ones with their parameters, and what to measure next."""

from __future__ import annotations

import math

from benchmark.discovery.criteria import ENOUGH_TRIALS, SAME_LOG, SAME_SHARE, Settings
from benchmark.discovery.discovery_result import Candidate, Estimate, NamedEffect
from benchmark.discovery.report.discovery_record import DiscoveryRecord, NextExperiment, Round
from benchmark.files.units import shown
from benchmark.physics.setup_entry import effect_name
from reports import Block, Bullets, Column, Download, Fact, Facts, Listing, Paragraph, Section, Subsection, Table
from reports.figures import RankedCandidate, ranking
from reports.formatting import format_number

MOST_CANDIDATES = 12
APART = 5.0
"""Standard deviations from which rivals are told to be apart as they stand, by their forms."""


def candidates_section(record: DiscoveryRecord) -> Section:
    """Return the ranking of candidates."""
    candidates = record.found.candidates
    if not candidates:
        text = "No candidate was tried: there is nothing that an effect would have to explain."
        return Section("Which effect", [Paragraph(record.labels.get("no_candidates", text)), *_not_shown(record)])
    text = (
        "Each candidate was fitted together with the base model and scored on trials that it had not seen. An effect "
        f"is accepted from z = {Settings.accept_z:g} up, with BIC on the effective sample size agreeing."
    )
    figure = ranking([_ranked(each, record) for each in candidates[:MOST_CANDIDATES]])
    blocks: list[Block] = [Paragraph(record.labels.get("candidates", text)), figure, _table(record)]
    return Section("Which effect", [*blocks, *_not_shown(record)])


def _not_shown(record: DiscoveryRecord) -> list[Block]:
    """Effects that were not looked for, and what such trials lack."""
    if not record.found.not_shown:
        return []
    items = [f"{effect_name(slug)}: needs {lacks}" for slug, lacks in record.found.not_shown.items()]
    return [Subsection("Not looked for: these trials cannot show it", [Bullets(items)])]


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


OF_A_RUN = "of the likelihood among the candidates; one run has no noise, so nothing is tested"
"""What the weight of an effect found in a run is, where a session's answer has a confidence."""


def _effect(effect: NamedEffect, record: DiscoveryRecord) -> list[Block]:
    card = record.cards.get(effect.slug)
    facts = _confidence(effect, record)
    blocks: list[Block] = []
    meanings: dict[str, str] = {}
    if card is not None:
        blocks += [Paragraph(card.sentence), Listing(card.equation, "Its term", folded=False)]
        facts = [Fact("Acts on", card.acts_on), *facts, Fact("Source", card.source)]
        meanings = {parameter.name: parameter.meaning for parameter in card.parameters}
    facts.append(Fact("Across conditions", _constancy(effect, record)))
    tables: list[Block] = [parameter_table(effect, meanings)]
    tables += [_condition_table(effect)] if effect.by_condition else []
    tables += [_rival_table(effect)] if effect.rivals else []
    return [*blocks, Facts(facts), *tables]


def _confidence(effect: NamedEffect, record: DiscoveryRecord) -> list[Fact]:
    """How often such an answer was right; of a run its weight; nothing for an entry that is not named."""
    if not record.named:
        return []
    told = f"{format_number(100 * effect.confidence, 2, trim=True)} %"
    if record.source == "run":
        return [Fact("Weight", f"{told} {OF_A_RUN}")]
    return [Fact("Confidence", f"{told}: so often was such an answer right in blind trials")]


def _constancy(effect: NamedEffect, record: DiscoveryRecord) -> str:
    """Whether the parameters are the same in every condition."""
    if not effect.by_condition:
        return "not known: there is one condition" if len(record.found.conditions) < 2 else "not known"
    moved = dict.fromkeys(f"{each.name} in {each.condition}" for each in effect.by_condition if not each.agrees)
    if moved:
        return f"other parameters: {', '.join(moved)}"
    joint = {each.name: each.value for each in effect.parameters}
    apart = [e for e in effect.by_condition if not e.ci95[0] <= joint.get(e.name, e.value) <= e.ci95[1]]
    if not apart:
        return "the same parameters in all"
    return (
        f"alike in all, to {100 * SAME_SHARE:g} % or a factor of {math.exp(SAME_LOG):.0f} in what goes "
        f"by its logarithm; the 95 % interval leaves out the joint value: "
        + ", ".join(dict.fromkeys(f"{each.name} in {each.condition}" for each in apart))
    )


def _condition_table(effect: NamedEffect) -> Table:
    """The parameters as each condition alone tells them."""
    columns = (
        "parameter", "condition", Column("value", "", 4), Column("95 % low"), Column("95 % high"), "unit", "agrees",
    )  # fmt: skip
    rows = []
    for each in effect.by_condition:
        value, unit = shown(each.value, each.unit)
        low, high = (shown(end, each.unit)[0] for end in each.ci95)
        rows.append((each.name, each.condition, value, low, high, unit, each.agrees))
    return Table(f"{effect_name(effect.slug)}: each condition alone", columns, rows)


def _rival_table(effect: NamedEffect) -> Table:
    """What stands in the effect's place, with its own parameters."""
    columns = (
        "in its place", Column("lacks", "% of the gain", 2), Column("lacks", "standard errors", 2), "parameter",
        Column("value", "", 4), Column("95 % low"), Column("95 % high"), "unit",
    )  # fmt: skip
    rows: list[tuple[object, ...]] = []
    for rival in effect.rivals:
        for each in rival.parameters:
            name, _, value, low, high, unit = _row(each, "")
            rows.append((effect_name(rival.slug), 100 * rival.lacking, rival.errors, name, value, low, high, unit))
    return Table("What these data cannot rule out in its place", columns, rows, folded=False)


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
    "cannot_tell": f"Repeat the press on one specimen: at least {ENOUGH_TRIALS} trials in all, two or more of one "
    "condition, more where they scatter, at a second and third speed where time shifts are warned of, and with a rigid "
    "block under each tool and all tools on one specimen where gains are.",
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
    listing = Listing(proposal.toml, "next_experiment.toml, for python -m bench_hw capture")
    if proposal.opens:
        text = f"{proposal.words} {shown_by(proposal)}"
        return Section("What to measure next", [Paragraph(text), listing])
    first, second = map(effect_name, proposal.rivals)
    text = (
        f"{proposal.words} Expected distance of {first} and {second}: "
        f"{proposal.separation:.1f} standard deviations by {trials_in_words(proposal.trials)} in "
        f"{proposal.minutes:.0f} minutes at the bench; the session tells "
        f"{proposal.separation_now:.1f}.{_apart(proposal)}"
    )
    return Section("What to measure next", [Paragraph(text), _menu(proposal), listing])


def shown_by(proposal: NextExperiment) -> str:
    """What a proposed experiment shows that was not looked for, and what it takes."""
    return (
        f"It shows what these trials cannot, and was not looked for: {', '.join(map(effect_name, proposal.opens))}; "
        f"{trials_in_words(proposal.trials)}, {proposal.minutes:.0f} min at the bench."
    )


def trials_in_words(count: int) -> str:
    """How many trials."""
    return "one trial" if count == 1 else f"{count} trials"


def _apart(proposal: NextExperiment) -> str:
    """Why rivals stay in question that are far apart already."""
    if proposal.separation_now < APART:
        return ""
    return (
        " Their textbook forms are far apart in this session already; the rival stays in question because the true "
        "form may be another, by which a good fit loses about as much."
    )


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


def loop_section(record: DiscoveryRecord) -> Section:
    """Return what was done on the bench, round by round."""
    title, none = "Measured on the bench", "No experiment was done: one answer stood, or none could be proposed."
    if record.stopped is not None:
        none = f"The loop ended before its time: {record.stopped}. What was recorded is in the folder session."
    if not record.rounds:
        return Section(title, [Paragraph(none)])
    told = [f"{each.words} {_compared(each)} {_outcome(each)}" for each in record.rounds]
    columns = (
        "round", "experiment", "rivals", Column("before", "sd", 3), Column("expected", "sd", 3),
        Column("found", "sd", 3), "trials", Column("bench time", "min", 3), "ruled out",
    )  # fmt: skip
    rows = [
        (
            number,
            each.choice,
            " / ".join(map(effect_name, each.rivals)),
            each.separation_now,
            each.expected,
            each.found,
            each.trials,
            each.minutes,
            ", ".join(map(effect_name, each.ruled_out)),
        )
        for number, each in enumerate(record.rounds, 1)
    ]
    caption = "Rounds: separation of the rivals in standard deviations before, expected of the experiment, and found"
    ended = [] if record.stopped is None else [Paragraph(none)]
    return Section(title, [*ended, Bullets(told), Table(caption, columns, rows, folded=False)])


def _compared(each: Round) -> str:
    if math.isnan(each.expected):
        return f"Shown, and not looked for before: {effect_name(each.rivals[1])}."
    first, second = map(effect_name, each.rivals)
    return f"{_begun(first)} against {second}: {_parted(each.found)} apart, {each.expected:.0f} expected."


def _parted(found: float | None) -> str:
    return "not compared" if found is None else f"{found:.0f} standard deviations"


def _outcome(each: Round) -> str:
    answer = " and ".join(map(effect_name, each.answer)) or "no effect"
    out = f"{', '.join(map(effect_name, each.ruled_out))} ruled out; " if each.ruled_out else ""
    beside = "alone" if each.remaining < 2 else "beside a rival" if each.remaining == 2 else "beside rivals"
    return _begun(f"{out}{answer} stands {beside}.")


def _begun(sentence: str) -> str:
    """With a capital letter."""
    return sentence[:1].upper() + sentence[1:]
