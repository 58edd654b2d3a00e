"""Poroelastic drainage: the force decays as fluid leaves the tissue."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="poroelastic_drainage",
    acts_on="body",
    sentence="Fluid leaves the pressed tissue: the force decays over a time that grows with the contact size squared.",
    equation="F = int (1 - g (1 - phi(xi - xi'))) df, xi = int D / a^2 dt, "
    "a of the contact, phi of one-dimensional consolidation",
    needs=(("hold", "second_rate"),),
    source="H. F. Wang, Theory of Linear Poroelasticity, section 6.3; Hu et al. 2010, Appl Phys Lett 96:121904",
    parameters=(
        linear(
            "drainage_share",
            "",
            0.0,
            0.95,
            "share g of the force that drains away",
            option=Option(0.0, 0.99),
            formerly="g",
        ),
        logarithmic(
            "drainage_diffusivity",
            "m^2/s",
            1e-12,
            1e-2,
            "diffusivity D of the pore fluid",
            option=Option(1e-15, 1.0),
            formerly="diffusivity",
        ),
    ),
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import PoroelasticDrainage

    edge = 0.0 if context.contact == "rigid_bonded" else context.edge_radius
    share, diffusivity = values["drainage_share"], values["drainage_diffusivity"]
    return {"drainage": PoroelasticDrainage(share, diffusivity, context.tool_radius, edge)}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    scale = context.tool_radius**2 / context.duration
    return tuple({"drainage_share": 0.2, "drainage_diffusivity": factor * scale} for factor in (0.5, 4.0, 30.0))


def _diffusion(values: Values, context: TrialContext) -> float:
    """Time of diffusion under the tool, a^2 / D, s."""
    return float(context.tool_radius**2 / values["drainage_diffusivity"])


EFFECT = Effect(
    DESCRIPTION,
    "drainage_share",
    body=_body,
    starts=_starts,
    acts_within=_diffusion,
    further_terms_of="viscoelastic_relaxation",
)
