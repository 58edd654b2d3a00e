"""Measured against simulated, before and after, for a few trials that stand for the rest."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.report.words import channel_name
from benchmark.discovery.result import Trace
from benchmark.discovery.units import channel_unit
from reports import Paragraph, Section
from reports.figures import RepairedTrace, repaired

MOST_PANELS = 6


def comparison_section(record: DiscoveryRecord) -> Section:
    """Return the section; without traces it says that there is nothing to show."""
    title = "Measured against simulated"
    chosen = representative(record.found.traces)
    if not chosen:
        return Section(title, [Paragraph("No trial could be simulated, so there is nothing to compare.")])
    measured = record.labels.get("measured", "Measured")
    panels = [_panel(trace, record) for trace in chosen]
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


def _panel(trace: Trace, record: DiscoveryRecord) -> RepairedTrace:
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
