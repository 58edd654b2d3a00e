"""Viscous damping: a force with the speed of the press."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from benchmark.physics.description import EffectDescription, Option, linear
from benchmark.physics.effect import Effect, Motion, Readings, TrialContext, Values

DESCRIPTION = EffectDescription(
    slug="viscous_damping",
    acts_on="body",
    sentence="The tissue resists the speed of the press, without any memory in a hold.",
    equation="F = f + eta df/dt + (c + lambda F) v_0 sign(v) |v / v_0|^n, v_0 = 1 mm/s",
    needs=(("unloading", "hold", "second_rate"),),
    source="Kelvin-Voigt solid; Simo and Hughes, Computational Inelasticity, chapter 10; power-law fluid for n < 1; "
    "Hunt and Crossley 1975, J Appl Mech 42:440 (damping that grows with the contact)",
    parameters=(
        linear(
            "damping_time",
            "s",
            0.0,
            10.0,
            "Kelvin-Voigt time eta of a force with the speed of the press",
            option=Option(1e-6, 1e7),
            formerly="eta",
        ),
        linear("drag", "N s/m", 0.0, 1e5, "resistance c at 1 mm/s, whatever the depth"),
        linear("drag_growth", "s/m", 0.0, 1e4, "growth lambda of that resistance with the force"),
        linear("power", "", 0.5, 1.0, "power n of the speed in that resistance", stated=(0.5, 1.5)),
    ),
    may_lack=(("drag_growth",),),
    in_wave="on top of its elastic law",
    in_fem="quasi-linear: on top of its elastic answer, in `run --model` only",
)
REFERENCE_SPEED = 1e-3
FORMED = 0.1
"""Share of the deepest press over which the contact forms, and with it the resistance c."""


def _body(values: Values, context: TrialContext) -> Mapping[str, Any]:
    from wavemodel.physics import ViscousDamping

    return {"damping": ViscousDamping(values["damping_time"])}


def _observe(values: Values, readings: Readings, motion: Motion, context: TrialContext) -> Readings:
    growth = values.get("drag_growth", 0.0)
    if values["drag"] <= 0.0 and growth <= 0.0:
        return readings
    speed = motion.speed / REFERENCE_SPEED
    formed = np.clip(motion.depth / (FORMED * context.peak_depth), 0.0, 1.0)
    resistance = (values["drag"] * formed + growth * np.maximum(readings.force, 0.0)) * REFERENCE_SPEED
    pushed = readings.force + resistance * np.sign(speed) * np.abs(speed) ** values["power"]
    return replace(readings, force=np.where(motion.depth > 0.0, np.maximum(pushed, 0.0), readings.force))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    slowest = context.peak_depth / context.duration
    drag = 0.01 * context.peak_force / max(slowest, 1e-9)
    growth = 0.01 / max(slowest, 1e-9)
    none = {"damping_time": 0.0, "drag": 0.0, "drag_growth": 0.0, "power": 1.0}
    kelvin = none | {"damping_time": 0.003 * context.duration}
    drags = [none | {"drag": drag, "power": power} for power in (1.0, 0.8)]
    growing = [none | {"drag_growth": growth, "power": power} for power in (1.0, 0.8)]
    return kelvin, *drags, *growing


EFFECT = Effect(
    DESCRIPTION,
    "damping_time",
    body=_body,
    observe=_observe,
    starts=_starts,
    amplitudes=("drag", "drag_growth"),
    like_delay=True,
)
