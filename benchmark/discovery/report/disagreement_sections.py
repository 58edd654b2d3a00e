"""The page's sections on the disagreement: curves, where it is, the gap before and after, what remains."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery.discovery_result import PHASES, ChannelGap, Contrast, Place, Trace, channel_unit
from benchmark.discovery.report.discovery_record import DiscoveryRecord
from benchmark.discovery.report.words import (
    HELD_OUT,
    channel_name,
    largest_place,
    phase_name,
    place_words,
    probability,
    sized,
)
from reports import Block, Bullets, Column, Download, Paragraph, Section, Subsection, Table
from reports.figures import Disagreement, GapRow, RepairedTrace, gap_bars, repaired, where_map

MOST_PANELS = 6
NOT_KNOWN = "not known"
"""In the place of a floor, and of the share closed, where no trial was repeated on one specimen."""
UNTESTED = "Not tested: sign flips of these trials cannot reach the level."


def comparison_section(record: DiscoveryRecord) -> Section:
    """Return the section; without traces it says that there is nothing to show."""
    title = "Measured against simulated"
    chosen = representative(record.found.traces)
    if not chosen:
        return Section(title, [Paragraph("No trial could be simulated, so there is nothing to compare.")])
    measured = record.labels.get("measured", "Measured")
    panels = [traced(trace, record) for trace in chosen]
    text = (
        "One trial a condition stands for the rest, the one in the middle of its group; held-out trials are marked. "
        "Gain, zero, time shift and depth at touch of each trial are fitted, before and after alike."
    )
    words = record.labels.get("comparison", text)
    return Section(title, [Paragraph(words), repaired(panels, changed=record.named, measured=measured)])


def representative(traces: Sequence[Trace]) -> list[Trace]:
    """One trace a channel and condition: held out where one is, of these the one of median residual before."""
    groups: dict[tuple[str, str], list[Trace]] = {}
    for trace in traces:
        groups.setdefault((trace.channel, trace.condition), []).append(trace)
    chosen = [_middle(group) for group in groups.values()]
    chosen.sort(key=lambda trace: not trace.channel.startswith("force"))
    return chosen[:MOST_PANELS]


def _middle(group: Sequence[Trace]) -> Trace:
    held = [trace for trace in group if trace.held_out] or list(group)
    ranked = sorted(held, key=_rms)
    return ranked[(len(ranked) - 1) // 2]


def _rms(trace: Trace) -> float:
    residual = trace.measured - trace.before
    present = residual[np.isfinite(residual)]
    return float(np.sqrt(np.mean(present**2))) if present.size else 0.0


def traced(trace: Trace, record: DiscoveryRecord) -> RepairedTrace:
    """Return a trace as the figures take it."""
    unit, scale = channel_unit(trace.channel)
    over_depth = record.source == "run"
    held = ", held out" if trace.held_out else ""
    name = trace.trial if trace.channel.startswith("force") else f"{trace.trial}, {channel_name(trace.channel)}"
    return RepairedTrace(
        title=f"{name}{held}",
        x=1e3 * trace.depth if over_depth else trace.time - trace.time[0],
        measured=scale * trace.measured,
        before=scale * trace.before,
        after=scale * trace.after,
        noise=scale * np.nan_to_num(trace.noise),
        channel="force" if trace.channel.startswith("force") else "displacement",
        unit=unit,
        x_label="depth (mm)" if over_depth else "time (s)",
    )


MOST_ROWS = 8


def _untested(record: DiscoveryRecord) -> bool:
    """Whether the test could not reach its level."""
    return record.found.verdict == "cannot_tell" and record.found.p is None


def where_section(record: DiscoveryRecord) -> Section:
    """Return the map of significant cells, their table, and the contrasts."""
    found = record.found
    if not found.where:
        nothing = (
            UNTESTED
            if _untested(record)
            else f"No place in which the disagreement is more than chance ({probability(found.p)} over all places)."
        )
        text = record.labels.get("where", nothing)
        return Section("Where", [Paragraph(text), *_size_table(record), *_contrasts(found.contrasts)])
    cells = [_cell(place, record) for place in found.where]
    rows = list(dict.fromkeys(cell.row for cell in sorted(cells, key=lambda cell: not cell.row.startswith("press"))))
    text = (
        f"Family-wise {probability(found.p)} for any disagreement, by sign flips of whole trials. "
        f"{len(found.where)} place{'s are' if len(found.where) > 1 else ' is'} significant on their own."
    )
    largest = f" Largest: {place_words(largest_place(found.where))}."
    blocks: list[Block] = [Paragraph(record.labels.get("where", text) + largest)]
    blocks += [where_map(cells, rows[:MOST_ROWS], list(map(phase_name, PHASES)))] if len(rows) <= MOST_ROWS else []
    return Section("Where", [*blocks, _where_table(record), *_size_table(record), *_contrasts(found.contrasts)])


def _size_table(record: DiscoveryRecord) -> list[Block]:
    """How large the misfit is against the tolerance, whatever its p; nothing where it was not asked."""
    if not record.found.sizes:
        return []
    columns = (
        "channel", "unit", Column("largest miss before", "", 3), Column("largest miss after", "", 3),
        Column("tolerance", "", 3), "within",
    )  # fmt: skip
    rows = []
    for each in record.found.sizes:
        unit, scale = channel_unit(each.channel)
        sizes = (scale * each.before, scale * each.after, scale * each.tolerance)
        rows.append((channel_name(each.channel), unit, *sizes, each.within))
    caption = "Size of the misfit: rms over trials of the mean residual in the worst cell, and the stated tolerance"
    return [Table(caption, columns, rows, folded=False)]


def _cell(place: Place, record: DiscoveryRecord) -> Disagreement:
    several = len(record.found.conditions) > 1
    row = channel_name(place.channel) + (f", {place.condition}" if several and place.condition else "")
    return Disagreement(
        row,
        phase_name(place.phase),
        place.cycle,
        (1e3 * place.depth[0], 1e3 * place.depth[1]),
        abs(place.percent_of_signal) * (1.0 if place.missed >= 0 else -1.0),
        sized(place.channel, place.missed),
        place.p,
    )


def _where_table(record: DiscoveryRecord) -> Table:
    columns = (
        "channel", "phase", "condition", "cycle", Column("from", "mm", 3), Column("to", "mm", 3),
        Column("measured minus simulated", "", 3), Column("effect's contribution", "", 3), "unit",
        Column("of the signal", "%", 3), Column("p", "", 2),
    )  # fmt: skip
    rows = [
        (
            channel_name(place.channel),
            phase_name(place.phase),
            place.condition,
            place.cycle or None,
            *(1e3 * end for end in place.depth),
            channel_unit(place.channel)[1] * place.missed,
            None if place.added is None else channel_unit(place.channel)[1] * place.added,
            channel_unit(place.channel)[0],
            place.percent_of_signal,
            place.p,
        )
        for place in record.found.where
    ]
    turning = any(place.either_way for place in record.found.where)
    note = "; of what changes its sign in a phase, the root mean square of what trials share" if turning else ""
    caption = f"Places that are significant, largest first{note}"
    return Table(caption, columns, rows, Download("tables/where.csv", "the same"), True)


def _contrasts(contrasts: tuple[Contrast, ...]) -> list[Block]:
    """The contrasts as sentences."""
    if not contrasts:
        return []
    items = [
        f"{contrast.question} ({channel_name(contrast.channel)}): {sized(contrast.channel, contrast.size)}, "
        f"{probability(contrast.p)}"
        for contrast in contrasts
    ]
    return [Subsection("One question at a time", [Bullets(items)])]


def gap_section(record: DiscoveryRecord) -> Section:
    """Return the gap per channel (and per layer of a run) before and after."""
    blocks: list[Block] = []
    bars = [_bar(gap) for gap in record.found.gap if gap.rmse_before > 0.0]
    if bars:
        held = {gap.held_out for gap in record.found.gap}
        words = HELD_OUT.get("condition" if "condition" in held else "trial", "held-out data")
        blocks.append(gap_bars(bars, record.labels.get("held_out", words)))
    blocks.append(_gap_table(record))
    if record.layers:
        layers = [
            GapRow(each.layer, 1e3 * each.rmse_before, 1e3 * each.rmse_after, None, "mm") for each in record.layers
        ]
        if all(layer.before > 0 for layer in layers):
            blocks.append(
                gap_bars(layers, "the loads that the fit has not seen, a layer's deflection on the tool axis")
            )
        blocks += [_curves(record), _layers(record)]
    return Section("The gap, before and after", blocks)


def _bar(gap: ChannelGap) -> GapRow:
    unit, scale = channel_unit(gap.channel)
    floor = scale * gap.noise_floor if gap.noise_floor else None
    return GapRow(channel_name(gap.channel), scale * gap.rmse_before, scale * gap.rmse_after, floor, unit)


def _gap_table(record: DiscoveryRecord) -> Table:
    columns = (
        "channel", "unit", Column("rms before", "", 3), Column("rms after", "", 3), Column("floor", "", 3),
        Column("closed", "%", 3), Column("95 % low", "%", 3), Column("95 % high", "%", 3), "held out",
    )  # fmt: skip
    rows = [_gap_row(gap) for gap in record.found.gap]
    caption = "Gap per channel; closed = (before² − after²) / (before² − floor²), interval by bootstrap over trials"
    return Table(caption, columns, rows, Download("tables/gap.csv", "the same"), False)


def _gap_row(gap: ChannelGap) -> tuple[object, ...]:
    unit, scale = channel_unit(gap.channel)
    ends = (None, None) if gap.ci95 is None else tuple(100 * end for end in gap.ci95)
    unknown = gap.noise_floor is None
    closed = (NOT_KNOWN if unknown else None) if gap.closed is None else 100 * gap.closed
    floor = NOT_KNOWN if gap.noise_floor is None else scale * gap.noise_floor
    sizes = (scale * gap.rmse_before, scale * gap.rmse_after, floor)
    return (channel_name(gap.channel), unit, *sizes, closed, *ends, gap.held_out)


def _curves(record: DiscoveryRecord) -> Block:
    """Each layer's deflection over force, up to the peak."""
    panels = []
    for layer in record.layers:
        rows = slice(0, int(layer.force.argmax()) + 1)
        panels.append(
            RepairedTrace(
                title=layer.layer,
                x=layer.force[rows],
                measured=1e3 * layer.reference[rows],
                before=1e3 * layer.before[rows],
                after=1e3 * layer.after[rows],
                noise=np.zeros(rows.stop),
                channel="deflection",
                unit="mm",
                x_label="force (N)",
            )
        )
    return repaired(panels, changed=record.named, measured=record.labels.get("measured", "Measured"))


