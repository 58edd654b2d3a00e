"""Strain stiffening: the force grows faster than the base law."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from benchmark.physics.description import EffectDescription, Option, linear
from benchmark.physics.effect import Array, Effect, FemTerm, TrialContext, Values

if TYPE_CHECKING:
    from fem import Problem

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
    in_fem="a Yeoh or Ogden term of the layers, identified so that the press stiffens as much; else quasi-linear",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import StrainStiffening

    return {"stiffening": StrainStiffening(values["b_1"], values["b_2"], context.thickness)}


def _in_fem(values: Values, problem: Problem, context: TrialContext) -> tuple[Problem, str]:
    from benchmark.physics.fem_identification import stiffened

    first, second = values.get("b_1", 0.0), values.get("b_2", 0.0)
    if first == second == 0.0:
        return problem, ""

    def factor(depth: Array) -> Array:
        x = depth / context.thickness
        return np.asarray(1.0 + first * x + second * x**2)

    peak = context.peak_force if context.control == "force" else context.peak_depth
    found = stiffened(problem, factor, context.control, peak)
    remark = (
        f"strain_stiffening is the law {found.law} in every layer, within {100 * found.misfit:.2g} % of its equation"
    )
    return found.problem, remark


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    x = context.peak_depth / context.thickness
    return {"b_1": 0.02 / x, "b_2": 0.2 / x**2}, {"b_1": 0.2 / x, "b_2": 0.02 / x**2}


EFFECT = Effect(
    DESCRIPTION,
    "b_2",
    body=_body,
    starts=_starts,
    amplitudes=("b_1",),
    fem=FemTerm(("b_1", "b_2"), _in_fem),
)
