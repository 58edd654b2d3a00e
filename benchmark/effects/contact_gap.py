"""Contact gap: free travel before contact."""

from __future__ import annotations

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Answer, Array, Effect, Motion, Surroundings, Values

CARD = Card(
    slug="contact_gap",
    acts_on="drive",
    sentence="The tool travels freely before it touches: zero depth is not where contact begins.",
    equation="d -> d - gap",
    source="offset of the actuator's zero; K. L. Johnson, Contact Mechanics, chapter 1",
    parameters=(linear("gap", "m", 0.0, 0.02, "free travel"),),
)


def _drive(values: Values, motion: Motion, answer: Answer) -> Array:
    return motion.depth - values["gap"]


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    return ({"gap": 0.02 * around.peak_depth},)


EFFECT = Effect(CARD, "gap", drive=_drive, starts=_starts)
