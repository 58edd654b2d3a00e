"""Strain stiffening: the force grows faster than the base law."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, Option, linear
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="strain_stiffening",
    acts_on="body",
    sentence="The tissue becomes stiffer the deeper it is pressed: the force grows faster than the base law.",
    equation="F = f(d) (1 + b_1 x + b_2 x^2), x = d / thickness",
    source="Hayes et al. 1972, J Biomech 5:541 (linear law); first terms of any smooth hyperelastic correction",
    parameters=(
        linear(
            "b_1",
            "",
            0.0,
            30.0,
            "growth b_1 of the force with depth over thickness",
            option=Option(0.0, 1e4, default=0.0, key="stiffening_linear"),
        ),
        linear(
            "b_2",
            "",
            0.0,
            300.0,
            "growth b_2 with depth over thickness squared",
            option=Option(0.0, 1e4, default=0.0, key="stiffening_quadratic"),
        ),
    ),
    in_wave="on top of its elastic law",
    in_fem="Yeoh terms of the layers in finite strain, identified so that it stiffens as much; else quasi-linear",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import StrainStiffening

    return {"stiffening": StrainStiffening(values["b_1"], values["b_2"], context.thickness)}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    x = context.peak_depth / context.thickness
    return {"b_1": 0.02 / x, "b_2": 0.2 / x**2}, {"b_1": 0.2 / x, "b_2": 0.02 / x**2}


EFFECT = Effect(DESCRIPTION, "b_2", body=_body, starts=_starts, amplitudes=("b_1",))
