"""Force saturation: readings stop at a limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.effects.effect import Card
from benchmark.effects.parameter import logarithmic
from benchmark.effects.term import Effect, Motion, Readings, Surroundings, Values

CARD = Card(
    slug="force_saturation",
    acts_on="observation",
    sentence="The force sensor reaches the end of its range: readings stop at a limit.",
    equation="F_read = F - s ln(1 + exp((F - limit) / s)), s = softness limit",
    source="clipping of an amplifier; smooth minimum",
    parameters=(
        logarithmic("limit", "N", 1e-3, 1e3, "largest reading"),
        logarithmic("softness", "", 1e-3, 0.3, "width of the bend as a share of the limit", 0.02),
    ),
)


def _observe(values: Values, readings: Readings, motion: Motion, around: Surroundings) -> Readings:
    bend = values["softness"] * values["limit"]
    over = bend * np.logaddexp(0.0, (readings.force - values["limit"]) / bend)
    return replace(readings, force=readings.force - over)


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    pairs = ((1.0, 0.02), (0.93, 0.02), (0.8, 0.02), (1.0, 0.1))
    return tuple({"limit": share * around.peak_force, "softness": soft} for share, soft in pairs)


EFFECT = Effect(CARD, "limit", observe=_observe, starts=_starts)
