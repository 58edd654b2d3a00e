"""Bottoming out: a stiff floor is met beyond a depth."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear, logarithmic
from benchmark.effects.term import Effect, Surroundings, Values

CARD = Card(
    slug="bottoming_out",
    acts_on="body",
    sentence="Beyond a depth the tissue meets a stiff floor, and the force rises abruptly.",
    equation="F = f(d) + k max(d - d_f, 0)",
    source="Winkler foundation; K. L. Johnson, Contact Mechanics, section 4.3",
    parameters=(
        logarithmic("depth", "m", 1e-5, 0.2, "depth of the floor"),
        linear("stiffness", "N/m", 0.0, 1e6, "stiffness of the floor"),
    ),
)


def _body(values: Values, around: Surroundings) -> Mapping[str, Any]:
    from wavemodel.physics import Floor

    return {"floor": Floor(values["depth"], values["stiffness"])}


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    stiffness = 0.3 * around.peak_force / around.peak_depth
    return tuple({"depth": share * around.peak_depth, "stiffness": stiffness} for share in (0.7, 0.85, 0.93))


EFFECT = Effect(CARD, "stiffness", body=_body, starts=_starts)
