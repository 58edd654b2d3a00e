"""How much of the gap closed on data that was held out, what remains, and what could have been seen."""

from __future__ import annotations

import numpy as np

from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.report.words import HELD_OUT, channel_name
from benchmark.discovery.result import ChannelGap
from benchmark.discovery.units import channel_unit
from reports import Block, Bullets, Column, Download, Paragraph, Section, Table
from reports.figures import Gap, RepairedTrace, gap_bars, repaired


def gap_section(record: DiscoveryRecord) -> Section:
    """Return the gap per channel (and per layer of a run) before and after."""
    blocks: list[Block] = []
    bars = [_bar(gap) for gap in record.found.gap if gap.rmse_before > 0.0]
    if bars:
        held = {gap.held_out for gap in record.found.gap}
        words = HELD_OUT.get("condition" if "condition" in held else "trial", "held-out data")
        blocks.append(gap_bars(bars, record.labels.get("held_out", words)))
    blocks.append(_table(record))
    if record.layers:
        layers = [Gap(each.layer, 1e3 * each.rmse_before, 1e3 * each.rmse_after, None, "mm") for each in record.layers]
        if all(layer.before > 0 for layer in layers):
            blocks.append(
                gap_bars(layers, "the loads that the fit has not seen, a layer's deflection on the tool axis")
            )
        blocks += [_curves(record), _layers(record)]
    return Section("The gap, before and after", blocks)


def _bar(gap: ChannelGap) -> Gap:
    unit, scale = channel_unit(gap.channel)
    floor = scale * gap.noise_floor if gap.noise_floor > 0.0 else None
    return Gap(channel_name(gap.channel), scale * gap.rmse_before, scale * gap.rmse_after, floor, unit)


def _table(record: DiscoveryRecord) -> Table:
    columns = (
        "channel", "unit", Column("rms before", "", 3), Column("rms after", "", 3), Column("floor", "", 3),
        Column("closed", "%", 3), Column("95 % low", "%", 3), Column("95 % high", "%", 3), "held out",
    )  # fmt: skip
    rows = [_row(gap) for gap in record.found.gap]
    caption = "Gap per channel; closed = (before² − after²) / (before² − floor²), interval by bootstrap over trials"
    return Table(caption, columns, rows, Download("tables/gap.csv", "the same"), False)


def _row(gap: ChannelGap) -> tuple[object, ...]:
    unit, scale = channel_unit(gap.channel)
    ends = (None, None) if gap.ci95 is None else tuple(100 * end for end in gap.ci95)
    closed = None if gap.closed is None else 100 * gap.closed
    sizes = (scale * gap.rmse_before, scale * gap.rmse_after, scale * gap.noise_floor)
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
    blocks: list[Block] = [Bullets(remains)] if remains else [Paragraph("Nothing significant remains.")]
    if record.found.smallest_visible:
        columns = ("channel", Column("smallest visible mean residual", "", 3), "unit")
        rows = [
            (channel_name(channel), channel_unit(channel)[1] * size, channel_unit(channel)[0])
            for channel, size in record.found.smallest_visible.items()
        ]
        blocks.append(Table("What these data could have shown", columns, rows, folded=False))
    return Section("What remains", blocks)
