"""Dry friction: hysteresis that does not depend on the rate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmark.physics.description import EffectDescription, Option, linear, logarithmic, option
from benchmark.physics.effect import Effect, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="dry_friction",
    acts_on="body",
    sentence="Rubbing adds a force against the motion that does not depend on its speed.",
    equation="F = f + z, dz/dd = (F_c sign(d') - z) / length sign(d'), F_c = force + share f",
    needs=(("unloading",),),
    source="P. R. Dahl 1968, A solid friction model, TOR-0158(3107-18)-1",
    parameters=(
        linear(
            "friction_force",
            "N",
            0.0,
            100.0,
            "dry friction in the tissue that does not depend on the press",
            option=Option(0.0, 1e3),
            formerly="force",
        ),
        logarithmic(
            "friction_length",
            "m",
            1e-6,
            0.01,
            "travel over which friction builds up",
            option=Option(1e-9, 1.0),
            formerly="length",
        ),
        linear("friction_share", "", 0.0, 2.0, "friction over elastic force", formerly="coefficient"),
    ),
    options=(
        option(
            "friction_coefficient",
            "",
            0.0,
            10.0,
            "Coulomb friction between tool and tissue; needed by a rigid_frictional tool, in FEM and wave (going in)",
        ),
    ),
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import DryFriction

    return {"friction": DryFriction(values["friction_force"], values["friction_length"], values["friction_share"])}


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    names = ("friction_force", "friction_length", "friction_share")
    force, length = 0.02 * context.peak_force, 0.03 * context.peak_depth
    return tuple(
        dict(zip(names, values, strict=True)) for values in ((force, length, 0.005), (0.1 * force, length, 0.05))
    )


EFFECT = Effect(DESCRIPTION, "friction_force", body=_body, starts=_starts, amplitudes=("friction_share",))
