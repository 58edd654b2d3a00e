"""Bottoming out: a stiff floor is met beyond a depth."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="bottoming_out",
    acts_on="body",
    sentence="Beyond a depth the tissue meets a stiff floor, and the force rises abruptly.",
    equation="F = f(d) + k l (s / l)^p, s = max(d - d_f, 0), l = 1 mm",
    source="Winkler foundation, p = 1; Hertz, p = 3/2; K. L. Johnson, Contact Mechanics, sections 4.2 and 4.3",
    parameters=(
        logarithmic("depth", "m", 1e-5, 0.2, "depth of the floor"),
        linear("stiffness", "N/m", 0.0, 1e6, "stiffness k of the floor, 1 mm deep in it"),
        linear("power", "", 1.0, 2.0, "power p: 1 for a flat floor, 3/2 for a domed one"),
    ),
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import Floor

    return {"floor": Floor(values["depth"], values["stiffness"], values["power"])}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    stiffness = 0.3 * context.peak_force / context.peak_depth
    pairs = ((0.4, 1.5), (0.7, 1.0), (0.7, 1.5), (0.85, 1.0), (0.93, 1.0))
    return tuple({"depth": share * context.peak_depth, "stiffness": stiffness, "power": p} for share, p in pairs)


EFFECT = Effect(DESCRIPTION, "stiffness", body=_body, starts=_starts)
