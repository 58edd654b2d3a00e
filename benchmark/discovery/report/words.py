"""Names and sizes of a discovery in words."""

from __future__ import annotations

import math
from collections.abc import Sequence

from benchmark.discovery.discovery_result import Place, channel_unit
from reports.formatting import format_number

CHANNELS = {
    "force_z": "press force",
    "marker_radial": "markers, radial",
    "marker_tangential": "markers, tangential",
    "marker_x": "markers, mean x",
    "marker_y": "markers, mean y",
}
PHASES = {
    "approach": "approach",
    "load": "load",
    "hold": "hold",
    "unload_high": "unload, high",
    "unload_low": "unload, low",
    "after_lift_off": "after lift-off",
}
HELD_OUT = {"condition": "a condition that the fit has not seen", "trial": "trials that the fit has not seen"}


def channel_name(channel: str) -> str:
    """A channel in words."""
    return CHANNELS.get(channel, channel.replace("_", " "))


def phase_name(phase: str) -> str:
    """A phase in words."""
    return PHASES.get(phase, phase.replace("_", " "))


def sized(channel: str, size: float) -> str:
    """A residual of a channel with its unit: 0.21 N, 35 um as 0.035 mm."""
    unit, scale = channel_unit(channel)
    return f"{format_number(scale * size, 2)} {unit}"


def probability(p: float | None) -> str:
    """A p value, or what stands in its place."""
    if p is None or math.isnan(p):
        return "not tested"
    return "p < 0.001" if p < 0.001 else f"p = {format_number(p, 2)}"


def place_words(place: Place) -> str:
    """A place in a sentence: where, how deep, how large, how sure."""
    cycle = f" of cycle {place.cycle}" if place.cycle else ""
    return (
        f"{channel_name(place.channel)}, {phase_name(place.phase)}{cycle} ({place.condition}), {depths(place)}: "
        f"{sized(place.channel, abs(place.missed))} {compared(place)}, "
        f"{format_number(abs(place.percent_of_signal), 2)} % of the signal, {probability(place.p)}"
        f"{added_words(place)}"
    )


def largest_place(places: Sequence[Place]) -> Place:
    """The place where residual, or what the effects add, is the largest share of its channel's signal."""
    return max(places, key=lambda place: place.largest_percent)


def depths(place: Place) -> str:
    """From where to where, mm; what is less than a thousandth of the deeper end is touch."""
    least = 1e-3 * abs(place.depth[1])
    low, high = (format_number(1e3 * end if abs(end) > least else 0.0, 3, trim=True) for end in place.depth)
    return f"{low} to {high} mm"


def compared(place: Place) -> str:
    """How a residual stands to the simulation."""
    if place.either_way:
        return "more and less than simulated in turn (root mean square)"
    return f"{'more' if place.missed > 0 else 'less'} than simulated"


def added_words(place: Place) -> str:
    """What the effects of the answer add there."""
    if place.added is None:
        return ""
    unit, scale = channel_unit(place.channel)
    return f" (the effect adds {scale * place.added:+.2g} {unit} to the simulation)"
