"""Tool inertia: the sensor weighs the accelerating tool."""

from __future__ import annotations

from dataclasses import replace

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="tool_inertia",
    acts_on="observation",
    sentence="The sensor carries the tool: it also reads the force that speeds the tool up and slows it down.",
    equation="F_read = F + m d^2d/dt^2",
    source="Newton's second law",
    parameters=(linear("mass", "kg", 0.0, 10.0, "of the tool below the sensor", 0.05),),
)


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    return replace(readings, force=readings.force + values["mass"] * motion.acceleration)


def _swing(values: Values, context: TrialContext) -> float:
    """The time sqrt(m / k) of the tool on the stiffness k of the deepest press, s."""
    return float((values["mass"] * context.peak_depth / context.peak_force) ** 0.5)


EFFECT = Effect(DESCRIPTION, "mass", observe=_observe, acts_within=_swing)
