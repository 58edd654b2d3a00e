"""Force drift: the sensor's zero creeps with time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="force_drift",
    acts_on="observation",
    sentence="The force sensor's zero creeps with time, whatever the tool does.",
    equation="F_read = F + rate tau (1 - exp(-t / tau)), t from the first sample",
    needs=(("hold", "second_rate", "lift_off"),),
    source="first-order thermal settling of a strain-gauge sensor",
    parameters=(
        linear("rate", "N/s", -10.0, 10.0, "of the drift at the start"),
        logarithmic("tau", "s", 0.3, 1e5, "over which the drift settles"),
    ),
)


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    passed = motion.time - motion.time[0]
    drift = -values["rate"] * values["tau"] * np.expm1(-passed / values["tau"])
    return replace(readings, force=readings.force + drift)


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    rate = 0.02 * context.peak_force / context.duration
    return {"rate": rate, "tau": 10.0 * context.duration}, {"rate": rate, "tau": 0.3 * context.duration}


EFFECT = Effect(DESCRIPTION, "rate", observe=_observe, starts=_starts)
