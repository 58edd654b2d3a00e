"""The page's section on the effects in the FEM and the wave model: what each predicts of unseen trials, and how."""

from __future__ import annotations

from benchmark.discovery.criteria import SMALL_IN_PRACTICE
from benchmark.discovery.discovery_result import channel_unit
from benchmark.discovery.refitting.refit_result import ModelRefit, Prediction, RefittedNumber
from benchmark.discovery.report.disagreement_sections import traced
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.discovery.report.words import channel_name, sized
from benchmark.files.units import shown
from benchmark.physics.setup_entry import effect_name
from reports import Block, Bullets, Column, Download, Paragraph, Section, Subsection, Table
from reports.figures import repaired
from reports.formatting import format_number

NAMES = {"fem": "FEM", "wave": "Wave model"}
KIND = {"nothing": "the fit itself", "condition": "condition", "tool": "tool", "trials": "trials"}
MOST_PANELS = 4
FAR = 2.0
"""Standard deviations of what is known of a set-up beyond which a refit bends it. First choice."""
ALIKE = 0.25
"""Of the strength, by which model and discovery may differ without a remark. First choice."""
INTRODUCTION = (
    "The effects were put into both models and refitted there: modulus, set-up within what is known of it and the "
    "effects' parameters, with each trial's own gain, zero, clock and touch, and without the bends that the search "
    "allows its base. Before is the same fit without the effects. Held out is what a fit has not seen."
)


def refit_section(record: DiscoveryRecord) -> Section:
    """Return the section."""
    blocks: list[Block] = [Paragraph(INTRODUCTION), _predictions(record)]
    for refit in record.refits:
        blocks.append(Subsection(NAMES[refit.model], _model(refit, record)))
    return Section("The effects in the FEM and the wave model", blocks)


def _predictions(record: DiscoveryRecord) -> Table:
    columns = (
        "model", "held out", "conditions", "channel", "unit", Column("rms before", "", 3), Column("rms after", "", 3),
        Column("floor", "", 3), Column("before / floor", "", 3), Column("after / floor", "", 3),
        Column("explained", "%", 3),
    )  # fmt: skip
    rows = []
    for refit in record.refits:
        for each in refit.predictions:
            row = each.row(refit.model)
            share = None if each.explained is None else 100.0 * each.explained
            sizes = [row[name] for name in ("rmse_before", "rmse_after", "noise_floor")]
            ratios = [row[name] for name in ("before_in_noise", "after_in_noise")]
            place = (NAMES[refit.model], KIND[each.held_out], each.name, channel_name(each.channel), row["unit"])
            rows.append((*place, *sizes, *ratios, share))
    caption = "Measured minus simulated without and with the effects; the floor is the scatter of replicates"
    return Table(caption, columns, rows, Download("tables/refitted.csv", "the same"), False)


def _model(refit: ModelRefit, record: DiscoveryRecord) -> list[Block]:
    if refit.reason:
        return [Paragraph(f"No refit: {refit.reason}.")]
    shown_traces = refit.traces[:MOST_PANELS]
    blocks: list[Block] = [Bullets(remarks(refit))]
    if shown_traces:
        blocks.append(repaired([traced(each, record) for each in shown_traces], changed=True))
    return [*blocks, _numbers(refit)]


def remarks(refit: ModelRefit) -> list[str]:
    """What a reader must know: how the effects are carried, what is unseen, and where the refit disagrees."""
    out = [f"{effect_name(each.slug)}: {each.words}." for each in refit.carried]
    if refit.found_adds > 0.0:
        ratio = refit.adds / refit.found_adds
        text = f"The effects add {sized('force_z', refit.adds)} rms to the force; in the search they added"
        word = "" if abs(ratio - 1.0) <= ALIKE else f": the strengths disagree, by a factor of {ratio:.2g}"
        out.append(f"{text} {sized('force_z', refit.found_adds)}{word}.")
    out += [
        f"{_named(each)} disagrees with the search, {_found(each)}." for each in refit.numbers if each.agrees is False
    ]
    out += [
        f"{_named(each)} is {abs(each.of_prior):.2g} standard deviations from what was told: the model makes up for "
        "something else by it."
        for each in refit.numbers
        if each.of_prior is not None and abs(each.of_prior) > FAR
    ]
    out += [
        f"With the effects {_unseen(each)} is predicted worse than without."
        for each in refit.predictions
        if each.held_out != "nothing" and each.after > each.before
    ]
    if 100.0 * refit.apart > SMALL_IN_PRACTICE:
        out.append(f"The refit did not settle: presses differ from their expansion by {100.0 * refit.apart:.2g} %.")
    return out


def _unseen(each: Prediction) -> str:
    return f"{channel_name(each.channel)} of the {KIND[each.held_out]} {each.name}"


def _named(number: RefittedNumber) -> str:
    return f"{effect_name(number.part)}, {number.estimate.name} = {_value(number)}"


def _value(number: RefittedNumber) -> str:
    value, unit = shown(number.estimate.value, number.estimate.unit)
    return f"{format_number(value, 3)} {unit}".rstrip()


def _found(number: RefittedNumber) -> str:
    assert number.found is not None
    value, unit = shown(number.found.value, number.found.unit)
    return f"{format_number(value, 3)} {unit}".rstrip()


def _numbers(refit: ModelRefit) -> Table:
    columns = (
        "part", "number", Column("value", "", 4), Column("95 % low", "", 4), Column("95 % high", "", 4), "unit",
        Column("in the search", "", 4), "agrees",
    )  # fmt: skip
    rows = []
    for each in refit.numbers:
        value, unit = shown(each.estimate.value, each.estimate.unit)
        ends = [shown(end, each.estimate.unit)[0] for end in each.estimate.ci95]
        found = None if each.found is None else shown(each.found.value, each.found.unit)[0]
        rows.append((each.part, each.estimate.name, value, *ends, unit, found, each.agrees))
    return Table("Refitted numbers; of a set-up its relative change", columns, rows, folded=False)


def refit_line(refit: ModelRefit) -> str:
    """One line of a terminal: force on what was held out, the most of a new set-up first."""
    if refit.reason:
        return f"{NAMES[refit.model]}: no refit: {refit.reason}"
    order = ("tool", "condition", "trials")
    unseen = [
        each for kind in order for each in refit.predictions if each.held_out == kind and each.channel == "force_z"
    ]
    if not unseen:
        return f"{NAMES[refit.model]}: refitted"
    each, (unit, scale) = unseen[0], channel_unit("force_z")
    floor = "" if not each.floor else f" (replicates: {scale * each.floor:.3g} {unit})"
    kind = {"tool": "an unseen tool", "condition": "an unseen condition", "trials": "unseen trials"}[each.held_out]
    return (
        f"{NAMES[refit.model]} on {kind} ({each.name}): rms {scale * each.before:.3g} -> {scale * each.after:.3g} "
        f"{unit}{floor}"
    )
