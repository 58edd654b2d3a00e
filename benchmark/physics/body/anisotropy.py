"""Anisotropy: x and y differ."""

from __future__ import annotations

import math
from dataclasses import replace

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, LowerFaceMotion, PressHistory, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="anisotropy",
    acts_on="body",
    sentence="The sheet is stiffer along one axis: the dent is drawn out, and markers along x and y move differently.",
    equation="T_x w_xx + T_y w_yy = -q: the dent at r' = sqrt(x^2 / sqrt(rho) + y^2 sqrt(rho)), rho = T_x / T_y",
    source="R. Haberman, Applied Partial Differential Equations, section 9.5 (scaling of the axes)",
    parameters=(linear("log_ratio", "", -2.3, 2.3, "natural logarithm of the tension along x over that along y", 0.1),),
    in_wave="in the markers alone",
    in_fem="in the markers alone; a layer's `fibre` makes x and y differ in a block",
)


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    return replace(face, ratio=math.exp(values["log_ratio"]))


EFFECT = Effect(DESCRIPTION, "log_ratio", lower_face=_lower_face, needs_markers=True)
