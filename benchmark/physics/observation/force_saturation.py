"""Force saturation: readings stop at a limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmark.physics.description import EffectDescription, logarithmic
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

SOFTEST = 0.12
"""A wider bend is no end of a range: it would take the place of whatever lets the force grow ever less."""
DESCRIPTION = EffectDescription(
    slug="force_saturation",
    acts_on="observation",
    sentence="The force sensor reaches the end of its range: readings stop at a limit.",
    equation="F_read = F - s ln(1 + exp((F - limit) / s)), s = softness limit",
    needs=(("free_force",),),
    source="clipping of an amplifier; smooth minimum",
    parameters=(
        logarithmic("limit", "N", 1e-3, 1e3, "largest reading"),
        logarithmic(
            "softness", "", 1e-3, SOFTEST, "width of the bend as a share of the limit", 0.02, stated=(1e-3, 0.3)
        ),
    ),
)


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    bend = values["softness"] * values["limit"]
    over = bend * np.logaddexp(0.0, (readings.force - values["limit"]) / bend)
    return replace(readings, force=readings.force - over)


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    pairs = ((1.0, 0.02), (0.93, 0.02), (0.8, 0.02), (1.0, 0.1))
    return tuple({"limit": share * context.peak_force, "softness": soft} for share, soft in pairs)


EFFECT = Effect(DESCRIPTION, "limit", observe=_observe, starts=_starts)
