"""Perspective: out-of-plane motion magnifies what the camera sees."""

from __future__ import annotations

from dataclasses import replace

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="perspective",
    acts_on="observation",
    sentence="The lower face comes nearer to the camera as it is pressed, which magnifies the markers' radius.",
    equation="x -> x / (1 - w / distance), w the face's motion towards the camera",
    source="pinhole camera; R. Hartley and A. Zisserman, Multiple View Geometry, chapter 6",
    parameters=(linear("nearness", "1/m", 0.0, 50.0, "one over the distance from camera to face", 1.0),),
)


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    if readings.markers is None or readings.sink is None:
        return readings
    larger = 1.0 / (1.0 - values["nearness"] * readings.sink)
    return replace(readings, markers=readings.markers * larger[..., None])


EFFECT = Effect(DESCRIPTION, "nearness", observe=_observe, needs_markers=True)
