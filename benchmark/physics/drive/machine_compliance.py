"""Machine compliance: the rig gives way in series with the tissue."""

from __future__ import annotations

import numpy as np

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Array, BodyResponse, Effect, Motion, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="machine_compliance",
    acts_on="drive",
    sentence="The rig bends under the load: the tissue is pressed less deep than the actuator shows.",
    equation="d -> d - c F",
    source="springs in series; ISO 14577-1, section on frame compliance",
    parameters=(linear("compliance", "m/N", 0.0, 0.1, "of the rig"),),
)
PASSES = 2


def _drive(values: Values, motion: Motion, response: BodyResponse) -> Array:
    compliance = values["compliance"]
    grid = np.linspace(0.0, max(float(motion.depth.max()), 1e-6), 400)
    shown = grid + compliance * response.elastic(grid)
    given = np.interp(motion.depth, shown, grid, left=0.0)
    given = np.where(motion.depth < 0.0, motion.depth, given)
    for _ in range(PASSES):
        extra = compliance * (response.force(given) - response.elastic(given))
        wanted = motion.depth - extra
        given = np.where(wanted < 0.0, wanted, np.interp(wanted, shown, grid, left=0.0))
    return given


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return ({"compliance": 0.03 * context.peak_depth / context.peak_force},)


EFFECT = Effect(DESCRIPTION, "compliance", drive=_drive, starts=_starts)
