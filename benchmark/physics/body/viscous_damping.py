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
    equation="F = f + eta df/dt + c v_0 sign(v) |v / v_0|^n, v_0 = 1 mm/s",
    needs=(("unloading", "hold", "second_rate"),),
    source="Kelvin-Voigt solid; Simo and Hughes, Computational Inelasticity, chapter 10; power-law fluid for n < 1",
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
        linear("power", "", 0.5, 1.5, "power n of the speed in that resistance"),
    ),
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
    if values["drag"] <= 0.0:
        return readings
    speed = np.gradient(motion.depth, motion.time) / REFERENCE_SPEED
    formed = np.clip(motion.depth / (FORMED * context.peak_depth), 0.0, 1.0)
    resisted = values["drag"] * REFERENCE_SPEED * formed * np.sign(speed) * np.abs(speed) ** values["power"]
    pushed = readings.force + resisted
    return replace(readings, force=np.where(motion.depth > 0.0, np.maximum(pushed, 0.0), readings.force))


def _starts(context: TrialContext) -> tuple[dict[str, float], ...]:
    slowest = context.peak_depth / context.duration
    drag = 0.01 * context.peak_force / max(slowest, 1e-9)
    kelvin = {"damping_time": 0.003 * context.duration, "drag": 0.0, "power": 1.0}
    return kelvin, {"damping_time": 0.0, "drag": drag, "power": 1.0}, {"damping_time": 0.0, "drag": drag, "power": 0.8}


EFFECT = Effect(DESCRIPTION, "damping_time", body=_body, observe=_observe, starts=_starts, amplitudes=("drag",))
