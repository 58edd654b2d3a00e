"""Strain stiffening: the force grows faster than the base law."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic
from benchmark.physics.effect import Effect, FemTerm, TrialContext, Values

if TYPE_CHECKING:
    from fem import Problem
    from wavemodel.physics import StrainStiffening

FIRST_TERMS = (
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
)
DESCRIPTION = EffectDescription(
    slug="strain_stiffening",
    acts_on="body",
    sentence="The tissue becomes stiffer the deeper it is pressed: the force grows faster than the base law.",
    equation="F = f(d) (1 + b_1 x + b_2 x^2), x = d / thickness (a half-space: over four tool radii)",
    source="Hayes et al. 1972, J Biomech 5:541 (linear law); first terms of any smooth hyperelastic correction",
    parameters=FIRST_TERMS,
    in_wave="on top of its elastic law",
    in_fem="a Yeoh or Ogden term of the layers, identified so that the press stiffens as much; else quasi-linear",
)
EXPONENTIAL = replace(
    DESCRIPTION,
    equation="F = f(d) (1 + (b_1 x + b_2 x^2) e^(b_3 x^2)), x = d / thickness (a half-space: over four tool radii)",
    source=f"{DESCRIPTION.source}; Y. C. Fung 1967, Am J Physiol 213:1532 (exponential law)",
    parameters=(*FIRST_TERMS, logarithmic("b_3", "", 1e-3, 1e3, "exponent b_3 with which those grow")),
    may_lack=(("b_3",),),
)


def _law(values: Values, context: TrialContext) -> StrainStiffening:
    from wavemodel.physics import StrainStiffening

    b_1, b_2, b_3 = (values.get(name, 0.0) for name in ("b_1", "b_2", "b_3"))
    return StrainStiffening(b_1, b_2, context.thickness, b_3)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    return {"stiffening": _law(values, context)}


def _in_fem(values: Values, problem: Problem, context: TrialContext) -> tuple[Problem, str]:
    from benchmark.physics.fem_identification import stiffened

    law = _law(values, context)
    if law.linear == law.quadratic == 0.0:
        return problem, ""
    peak = context.peak_force if context.control == "force" else context.peak_depth
    found = stiffened(problem, law.factor, context.control, peak)
    remark = (
        f"strain_stiffening is the law {found.law} in every layer, within {100 * found.misfit:.2g} % of its equation"
    )
    return found.problem, remark


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    x = context.peak_depth / context.thickness
    return {"b_1": 0.02 / x, "b_2": 0.2 / x**2}, {"b_1": 0.2 / x, "b_2": 0.02 / x**2}


def _steeper_starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    x = context.peak_depth / context.thickness
    return tuple(start | {"b_3": share / x**2} for start in _starts(context) for share in (0.5, 1.5))


STEEPER = Effect(
    EXPONENTIAL,
    "b_2",
    body=_body,
    starts=_steeper_starts,
    amplitudes=("b_1",),
    form=("b_3",),
    fem=FemTerm(("b_1", "b_2", "b_3"), _in_fem),
)
EFFECT = replace(STEEPER, description=DESCRIPTION, starts=_starts, richer=STEEPER, fem=FemTerm(("b_1", "b_2"), _in_fem))
