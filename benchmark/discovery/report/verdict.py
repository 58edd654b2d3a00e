"""The verdict of a discovery: one sentence, and what stands behind it."""

from __future__ import annotations

from benchmark.discovery.record import DiscoveryRecord
from benchmark.discovery.report.words import channel_name, effect_name, place_words, sized
from reports import Verdict
from reports.formatting import format_number

MATTERS = 2.0
"""Of a channel's largest signal, %: what is smaller is said to be small in practice."""
MEANING = {
    "no_discrepancy": "Verdict no_discrepancy: what is left between model and measurement is no more than chance.",
    "named": "Verdict named: one answer, and it holds on a condition that it was not fitted to.",
    "conditional": "Verdict conditional: the effect stands out here, but transfer to another condition is not shown.",
    "lookalikes": "Verdict lookalikes: these data cannot separate the effects in the set.",
    "partly_explained": "Verdict partly_explained: a real gain, and something significant is left.",
    "outside_catalogue": "Verdict outside_catalogue: a real disagreement that no entry of the catalogue describes.",
    "instrument_first": "Verdict instrument_first: the rig or a sensor could do this as well as the tissue. Calibrate.",
}


def discovery_verdict(record: DiscoveryRecord) -> Verdict:
    """Return the verdict of the page."""
    found = record.found
    status = "good" if found.verdict in ("no_discrepancy", "named") else "finding"
    points = [MEANING[found.verdict]]
    if found.where:
        points.append(f"Largest disagreement: {place_words(found.where[0])}.")
        if all(abs(place.percent_of_signal) < MATTERS for place in found.where):
            points.append(f"All of it lies below {MATTERS:g} % of the signal: visible, but small in practice.")
    points.extend(_closed(record))
    similar = sorted({name for effect in found.effects for name in effect.lookalikes})
    if similar:
        points.append(f"Not separable from it here: {', '.join(effect_name(name) for name in similar)}.")
    if found.verdict == "no_discrepancy" and found.smallest_visible:
        smallest = ", ".join(
            f"{sized(name, size)} in {channel_name(name)}" for name, size in found.smallest_visible.items()
        )
        points.append(f"The smallest disagreement these data could have shown: {smallest}.")
    return Verdict(status, found.statement, points)


def _closed(record: DiscoveryRecord) -> list[str]:
    """How much of the gap closed, channel by channel."""
    closed = [gap for gap in record.found.gap if gap.closed is not None] if record.named else []
    if not closed:
        return []
    told = "; ".join(
        f"{channel_name(gap.channel)} {format_number(100 * (gap.closed or 0.0), 3, trim=True)} %" for gap in closed
    )
    return [f"Explainable gap closed on held-out data: {told}."]
