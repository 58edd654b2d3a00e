"""Marker scale error: wrong millimetres per pixel."""

from __future__ import annotations

from dataclasses import replace

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Effect, Motion, Readings, Surroundings, Values

CARD = Card(
    slug="marker_scale_error",
    acts_on="observation",
    sentence="Millimetres per pixel are wrong: resting grid and motion are both too large or too small.",
    equation="x -> x (1 + error)",
    source="calibration of the camera's plane",
    parameters=(linear("error", "", -0.5, 0.5, "relative error of the scale", 0.01),),
)


def _observe(values: Values, readings: Readings, motion: Motion, around: Surroundings) -> Readings:
    if readings.markers is None:
        return readings
    return replace(readings, markers=readings.markers * (1.0 + values["error"]))


EFFECT = Effect(CARD, "error", observe=_observe, needs_markers=True)
