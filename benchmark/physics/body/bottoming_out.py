"""Bottoming out: a stiff floor is met beyond a depth."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="bottoming_out",
    acts_on="body",
    sentence="Beyond a depth the tissue meets a stiff floor, and the force rises abruptly.",
    equation="F = f(d) + k l (s / l)^p, s = max(d - d_f, 0), l = 1 mm",
    source="Winkler foundation, p = 1; Hertz, p = 3/2; K. L. Johnson, Contact Mechanics, sections 4.2 and 4.3",
    parameters=(
        logarithmic(
            "floor_depth",
            "m",
            1e-5,
            0.2,
            "depth d_f of the press at which a stiff floor is met; over a hole the lower face is taken to be as deep",
            option=Option(1e-9, 1e5, example="6 mm"),
            formerly="depth",
        ),
        linear(
            "floor_stiffness",
            "N/m",
            0.0,
            1e6,
            "stiffness k of the floor, 1 mm deep in it",
            option=Option(0.0, 1e8, above=True, default=1e6),
            formerly="stiffness",
        ),
        linear("power", "", 1.0, 1.5, "power p: 1 for a flat floor, 3/2 for a domed one", stated=(1.0, 3.0)),
    ),
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import Floor

    return {"floor": Floor(values["floor_depth"], values["floor_stiffness"], values["power"])}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    stiffness = 0.3 * context.peak_force / context.peak_depth
    pairs = ((0.4, 1.5), (0.7, 1.0), (0.7, 1.5), (0.85, 1.0), (0.93, 1.0))
    return tuple(
        {"floor_depth": share * context.peak_depth, "floor_stiffness": stiffness, "power": p} for share, p in pairs
    )


EFFECT = Effect(DESCRIPTION, "floor_stiffness", body=_body, starts=_starts)
