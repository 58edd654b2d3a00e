"""Camera latency: frames are late against force."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="camera_latency",
    acts_on="observation",
    sentence="Frames carry the wrong time: the markers move later than force and depth say.",
    equation="x(t) -> x(t - latency)",
    source="time stamps at the arrival of a frame",
    parameters=(linear("latency", "s", 0.0, 2.0, "of the frames against the force", 0.02),),
)


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    if readings.markers is None:
        return readings
    late = motion.time - values["latency"]
    at = np.clip(np.searchsorted(motion.time, late) - 1, 0, motion.time.size - 2)
    share = np.clip((late - motion.time[at]) / (motion.time[at + 1] - motion.time[at]), 0.0, 1.0)[:, None, None]
    seen = readings.markers[at] * (1.0 - share) + readings.markers[at + 1] * share
    return replace(readings, markers=seen)


EFFECT = Effect(DESCRIPTION, "latency", observe=_observe, needs_markers=True)
