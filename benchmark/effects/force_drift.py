"""Force drift: the sensor's zero creeps with time."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear, logarithmic
from benchmark.effects.term import Effect, Motion, Readings, Surroundings, Values

CARD = Card(
    slug="force_drift",
    acts_on="observation",
    sentence="The force sensor's zero creeps with time, whatever the tool does.",
    equation="F_read = F + rate tau (1 - exp(-t / tau)), t from the first sample",
    source="first-order thermal settling of a strain-gauge sensor",
    parameters=(
        linear("rate", "N/s", -10.0, 10.0, "of the drift at the start"),
        logarithmic("tau", "s", 0.3, 1e5, "over which the drift settles"),
    ),
)


def _observe(values: Values, readings: Readings, motion: Motion, around: Surroundings) -> Readings:
    passed = motion.time - motion.time[0]
    drift = -values["rate"] * values["tau"] * np.expm1(-passed / values["tau"])
    return replace(readings, force=readings.force + drift)


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    rate = 0.02 * around.peak_force / around.duration
    return {"rate": rate, "tau": 10.0 * around.duration}, {"rate": rate, "tau": 0.3 * around.duration}


EFFECT = Effect(CARD, "rate", observe=_observe, starts=_starts)
