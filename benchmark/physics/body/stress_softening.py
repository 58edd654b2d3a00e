"""Stress softening: softer below the deepest depth reached so far."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="stress_softening",
    acts_on="body",
    sentence="Below the deepest depth reached so far the tissue is softer than at first, at any rate (Mullins).",
    equation="F = f (1 - s erf((1 - W / W_max) / m))",
    source="Ogden and Roxburgh 1999, Proc R Soc A 455:2861",
    parameters=(
        linear("strength", "", 0.0, 0.95, "largest share of the force that is lost"),
        logarithmic("width", "", 0.05, 5.0, "share of the energy given back at which softening is nearly full", 0.5),
    ),
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import StressSoftening

    return {"softening": StressSoftening(values["strength"], values["width"])}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return {"strength": 0.1, "width": 0.3}, {"strength": 0.1, "width": 1.0}


EFFECT = Effect(DESCRIPTION, "strength", body=_body, starts=_starts)
