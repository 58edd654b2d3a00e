"""Machine compliance: the rig gives way in series with the tissue."""

from __future__ import annotations

import numpy as np

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Array, BodyResponse, Effect, Motion, TrialContext, Values

PASSES = 2
COMPLIANCE = linear("compliance", "m/N", 0.0, 0.1, "of the rig; where it is no constant, at a force of 1 N")
POWER = linear("power", "", 0.5, 2.0, "power n: 1 for a spring, 2/3 for domes in contact, more for worn guides")


def _description(*, curved: bool = False) -> EffectDescription:
    return EffectDescription(
        slug="machine_compliance",
        acts_on="drive",
        sentence="The rig bends under the load: the tissue is pressed less deep than the actuator shows.",
        equation="d -> d - c F_1 (F / F_1)^n, F_1 = 1 N" if curved else "d -> d - c F",
        source="springs in series; ISO 14577-1, section on frame compliance"
        + ("; K. L. Johnson, Contact Mechanics, section 4.2 (n = 2/3)" if curved else ""),
        parameters=(COMPLIANCE, POWER) if curved else (COMPLIANCE,),
        may_lack=(("power",),) if curved else (),
    )


def _given_way(values: Values, force: Array) -> Array:
    """Depth (n,) m that the rig loses under forces (n,) N."""
    return np.asarray(values["compliance"] * np.sign(force) * np.abs(force) ** values.get("power", 1.0))


def _drive(values: Values, motion: Motion, response: BodyResponse) -> Array:
    grid = np.linspace(0.0, max(float(motion.depth.max()), 1e-6), 400)
    shown = grid + _given_way(values, response.elastic(grid))
    given = np.interp(motion.depth, shown, grid, left=0.0)
    given = np.where(motion.depth < 0.0, motion.depth, given)
    for _ in range(PASSES):
        extra = _given_way(values, response.force(given)) - _given_way(values, response.elastic(given))
        wanted = motion.depth - extra
        given = np.where(wanted < 0.0, wanted, np.interp(wanted, shown, grid, left=0.0))
    return given


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return ({"compliance": 0.03 * context.peak_depth / context.peak_force},)


def _curved_starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    lost = 0.03 * context.peak_depth
    return tuple({"compliance": lost / context.peak_force**power, "power": power} for power in (0.8, 1.4))


CURVED = Effect(_description(curved=True), "compliance", drive=_drive, starts=_curved_starts)
EFFECT = Effect(_description(), "compliance", drive=_drive, starts=_starts, richer=CURVED)
