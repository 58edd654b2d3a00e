"""Poroelastic drainage: the force decays as fluid leaves the tissue."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.effects.effect import Card
from benchmark.effects.parameter import linear, logarithmic
from benchmark.effects.term import Effect, Surroundings, Values

CARD = Card(
    slug="poroelastic_drainage",
    acts_on="body",
    sentence="Fluid leaves the pressed tissue: the force decays over a time that grows with the contact size squared.",
    equation="F = int (1 - g (1 - phi(xi - xi'))) df, xi = int D / a^2 dt, phi of one-dimensional consolidation",
    source="H. F. Wang, Theory of Linear Poroelasticity, section 6.3; Hu et al. 2010, Appl Phys Lett 96:121904",
    parameters=(
        linear("g", "", 0.0, 0.95, "share of the force that drains away"),
        logarithmic("diffusivity", "m^2/s", 1e-12, 1e-2, "of the pore fluid"),
    ),
)


def _body(values: Values, around: Surroundings) -> Mapping[str, Any]:
    from wavemodel.physics import PoroelasticDrainage

    return {"drainage": PoroelasticDrainage(values["g"], values["diffusivity"], around.tool_radius)}


def _starts(around: Surroundings) -> tuple[dict[str, float], ...]:
    scale = around.tool_radius**2 / around.duration
    return tuple({"g": 0.2, "diffusivity": factor * scale} for factor in (0.5, 4.0, 30.0))


EFFECT = Effect(CARD, "g", body=_body, starts=_starts)
