"""Marker scale error: wrong millimetres per pixel.

How well the resting grid tells of it is the base's matter: its printed size has a standard error of its own.
"""

from __future__ import annotations

from dataclasses import replace

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="marker_scale_error",
    acts_on="observation",
    sentence="Millimetres per pixel are wrong: resting grid and motion are both too large or too small.",
    equation="x -> x (1 + error)",
    source="calibration of the camera's plane",
    parameters=(linear("error", "", -0.5, 0.5, "relative error of the scale", 0.01),),
)


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    if readings.markers is None:
        return readings
    return replace(readings, markers=readings.markers * (1.0 + values["error"]))


EFFECT = Effect(DESCRIPTION, "error", observe=_observe, needs_markers=True)