def _layers(record: DiscoveryRecord) -> Table:
    columns = (
        "layer", Column("rms before", "mm", 3), Column("rms after", "mm", 3), Column("closed", "%", 3),
        Column("at peak before", "%", 3), Column("at peak after", "%", 3),
    )  # fmt: skip
    rows = [
        (
            each.layer,
            1e3 * each.rmse_before,
            1e3 * each.rmse_after,
            None if each.closed is None else 100 * each.closed,
            each.peak_before,
            each.peak_after,
        )
        for each in record.layers
    ]
    caption = "Deflection of each layer's top face under the run's force: model against the reference"
    return Table(caption, columns, rows, Download("tables/layers.csv", "the same"), False)


def remains_section(record: DiscoveryRecord) -> Section:
    """Return what is left unexplained, and the smallest disagreement that could have been seen."""
    remains = record.found.remains
    blocks: list[Block] = (
        [Bullets(remains)]
        if remains
        else [Paragraph(UNTESTED if _untested(record) else "Nothing significant remains.")]
    )
    if record.found.smallest_visible:
        columns = ("channel", Column("smallest visible mean residual", "", 3), "unit")
        rows = [
            (channel_name(channel), channel_unit(channel)[1] * size, channel_unit(channel)[0])
            for channel, size in record.found.smallest_visible.items()
        ]
        blocks.append(Table("What these data could have shown", columns, rows, folded=False))
    return Section("What remains", blocks)
