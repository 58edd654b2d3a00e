"""Contact gap: free travel before contact."""

from __future__ import annotations

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Array, BodyResponse, Effect, Motion, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="contact_gap",
    acts_on="drive",
    sentence="The tool travels freely before it touches: zero depth is not where contact begins.",
    equation="d -> d - gap",
    source="offset of the actuator's zero; K. L. Johnson, Contact Mechanics, chapter 1",
    parameters=(linear("gap", "m", 0.0, 0.02, "free travel"),),
)


def _drive(values: Values, motion: Motion, response: BodyResponse) -> Array:
    return motion.depth - values["gap"]


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return ({"gap": 0.02 * context.peak_depth},)


EFFECT = Effect(DESCRIPTION, "gap", drive=_drive, starts=_starts)
