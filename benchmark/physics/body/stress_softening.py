"""Stress softening: softer below the deepest depth reached so far."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="stress_softening",
    acts_on="body",
    sentence="Below the deepest depth reached so far the tissue is softer than at first, at any rate (Mullins).",
    equation="F = f (1 - s erf((1 - W / W_max) / m))",
    needs=(("unloading",),),
    source="Ogden and Roxburgh 1999, Proc R Soc A 455:2861",
    parameters=(
        linear(
            "softening",
            "",
            0.0,
            0.95,
            "largest share s of the force that is lost below the deepest depth so far (Mullins)",
            option=Option(0.0, 0.99, example="0.2"),
            formerly="strength",
        ),
        logarithmic(
            "softening_width",
            "",
            0.05,
            5.0,
            "share m of the energy given back at which softening is nearly full",
            0.5,
            option=Option(0.01, 100.0, default=0.5),
            formerly="width",
        ),
    ),
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import StressSoftening

    return {"softening": StressSoftening(values["softening"], values["softening_width"])}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    return {"softening": 0.1, "softening_width": 0.3}, {"softening": 0.1, "softening_width": 1.0}


EFFECT = Effect(DESCRIPTION, "softening", body=_body, starts=_starts)
