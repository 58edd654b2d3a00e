"""Dry friction: hysteresis that does not depend on the rate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="dry_friction",
    acts_on="body",
    sentence="Rubbing adds a force against the motion that does not depend on its speed.",
    equation="F = f + z, dz/dd = (F_c sign(d') - z) / length sign(d'), F_c = force + coefficient f",
    source="P. R. Dahl 1968, A solid friction model, TOR-0158(3107-18)-1",
    parameters=(
        linear("force", "N", 0.0, 100.0, "friction that does not depend on the press"),
        logarithmic("length", "m", 1e-6, 0.01, "travel over which friction builds up"),
        linear("coefficient", "", 0.0, 2.0, "friction over elastic force"),
    ),
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import DryFriction

    return {"friction": DryFriction(values["force"], values["length"], values["coefficient"])}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    force, length = 0.02 * context.peak_force, 0.03 * context.peak_depth
    return (
        {"force": force, "length": length, "coefficient": 0.005},
        {"force": 0.1 * force, "length": length, "coefficient": 0.05},
    )


EFFECT = Effect(DESCRIPTION, "force", body=_body, starts=_starts)
