"""Viscous damping: a force with the speed of the press."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear
from benchmark.effects.term import Effect, Surroundings, Values

CARD = Card(
    slug="viscous_damping",
    acts_on="body",
    sentence="The tissue resists in proportion to the speed of the press, without any memory in a hold.",
    equation="F = f + eta df/dt",
    source="Kelvin-Voigt solid; Simo and Hughes, Computational Inelasticity, chapter 10",
    parameters=(linear("eta", "s", 0.0, 10.0, "retardation time"),),
)


def _body(values: Values, around: Surroundings) -> Mapping[str, Any]:
    from wavemodel.physics import ViscousDamping

    return {"damping": ViscousDamping(values["eta"])}


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    return ({"eta": 0.003 * around.duration},)


EFFECT = Effect(CARD, "eta", body=_body, starts=_starts)
