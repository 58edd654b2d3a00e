"""Pretension: a tension that is there before the press."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Effect, Press, Spread, Surroundings, Values

CARD = Card(
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


def _body(values: Values, around: Surroundings) -> Mapping[str, Any]:
    from wavemodel.physics import Pretension

    return {"pretension": Pretension(values["stiffness"])}


def _spread(values: Values, spread: Spread, press: Press, around: Surroundings) -> Spread:
    """The tension's share of the force makes the dent a membrane's, whose slope is d / (r ln(R / a))."""
    if not math.isfinite(around.hole_radius):
        return spread
    carried = values["stiffness"] * press.surface
    pressed = press.elastic > 1e-9 * around.peak_force
    share = np.divide(carried, press.elastic, out=np.zeros_like(carried), where=pressed)
    share = values["field"] * np.clip(share, 0.0, 1.0)
    slope = spread.depth / math.log(around.hole_radius / around.tool_radius)
    dent = 0.5 * around.thickness * share * slope
    return replace(spread, passed=spread.passed * (1.0 - share), dent=(dent, around.tool_radius))


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    stiffness = 0.1 * around.peak_force / around.peak_depth
    return tuple({"stiffness": stiffness, "field": part} for part in (0.3, 1.0))


EFFECT = Effect(CARD, "stiffness", body=_body, spread=_spread, starts=_starts)
