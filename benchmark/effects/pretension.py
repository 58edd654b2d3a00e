"""Pretension: a tension that is there before the press."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Effect, Surroundings, Values

CARD = Card(
    slug="pretension",
    acts_on="body",
    sentence="The specimen was under tension before the press, which adds a stiffness that is there from the start.",
    equation="F = f(d) + k d, for a membrane k = 2 pi T / ln(R / a)",
    source="Timoshenko and Woinowsky-Krieger, Theory of Plates and Shells, chapter 13",
    parameters=(linear("stiffness", "N/m", 0.0, 1e5, "added stiffness k"),),
)


def _body(values: Values, around: Surroundings) -> Mapping[str, Any]:
    from wavemodel.physics import Pretension

    return {"pretension": Pretension(values["stiffness"])}


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    return ({"stiffness": 0.1 * around.peak_force / around.peak_depth},)


EFFECT = Effect(CARD, "stiffness", body=_body, starts=_starts)
