"""Pretension: a tension that is there before the press."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmark.physics.description import EffectDescription, linear
from benchmark.physics.effect import Effect, LowerFaceMotion, PressHistory, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="pretension",
    acts_on="body",
    sentence="The specimen was under tension before the press, which adds a stiffness that is there from the start.",
    equation="F = f(d) + k d, for a membrane k = 2 pi T / ln(R / a); "
    "of its share of F a part q moves the lower face by t d / (2 r ln(R / a))",
    source="Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, chapter 13",
    parameters=(
        linear("stiffness", "N/m", 0.0, 1e5, "added stiffness k"),
        linear("field", "", 0.0, 1.0, "part q of the tension's share that shows in the lower face: 1 for a membrane"),
    ),
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import Pretension

    return {"pretension": Pretension(values["stiffness"])}


def _lower_face(values: Values, face: LowerFaceMotion, press: PressHistory, context: TrialContext) -> LowerFaceMotion:
    """The tension's share of the force makes the dent a membrane's, whose slope is d / (r ln(R / a))."""
    if not math.isfinite(context.hole_radius):
        return face
    carried = values["stiffness"] * press.surface
    pressed = press.elastic > 1e-9 * context.peak_force
    share = np.divide(carried, press.elastic, out=np.zeros_like(carried), where=pressed)
    share = values["field"] * np.clip(share, 0.0, 1.0)
    slope = face.depth / math.log(context.hole_radius / context.tool_radius)
    dent = 0.5 * context.thickness * share * slope
    return replace(face, passed=face.passed * (1.0 - share), dent=(dent, context.tool_radius))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    stiffness = 0.1 * context.peak_force / context.peak_depth
    return tuple({"stiffness": stiffness, "field": part} for part in (0.3, 1.0))


EFFECT = Effect(DESCRIPTION, "stiffness", body=_body, lower_face=_lower_face, starts=_starts)
